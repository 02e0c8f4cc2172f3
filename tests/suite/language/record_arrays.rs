//! Functions that rearrange arrays of records in models (MLS §10.3.3, §10.3.5, §10.4.2).

use gapilib::Session;
use gapilib::internals::syntax::ast::ExpressionKind;
use gapilib::world::MemoryWorld;
use std::sync::Arc;

const MODEL: &str = include_str!("../../data/models/record_arrays_model.mo");

#[test]
fn records_are_filled_joined_and_transposed() {
    let world = MemoryWorld::new().with_file("M.mo", MODEL);
    let streams = world.streams();
    let script = "openModel(\"M.mo\");
simulateModel(\"M\", stopTime = 0.5, resultFile = \"r\");
names := {\"filled[2].x\", \"joined[3].x\", \"joined[2].y[2]\", \"joined[3].y[1]\",
          \"turned[1, 2].x\", \"turned[1, 1].y[2]\", \"turned[1, 2].y[2]\", \"given[2].y[1]\", \"twice[2].y[2]\",
          \"t\", \"ramp\"};
for i in 1:size(names, 1) loop
  value := readTrajectory(\"r.mat\", {names[i]}, readTrajectorySize(\"r.mat\"));
  print(names[i] + \" \" + String(value[1, end]));
end for;";
    let status = Session::new(Box::new(world)).run_text("s.mos", script);
    assert_eq!((status.code, streams.errors().as_str()), (0, ""));
    let output = streams.output();
    let values: Vec<&str> = output
        .lines()
        .filter_map(|line| line.rsplit_once(' ').map(|(_, value)| value))
        .filter(|value| value.parse::<f64>().is_ok())
        .collect();
    // total(filled) + 2 total(filled), and 6 time.
    let expected = ["0.5", "3", "2", "4", "6", "2", "8", "10", "4", "10.5", "3"];
    assert_eq!(values, expected, "{output}");
}

/// A value that a function computes for a whole record is kept once, however many components it has:
/// otherwise a hundred components of a function of a hundred components would be ten thousand.
#[test]
fn the_components_of_a_computed_record_share_its_value() {
    let flat = crate::language::library_forms::flattened(
        "record R Real a; Real b; end R; \
         function made input Real x; output R r; algorithm r.a := x; r.b := x; end made; \
         model M parameter R r = made(2); end M;",
    )
    .model;
    let record = |name: &str| match &flat.variables[name].binding.as_ref().unwrap().kind {
        ExpressionKind::Field { base, .. } => base.clone(),
        other => panic!("{other:?}"),
    };
    assert!(Arc::ptr_eq(&record("r.a"), &record("r.b")));
}
