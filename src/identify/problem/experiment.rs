//! Experiments on models: which variables are compared at which points, and the simulator that
//! runs all of them for one set of parameters.

use super::event_limits::{Limit, limits};
use super::{Failed, FailureKind, Portable, PortableExperiment, Simulate};
use crate::diag::{Diagnostic, Fault};
use crate::plan::{Plan, TIME, plan, with_driver};
use crate::pointwise::Pointwise;
use crate::sim::{
    Failure, PortableSettings, Settings, SimError, SimErrorKind, Simulator, Trajectory,
    find_integrator,
};
use crate::{Instance, Model, Path};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A failed simulation is tried once more with the tolerance times this and another integrator.
const TIGHTER: f64 = 0.01;
/// The method that integrates sensitivities with the model.
const WITH_SENSITIVITIES: &str = "dassl";
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
    /// Whether a simulation that the solver did not get through is tried once more, with another
    /// method and a smaller tolerance. Not in the algorithm of the paper, where it has failed.
    pub second_attempt: bool,
    /// The variable that X holds values of; `time` if nothing else.
    pub x_name: String,
    /// What is compared, and after that the standard deviations that the model computes.
    pub observations: Vec<Observation>,
    /// How many of the observations are such.
    pub deviations: usize,
    /// The free parameters that it depends on: their places in the problem, and their names in the
    /// model.
    pub parameters: Vec<(usize, String)>,
}

/// A variable with the points at which it was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Observation {
    /// The variable.
    pub y_name: String,
    /// X of the points. Over time, consecutive points with one time are the left and the right limit
    /// at an event.
    pub x: Vec<f64>,
}

/// Runs experiments one after the other.
pub struct ModelSimulator {
    experiments: Vec<Experiment>,
    stages: Vec<Stage>,
    simulator: Simulator,
    trajectory: Trajectory,
    refusal: Option<String>,
}

/// One experiment, ready to run.
struct Stage {
    name: String,
    instance: Box<dyn Instance>,
    places: Vec<usize>,
    /// Values of the parameters, new for each run.
    values: Vec<f64>,
    settings: Settings,
    retry: Option<Settings>,
    /// The tolerances of both as they were set.
    tolerances: [f64; 2],
    x_name: String,
    /// The variables of the observations.
    y_names: Vec<String>,
    /// For each observation the times, or in X the points.
    points: Vec<Vec<f64>>,
    /// For each observation over time, which of the points are limits at events.
    limits: Vec<Vec<Option<Limit>>>,
    in_x: bool,
    /// For static curves.
    pointwise: Option<Pointwise>,
}

impl Experiment {
    fn portable(&self) -> Result<PortableExperiment, String> {
        let Experiment {
            name,
            model,
            settings,
            second_attempt,
            x_name,
            observations,
            deviations,
            parameters,
        } = self;
        let of = |observation: &Observation| (observation.y_name.clone(), observation.x.clone());
        Ok(PortableExperiment {
            name: name.clone(),
            model: model.portable().map_err(|reason| format!("`{}` {reason}", model.name()))?,
            settings: PortableSettings::of(settings),
            second_attempt: *second_attempt,
            x_name: x_name.clone(),
            observations: observations.iter().map(of).collect(),
            deviations: *deviations,
            parameters: parameters.clone(),
        })
    }
}

impl ModelSimulator {
    /// Prepares the experiments.
    ///
    /// # Errors
    ///
    /// Variables and parameters that the model does not have, points that cannot be reached.
    pub fn new(experiments: &[Experiment]) -> Result<ModelSimulator, Fault> {
        let mut stages = experiments.iter().map(Stage::new).collect::<Result<Vec<_>, Fault>>()?;
        stages.iter_mut().for_each(|stage| stage.instance.allow_missing_values());
        Ok(ModelSimulator {
            experiments: experiments.to_vec(),
            stages,
            simulator: Simulator::new(),
            trajectory: Trajectory::default(),
            refusal: None,
        })
    }

    /// The settings of the first experiment, with its times of output.
    pub fn settings(&self) -> &Settings {
        &self.stages[0].settings
    }

    /// Whether the first experiment has no states, so that nothing is integrated.
    pub fn is_static(&mut self) -> bool {
        self.stages[0].instance.is_static()
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
            run.map_err(|failed| located(failed, (number, count), &stage.name))?;
        }
        Ok(())
    }

    fn sensitivities(
        &mut self,
        parameters: &[f64],
        out: &mut [f64],
        derivatives: &mut [f64],
    ) -> Result<bool, Failed> {
        self.refusal = None;
        let (count, genes) = (self.stages.len(), parameters.len());
        let mut first = 0;
        for (number, stage) in self.stages.iter_mut().enumerate() {
            let length: usize = stage.points.iter().map(Vec::len).sum();
            let rows = first..first + length;
            let derivatives = &mut derivatives[rows.start * genes..rows.end * genes];
            first += length;
            let workspace = (&mut self.simulator, &mut self.trajectory);
            let run = stage.differentiate(parameters, workspace, &mut out[rows], derivatives);
            match run.map_err(|failed| located(failed, (number, count), &stage.name))? {
                Ok(()) => {}
                Err(refusal) => {
                    self.refusal = Some(refusal);
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }

    fn sensitivity_refusal(&self) -> Option<&str> {
        self.refusal.as_deref()
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

    fn portable(&self) -> Result<Portable, String> {
        let all: Result<_, String> = self.experiments.iter().map(Experiment::portable).collect();
        Ok(Portable::Experiments(all?))
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

/// Why these values cannot be simulated, with the place in the model, and when it failed; `None`
/// where they can, or nothing more is known than the cause.
pub fn diagnosed(experiments: &[Experiment], values: &[f64]) -> Option<(Diagnostic, f64)> {
    experiments.iter().find_map(|experiment| {
        let mut stage = Stage::new(experiment).ok()?;
        let own: Vec<f64> = stage.places.iter().map(|&place| values[place]).collect();
        stage.instance.set(&own).ok()?;
        let mut out = Trajectory::default();
        let run = stage.instance.simulate(&mut Simulator::new(), &stage.settings, &mut out);
        let error = run.err()?;
        Some((stage.instance.diagnostic(&error)?, error.time))
    })
}

/// A failure of one experiment among several.
fn located(mut failed: Failed, (number, count): (usize, usize), name: &str) -> Failed {
    failed.progress = (number as f64 + failed.progress) / count as f64;
    if count > 1 {
        failed.cause = format!("{name}: {}", failed.cause);
    }
    failed
}

impl Stage {
    fn new(experiment: &Experiment) -> Result<Stage, Fault> {
        let Experiment { name, model, observations, x_name, .. } = experiment;
        let varied: Vec<String> =
            experiment.parameters.iter().map(|(_, name)| name.clone()).collect();
        let mut all: Vec<f64> = observations.iter().flat_map(|o| o.x.clone()).collect();
        all.sort_by(f64::total_cmp);
        all.dedup_by(|a, b| a.total_cmp(b).is_eq());
        let mut settings = experiment.settings.clone();
        let plan = plan(model.as_ref(), &varied, x_name, &all, &mut settings)?;
        let mut observed: Vec<String> = observations.iter().map(|o| o.y_name.clone()).collect();
        let pointwise = matches!(plan, Plan::OneByOne).then(Pointwise::default);
        let limits = match x_name == TIME {
            true => observations.iter().map(|o| limits(&o.x)).collect(),
            false => vec![Vec::new(); observations.len()],
        };
        let (points, in_x) = match plan {
            Plan::AtTimes(times) => {
                let time =
                    |x: &f64| all.binary_search_by(|known| known.total_cmp(x)).map(|k| times[k]);
                let times = |o: &Observation| o.x.iter().filter_map(|x| time(x).ok()).collect();
                (observations.iter().map(times).collect(), false)
            }
            Plan::OneByOne => (observations.iter().map(|o| o.x.clone()).collect(), false),
            Plan::InX => {
                observed.push(x_name.clone());
                (observations.iter().map(|o| o.x.clone()).collect(), true)
            }
        };
        let retry = retry(&settings).filter(|_| experiment.second_attempt);
        Ok(Stage {
            name: name.clone(),
            instance: model.instance(&with_driver(model.as_ref(), &varied), &observed)?,
            places: experiment.parameters.iter().map(|(place, _)| *place).collect(),
            values: Vec::with_capacity(varied.len()),
            tolerances: [
                settings.tolerance,
                retry.as_ref().map_or(settings.tolerance, |retry| retry.tolerance),
            ],
            retry,
            settings,
            x_name: x_name.clone(),
            y_names: observations.iter().map(|o| o.y_name.clone()).collect(),
            points,
            limits,
            in_x,
            pointwise,
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
        if self.pointwise.is_some() {
            return self.one_by_one(out);
        }
        let (failed, again) = match self.attempt(false, simulator, trajectory) {
            Ok(()) => return self.read(trajectory, out),
            Err((failed, is_start)) => {
                let again = failed.kind == FailureKind::Solver && !is_start && self.retry.is_some();
                (failed, again)
            }
        };
        if again && self.attempt(true, simulator, trajectory).is_ok() {
            let first = failed.at;
            return self.read(trajectory, out).map_err(|failed| Failed { at: first, ..failed });
        }
        Err(failed)
    }

    /// The points of a static curve.
    fn one_by_one(&mut self, out: &mut [f64]) -> Result<(), Failed> {
        let Stage { pointwise: Some(pointwise), instance, values, settings, points, .. } = self
        else {
            return Ok(());
        };
        let mut first = 0;
        for (column, x) in points.iter().enumerate() {
            if settings.cancel.as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed)) {
                return Err(Failed::new(FailureKind::Points, "it was cancelled", 0.0));
            }
            let out = &mut out[first..first + x.len()];
            first += x.len();
            let at = (values.as_slice(), settings.start);
            pointwise
                .evaluate(instance.as_mut(), at, (column, x), out)
                .map_err(|cause| Failed::new(FailureKind::Model, cause, 0.0))?;
        }
        self.refuse_not_finite(out).map_err(|failed| Failed { progress: 0.0, ..failed })
    }

    /// The simulation has no row at a point.
    fn not_reached(&self, point: f64) -> Failed {
        missing(&format!("the model ended the simulation before {}", self.point(point)))
    }

    /// A point in words.
    fn point(&self, point: f64) -> String {
        match self.x_name == TIME {
            true => format!("{point} s"),
            false => format!("`{}` = {point}", self.x_name),
        }
    }

    /// Refuses points that cannot be compared.
    fn refuse_not_finite(&self, out: &[f64]) -> Result<(), Failed> {
        let mut rest = out;
        for (name, points) in self.y_names.iter().zip(&self.points) {
            let (own, others) = rest.split_at(points.len().min(rest.len()));
            rest = others;
            if let Some(at) = own.iter().position(|value| !value.is_finite()) {
                let point = self.point(points[at]);
                return Err(missing(&format!("`{name}` is {} at {point}", own[at])));
            }
        }
        Ok(())
    }

    /// Simulates with derivatives for all parameters of the problem; `Err` within `Ok` says why there
    /// are none.
    fn differentiate(
        &mut self,
        parameters: &[f64],
        (simulator, trajectory): (&mut Simulator, &mut Trajectory),
        out: &mut [f64],
        derivatives: &mut [f64],
    ) -> Result<Result<(), String>, Failed> {
        self.values.clear();
        self.values.extend(self.places.iter().map(|&place| parameters[place]));
        let is_static = self.instance.is_static();
        let method = self.settings.method.name;
        if !is_static && method != WITH_SENSITIVITIES {
            return Ok(Err(format!(
                "the method `{method}` does not integrate sensitivity equations"
            )));
        }
        if let Err(refusal) = self.instance.differentiate(true) {
            return Ok(Err(refusal));
        }
        if self.pointwise.is_some() {
            return Ok(self.differentiate_one_by_one(parameters.len(), out, derivatives));
        }
        let attempt = self.attempt(false, simulator, trajectory);
        let refusal = self.instance.sensitivity_refusal();
        // From here on values alone.
        let _ = self.instance.differentiate(false);
        if let Err((failed, _)) = attempt {
            // Whether the model itself fails, a simulation without derivatives tells.
            let because =
                |failed: Failed| format!("its equations have no derivatives: {}", failed.cause);
            return Ok(Err(refusal.unwrap_or_else(|| because(failed))));
        }
        self.read(trajectory, out)?;
        self.read_derivatives(trajectory, parameters.len(), derivatives)?;
        match derivatives.iter().all(|value| value.is_finite()) {
            true => Ok(Ok(())),
            false => Ok(Err("a derivative is not finite".to_owned())),
        }
    }

    /// The points of a static curve and their derivatives; an instance that differentiates no
    /// longer remains.
    fn differentiate_one_by_one(
        &mut self,
        genes: usize,
        out: &mut [f64],
        derivatives: &mut [f64],
    ) -> Result<(), String> {
        let Stage {
            pointwise: Some(pointwise), instance, values, settings, points, places, ..
        } = self
        else {
            return Ok(());
        };
        let at = (values.as_slice(), settings.start);
        let (mut first, mut own, mut solved) = (0, Vec::new(), Ok(()));
        for (column, x) in points.iter().enumerate() {
            let to = (&mut out[first..first + x.len()], &mut own);
            first += x.len();
            let of = (column, points.len(), x.as_slice());
            solved = solved.and_then(|()| pointwise.differentiate(instance.as_mut(), at, of, to));
        }
        let refusal = instance.sensitivity_refusal();
        // From here on values alone.
        let _ = instance.differentiate(false);
        // Whether the model itself fails, points without derivatives tell.
        solved.map_err(|cause| {
            refusal.unwrap_or_else(|| format!("its equations have no derivatives: {cause}"))
        })?;
        derivatives.fill(0.0);
        let rows = derivatives.chunks_exact_mut(genes.max(1));
        for (row, own) in rows.zip(own.chunks_exact(places.len().max(1))) {
            places.iter().zip(own).for_each(|(place, value)| row[*place] += value);
        }
        match derivatives.iter().chain(&*out).all(|value| value.is_finite()) {
            true => Ok(()),
            false => Err("a derivative is not finite".to_owned()),
        }
    }

    /// The derivatives of all points by all parameters of the problem, point by point.
    fn read_derivatives(
        &self,
        trajectory: &Trajectory,
        genes: usize,
        derivatives: &mut [f64],
    ) -> Result<(), Failed> {
        derivatives.fill(0.0);
        let observed = self.points.len() + usize::from(self.in_x);
        let mut rows = derivatives.chunks_exact_mut(genes.max(1));
        for (column, points) in self.points.iter().enumerate() {
            for ((number, point), row) in points.iter().enumerate().zip(&mut rows) {
                for (k, place) in self.places.iter().enumerate() {
                    let of = |column: usize| observed * (k + 1) + column;
                    row[*place] += match self.in_x {
                        true => self.derivative_in_x(trajectory, column, *point, of),
                        false => self.at(trajectory, [column, of(column)], (number, *point)),
                    }
                    .ok_or_else(|| self.not_reached(*point))?;
                }
            }
        }
        Ok(())
    }

    /// The derivative of y at a given X: dy − (dy/dX) dX at the rows on both sides, and linear
    /// between them. Both are of second order in the distance of the rows.
    fn derivative_in_x(
        &self,
        trajectory: &Trajectory,
        column: usize,
        target: f64,
        of: impl Fn(usize) -> usize,
    ) -> Option<f64> {
        let x_column = self.points.len();
        let (x, y) = (trajectory.column(x_column), trajectory.column(column));
        let (dx, dy) = (trajectory.column(of(x_column)), trajectory.column(of(column)));
        let times = trajectory.time();
        let path = Path { times, x };
        let k = path.slice_of(&self.x_name, target).ok()?;
        if x[k] == x[k + 1] {
            // Held from the beginning: the time is the first one, whatever the parameters are.
            return dy.get(k).copied();
        }
        let share = path.share(k, target);
        // Not across an event, which has two rows, nor where X is held.
        let is_slice = |a: usize, b: usize| times[a] < times[b] && x[a] != x[b];
        let first = k.checked_sub(1).filter(|before| is_slice(*before, k)).unwrap_or(k);
        let last = Some(k + 2).filter(|at| *at < times.len() && is_slice(k + 1, *at));
        let last = last.unwrap_or(k + 1);
        let at_given_x = |row: usize, ends: [usize; 2]| {
            let [a, b] = ends;
            dy[row] - (y[b] - y[a]) / (x[b] - x[a]) * dx[row]
        };
        let (before, after) = (at_given_x(k, [first, k + 1]), at_given_x(k + 1, [k, last]));
        Some(before + share * (after - before))
    }

    /// A simulation; why it failed, and whether at its start, which is the same with every method.
    fn attempt(
        &mut self,
        again: bool,
        simulator: &mut Simulator,
        trajectory: &mut Trajectory,
    ) -> Result<(), (Failed, bool)> {
        let refused = |fault: Fault| (Failed::new(FailureKind::Model, fault.message, 0.0), true);
        self.instance.set(&self.values).map_err(refused)?;
        let settings = self.retry.as_ref().filter(|_| again).unwrap_or(&self.settings);
        let run = self.instance.simulate(simulator, settings, trajectory);
        run.map(|_| ()).map_err(|error| {
            let length = (settings.stop - settings.start).max(f64::MIN_POSITIVE);
            let failed = Failed {
                kind: match self.instance.is_hopeless() {
                    true => FailureKind::Hopeless,
                    false => kind(&error),
                },
                cause: self.instance.explain(&error),
                progress: (error.time - settings.start) / length,
                at: Some(error.time),
            };
            (failed, matches!(error.kind, SimErrorKind::Initialization(_)))
        })
    }

    /// The value of a column of the trajectory at point `number` of observation `y`.
    fn at(
        &self,
        trajectory: &Trajectory,
        [y, of]: [usize; 2],
        (number, time): (usize, f64),
    ) -> Option<f64> {
        match self.limits[y].get(number) {
            Some(Some(limit)) => limit.value(trajectory, [y, of], time),
            _ => trajectory.at(of, time),
        }
    }

    fn read(&self, trajectory: &Trajectory, out: &mut [f64]) -> Result<(), Failed> {
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
                for (value, (number, &time)) in out.iter_mut().zip(points.iter().enumerate()) {
                    let found = self.at(trajectory, [column, column], (number, time));
                    *value = found.ok_or_else(|| self.not_reached(time))?;
                }
            }
        }
        self.refuse_not_finite(out)
    }
}

/// The points could not be read.
fn missing(cause: &str) -> Failed {
    Failed::new(FailureKind::Points, cause, 1.0)
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
    Some(Settings { method, tolerance, takes_exact_steps: false, ..settings.clone() })
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
