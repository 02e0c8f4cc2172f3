//! Experiments on models: which variables are compared at which points, and the simulator that
//! runs all of them for one set of parameters.

use super::{Failed, FailureKind, Simulate};
use crate::diag::Fault;
use crate::identify::evaluation::{Plan, plan};
use crate::identify::{Instance, Model, Path};
use crate::sim::{
    Failure, Settings, SimError, SimErrorKind, Simulator, Trajectory, find_integrator,
};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A failed simulation is tried once more with the tolerance times this and another integrator.
const TIGHTER: f64 = 0.01;
/// No tolerance is tightened beyond this, where errors of rounding begin.
const SMALLEST_TOLERANCE: f64 = 1e-12;

/// An experiment: one simulation of one model.
#[derive(Clone)]
pub struct Experiment {
    /// Its name, for messages.
    pub name: String,
    /// The model with everything that this experiment sets.
    pub model: Arc<dyn Model>,
    /// How it is simulated.
    pub settings: Settings,
    /// The variable that X holds values of; `time` if nothing else.
    pub x_name: String,
    /// What is compared.
    pub observations: Vec<Observation>,
    /// The free parameters that it depends on: their places in the problem, and their names in the
    /// model.
    pub parameters: Vec<(usize, String)>,
}

/// A variable with the points at which it was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Observation {
    /// The variable.
    pub y_name: String,
    /// X of the points.
    pub x: Vec<f64>,
}

/// Runs experiments one after the other.
pub struct ModelSimulator {
    stages: Vec<Stage>,
    simulator: Simulator,
    trajectory: Trajectory,
}

/// One experiment, ready to run.
struct Stage {
    name: String,
    instance: Box<dyn Instance>,
    places: Vec<usize>,
    /// Values of the parameters, for each run anew.
    values: Vec<f64>,
    settings: Settings,
    retry: Option<Settings>,
    /// The tolerances of both as they were set.
    tolerances: [f64; 2],
    x_name: String,
    /// For each observation the times, or in X the points.
    points: Vec<Vec<f64>>,
    in_x: bool,
}

impl ModelSimulator {
    /// Prepares the experiments.
    ///
    /// # Errors
    ///
    /// Variables and parameters that the model does not have, points that cannot be reached.
    pub fn new(experiments: &[Experiment]) -> Result<ModelSimulator, Fault> {
        let stages = experiments.iter().map(Stage::new).collect::<Result<_, Fault>>()?;
        Ok(ModelSimulator {
            stages,
            simulator: Simulator::new(),
            trajectory: Trajectory::default(),
        })
    }
}

impl Simulate for ModelSimulator {
    fn simulate(&mut self, parameters: &[f64], out: &mut [f64]) -> Result<(), Failed> {
        let count = self.stages.len();
        let mut first = 0;
        for (number, stage) in self.stages.iter_mut().enumerate() {
            let length: usize = stage.points.iter().map(Vec::len).sum();
            let out = &mut out[first..first + length];
            first += length;
            let run = stage.run(parameters, &mut self.simulator, &mut self.trajectory, out);
            run.map_err(|mut failed| {
                failed.progress = (number as f64 + failed.progress) / count as f64;
                if count > 1 {
                    failed.cause = format!("{}: {}", stage.name, failed.cause);
                }
                failed
            })?;
        }
        Ok(())
    }

    fn scale_tolerance(&mut self, factor: f64) {
        for stage in &mut self.stages {
            let [first, second] =
                stage.tolerances.map(|own| (own * factor).max(SMALLEST_TOLERANCE.min(own)));
            stage.settings.tolerance = first;
            if let Some(retry) = &mut stage.retry {
                retry.tolerance = second;
            }
        }
    }

    fn cancel_by(&mut self, flag: Option<Arc<AtomicBool>>) {
        for stage in &mut self.stages {
            stage.settings.cancel.clone_from(&flag);
            if let Some(retry) = &mut stage.retry {
                retry.cancel.clone_from(&flag);
            }
        }
    }
}

impl Stage {
    fn new(experiment: &Experiment) -> Result<Stage, Fault> {
        let Experiment { name, model, observations, x_name, .. } = experiment;
        let varied: Vec<String> =
            experiment.parameters.iter().map(|(_, name)| name.clone()).collect();
        let mut all: Vec<f64> = observations.iter().flat_map(|o| o.x.clone()).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        let mut settings = experiment.settings.clone();
        let plan = plan(model.as_ref(), &varied, x_name, &all, &mut settings)?;
        let mut observed: Vec<String> = observations.iter().map(|o| o.y_name.clone()).collect();
        let (points, in_x) = match plan {
            Plan::AtTimes(times) => {
                let time =
                    |x: &f64| all.binary_search_by(|known| known.total_cmp(x)).map(|k| times[k]);
                let times = |o: &Observation| o.x.iter().filter_map(|x| time(x).ok()).collect();
                (observations.iter().map(times).collect(), false)
            }
            Plan::InX => {
                observed.push(x_name.clone());
                (observations.iter().map(|o| o.x.clone()).collect(), true)
            }
        };
        Ok(Stage {
            name: name.clone(),
            instance: model.instance(&varied, &observed)?,
            places: experiment.parameters.iter().map(|(place, _)| *place).collect(),
            values: Vec::with_capacity(varied.len()),
            tolerances: [
                settings.tolerance,
                retry(&settings).map_or(settings.tolerance, |retry| retry.tolerance),
            ],
            retry: retry(&settings),
            settings,
            x_name: x_name.clone(),
            points,
            in_x,
        })
    }

    fn run(
        &mut self,
        parameters: &[f64],
        simulator: &mut Simulator,
        trajectory: &mut Trajectory,
        out: &mut [f64],
    ) -> Result<(), Failed> {
        self.values.clear();
        self.values.extend(self.places.iter().map(|&place| parameters[place]));
        let failed = match self.attempt(false, simulator, trajectory) {
            Ok(()) => return self.read(trajectory, out),
            Err(failed) => failed,
        };
        let again = failed.kind == FailureKind::Solver && self.retry.is_some();
        if again && self.attempt(true, simulator, trajectory).is_ok() {
            return self.read(trajectory, out);
        }
        Err(failed)
    }

    fn attempt(
        &mut self,
        again: bool,
        simulator: &mut Simulator,
        trajectory: &mut Trajectory,
    ) -> Result<(), Failed> {
        let refused =
            |fault: Fault| Failed { kind: FailureKind::Model, cause: fault.message, progress: 0.0 };
        self.instance.set(&self.values).map_err(refused)?;
        let settings = self.retry.as_ref().filter(|_| again).unwrap_or(&self.settings);
        let run = simulator.run(self.instance.system(), settings, trajectory);
        run.map(|_| ()).map_err(|error| {
            let length = (settings.stop - settings.start).max(f64::MIN_POSITIVE);
            Failed {
                kind: kind(&error),
                cause: self.instance.explain(&error),
                progress: (error.time - settings.start) / length,
            }
        })
    }

    fn read(&self, trajectory: &Trajectory, out: &mut [f64]) -> Result<(), Failed> {
        let missing = |cause: &str| Failed {
            kind: FailureKind::Points,
            cause: cause.to_owned(),
            progress: 1.0,
        };
        let mut first = 0;
        for (column, points) in self.points.iter().enumerate() {
            let out = &mut out[first..first + points.len()];
            first += points.len();
            if self.in_x {
                let x = trajectory.column(self.points.len());
                let path = Path { times: trajectory.time(), x };
                let y = trajectory.column(column);
                path.interpolate(&self.x_name, y, points, out)
                    .map_err(|fault| missing(&fault.message))?;
            } else {
                for (value, &time) in out.iter_mut().zip(points) {
                    let found = trajectory.at(column, time);
                    *value = found.ok_or_else(|| missing("the simulation ended early"))?;
                }
            }
        }
        match out.iter().all(|value| value.is_finite()) {
            true => Ok(()),
            false => Err(missing("a simulated value is not finite")),
        }
    }
}

/// Other settings for a second attempt; none for methods with fixed step.
fn retry(settings: &Settings) -> Option<Settings> {
    let other = match settings.method.name {
        "radau" => "dassl",
        "euler" | "rungekutta" => return None,
        _ => "radau",
    };
    let method = find_integrator(other).ok()?;
    let tolerance = (settings.tolerance * TIGHTER).max(1e-12);
    Some(Settings { method, tolerance, ..settings.clone() })
}

fn kind(error: &SimError) -> FailureKind {
    match error.kind {
        SimErrorKind::StepBudget | SimErrorKind::TimeBudget => FailureKind::Budget,
        SimErrorKind::Initialization(failure) | SimErrorKind::Evaluation(failure) => {
            match failure {
                Failure::Domain { .. } | Failure::Function { .. } | Failure::Assertion { .. } => {
                    FailureKind::Model
                }
                _ => FailureKind::Solver,
            }
        }
        _ => FailureKind::Solver,
    }
}
