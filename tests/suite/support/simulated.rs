//! Models of a text, simulated, with the values of their variables over time.

use gapilib::Diagnostic;
use gapilib::internals::causalize::causalize;
use gapilib::internals::codegen::{Access, Program};
use gapilib::internals::flatten::{FlatModel, Library, flatten};
use gapilib::internals::runtime::System;
use gapilib::internals::sim::{OutputGrid, Settings, SimError, Simulator, Trajectory};
use gapilib::internals::source::SourceMap;
use gapilib::internals::syntax::parse_stored_definition;
use std::sync::Arc;

/// The flat model of the last class of a text.
pub(crate) fn flat(text: &str) -> Result<FlatModel, Diagnostic> {
    let source = SourceMap::default().add("model.mo", text);
    let file = parse_stored_definition(source, text).expect("the text parses");
    let mut library = Library::new();
    let names = library.load(&file).expect("the classes can be loaded");
    let flattened = flatten(&library, names.last().expect("a class"), &[]);
    flattened.map(|f| f.model).map_err(|mut errors| errors.swap_remove(0))
}

pub(crate) fn compiled(text: &str) -> Result<Arc<Program>, Diagnostic> {
    flat(text).and_then(|flat| causalize(&flat)).and_then(Program::compile)
}

/// A model that compiles.
pub(crate) fn program(text: &str) -> Arc<Program> {
    compiled(text).unwrap_or_else(|d| panic!("{}: {}", d.code.slug, d.message))
}

/// The fault of a model that cannot be sorted or compiled: code, message, helps.
pub(crate) fn refused(text: &str) -> String {
    match compiled(text) {
        Ok(_) => panic!("the model is accepted"),
        Err(d) => format!("{}: {}; {}", d.code.slug, d.message, d.helps.join("; ")),
    }
}

/// The model of this name in `tests/simulation`.
pub(crate) fn file(name: &str) -> String {
    let root = env!("CARGO_MANIFEST_DIR");
    std::fs::read_to_string(format!("{root}/tests/simulation/{name}.mo")).expect("a model")
}

/// A simulation that may end with an error.
pub(crate) fn attempt(
    text: &str,
    stop: f64,
) -> (Arc<Program>, System, Trajectory, Result<(), SimError>) {
    let output = OutputGrid::Intervals(50);
    attempt_with(text, &Settings { stop, tolerance: 1e-9, output, ..Settings::default() })
}

fn attempt_with(
    text: &str,
    settings: &Settings,
) -> (Arc<Program>, System, Trajectory, Result<(), SimError>) {
    let program = program(text);
    let mut system = program.system();
    let mut trajectory = Trajectory::default();
    let ended = Simulator::new().run(&mut system, settings, &mut trajectory).map(|_| ());
    (program, system, trajectory, ended)
}

/// A finished simulation.
pub(crate) struct Run {
    pub(crate) program: Arc<Program>,
    pub(crate) system: System,
    pub(crate) trajectory: Trajectory,
}

pub(crate) fn simulated(text: &str, stop: f64) -> Run {
    let output = OutputGrid::Intervals(50);
    simulated_with(text, &Settings { stop, tolerance: 1e-9, output, ..Settings::default() })
}

pub(crate) fn simulated_with(text: &str, settings: &Settings) -> Run {
    let (program, system, trajectory, ended) = attempt_with(text, settings);
    if let Err(error) = ended {
        panic!("{}", program.explain(&error).message);
    }
    Run { program, system, trajectory }
}

impl Run {
    /// The same on the output grid of the settings.
    pub(crate) fn of(text: &str, stop: f64) -> Run {
        simulated_with(text, &Settings { stop, tolerance: 1e-9, ..Settings::default() })
    }

    /// All values of a variable.
    pub(crate) fn values(&self, name: &str) -> Vec<f64> {
        let at = self.program.find_variable(name).expect("the variable exists");
        match self.program.variables()[at].access {
            Access::Observed { column, negated } => {
                let sign = if negated { -1.0 } else { 1.0 };
                self.trajectory.column(column).iter().map(|value| sign * value).collect()
            }
            Access::Time => self.trajectory.time().to_vec(),
            _ => {
                let value = self.system.value(at).expect("a parameter has a value");
                vec![value; self.trajectory.len()]
            }
        }
    }

    /// The value at the start, before the events of that time.
    pub(crate) fn first(&self, name: &str) -> f64 {
        self.values(name)[0]
    }

    pub(crate) fn last(&self, name: &str) -> f64 {
        *self.values(name).last().expect("a row")
    }

    /// The value after all events at a time of the output grid or of an event.
    pub(crate) fn at(&self, name: &str, time: f64) -> f64 {
        let rows = self.trajectory.time().iter().zip(self.values(name));
        let near = rows.filter(|(t, _)| (**t - time).abs() <= 1e-9);
        near.collect::<Vec<_>>().pop().unwrap_or_else(|| panic!("no row at {time}")).1
    }

    /// The value of the last row up to a time: that of what varies at events only.
    pub(crate) fn held(&self, name: &str, time: f64) -> f64 {
        let rows = self.trajectory.time().iter().zip(self.values(name));
        rows.take_while(|(t, _)| **t <= time).last().expect("a row before this time").1
    }

    /// Times of events.
    pub(crate) fn events(&self) -> Vec<f64> {
        let pairs = self.trajectory.time().windows(2).filter(|t| t[0] == t[1]);
        let mut times: Vec<f64> = pairs.map(|t| t[0]).collect();
        times.dedup();
        times
    }

    /// Times at which a variable jumps.
    pub(crate) fn jumps(&self, name: &str) -> Vec<f64> {
        let (values, times) = (self.values(name), self.trajectory.time());
        let pairs = values.windows(2).zip(times.windows(2));
        pairs.filter(|(v, t)| v[0] != v[1] && t[0] == t[1]).map(|(_, t)| t[1]).collect()
    }

    /// Compares a variable with a function of time at every output point.
    #[track_caller]
    pub(crate) fn follows(&self, name: &str, tolerance: f64, exact: impl Fn(f64) -> f64) {
        for (t, value) in self.trajectory.time().iter().zip(self.values(name)) {
            let expected = exact(*t);
            let error = (value - expected).abs() / expected.abs().max(1.0);
            assert!(error <= tolerance, "{name}({t}) = {value} instead of {expected}");
        }
    }

    pub(crate) fn states(&self) -> Vec<&str> {
        let sorted = self.program.sorted();
        sorted.states.iter().map(|v| &*sorted.dae.variable(*v).name).collect()
    }
}

#[track_caller]
pub(crate) fn near(value: f64, expected: f64, tolerance: f64) {
    let error = (value - expected).abs() / expected.abs().max(1.0);
    assert!(error <= tolerance, "{value} instead of {expected}");
}

#[track_caller]
pub(crate) fn all_near(values: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(values.len(), expected.len(), "{values:?} instead of {expected:?}");
    values.iter().zip(expected).for_each(|(value, expected)| near(*value, *expected, tolerance));
}
