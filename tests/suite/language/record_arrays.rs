//! Functions that rearrange arrays of records in models (MLS §10.3.3, §10.3.5, §10.4.2).

use crate::support::simulated::simulated;
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

/// Subscripts of one part of `q[…].a[…].v[…]`, each of which has three elements, which of them it
/// chooses, and whether the dimension stays; `k` is a variable with the value 2.
const SUBSCRIPTS: [(&str, &[usize], bool); 6] = [
    ("", &[0, 1, 2], true),
    ("[2]", &[1], false),
    ("[:]", &[0, 1, 2], true),
    ("[{3, 1}]", &[2, 0], true),
    ("[end]", &[2], false),
    ("[k]", &[1], false),
];

/// A slice as it is written, the places of its elements among the 27 in order, and its sizes.
struct Slice {
    text: String,
    places: Vec<usize>,
    dims: Vec<usize>,
}

/// Each way to write a slice.
fn slices() -> Vec<Slice> {
    let mut all = Vec::new();
    for outer in SUBSCRIPTS {
        for inner in SUBSCRIPTS {
            for last in SUBSCRIPTS {
                let of_part = |h: usize, i: usize| last.1.iter().map(move |j| 9 * h + 3 * i + j);
                let of_record = |h: &usize| inner.1.iter().flat_map(|i| of_part(*h, *i)).collect();
                let places: Vec<Vec<usize>> = outer.1.iter().map(of_record).collect();
                let parts = [outer, inner, last].into_iter().filter(|(.., stays)| *stays);
                all.push(Slice {
                    text: format!("q{}.a{}.v{}", outer.0, inner.0, last.0),
                    places: places.concat(),
                    dims: parts.map(|(_, chosen, _)| chosen.len()).collect(),
                });
            }
        }
    }
    all
}

/// The numbers 1, 2, … as an array of these sizes.
fn weights(dims: &[usize], next: &mut u32) -> String {
    let Some((n, inner)) = dims.split_first() else {
        *next += 1;
        return format!("{next}.0");
    };
    let elements: Vec<String> = (0..*n).map(|_| weights(inner, next)).collect();
    format!("{{{}}}", elements.join(", "))
}

/// The sum of values times 1, 2, …
fn weighted(values: impl Iterator<Item = f64>) -> f64 {
    values.zip(1..).map(|(value, weight)| value * f64::from(weight)).sum()
}

/// `v[:].x[2]` chooses in the vectors of the records, not among the records (MLS §10.5): what a
/// function reads and assigns, inlined and compiled, with the places counted by hand.
#[test]
fn subscripts_of_slices_of_records_belong_to_their_parts() {
    let initial = |place: usize| (place * place + 3) as f64;
    let (mut functions, mut variables, mut expected) = (String::new(), String::new(), Vec::new());
    let header =
        "input Whole given[3]; output Real s; protected Whole q[3] = given; Integer k = 2;";
    let all = weights(&[3, 3, 3], &mut 0);
    for (at, Slice { text: slice, places, dims }) in slices().into_iter().enumerate() {
        // What a `while` is in is compiled.
        let compiled = "while k > 2 loop k := k - 1; end while;";
        let own = weights(&dims, &mut 0);
        for (name, statement) in [("i", ""), ("c", compiled)] {
            functions += &format!(
                "function r{name}{at} {header} algorithm {statement} \
                 s := sum({{{slice} .* {own}}}); end r{name}{at};
                 function a{name}{at} {header} algorithm {statement} {slice} := -2*{slice}; \
                 s := sum(q.a.v .* {all}); end a{name}{at};\n"
            );
            for kind in ["r", "a"] {
                variables += &format!("Real {kind}{name}{at} = {kind}{name}{at}(q);\n");
                let value = |place: usize| match places.contains(&place) {
                    true => -2.0 * initial(place),
                    false => initial(place),
                };
                let sum = match kind {
                    "r" => weighted(places.iter().map(|place| initial(*place))),
                    _ => weighted((0..27).map(value)),
                };
                expected.push((format!("{kind}{name}{at}"), slice.clone(), sum));
            }
        }
    }
    let run = simulated(
        &format!(
            "package S record Part Real v[3]; end Part; record Whole Part a[3]; end Whole;
             function made input Real x; output Whole q[3]; algorithm for h in 0:2 loop \
             for i in 0:2 loop for j in 0:2 loop \
             q[h + 1].a[i + 1].v[j + 1] := x*((9*h + 3*i + j)^2 + 3); \
             end for; end for; end for; end made; {functions} end S;
             model M import S.*; Whole q[3] = made(if time < 1 then 1 else 2); {variables} end M;"
        ),
        0.1,
    );
    for (variable, slice, sum) in expected {
        let value = run.last(&variable);
        assert!((value - sum).abs() < 1e-9 * sum.abs(), "{variable}, {slice}: {value}, not {sum}");
    }
}

/// Values at 1 s, computed by hand.
#[test]
fn arrays_of_records_are_assigned_in_algorithms() {
    let models = include_str!("../../data/models/record_arrays_assigned.mo");
    let of = |model: &str| format!("{models}\nmodel Own = Assigned.{model};");
    let expected: &[(&str, &[(&str, f64)])] = &[
        ("Whole", &[("b[1].v", 2.0), ("b[1].w[1]", 2.0), ("b[2].v", 1.0), ("b[2].w[2]", 1.0)]),
        (
            "Slices",
            &[
                ("b[1].v", 8.0),
                ("b[2].v", 9.0),
                ("b[3].v", 100.0),
                ("b[2].w[1]", 10.0),
                ("b[2].w[2]", 1.0),
                ("c[2].v", 100.0),
                ("c[2].w[1]", 20.0),
            ],
        ),
        ("Elements", &[("b[2].v", 1.0), ("b[2].w[2]", 3.0), ("b[3].v", 3.0), ("b[3].w[1]", 2.0)]),
        ("Nested", &[("n[1].r[2].v", 2.0), ("n[2].r[1].w[2]", 6.0), ("n[2].r[2].w[1]", 2.0)]),
        ("Matrix", &[("b[2,1].v", 60.0), ("b[2,2].v", 4.0), ("b[1,2].w[1]", 2.0)]),
        ("Branches", &[("b[2].v", 6.0), ("b[2].w[2]", 3.0)]),
        ("Outputs", &[("b[2].v", 2.0), ("y", 1.0)]),
        ("Events", &[("b[2].v", 2.0), ("b[2].w[1]", 2.0)]),
        ("Parts", &[("p[1].s", 3.0), ("p[2].s", 6.0), ("p[2].b[3].w[1]", 3.0)]),
        ("Iterators", &[("s", 36.0), ("t[2]", 6.0), ("u", 12.0), ("q[1]", 2.0)]),
    ];
    for (model, values) in expected {
        let run = simulated(&of(model), 1.0);
        for (name, value) in *values {
            let found = run.last(name);
            assert!((found - value).abs() < 1e-9, "{model}: {name} = {found}");
        }
    }
    let said = crate::support::simulated::refused(&of("WrongSize"));
    assert!(said.starts_with("array-mismatch"), "{said}");
}
