//! Inputs whose values are recorded samples: what the model sees of them, and when events happen.

use crate::support::flat_class::flat;
use gapilib::internals::causalize::causalize;
use gapilib::internals::codegen::Program;
use gapilib::internals::flatten::RecordedInput;
use gapilib::internals::sim::{OutputGrid, Settings, Statistics, Trajectory, simulate};
use std::sync::Arc;

/// Name of an input, whether it is held, times, values.
pub(super) type Recorded<'a> = (&'a str, bool, &'a [f64], &'a [f64]);

/// A model of which inputs follow samples.
pub(super) fn program(text: &str, inputs: &[Recorded<'_>]) -> Arc<Program> {
    let mut model = flat(text);
    let recorded = inputs.iter().map(|(name, is_held, times, values)| RecordedInput {
        name: (*name).into(),
        times: (*times).into(),
        values: (*values).into(),
        is_held: *is_held,
    });
    model.recorded = recorded.collect();
    Program::compile(causalize(&model).expect("it can be sorted")).expect("it compiles")
}

fn run(program: &Arc<Program>, names: &[&str], at: &[f64]) -> (Trajectory, Statistics) {
    let mut system = program.system();
    let found = names.iter().map(|name| program.find_variable(name).expect("a variable"));
    system.observe_only(&found.collect::<Vec<_>>());
    let settings = Settings {
        stop: at[at.len() - 1],
        output: OutputGrid::At(at.to_vec()),
        tolerance: 1e-10,
        ..Settings::default()
    };
    simulate(&mut system, &settings).expect("a simulation")
}

/// The values of a column in the rows of this time.
fn rows(trajectory: &Trajectory, column: usize, time: f64) -> Vec<f64> {
    let rows = trajectory.time().iter().zip(trajectory.column(column));
    rows.filter(|(t, _)| **t == time).map(|(_, value)| *value).collect()
}

const INTEGRATOR: &str = "model M input Real u; Real x(start = 1, fixed = true); \
    equation der(x) = u; end M;";

#[test]
fn a_held_input_jumps_at_its_samples() {
    let (times, values) = ([0.5, 1.0, 2.0, 3.0, 4.0], [3.0, -1.0, -1.0, 2.0, 0.0]);
    let program = program(INTEGRATOR, &[("u", true, &times, &values)]);
    let (found, statistics) = run(&program, &["u", "x"], &[0.0, 0.5, 1.0, 2.0, 2.5, 3.0, 6.0]);
    assert_eq!(rows(&found, 0, 0.0), [3.0], "before the first sample it has its value");
    assert_eq!(rows(&found, 0, 1.0), [3.0, -1.0]);
    assert_eq!(rows(&found, 0, 2.5), [-1.0]);
    assert_eq!(rows(&found, 0, 6.0), [0.0], "after the last sample it has its value");
    // Neither the first sample nor one that equals the one before needs an event.
    assert_eq!(statistics.time_events, 4);
    for (time, x) in [(0.5, 2.5), (1.0, 4.0), (2.5, 2.5), (3.0, 2.0), (6.0, 4.0)] {
        let last = rows(&found, 1, time).pop().expect("a row");
        assert!((last - x).abs() < 1e-9, "{time}: {last}");
    }
}

#[test]
fn a_linear_input_bends_at_its_samples_and_jumps_where_two_have_one_time() {
    let (times, values) = ([0.0, 1.0, 2.0, 2.0, 3.0], [0.0, 2.0, 2.0, 5.0, 4.0]);
    let program = program(INTEGRATOR, &[("u", false, &times, &values)]);
    let (found, _) = run(&program, &["u", "x"], &[0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0]);
    for (time, u) in [(0.5, 1.0), (1.5, 2.0), (2.5, 4.5), (4.0, 4.0)] {
        assert_eq!(rows(&found, 0, time), [u]);
    }
    assert_eq!(rows(&found, 0, 2.0), [2.0, 5.0]);
    for (time, x) in [(0.5, 1.25), (1.0, 2.0), (2.0, 4.0), (3.0, 8.5), (4.0, 12.5)] {
        let last = rows(&found, 1, time).pop().expect("a row");
        assert!((last - x).abs() < 1e-9, "{time}: {last}");
    }
}

#[test]
fn the_derivative_of_a_linear_input_is_its_slope() {
    // The position is prescribed: index reduction asks for the derivative of the input.
    let text = "model M input Real u; Real x; Real v; Real w(start = 0, fixed = true); \
        equation x = u; der(x) = v; der(w) = v*v; end M;";
    let (times, values) = ([0.0, 1.0, 3.0], [0.0, 2.0, -2.0]);
    let program = program(text, &[("u", false, &times, &values)]);
    let (found, _) = run(&program, &["v", "w"], &[0.5, 1.0, 2.0, 3.0]);
    assert_eq!(rows(&found, 0, 0.5), [2.0]);
    assert_eq!(rows(&found, 0, 1.0), [2.0, -2.0]);
    let w = rows(&found, 1, 3.0).pop().expect("a row");
    assert!((w - 12.0).abs() < 1e-9, "{w}");
}

#[test]
fn events_see_discrete_inputs() {
    let text = "model M input Boolean on; input Integer level; discrete Integer n(start = 0, \
        fixed = true), m(start = 0, fixed = true); Real x(start = 0, fixed = true); \
        equation der(x) = if on then level else 0; when edge(on) then n = pre(n) + 1; end when; \
        when change(level) then m = level; end when; end M;";
    let on = ("on", true, &[0.0, 1.0, 2.0, 4.0][..], &[0.0, 1.0, 0.0, 1.0][..]);
    let level = ("level", true, &[0.0, 1.5, 5.0][..], &[2.0, 4.0, 4.0][..]);
    let program = program(text, &[on, level]);
    let (found, _) = run(&program, &["n", "m", "x"], &[0.5, 1.7, 3.0, 5.0]);
    for (time, [n, m, x]) in
        [(0.5, [0.0, 0.0, 0.0]), (1.7, [1.0, 4.0, 1.8]), (5.0, [2.0, 4.0, 7.0])]
    {
        let values = [0, 1, 2].map(|column| rows(&found, column, time).pop().expect("a row"));
        assert_eq!(values[..2], [n, m], "{time}");
        assert!((values[2] - x).abs() < 1e-9, "{time}: {}", values[2]);
    }
}

#[test]
fn samples_are_kept_with_the_program() {
    let (times, values) = ([0.0, 1.0], [1.0, 3.0]);
    let program = program(INTEGRATOR, &[("u", false, &times, &values)]);
    let bytes = program.to_bytes().expect("it can be kept");
    let again = Arc::new(Program::from_bytes(&bytes).expect("it is whole"));
    let (found, _) = run(&again, &["x"], &[1.0]);
    assert!((rows(&found, 0, 1.0)[0] - 3.0).abs() < 1e-9);
}
