//! Levenberg-Marquardt as a trust-region method with bounds: steps of Gauss and Newton within a
//! region that grows and shrinks by how well the linear model predicts, Moré's scaling, genes held at
//! a bound while the gradient points outwards, and geodesic acceleration where the residuals are
//! strongly curved. A descent continues until it ends by itself or its steps are used up; then it
//! can be continued.
//!
//! References: [Moré 1978](gapilib_base::bibliography#more-1978);
//! [Transtrum & Sethna 2012](gapilib_base::bibliography#transtrum-sethna-2012) (acceleration);
//! [Nocedal & Wright 2006](gapilib_base::bibliography#nocedal-wright-2006), §10.3.

use super::linear_model::{LinearModel, Offset, Step};
use super::{
    Answers, DescentEnd, DescentReport, ERRORS, Method, Optimizer, Required, Scale, Setup,
};
use crate::diag::Fault;
use crate::elementary;
use crate::ga::Genomes;
use crate::registry::Entry;
use nalgebra::DVector;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Method> = Entry {
    name: "levenberg_marquardt",
    aliases: &["lm", "levenberg-marquardt"],
    summary: "nonlinear least squares from one point: the start values if given, otherwise the \
              middle of the ranges",
    reference: "more-1978",
    make: |options| {
        let steps = options.take_whole("steps", 1.0..=1e6, 2000.0)?;
        let offset = options.take("offset", FINE..=MINIMUM, FINE)?;
        Ok(Box::new(LevenbergMarquardt { steps, offset }))
    },
};

/// Relative offset below which a point is a minimum; Bates and Watts' choice: the parameters lie
/// within a thousandth of their standard errors.
pub const MINIMUM: f64 = 1e-3;
/// Relative offset at which the best descent stops: parameters to 1e-7 of their standard errors.
pub(crate) const FINE: f64 = 1e-7;
/// Relative offset at which the others stop. Problems with large residuals converge slowly from here
/// (ENSO takes as many steps again).
pub(crate) const COARSE: f64 = 3e-4;
/// A minimum whose residuals come near to the errors of the simulation is located to this offset at
/// best (Lanczos1: residuals of 1e-13).
const COARSEST: f64 = 0.02;
/// A scale falls at most by this factor in a step; with scales that never fall, MGH10 and Eckerle4
/// stop far from the minimum.
const FORGET: f64 = 0.3;
/// Without degrees of freedom, and where the residuals are those of rounding, a minimum is where the
/// step of Gauss and Newton is below this part of the ranges.
const SMALL_STEP: f64 = 1e-8;
/// Changes of the sum of squares below this, relative, are those of rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// The first region reaches this part of the ranges.
const FIRST: f64 = 0.3;
/// Length of the probe of the curvature, as a part of the step; Transtrum and Sethna's choice.
const PROBE: f64 = 0.1;
/// Accelerations beyond this part of the step are not trusted; their choice.
const TRUSTED: f64 = 0.75;
/// Steps that fell short of the prediction before curvature is probed.
const CURVED: u32 = 2;

/// A short step changes a gene on a logarithmic scale by at most this factor.
const FACTOR: f64 = 100.0;

/// How far a short step may move each gene, as a part of its range.
pub(crate) fn reach(scales: &[Scale]) -> Vec<f64> {
    let one = |scale: &Scale| match scale.logarithmic {
        // Of a range of negative numbers, the quotient is below 1.
        true => elementary::ln(FACTOR) / elementary::ln(scale.max / scale.min).abs(),
        false => 1.0,
    };
    scales.iter().map(one).collect()
}

struct LevenbergMarquardt {
    steps: usize,
    /// Relative offset at which the descent stops.
    offset: f64,
}

impl Method for LevenbergMarquardt {
    fn start(&self, setup: Setup) -> Result<Box<dyn Optimizer>, Fault> {
        let start = setup.start.clone().unwrap_or_else(|| vec![0.5; setup.genes.len()]);
        Ok(Box::new(Descent::new(start, Accuracy::of(&setup), self.steps, self.offset)))
    }

    fn needs_residuals(&self) -> bool {
        true
    }

    fn can_be_polished(&self) -> bool {
        false
    }
}

/// How exact the answers are.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Accuracy {
    /// Relative error of the simulated values.
    pub(super) noise: f64,
    /// Root of the sum of squares of the measured values, weighted as the residuals are.
    pub(super) size: f64,
}

impl Accuracy {
    pub(crate) fn of(setup: &Setup) -> Accuracy {
        Accuracy { noise: setup.noise, size: setup.size }
    }

    /// Below this the residuals are those of rounding, or of the simulator's tolerance.
    fn floor(self) -> f64 {
        self.size * (self.noise * 1e-3).max(1e-16)
    }

    /// Singular values below this are those of errors of the derivatives.
    pub(crate) fn rank_tolerance(self) -> f64 {
        elementary::powf(self.noise, 2.0 / 3.0).clamp(1e-9, 1e-4)
    }
}

/// What was asked last.
#[derive(Clone, Copy, PartialEq)]
enum Request {
    Start,
    Jacobian,
    Probe,
    Trial,
}

/// One descent.
pub(crate) struct Descent {
    start: Vec<f64>,
    x: Vec<f64>,
    sum: f64,
    residuals: Vec<f64>,
    jacobian: Vec<f64>,
    model: Option<LinearModel>,
    scales: Vec<f64>,
    /// How far a step may move each gene.
    reach: Vec<f64>,
    accuracy: Accuracy,
    radius: f64,
    step: Option<Step>,
    trial: Vec<f64>,
    /// Steps left, and taken.
    left: usize,
    taken: u64,
    /// Steps in a row that fell short of the prediction.
    curved: u32,
    asked: Request,
    offset: Option<Offset>,
    /// The relative offset at which it stops.
    goal: f64,
    end: Option<DescentEnd>,
}

impl Descent {
    pub(crate) fn new(start: Vec<f64>, accuracy: Accuracy, steps: usize, goal: f64) -> Descent {
        Descent {
            x: start.clone(),
            trial: start.clone(),
            scales: vec![0.0; start.len()],
            reach: vec![1.0; start.len()],
            start,
            sum: f64::INFINITY,
            residuals: Vec::new(),
            jacobian: Vec::new(),
            model: None,
            accuracy,
            radius: 0.0,
            step: None,
            left: steps,
            taken: 0,
            curved: 0,
            asked: Request::Start,
            offset: None,
            goal,
            end: None,
        }
    }

    /// The same with steps that move each gene by at most this.
    pub(crate) fn within(mut self, reach: &[f64]) -> Descent {
        self.reach.iter_mut().zip(reach).for_each(|(own, reach)| *own = *reach);
        self
    }

    /// Whether it has ended by itself.
    pub(crate) fn has_ended(&self) -> bool {
        self.end.is_some()
    }

    /// Allows further steps, up to a relative offset; one that has ended at a minimum continues if
    /// it was not that near to it.
    pub(crate) fn grant(&mut self, steps: usize, goal: f64) {
        self.left = steps;
        if goal < self.goal && self.end == Some(DescentEnd::Minimum) {
            self.goal = goal;
            self.end = None;
            self.judge();
        }
        self.goal = self.goal.min(goal);
    }

    /// Whether a finer goal is open to it.
    pub(crate) fn can_be_refined(&self) -> bool {
        self.end == Some(DescentEnd::Minimum) && self.goal > FINE
    }

    /// Whether it has just come to a place whose derivatives are not yet known.
    pub(crate) fn has_moved(&self) -> bool {
        self.end.is_none() && self.asked == Request::Jacobian
    }

    /// Whether it is on the way to the minimum where `other` has ended: the linear model about this
    /// minimum, which determines every gene, predicts its residuals. This model is convex, and so
    /// there is no other minimum between them.
    pub(crate) fn leads_to(&self, other: &Descent) -> bool {
        let n = self.x.len();
        let Some(offset) = other.offset else { return false };
        let is_known = other.end == Some(DescentEnd::Minimum) && !offset.blind;
        if !is_known || offset.rank + offset.held < n || self.sum < other.sum {
            return false;
        }
        let (mut moved, mut error) = (0.0, 0.0);
        let rows = other.jacobian.chunks_exact(n).zip(&other.residuals).zip(&self.residuals);
        for ((row, at_minimum), here) in rows {
            let places = self.x.iter().zip(&other.x);
            let by: f64 = row.iter().zip(places).map(|(d, (a, b))| d * (a - b)).sum();
            moved += by * by;
            error += elementary::powi(here - at_minimum - by, 2);
        }
        error <= LINEAR * LINEAR * moved
    }

    /// Ends it on the way to a known minimum.
    pub(crate) fn join(&mut self) {
        self.end = Some(DescentEnd::Joined);
    }

    /// Whether a bound holds a gene where it stands.
    pub(crate) fn is_held(&self) -> bool {
        self.offset.is_some_and(|offset| offset.held > 0)
    }

    /// The sum of squares where it stands.
    pub(crate) fn sum(&self) -> f64 {
        self.sum
    }

    /// Where it started, where it stands and how it ended.
    pub(crate) fn report(&self) -> DescentReport {
        DescentReport {
            start: self.start.clone(),
            end: self.x.clone(),
            objective: self.sum,
            ending: self.end.unwrap_or(DescentEnd::StepLimit),
            offset: self.offset.and_then(|offset| offset.relative),
            steps: self.taken,
            group: 0,
        }
    }

    /// Whether another descent has ended at the same minimum: the sums of squares agree, and so do
    /// the places, by their effect on the residuals, or the residuals themselves where the data do
    /// not determine the place.
    pub(crate) fn agrees(&self, other: &Descent) -> bool {
        let (Some(model), Some(offset)) = (&self.model, self.offset) else { return false };
        // Residuals of the size of the errors of the simulation are those of an exact fit, wherever in a
        // valley: noise-free data of a model with a structurally non-identifiable product.
        let errors = ERRORS * self.accuracy.noise * self.accuracy.size;
        let floor = self.accuracy.floor().max(errors);
        let freedom = self.residuals.len().saturating_sub(offset.rank).max(1);
        let error = (self.sum / freedom as f64).sqrt();
        let near = AGREED * error + floor;
        if (self.sum - other.sum).abs() > AGREED * AGREED * self.sum + floor * floor {
            return false;
        }
        let is_deficient = offset.rank + offset.held < self.x.len();
        if is_deficient {
            let square = |(a, b): (&f64, &f64)| (a - b) * (a - b);
            let apart: f64 = self.residuals.iter().zip(&other.residuals).map(square).sum();
            return apart.sqrt() <= near * (freedom as f64).sqrt();
        }
        let apart = self.x.iter().zip(&other.x).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        apart <= SAME_PLACE || model.distance(&self.x, &other.x) <= near
    }

    fn finish(&mut self, otherwise: DescentEnd) {
        let is_minimum = self.offset.is_some_and(|offset| self.is_minimum(offset, MINIMUM));
        self.end = Some(if is_minimum { DescentEnd::Minimum } else { otherwise });
    }

    fn is_minimum(&self, offset: Offset, limit: f64) -> bool {
        is_minimum(&offset, self.sum.sqrt(), self.accuracy, limit)
    }

    fn take_jacobian(&mut self, answers: &Answers<'_>) {
        self.jacobian = answers.jacobians.to_vec();
        let tolerance = self.accuracy.rank_tolerance();
        let model = LinearModel::new(&self.residuals, &self.jacobian, self.x.len(), tolerance);
        let largest = model.norms.iter().copied().fold(0.0, f64::max);
        let is_first = self.model.is_none();
        for (scale, norm) in self.scales.iter_mut().zip(&model.norms) {
            *scale = norm.max(FORGET * *scale).max(1e-12 * largest);
        }
        if is_first {
            self.radius = FIRST * self.scales.iter().map(|d| d * d).sum::<f64>().sqrt();
        }
        let offset = model.offset(&self.x);
        self.offset = Some(offset);
        self.model = Some(model);
        if largest == 0.0 && self.sum > 0.0 {
            self.end = Some(DescentEnd::Flat);
        } else {
            self.judge();
        }
    }

    /// Ends where the goal is reached; else the next step.
    fn judge(&mut self) {
        let is_reached = self.offset.is_some_and(|offset| self.is_minimum(offset, self.goal));
        if is_reached {
            self.end = Some(DescentEnd::Minimum);
        } else {
            self.propose();
        }
    }

    /// The next step; ends where none exceeds rounding errors.
    fn propose(&mut self) {
        let limits = (&self.scales[..], &self.reach[..]);
        let step = self.model.as_ref().and_then(|m| m.step(&self.x, limits, self.radius));
        let Some(step) = step else { return self.finish(DescentEnd::NoDescent) };
        let moves = step.by.iter().zip(&self.x).any(|(by, x)| by.abs() > 1e-15 * x.max(1e-3));
        if !moves || step.reduction <= ROUNDING * ROUNDING * self.sum {
            return self.finish(DescentEnd::NoDescent);
        }
        self.set_trial(&step.by, 1.0);
        self.asked = Request::Trial;
        if self.curved >= CURVED && step.damping > 0.0 {
            self.set_trial(&step.by, PROBE);
            self.asked = Request::Probe;
        }
        self.step = Some(step);
    }

    fn set_trial(&mut self, by: &[f64], part: f64) {
        for ((trial, x), by) in self.trial.iter_mut().zip(&self.x).zip(by) {
            *trial = (x + part * by).clamp(0.0, 1.0);
        }
    }

    /// Bends the step by its acceleration, found from the residuals a part of it away.
    fn take_probe(&mut self, answers: &Answers<'_>) {
        self.asked = Request::Trial;
        let Some(step) = self.step.take() else { return };
        let by = self.bent(&step, answers.residuals).unwrap_or_else(|| step.by.clone());
        self.set_trial(&by, 1.0);
        self.step = Some(step);
    }

    fn bent(&self, step: &Step, probe: &[f64]) -> Option<Vec<f64>> {
        let n = self.x.len();
        let mut gradient = DVector::zeros(n);
        for ((row, probe), r) in self.jacobian.chunks_exact(n).zip(probe).zip(&self.residuals) {
            let linear: f64 = row
                .iter()
                .zip(&step.by)
                .map(|(j, p)| if j.is_finite() { j * p } else { 0.0 })
                .sum();
            let second = 2.0 / PROBE * ((probe - r) / PROBE - linear);
            for (g, j) in gradient.iter_mut().zip(row) {
                *g += second * if j.is_finite() { *j } else { 0.0 };
            }
        }
        let a = self.model.as_ref()?.acceleration(step, &self.scales, &gradient)?;
        let length =
            a.iter().zip(&self.scales).map(|(a, d)| elementary::powi(a * d, 2)).sum::<f64>().sqrt();
        // Not finite where the probe failed.
        let trusted = 2.0 * length <= TRUSTED * step.length;
        trusted.then(|| step.by.iter().zip(&a).map(|(p, a)| p + 0.5 * a).collect())
    }

    fn take_trial(&mut self, answers: &Answers<'_>) {
        self.left = self.left.saturating_sub(1);
        self.taken += 1;
        let Some(step) = self.step.take() else { return };
        let sum: f64 = answers.residuals.iter().map(|r| r * r).sum();
        let sum = if sum.is_finite() { sum } else { f64::INFINITY };
        let gain = self.sum - sum;
        let ratio = gain / step.reduction;
        self.curved = if ratio < 0.25 { self.curved + 1 } else { self.curved };
        if ratio <= 0.25 {
            // The minimum of the parabola through both values and the derivative, within limits.
            let part = if sum.is_finite() { 0.5 / (1.0 - 0.5 * ratio) } else { 0.25 };
            self.radius = part.clamp(0.1, 0.5) * step.length.min(self.radius);
        } else if ratio >= 0.75 || step.damping == 0.0 {
            self.radius = self.radius.max(2.0 * step.length);
        }
        if ratio > 1e-4 {
            self.x.copy_from_slice(&self.trial);
            self.residuals = answers.residuals.to_vec();
            self.sum = sum;
            self.asked = Request::Jacobian;
            return;
        }
        let error = self.accuracy.noise * self.accuracy.size * 1e-3 * self.sum.sqrt();
        if step.reduction <= (ROUNDING * self.sum).max(error) {
            return self.finish(DescentEnd::NoDescent);
        }
        self.propose();
    }
}

/// A minimum is known to lie ahead where its linear model predicts the residuals to this part of their
/// change: from here Gauss-Newton steps shorten the distance by such a factor or more.
const LINEAR: f64 = 0.2;
/// Genes nearer than this are the same.
const SAME_PLACE: f64 = 1e-5;
/// Minima that differ by less than this part of a standard error are the same.
const AGREED: f64 = 0.03;

/// Whether a point with such an offset and residuals of such a length is a minimum.
pub(crate) fn is_minimum(offset: &Offset, length: f64, accuracy: Accuracy, limit: f64) -> bool {
    if offset.blind || offset.rank == 0 && offset.held == 0 {
        return false;
    }
    if length <= accuracy.floor() {
        return true;
    }
    if offset.rank == 0 {
        // Every gene stands at a bound and is held there.
        return offset.flat == 0;
    }
    let error = accuracy.noise * accuracy.size / length;
    match offset.relative {
        Some(relative) if error < 1.0 => relative <= limit.max(error.min(COARSEST)),
        _ => offset.step <= SMALL_STEP,
    }
}

impl Descent {
    /// What the next request needs to be evaluated.
    pub(crate) fn required_now(&self) -> Required {
        match self.asked {
            Request::Start | Request::Jacobian => Required::Jacobians,
            Request::Probe | Request::Trial => Required::Residuals,
        }
    }

    /// Asks for one individual; for none when it has ended or its steps are used up.
    pub(crate) fn ask_next(&self, batch: &mut Genomes) {
        if self.end.is_some() || self.left == 0 && self.asked != Request::Jacobian {
            return;
        }
        match self.asked {
            Request::Start | Request::Jacobian => batch.push(&self.x),
            Request::Probe | Request::Trial => batch.push(&self.trial),
        }
    }

    /// Takes the answers about it.
    pub(crate) fn take(&mut self, answers: &Answers<'_>) {
        match self.asked {
            Request::Start => {
                self.sum = answers.residuals.iter().map(|r| r * r).sum();
                self.residuals = answers.residuals.to_vec();
                if self.sum.is_finite() {
                    self.take_jacobian(answers);
                } else {
                    self.sum = f64::INFINITY;
                    self.end = Some(DescentEnd::Failed);
                }
            }
            Request::Jacobian => self.take_jacobian(answers),
            Request::Probe => self.take_probe(answers),
            Request::Trial => self.take_trial(answers),
        }
    }

    /// Where it started and where it stands.
    pub(crate) fn places(&self) -> [&[f64]; 2] {
        [&self.start, &self.x]
    }
}

impl Optimizer for Descent {
    fn ask(&mut self, batch: &mut Genomes) {
        self.ask_next(batch);
    }

    fn tell(&mut self, _: &Genomes, answers: &Answers<'_>) {
        self.take(answers);
    }

    fn required(&self) -> Required {
        self.required_now()
    }

    fn phase(&self) -> &'static str {
        "least squares"
    }

    fn descents(&self) -> Vec<DescentReport> {
        vec![self.report()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_reach_a_factor_of_100_on_logarithmic_scales() {
        let scale = |min, max, logarithmic| Scale { min, max, logarithmic, unit: String::new() };
        let all = [
            scale(1e-5, 1e3, true),
            scale(-1e3, -1e-5, true),
            scale(1.0, 10.0, true),
            scale(1e-5, 1e3, false),
        ];
        let found = reach(&all);
        assert!((found[0] - 0.25).abs() < 1e-12 && (found[1] - 0.25).abs() < 1e-12, "{found:?}");
        assert!(found[2] > 1.0 && found[3] == 1.0, "{found:?}");
    }
}
