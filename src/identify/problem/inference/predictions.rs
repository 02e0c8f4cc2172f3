//! Simulated curves at points that were not measured, and their Jacobians.

use super::super::{Experiment, Failed, Free, ModelSimulator, Observation, Problem, Simulate};
use crate::diag::Fault;
use crate::elementary;
use crate::errors::{NOT_MONOTONE, POINTS_OUTSIDE};
use std::ops::Range;

/// How far bands go beyond the measured points, as a fraction of their width: as far as the eye
/// continues a curve.
const BEYOND: f64 = 0.1;
/// Times at which the range of a variable X is looked for.
const LOOKS: usize = 400;

/// Up to where curves are requested.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reach {
    /// Over the measured points and a tenth of their width beyond, as far as that is simulated.
    Measured,
    /// Over everything that is simulated.
    Simulated,
    /// Over this range; over time the simulation is made as long.
    Range([f64; 2]),
}

/// What is to be predicted.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveRequest<'a> {
    /// Variables beside the measured ones.
    pub variables: &'a [String],
    /// The range of X.
    pub reach: Reach,
    /// Points of each curve, evenly over its range.
    pub points: usize,
    /// Whether experiments count that were not made.
    pub proposes: bool,
}

/// A variable of an experiment over X.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// The experiment.
    pub experiment: String,
    /// The variable and its unit.
    pub y: [String; 2],
    /// What it is given over, and the unit.
    pub x: [String; 2],
    /// X, ascending.
    pub points: Vec<f64>,
    /// The measured series of this experiment and variable.
    pub series: Option<usize>,
    /// Whether X is the frequency of a spectrum.
    pub is_over_frequency: bool,
    /// Where the curve was not measured itself: the parts of the spectrum to the magnitude of which the
    /// measurement errors are in proportion; empty where they are the same at other operating points.
    pub in_proportion_to: Range<usize>,
}

/// Curves and what simulates them, one after the other.
pub struct Curves {
    /// The curves.
    pub curves: Vec<Curve>,
    /// Writes all points of all curves.
    pub simulator: Box<dyn Simulate>,
    /// Which experiments are missing, and why.
    pub(crate) refusals: Vec<String>,
}

/// Something that can simulate where nothing was measured.
pub trait Predict: Send + Sync {
    /// Curves that exist at all of these values of the parameters, the first being the best.
    ///
    /// # Errors
    ///
    /// Variables that there are not.
    fn curves(&self, around: &[Vec<f64>], request: &CurveRequest<'_>) -> Result<Curves, Fault>;
}

/// Values of curves and how they change with the parameters.
pub struct Linear {
    /// The points of all curves, one curve after the other.
    pub values: Vec<f64>,
    /// Derivatives by the parameters, point by point.
    pub(crate) gradients: Vec<Vec<f64>>,
}

/// Curves at `values`, linear in the parameters about them.
///
/// # Errors
///
/// Those of [`Predict::curves`].
pub fn linear(
    problem: &Problem,
    predict: &dyn Predict,
    values: &[f64],
    request: &CurveRequest<'_>,
) -> Result<(Curves, Result<Linear, Failed>), Fault> {
    let ends = ends(&problem.parameters, values, problem.noise);
    let around: Vec<Vec<f64>> =
        std::iter::once(values.to_vec()).chain(ends.iter().cloned()).collect();
    let mut curves = predict.curves(&around, request)?;
    let points = curves.curves.iter().map(|curve| curve.points.len()).sum();
    let mut linear = differentiate(curves.simulator.as_mut(), values, &ends, points);
    if let Ok(linear) = &mut linear {
        as_series(problem, &mut curves.curves, linear);
    }
    Ok((curves, linear))
}

/// Curves of measured series are named as these, and log-normal ones are those of the logarithms.
fn as_series(problem: &Problem, curves: &mut [Curve], linear: &mut Linear) {
    let mut first = 0;
    for curve in curves {
        let own = first..first + curve.points.len();
        first = own.end;
        let Some(series) = curve.series else { continue };
        let measured = &problem.series[series];
        curve.y = [measured.y_name.clone(), measured.y_unit.clone()];
        if !problem.inference.logarithmic.contains(&series) {
            continue;
        }
        for place in own {
            let value = linear.values[place];
            linear.gradients[place].iter_mut().for_each(|gradient| *gradient /= value);
            linear.values[place] = elementary::ln(value);
        }
    }
}

/// Below and above every parameter, within the ranges: the step that balances the error of a
/// central difference against that of the simulation.
fn ends(parameters: &[Free], values: &[f64], noise: f64) -> Vec<Vec<f64>> {
    let step = elementary::cbrt(noise).clamp(1e-5, 1e-2);
    let mut ends = Vec::with_capacity(2 * values.len());
    for (k, free) in parameters.iter().enumerate() {
        let width = free.max - free.min;
        let size = if values[k] == 0.0 { width } else { values[k].abs().min(width) };
        for side in [-1.0, 1.0] {
            let mut point = values.to_vec();
            point[k] = (values[k] + side * step * size).clamp(free.min, free.max);
            ends.push(point);
        }
    }
    ends
}

/// Exact sensitivities where the simulator has them, else differences between `ends`.
fn differentiate(
    simulator: &mut dyn Simulate,
    values: &[f64],
    ends: &[Vec<f64>],
    points: usize,
) -> Result<Linear, Failed> {
    let n = values.len();
    let (mut out, mut flat) = (vec![f64::NAN; points], vec![f64::NAN; points * n]);
    if simulator.sensitivities(values, &mut out, &mut flat)? {
        let gradients = flat.chunks_exact(n).map(<[f64]>::to_vec).collect();
        return Ok(Linear { values: out, gradients });
    }
    simulator.simulate(values, &mut out)?;
    let mut gradients = vec![vec![0.0; n]; points];
    let (mut low, mut high) = (out.clone(), out.clone());
    for k in 0..n {
        simulator.simulate(&ends[2 * k], &mut low)?;
        simulator.simulate(&ends[2 * k + 1], &mut high)?;
        let step = ends[2 * k + 1][k] - ends[2 * k][k];
        for (gradient, (low, high)) in gradients.iter_mut().zip(low.iter().zip(&high)) {
            gradient[k] = (high - low) / step;
        }
    }
    Ok(Linear { values: out, gradients })
}

/// Predictions of models.
pub struct ModelPredictions {
    /// The experiments of the problem, whose observations are its series in their order.
    pub experiments: Vec<Experiment>,
    /// Experiments that were not made.
    pub proposed: Vec<Proposed>,
}

/// An experiment that was not made, like one that was.
pub struct Proposed {
    /// The experiment.
    pub experiment: Experiment,
    /// The series of the other one's first observation.
    pub first: usize,
    /// Whether errors are in proportion to the magnitude of a spectrum.
    pub is_proportional: bool,
}

impl Predict for ModelPredictions {
    fn curves(&self, around: &[Vec<f64>], request: &CurveRequest<'_>) -> Result<Curves, Fault> {
        let (mut curves, mut kept, mut refusals) = (Vec::new(), Vec::new(), Vec::new());
        let made = self.experiments.iter().scan(0, |first, experiment| {
            let series = *first;
            *first += experiment.observations.len();
            Some((series, experiment))
        });
        let made = made.map(|(series, experiment)| (series, experiment, false));
        let proposed = self.proposed.iter().filter(|_| request.proposes);
        let proposed = proposed.map(|own| (own.first, &own.experiment, own.is_proportional));
        for (first, experiment, is_proportional) in made.chain(proposed) {
            match dense(experiment, around, request)? {
                Ok(dense) => {
                    let mut own = described(experiment, &dense, first);
                    if is_proportional {
                        let all = first..first + experiment.observations.len();
                        own.iter_mut().for_each(|curve| curve.in_proportion_to = all.clone());
                    }
                    curves.append(&mut own);
                    kept.push(dense);
                }
                Err(why) => refusals.push(match experiment.name.as_str() {
                    "" => format!("There are no predictions: {why}."),
                    name => format!("There are no predictions of {name}: {why}."),
                }),
            }
        }
        Ok(Curves { curves, simulator: Box::new(ModelSimulator::new(&kept)?), refusals })
    }
}

/// The experiment with a grid of points instead of the measured ones; why there is none.
fn dense(
    experiment: &Experiment,
    around: &[Vec<f64>],
    request: &CurveRequest<'_>,
) -> Result<Result<Experiment, String>, Fault> {
    let mut settings = experiment.settings.clone();
    if let (Reach::Range([_, end]), "time") = (request.reach, experiment.x_name.as_str()) {
        settings.stop = settings.stop.max(end);
    }
    let dense = Experiment { settings, ..experiment.clone() };
    let is_free = experiment.model.driven().is_some_and(|(driven, _)| driven == experiment.x_name);
    if is_free || is_over_frequency(experiment) {
        return over_input(&dense, around, request);
    }
    let simulated = match simulated_range(&dense, around)? {
        Ok(range) => range,
        Err(failed) => return Ok(Err(failed.cause)),
    };
    let range = match request.reach {
        Reach::Simulated => simulated,
        Reach::Measured => cut(measured_range(experiment, BEYOND), simulated),
        Reach::Range(range) => cut(range, simulated),
    };
    on_grid(dense, around, request, range)
}

/// The grid over an input, which may take any value: beyond the measured points as far as requested
/// where the model has a solution, else over these alone.
fn over_input(
    experiment: &Experiment,
    around: &[Vec<f64>],
    request: &CurveRequest<'_>,
) -> Result<Result<Experiment, String>, Fault> {
    if let Reach::Range(range) = request.reach {
        return on_grid(experiment.clone(), around, request, range);
    }
    // A next measurement is proposed where some have been possible.
    let beyond = if request.reach == Reach::Measured { BEYOND } else { 0.0 };
    let beyond = measured_range(experiment, beyond);
    match on_grid(experiment.clone(), around, request, beyond)? {
        Ok(dense) => Ok(Ok(dense)),
        Err(_) => on_grid(experiment.clone(), around, request, measured_range(experiment, 0.0)),
    }
}

/// The experiment with points evenly over a range; why there is none.
fn on_grid(
    mut dense: Experiment,
    around: &[Vec<f64>],
    request: &CurveRequest<'_>,
    range: [f64; 2],
) -> Result<Result<Experiment, String>, Fault> {
    let Some([low, high]) = range.filter_increasing() else {
        return Ok(Err(format!("`{}` does not vary there", dense.x_name)));
    };
    let last = (request.points.max(2) - 1) as f64;
    let at = |share: f64| match is_over_frequency(&dense) {
        true => low * elementary::powf(high / low, share),
        false => low + (high - low) * share,
    };
    let x: Vec<f64> = (0..=last as usize).map(|k| at(k as f64 / last)).collect();
    let compared = dense.observations.len() - dense.deviations;
    let own = dense.observations[..compared].iter().map(|own| own.y_name.clone());
    let mut names: Vec<String> = own.collect();
    for variable in
        request.variables.iter().filter(|name| !names.contains(name)).cloned().collect::<Vec<_>>()
    {
        names.push(variable);
    }
    dense.deviations = 0;
    dense.observations =
        names.into_iter().map(|y_name| Observation { y_name, x: x.clone() }).collect();
    let mut simulator = match ModelSimulator::new(std::slice::from_ref(&dense)) {
        Ok(simulator) => simulator,
        // The grid has points between the measured ones, which X need not reach.
        Err(fault) if [POINTS_OUTSIDE, NOT_MONOTONE].contains(&fault.code) => {
            return Ok(Err(fault.message));
        }
        Err(fault) => return Err(fault),
    };
    let mut out = vec![f64::NAN; dense.observations.len() * x.len()];
    for values in around {
        if let Err(failed) = simulator.simulate(values, &mut out) {
            return Ok(Err(failed.cause));
        }
    }
    Ok(Ok(dense))
}

/// Whether X is a frequency, whose points are spaced by their ratio.
fn is_over_frequency(experiment: &Experiment) -> bool {
    experiment.model.abscissa() == Some(experiment.x_name.as_str())
}

/// Ranges that may be empty.
trait Increasing {
    fn filter_increasing(self) -> Option<[f64; 2]>;
}

impl Increasing for [f64; 2] {
    fn filter_increasing(self) -> Option<[f64; 2]> {
        (self[0] < self[1]).then_some(self)
    }
}

fn cut(range: [f64; 2], within: [f64; 2]) -> [f64; 2] {
    [range[0].max(within[0]), range[1].min(within[1])]
}

/// The range of the measured points and this part of its width beyond.
fn measured_range(experiment: &Experiment, beyond: f64) -> [f64; 2] {
    let all = experiment.observations.iter().flat_map(|observation| &observation.x);
    let (low, high) =
        all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
    if is_over_frequency(experiment) {
        let factor = elementary::powf(high / low, beyond);
        return [low / factor, high * factor];
    }
    let beyond = beyond * (high - low);
    [low - beyond, high + beyond]
}

/// The range that X covers at all of these values of the parameters.
fn simulated_range(
    experiment: &Experiment,
    around: &[Vec<f64>],
) -> Result<Result<[f64; 2], Failed>, Fault> {
    let [start, stop] = [experiment.settings.start, experiment.settings.stop];
    if experiment.x_name == "time" {
        return Ok(Ok([start, stop]));
    }
    let times = (0..=LOOKS).map(|k| start + (stop - start) * (k as f64 / LOOKS as f64)).collect();
    let over_time = Experiment {
        x_name: "time".to_owned(),
        observations: vec![Observation { y_name: experiment.x_name.clone(), x: times }],
        ..experiment.clone()
    };
    let mut simulator = ModelSimulator::new(&[over_time])?;
    let mut row = vec![f64::NAN; LOOKS + 1];
    let mut common = [f64::NEG_INFINITY, f64::INFINITY];
    for values in around {
        if let Err(failed) = simulator.simulate(values, &mut row) {
            return Ok(Err(failed));
        }
        let low = row.iter().copied().fold(f64::INFINITY, f64::min);
        let high = row.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        common = cut(common, [low, high]);
    }
    Ok(Ok(common))
}

fn described(experiment: &Experiment, dense: &Experiment, first: usize) -> Vec<Curve> {
    let unit = |name: &str| match name {
        "time" => "s".to_owned(),
        name => experiment.model.unit(name).unwrap_or_default(),
    };
    let measured = experiment.observations.len() - experiment.deviations;
    let one = |(k, observation): (usize, &Observation)| Curve {
        experiment: experiment.name.clone(),
        y: [observation.y_name.clone(), unit(&observation.y_name)],
        x: [experiment.x_name.clone(), unit(&experiment.x_name)],
        points: observation.x.clone(),
        series: (k < measured).then_some(first + k),
        is_over_frequency: is_over_frequency(experiment),
        in_proportion_to: 0..0,
    };
    dense.observations.iter().enumerate().map(one).collect()
}
