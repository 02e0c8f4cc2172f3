//! Algorithm sections of models whose loops and subscripts depend on variables (MLS §11.1.1, §11.2).

use crate::support::shipped;
use gapilib::Session;

const PACKAGE: &str = include_str!("../../data/models/algorithms_package.mo");

/// The last values of variables, or what is wrong.
fn last(model: &str, names: &[&str]) -> Result<Vec<f64>, String> {
    let world = shipped::world().with_file("L.mo", PACKAGE);
    let streams = world.streams();
    let list = names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
    let script = format!(
        "openModel(\"L.mo\");
        simulateModel(\"L.{model}\", stopTime = 1, tolerance = 1e-9, resultFile = \"r\");
        all := readTrajectory(\"r.mat\", {{{list}}}, readTrajectorySize(\"r.mat\"));
        last := all[:, end];"
    );
    let mut session = Session::new(Box::new(world));
    session.run_text("s.mos", &script);
    match streams.errors() {
        errors if errors.is_empty() => {}
        errors => return Err(errors),
    }
    let values = session.variable("last").expect("values");
    Ok(values.as_reals().expect("numbers").into_owned())
}

fn close(model: &str, names: &[&str], expected: &[f64]) {
    let found = last(model, names).unwrap_or_else(|errors| panic!("{model}: {errors}"));
    for ((name, found), expected) in names.iter().zip(found).zip(expected) {
        assert!((found - expected).abs() < 1e-7, "{model}: {name} = {found}, not {expected}");
    }
}

#[test]
fn loops_may_end_where_variables_say() {
    close("Units", &["x", "rest", "n"], &[3.25, 0.25, 3.0]);
    close("Root", &["y"], &[2f64.sqrt()]);
    close("Parts", &["c[1]", "c[2]", "z"], &[0.1, 0.2, 0.3]);
}

#[test]
fn at_events_they_run_once() {
    // s[2] reaches 6 at the fourth sample, which ends the loop there.
    let names = ["s[1]", "s[2]", "s[3]", "s[4]", "k"];
    close("Sampled", &names, &[4.0, 6.0, 3.0, 0.0, 4.0]);
}

#[test]
fn what_goes_wrong_in_them_is_told() {
    let errors = last("Endless", &["y"]).expect_err("no end");
    assert!(errors.contains("more than 20 million instructions"), "{errors}");
    let errors = last("Asserts", &["y"]).expect_err("an assertion");
    assert!(errors.contains("y is too large (at t = 0.7"), "{errors}");
    // A discrete variable would change where no event is.
    let errors = last("Wanders", &["n"]).expect_err("no events");
    assert!(errors.contains("`n` is discrete"), "{errors}");
}
