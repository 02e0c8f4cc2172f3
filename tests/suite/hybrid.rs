//! Models with events, from text to trajectory, against exact solutions.

use super::flat_class::flat;
use gapilib::compile::{Access, Program, System};
use gapilib::dae::sort;
use gapilib::diag::Diagnostic;
use gapilib::sim::{OutputGrid, Settings, SimError, Simulator, Trajectory};
use std::sync::Arc;

/// A finished simulation.
struct Run {
    program: Arc<Program>,
    system: System,
    rows: Trajectory,
}

fn compiled(text: &str) -> Result<Arc<Program>, Diagnostic> {
    sort(&flat(text)).and_then(Program::compile)
}

fn attempt(text: &str, stop: f64) -> (Arc<Program>, System, Trajectory, Result<(), SimError>) {
    let program = compiled(text).unwrap_or_else(|d| panic!("{}: {}", d.code.slug, d.message));
    let mut system = program.system();
    let output = OutputGrid::Intervals(50);
    let settings = Settings { stop, tolerance: 1e-9, output, ..Settings::default() };
    let mut rows = Trajectory::default();
    let ended = Simulator::new().run(&mut system, &settings, &mut rows).map(|_| ());
    (program, system, rows, ended)
}

fn simulated(text: &str, stop: f64) -> Run {
    let (program, system, rows, ended) = attempt(text, stop);
    if let Err(error) = ended {
        panic!("{}", program.explain(&error).message);
    }
    Run { program, system, rows }
}

/// The model of this name in `tests/simulation`.
fn file(name: &str) -> String {
    let root = env!("CARGO_MANIFEST_DIR");
    std::fs::read_to_string(format!("{root}/tests/simulation/{name}.mo")).expect("a model")
}

impl Run {
    /// All values of a variable.
    fn column(&self, name: &str) -> Vec<f64> {
        let at = self.program.find_variable(name).expect("the variable exists");
        match self.program.variables()[at].access {
            Access::Observed { column, negated } => {
                let sign = if negated { -1.0 } else { 1.0 };
                self.rows.column(column).iter().map(|value| sign * value).collect()
            }
            Access::Time => self.rows.time().to_vec(),
            _ => vec![self.system.value(at).expect("a parameter has a value"); self.rows.len()],
        }
    }

    fn last(&self, name: &str) -> f64 {
        *self.column(name).last().expect("a row")
    }

    /// The value behind all events at a time of the output grid or of an event.
    fn at(&self, name: &str, time: f64) -> f64 {
        let rows = self.rows.time().iter().zip(self.column(name));
        let near = rows.filter(|(t, _)| (**t - time).abs() <= 1e-9);
        near.last().unwrap_or_else(|| panic!("no row at {time}")).1
    }

    /// Times at which a variable jumps.
    fn jumps(&self, name: &str) -> Vec<f64> {
        let (values, times) = (self.column(name), self.rows.time());
        let pairs = values.windows(2).zip(times.windows(2));
        pairs.filter(|(v, t)| v[0] != v[1] && t[0] == t[1]).map(|(_, t)| t[1]).collect()
    }
}

#[track_caller]
fn near(value: f64, expected: f64, tolerance: f64) {
    let error = (value - expected).abs() / expected.abs().max(1.0);
    assert!(error <= tolerance, "{value} instead of {expected}");
}

#[track_caller]
fn all_near(values: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(values.len(), expected.len(), "{values:?} instead of {expected:?}");
    values.iter().zip(expected).for_each(|(value, expected)| near(*value, *expected, tolerance));
}

#[test]
fn a_ball_bounces_twenty_times_at_the_exact_times() {
    let run = simulated(&file("BouncingBall"), 4.02);
    let (e, g) = (0.8f64, 9.81f64);
    let first = (2.0 / g).sqrt();
    let mut expected = vec![first];
    for n in 0..25 {
        expected.push(expected[n] + 2.0 * first * e.powi(n as i32 + 1));
    }
    expected.retain(|t| *t < 4.02);
    assert!(expected.len() >= 20, "{}", expected.len());
    all_near(&run.jumps("impacts"), &expected, 1e-7);
    assert_eq!(run.last("impacts"), expected.len() as f64);
    near(run.last("last"), *expected.last().unwrap(), 1e-7);
}

#[test]
fn a_sampled_controller_follows_its_difference_equation() {
    let run = simulated(&file("SampledController"), 2.0);
    let (k, decay) = (2.0, (-0.1f64).exp());
    let mut x = 1.0;
    for n in 0..20 {
        let t = n as f64 * 0.1;
        near(run.at("x", t), x, 1e-7);
        near(run.at("u", t), -k * x, 1e-7);
        x = x * decay - k * x * (1.0 - decay);
    }
    assert_eq!(run.last("n"), 21.0);
    let times: Vec<f64> = (1..=20).map(|n| n as f64 * 0.1).collect();
    assert_eq!(run.jumps("n"), times);
}
