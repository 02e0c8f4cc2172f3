//! What the identification needs of a model: names, and systems to simulate.

use crate::codegen::LinearPart;
use crate::diag::{Diagnostic, Fault};
use crate::fmi::description::DefaultExperiment;
use crate::sim::{
    DaeSystem, Failure, OutputGrid, Settings, SimError, Simulator, Statistics, Trajectory,
};
use crate::units::Definitions;
use serde::{Deserialize, Serialize};

/// Output points where a model gives no interval.
const INTERVALS: usize = 500;
/// More output points than this are a mistake of the model.
const MOST_INTERVALS: f64 = 1e6;

/// The settings of a model that says this of its experiment.
pub(super) fn settings_of(experiment: DefaultExperiment) -> Settings {
    let default = Settings::default();
    let start = experiment.start.unwrap_or(default.start);
    let stop = experiment.stop.unwrap_or(start + 1.0).max(start);
    let intervals = experiment.step.map_or(INTERVALS, |step| {
        let intervals = ((stop - start) / step).round();
        if (1.0..=MOST_INTERVALS).contains(&intervals) { intervals as usize } else { INTERVALS }
    });
    Settings {
        start,
        stop,
        output: OutputGrid::Intervals(intervals),
        tolerance: experiment.tolerance.unwrap_or(default.tolerance),
        ..default
    }
}

/// A model that can be simulated many times with different parameter values.
pub trait Model: Send + Sync {
    /// Its name, with its modification.
    fn name(&self) -> &str;
    /// Its parameters in order of declaration.
    fn parameters(&self) -> Vec<Parameter>;
    /// Its top-level outputs.
    fn outputs(&self) -> Vec<String>;
    /// The names of all its Real variables and parameters, for suggestions.
    fn names(&self) -> Vec<String>;
    /// The unit of a Real variable, empty if it has none; `None` if there is no such variable.
    fn unit(&self, variable: &str) -> Option<String>;
    /// What names of units stand for that are not known, where the model says so.
    fn unit_definitions(&self) -> Definitions {
        Definitions::default()
    }
    /// The description string of a variable; `None` if it has none.
    fn description(&self, _variable: &str) -> Option<String> {
        None
    }
    /// Whether a variable is a difference, whose unit converts without an offset
    /// (`annotation(absoluteValue = false)`).
    fn is_relative(&self, _variable: &str) -> bool {
        false
    }
    /// Whether the variable's value depends on time but on no state and on none of these
    /// parameters; `false` where that is not certain.
    fn depends_on_time_alone(&self, variable: &str, varied: &[String]) -> bool;
    /// The variable that is an input of the model and the parameter that gives it its value, where
    /// points are evaluated one by one.
    fn driven(&self) -> Option<(&str, &str)> {
        None
    }
    /// X of its trajectories where that is not the time but the frequency.
    fn abscissa(&self) -> Option<&str> {
        None
    }
    /// The simulation settings of its `experiment` annotation.
    fn settings(&self) -> Settings;
    /// Whether its `experiment` annotation gives a stop time; without one it is simulated as far as
    /// the measured points reach.
    fn has_stop_time(&self) -> bool {
        true
    }
    /// A system of its own, which observes these variables in this order and whose parameters
    /// `varied` can be set.
    fn instance(&self, varied: &[String], observed: &[String]) -> Result<Box<dyn Instance>, Fault>;
    /// The model as data that another process of this version can read.
    ///
    /// # Errors
    ///
    /// Why it cannot be sent, in words that follow the model's name.
    fn portable(&self) -> Result<PortableModel, String> {
        Err("is not a compiled model".to_owned())
    }
}

/// A parameter of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Its unit; empty if it has none.
    pub unit: String,
    /// The smallest value that the model allows; −∞ where it does not say.
    pub min: f64,
    /// The largest value that the model allows; ∞ where it does not say.
    pub max: f64,
    /// Whether it can be set without translating the model again.
    pub tunable: bool,
    /// Whether it stands directly in the model.
    pub top_level: bool,
}

/// A compiled model as data.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct PortableModel {
    /// Its name, with its modification.
    pub name: String,
    /// See [`Model::driven`].
    pub driven: Option<(String, String)>,
    /// Positions of parameters, and values that they have in place of those of the model.
    pub values: Vec<(usize, f64)>,
    /// [`Program::to_bytes`](crate::codegen::Program::to_bytes).
    pub program: Vec<u8>,
    /// Which of its spectra is meant, if any.
    pub spectrum: Option<Spectrum>,
}

/// Which spectrum of a model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Spectrum {
    /// Where the entries of the Jacobian are found.
    pub linear: LinearPart,
    /// When the simulation begins, and the time of the operating point; equal where it does not move.
    pub times: [f64; 2],
    /// What y/u is multiplied with; −1 for the impedance of a source whose current flows out.
    pub factor: f64,
    /// Its unit.
    pub unit: String,
}

/// A system with settable parameters.
pub trait Instance: Send {
    /// Sets the varied parameters, in their order; nothing of an earlier simulation remains.
    fn set(&mut self, genome: &[f64]) -> Result<(), Fault>;
    /// Simulates with the values that were set; the observed variables become the columns of `out`.
    ///
    /// # Errors
    ///
    /// When and why it failed; `out` keeps what was computed until then.
    fn simulate(
        &mut self,
        simulator: &mut Simulator,
        settings: &Settings,
        out: &mut Trajectory,
    ) -> Result<Statistics, SimError>;
    /// From now on variables that nothing else depends on may be NaN where they have no value: the caller
    /// looks at each.
    fn allow_missing_values(&mut self) {}
    /// Whether it has no states, so that nothing is integrated.
    fn is_static(&mut self) -> bool;
    /// The system that is simulated, where it is one of this process.
    fn system(&mut self) -> Option<&mut dyn DaeSystem>;
    /// The observed variables at a time, which need no states: with the relations that hold at this
    /// time, which no simulation has led to. `unknowns` are those of the start.
    ///
    /// # Errors
    ///
    /// Why they have no values there.
    fn observe_in_time(
        &mut self,
        time: f64,
        unknowns: &[f64],
        out: &mut [f64],
    ) -> Result<(), Failure> {
        self.system().map_or(Ok(()), |system| system.observe(time, unknowns, out))
    }
    /// From the next simulation on, the observed variables are followed by their derivatives for the
    /// varied parameters, parameter by parameter; or no longer.
    ///
    /// # Errors
    ///
    /// Why there are none, in words that follow on "because"; then it observes values alone.
    fn differentiate(&mut self, with_derivatives: bool) -> Result<(), String> {
        match with_derivatives {
            true => Err("the model has no equations to differentiate".to_owned()),
            false => Ok(()),
        }
    }
    /// Why the last simulation with derivatives could not go on, if it was for these.
    fn sensitivity_refusal(&self) -> Option<String> {
        None
    }
    /// Whether the simulation that has failed is the last of so many that no other is worth its time.
    fn is_hopeless(&self) -> bool {
        false
    }
    /// Why a simulation failed, in one sentence without the time.
    fn explain(&self, error: &SimError) -> String;
    /// The same with the time and the place in the model, where it has one.
    fn diagnostic(&self, _: &SimError) -> Option<Diagnostic> {
        None
    }
}
