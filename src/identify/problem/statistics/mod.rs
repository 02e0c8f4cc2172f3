//! What the data tell about the parameters found, and whether the residuals look like noise.
//!
//! With the sensitivities J of the weighted residuals at the best point and their variance
//! s² = Σ r² / (points − parameters), or 1 where the deviations of the measurements are given and
//! believed, the covariance is s² (JᵀJ)⁻¹ and an interval reaches t s as
//! far as Student's distribution says. Both hold where the model is nearly linear about the best
//! point; a profile says more.
//!
//! Series that hold the same numbers count once: each of m has its weights divided by √m.
//!
//! Reference: [Walter & Pronzato 1997](gapilib_base::bibliography#walter-pronzato-1997), chapter 5.

pub(super) mod at_bounds;
pub(crate) mod distributions;
pub(super) mod freedom;
pub(super) mod outliers;
pub(super) mod residuals;
pub(super) mod resolution;
mod special_functions;

use crate::elementary;
use crate::fitness::{Whitening, raised};
use at_bounds::AtBounds;
pub(crate) use residuals::{ResidualTest, residual_test};

use super::confirmed::is_confirmed;
use super::explicit::Explicit;
use super::joint::is_joint;
use super::non_identifiable::{self, Form, NonIdentifiable, Rank};
use super::sensitivities::Sensitivities;
use super::separable::Combination;
use super::{ErrorModel, Evaluation, Problem, Role, Series};
use crate::{Uncertainty, error_of_combination, uncertainty_given};
use distributions::normal_quantile;
pub(super) use distributions::student_quantile;

/// A singular value this far below the largest is none, however exact the simulation is, and
/// however inexact.
const RANK: [f64; 2] = [1e-7, 1e-4];
/// Where a lack of rank shows, derivatives are taken with errors of the simulation no larger than
/// this; where that is refused, the lack must show at several points to be believed.
const EXACT: f64 = 1e-9;
/// Derivatives that over the whole range would change the points by less than this part of the
/// largest are rounding.
const NO_EFFECT: f64 = 1e-10;
/// Where no parameter has an effect of so many times the errors of the simulation, derivatives are
/// errors, and say nothing of what cancels.
const NOTICEABLE: f64 = 1e4;
/// Elsewhere, derivatives are as exact as at the best point up to this factor.
const ELSEWHERE: f64 = 100.0;
/// Points elsewhere at which a lack of rank must show, where its form is not known.
const AGREEING: usize = 3;
/// The upper end of a 95 % interval as a probability.
const UPPER: f64 = 0.975;
/// Values nearer to an end of the range than this part of their standard error stand at that end,
/// unless the range itself is not much larger than that.
const AT_END: f64 = 0.01;
const NEAR_END: f64 = 1e-3;
/// Without a standard error, this fraction of the range.
const ON_END: f64 = 1e-9;
/// Sums of squares that are smaller by this factor than those from which they were computed are
/// rounding.
const ROUNDING: f64 = 1e-12;

/// What the data tell.
#[derive(Debug, Clone, PartialEq)]
pub struct Statistics {
    /// Standard errors and correlations; `None` where they cannot be computed.
    pub uncertainty: Option<Uncertainty>,
    /// What holds where parameters stand at ends of their ranges; `None` where none does.
    pub(super) at_bounds: Option<AtBounds>,
    /// For parameters that stand at an end of their range, 1 where the range lies above it and −1
    /// where below.
    pub(super) inward: Vec<Option<f64>>,
    /// What the variance of the errors is.
    pub(crate) spread: Spread,
    /// Parameters that take no degree of freedom: those without any effect, and in groups that act only
    /// together those of which the others are made up for.
    open: usize,
    /// Weights of the points: reciprocal standard deviations where these are known or estimated.
    pub weights: Vec<f64>,
    /// Weighted residuals, measured less simulated.
    pub residuals: Vec<f64>,
    /// Series that hold the same numbers as an earlier one: the later and the earlier.
    pub repeated: Vec<(usize, usize)>,
    /// The rank of the sensitivities at the best values.
    pub(super) rank: Rank,
    /// Parameters whose derivatives cancel each other, while finite changes do not.
    pub(super) cancelling: Vec<usize>,
    /// Sensitivities of the simulated points by the parameters, column by column, without weights.
    pub jacobian: Vec<Vec<f64>>,
    /// Simulations that it took.
    pub simulations: u64,
    /// What the square of each residual counts.
    pub(super) shares: Vec<f64>,
    /// Scales and offsets of relative data.
    pub(super) explicit: Option<Explicit>,
    /// What makes derivatives of the points sensitivities.
    scales: Scales,
    /// The weighted sum of squares, as the variance is estimated from it.
    square: f64,
    /// The sum of squares that least squares minimize.
    pub(super) searched: f64,
    /// Whether it is a likelihood with deviations that the model computes.
    error_model: ErrorModel,
    /// Singular values below this part of the largest are none.
    rank_tolerance: f64,
    /// What the solver's tolerance is multiplied with when derivatives are taken.
    fineness: f64,
}

impl Statistics {
    /// The largest sum of squares, as least squares minimize it, within the 95 % limit of the
    /// likelihood.
    pub(super) fn limit_of_squares(&self) -> f64 {
        let rise = elementary::powi(self.quantile_of_squares(), 2);
        let points = self.residuals.len() as f64;
        let relative = 1.0 + rise / self.spread.freedom;
        match (self.error_model, self.spread.believed) {
            (ErrorModel::Computed, true) => raised(self.searched, points, rise),
            (ErrorModel::Estimated, _) => {
                raised(self.searched, points, points * elementary::ln(relative))
            }
            (_, true) => self.searched + rise,
            (_, false) => self.searched * relative,
        }
    }

    /// What the root of the rise of the sum of squares is within the 95 % limit, in units of the
    /// residual variance.
    pub(super) fn quantile_of_squares(&self) -> f64 {
        if self.spread.believed || self.spread.robust || self.is_mixed() {
            return self.spread.quantile;
        }
        self.spread.quantile * (self.spread.variance * self.spread.freedom / self.square).sqrt()
    }

    /// The weighted sum of squares of the data, some points left out; equal series count once. A prior
    /// is no datum: it takes a point away and the parameter that this point would determine, so that
    /// the degrees of freedom are those of all points.
    pub(super) fn chi_square(&self, problem: &Problem, without: &[usize]) -> f64 {
        let is_datum = problem
            .series
            .iter()
            .flat_map(|series| std::iter::repeat_n(series.is_data(), series.x.len()));
        let points = self.residuals.iter().zip(&self.shares).zip(is_datum).enumerate();
        let kept = points.filter(|(j, (_, is_datum))| *is_datum && !without.contains(j));
        kept.map(|(_, ((r, share), _))| share * r * r).sum()
    }

    /// Computes them at `values`, where the simulated points are `simulated`. `others`: points
    /// elsewhere in the search space, which tell how far a lack of rank goes.
    pub fn at(
        problem: &Problem,
        evaluation: &Evaluation,
        values: &[f64],
        simulated: &[f64],
        others: &[Vec<f64>],
    ) -> Statistics {
        let repeated = repeated(&problem.series);
        let data = Data::at(problem, evaluation, simulated, &repeated);
        let Fine { best, jacobian, fineness, simulations } =
            Fine::at(problem, evaluation, (values, simulated), &data.scales);
        let mut found = Statistics {
            uncertainty: None,
            at_bounds: None,
            inward: Vec::new(),
            spread: Spread::default(),
            open: 0,
            weights: data.weights.clone(),
            residuals: data.residuals.clone(),
            repeated,
            rank: Rank::default(),
            cancelling: Vec::new(),
            jacobian,
            simulations,
            explicit: Explicit::at(problem, evaluation, values, fineness),
            shares: data.shares.clone(),
            scales: data.scales.clone(),
            square: data.square,
            searched: data.searched,
            error_model: ErrorModel::of(problem),
            rank_tolerance: rank_tolerance(problem.noise * fineness),
            fineness,
        };
        found.estimate_errors(problem, evaluation, &data, &best);
        found.find_rank(problem, evaluation, (&best, simulated), others, &data);
        let groups = found.rank.non_identifiable.iter().filter(|group| group.form != Form::Local);
        found.open = groups.map(|group| group.excess).sum();
        if !found.rank.non_identifiable.is_empty() {
            found.estimate_errors(problem, evaluation, &data, &best);
        }
        found
    }

    /// Counts parameters that change nothing that was compared as open: they take no degree of freedom.
    pub(super) fn release(
        &mut self,
        problem: &Problem,
        evaluation: &Evaluation,
        (values, simulated): (&[f64], &[f64]),
        count: usize,
    ) {
        if count > 0 {
            self.open += count;
            let data = Data::at(problem, evaluation, simulated, &self.repeated);
            let columns = weighted(&self.jacobian, &data.scales);
            let best = Sensitivities { values: values.to_vec(), columns };
            self.estimate_errors(problem, evaluation, &data, &best);
        }
    }

    /// Estimates the variance of the measurements, and from it the standard errors.
    fn estimate_errors(
        &mut self,
        problem: &Problem,
        evaluation: &Evaluation,
        data: &Data,
        best: &Sensitivities,
    ) {
        let explicit = self.explicit.as_ref().map(|own| weighted(&own.columns, &data.scales));
        let columns = explicit.as_ref().unwrap_or(&best.columns);
        let spread = Spread::of(problem, evaluation, data, (columns, self.open));
        let mut reduced = best.columns.clone();
        reduce(&mut reduced, spread.reduction.as_deref());
        let own = &reduced;
        self.uncertainty = match spread.freedom > 0.0 || spread.believed && spread.freedom == 0.0 {
            true => uncertainty_given(own, spread.variance),
            false => None,
        };
        self.inward = inward(problem, &best.values, self.uncertainty.as_ref());
        self.at_bounds = self.uncertainty.as_ref().and_then(|_| {
            let plain = (!spread.robust).then(|| data.shared_residuals());
            let variances = [spread.variance, spread.rise()];
            let groups = &self.rank.non_identifiable;
            AtBounds::of(own, groups, plain.as_deref(), &self.inward, variances)
        });
        self.spread = spread;
    }

    /// Finds which parameters have no effect, and which act only together.
    fn find_rank(
        &mut self,
        problem: &Problem,
        evaluation: &Evaluation,
        (best, simulated): (&Sensitivities, &[f64]),
        others: &[Vec<f64>],
        data: &Data,
    ) {
        let scales = &data.scales;
        let mut rank = non_identifiable::rank(best, &[], self.rank_tolerance);
        if !rank.non_identifiable.is_empty() {
            let elsewhere = self.elsewhere(problem, evaluation, others, scales);
            rank = non_identifiable::rank(best, &elsewhere, self.rank_tolerance);
            for group in rank.non_identifiable.iter_mut().filter(|own| own.form == Form::Local) {
                self.find_function((problem, evaluation), best, group, (&elsewhere, scales));
            }
            let is_exact = problem.noise * self.fineness <= EXACT;
            rank.non_identifiable.retain(|group| is_exact || group.form != Form::Local);
        }
        let rise = elementary::powi(self.spread.quantile, 2) * self.spread.variance;
        let is_within =
            |row: &[f64]| rise_of_squares(problem, evaluation, data, (simulated, row)) <= rise;
        for group in rank.non_identifiable {
            if group.form == Form::Function {
                self.rank.non_identifiable.push(group);
                continue;
            }
            let at = (&best.values[..], simulated);
            let (holds, took) = is_confirmed(problem, evaluation, at, &group, &is_within);
            self.simulations += took;
            match holds {
                true => self.rank.non_identifiable.push(group),
                false => self.cancelling.extend(group.parameters),
            }
        }
        (self.rank.condition, self.rank.without_effect) = (rank.condition, rank.without_effect);
    }

    /// The sensitivities at those points elsewhere at which they exceed the errors of the simulation.
    fn elsewhere(
        &mut self,
        problem: &Problem,
        evaluation: &Evaluation,
        others: &[Vec<f64>],
        scales: &Scales,
    ) -> Vec<Sensitivities> {
        let mut found = Vec::new();
        for (values, simulated) in others.iter().zip(evaluation.simulate_all(others)) {
            self.simulations += 1;
            let Ok(simulated) = simulated else { continue };
            let (jacobian, took) = sensitivities(problem, evaluation, values, self.fineness);
            self.simulations += took;
            let columns = weighted(&jacobian, scales);
            let errors = problem.noise * self.fineness * size(&simulated, &scales.own);
            let is_noticeable = largest_effect(&columns, values) > NOTICEABLE * errors;
            if is_noticeable && columns.iter().flatten().all(|value| value.is_finite()) {
                found.push(Sensitivities { values: values.clone(), columns });
            }
        }
        found
    }

    /// Whether the model depends only on a function of a group whose members cancel each other at the
    /// best point by other proportions than elsewhere.
    fn find_function(
        &mut self,
        (problem, evaluation): (&Problem, &Evaluation),
        best: &Sensitivities,
        group: &mut NonIdentifiable,
        (elsewhere, scales): (&[Sensitivities], &Scales),
    ) {
        let is_deficient =
            |point: &Sensitivities| point.is_deficient(group, ELSEWHERE * self.rank_tolerance);
        // Too few points leave every model without full rank.
        let points = best.columns.first().map_or(0, Vec::len);
        if points < problem.parameters.len() || !elsewhere.iter().all(is_deficient) {
            return;
        }
        let (fineness, simulations) = (self.fineness, &mut self.simulations);
        let mut columns = |values: &[f64]| {
            let (jacobian, took) = sensitivities(problem, evaluation, values, fineness);
            *simulations += took;
            weighted(&jacobian, scales)
        };
        let about = (problem, evaluation);
        if group.parameters.len() == group.excess + 1 {
            let members = &group.parameters;
            group.function = Combination::of(about, best, members, elsewhere, &mut columns);
        }
        // Without a form that can be tested by finite changes, several points have to agree.
        if group.function.is_some() || elsewhere.len() >= AGREEING {
            group.form = Form::Function;
        }
    }
}

/// What makes derivatives of the points sensitivities: factors, and where errors are correlated a
/// linear map of what they make.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scales {
    own: Vec<f64>,
    whitening: Option<Whitening>,
}

/// The data as they count at one place.
struct Data {
    weights: Vec<f64>,
    /// What the square of each residual counts: less than 1 where several series hold the same
    /// numbers, nothing where it is one of a deviation.
    shares: Vec<f64>,
    /// Weights with shares, of deviations whole.
    scales: Scales,
    residuals: Vec<f64>,
    /// Weighted sum of squares.
    square: f64,
    /// The sum of squares that least squares minimize.
    searched: f64,
}

impl Data {
    fn at(
        problem: &Problem,
        evaluation: &Evaluation,
        simulated: &[f64],
        repeated: &[(usize, usize)],
    ) -> Data {
        let shares = shares(&problem.series, repeated);
        let weights: Vec<f64> = evaluation.error_weights(problem, simulated);
        // A deviation tells of the parameters, though nothing is compared with it.
        let is_deviation = problem.series.iter().flat_map(|series| {
            std::iter::repeat_n(matches!(series.role, Role::Deviation(_)), series.y.len())
        });
        let scales = weights.iter().zip(&shares).zip(is_deviation);
        let scales = scales.map(|((w, s), whole)| if whole { *w } else { w * s.sqrt() }).collect();
        let residuals = evaluation.standard_residuals(problem, simulated);
        let square = match problem.is_normal() {
            true => residuals.iter().zip(&shares).map(|(r, share)| share * r * r).sum(),
            // The most likely scales make it so.
            false => shares.iter().sum(),
        };
        let searched = evaluation.searched_sum(problem, simulated);
        let scales = Scales { own: scales, whitening: evaluation.whitening(problem, simulated) };
        Data { weights, shares, scales, residuals, square, searched }
    }

    fn shared_residuals(&self) -> Vec<f64> {
        let parts = self.residuals.iter().zip(&self.scales.own).zip(&self.weights);
        parts.map(|((r, scale), weight)| r * scale / weight).collect()
    }
}

/// Half-width of a 95 % interval by the standard error: the quantile of Student's distribution, with
/// infinitely many degrees of freedom that of the normal one.
pub(super) fn quantile(freedom: f64) -> f64 {
    if freedom == f64::INFINITY { normal_quantile(UPPER) } else { student_quantile(UPPER, freedom) }
}

/// Multiplies the sensitivities of each point with a factor.
fn reduce(columns: &mut [Vec<f64>], reduction: Option<&[f64]>) {
    for column in columns {
        let factors = reduction.into_iter().flatten();
        column.iter_mut().zip(factors).for_each(|(value, factor)| *value *= factor);
    }
}

/// What the variance of the errors is, and how it is known.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Spread {
    /// Points less the parameters that the data can determine; equal series count once.
    pub freedom: f64,
    /// Whether the fitness is a robust one.
    pub robust: bool,
    /// Whether the deviations of the measurements are known and believed.
    pub believed: bool,
    /// v of the covariance v (JᵀJ)⁻¹ of the weighted sensitivities: 1 where sigma is believed, the
    /// residual variance, or for robust fitness functions that of M-estimators.
    pub variance: f64,
    /// Where some deviations are known and others estimated: what sensitivities of the points are
    /// multiplied with, so that standard errors have the degrees of freedom of the estimated ones.
    reduction: Option<Vec<f64>>,
    /// Half-widths of the 95 % intervals, as multiples of a standard error: a quantile of
    /// Student's distribution, or of the normal one where sigma is given.
    pub quantile: f64,
    /// Its degrees of freedom; infinite where it is that of the normal distribution.
    freedom_of_quantile: f64,
}

impl Spread {
    /// From the residuals of a fit and the sensitivities, of which some parameters are left open.
    fn of(
        problem: &Problem,
        evaluation: &Evaluation,
        data: &Data,
        (columns, open): (&[Vec<f64>], usize),
    ) -> Spread {
        let freedom = data.shares.iter().sum::<f64>() - (columns.len() - open) as f64;
        let robust = problem.objectives.first().and_then(|(_, fitness)| {
            fitness.robustness(&data.residuals, freedom).filter(|_| freedom > 0.0)
        });
        let plain =
            robust.is_none() && evaluation.scales().is_some_and(|own| own == evaluation.weights());
        let believed =
            plain && matches!(ErrorModel::of(problem), ErrorModel::Known | ErrorModel::Computed);
        let is_known = |series: &Series| series.sigma.is_known();
        let is_mixed = plain
            && ErrorModel::of(problem) == ErrorModel::Estimated
            && problem.series.iter().any(is_known);
        let effective = match is_mixed {
            true => freedom::effective_of_some(problem, columns, &data.shares),
            false => freedom::effective(problem, columns, freedom),
        };
        let variance = match robust {
            Some(robust) => robust.variance,
            None if is_mixed => effective.inflation,
            None if believed => 1.0,
            None => effective.inflation * data.square / freedom,
        };
        let freedom_of_quantile = match believed {
            true => f64::INFINITY,
            false => robust.map_or(effective.freedom, |robust| robust.freedom),
        };
        Spread {
            freedom,
            robust: robust.is_some(),
            believed,
            variance,
            reduction: effective.reduction,
            quantile: quantile(freedom_of_quantile),
            freedom_of_quantile,
        }
    }

    /// By how much the weighted sum of squares may rise within the 95 % limit of one parameter.
    fn rise(&self) -> f64 {
        self.quantile * self.quantile * self.variance
    }
}

impl Statistics {
    /// The standard error of Σ wₖ pₖ, also where the data determine no pₖ alone; `None` where there
    /// are no standard errors.
    pub(super) fn error_of(&self, weights: &[f64]) -> Option<f64> {
        let columns = self.reduced(&self.jacobian, &self.scales);
        self.uncertainty.as_ref()?;
        error_of_combination(&columns, weights, self.spread.variance, self.rank_tolerance)
    }
}

impl Statistics {
    /// Weighted sensitivities by the parameters and by scales and offsets of relative data, and below
    /// which part of the largest singular values are none.
    pub(super) fn explicit_columns(&self) -> Option<(Vec<Vec<f64>>, f64)> {
        let own = self.explicit.as_ref()?;
        Some((self.reduced(&own.columns, &self.scales), self.rank_tolerance))
    }

    /// What makes derivatives those of the residuals, all series as if there were no equal ones.
    fn by_weights(&self) -> Scales {
        Scales { own: self.weights.clone(), whitening: self.scales.whitening.clone() }
    }

    /// The sensitivities of the residuals by the parameters, column by column, from derivatives of the
    /// points, as standard errors follow from them.
    pub(super) fn weighted(&self, jacobian: &[Vec<f64>]) -> Vec<Vec<f64>> {
        self.reduced(jacobian, &self.by_weights())
    }

    fn reduced(&self, jacobian: &[Vec<f64>], scales: &Scales) -> Vec<Vec<f64>> {
        let mut columns = weighted(jacobian, scales);
        reduce(&mut columns, self.spread.reduction.as_deref());
        columns
    }

    /// Whether some deviations are known and others estimated: neither is scaled by all residuals.
    pub(super) fn is_mixed(&self) -> bool {
        self.spread.reduction.is_some()
    }

    /// The variance of a measurement in units of its weight.
    pub(super) fn variance_of_points(&self) -> f64 {
        if self.is_mixed() { 1.0 } else { self.spread.variance }
    }

    /// The degrees of freedom of the quantile where all outputs have one variance; further points add to
    /// them.
    pub(super) fn freedom_of_points(&self) -> f64 {
        if self.is_mixed() || self.spread.believed {
            self.spread.freedom_of_quantile
        } else {
            self.spread.freedom
        }
    }

    /// Derivatives of half the weighted sum of squares by the parameters, with the other sign.
    pub(super) fn gradient(&self) -> Vec<f64> {
        let columns = weighted(&self.jacobian, &self.by_weights()).into_iter();
        let product =
            |column: Vec<f64>| column.iter().zip(&self.residuals).map(|(value, r)| value * r).sum();
        columns.map(product).collect()
    }

    /// Residuals and weights of the points with the degrees of freedom of estimated deviations where
    /// others are known.
    pub(super) fn reduced_points(&self) -> [Vec<f64>; 2] {
        let mut points = [self.residuals.clone(), self.weights.clone()];
        reduce(&mut points, self.spread.reduction.as_deref());
        points
    }

    /// Whether a parameter that has no effect acts on the outputs, so that it is scales and offsets of
    /// relative data that make up for it.
    pub(super) fn is_made_up_for(&self, k: usize) -> bool {
        let column = self.explicit.as_ref().and_then(|own| own.columns.get(k));
        column.is_some_and(|own| own.iter().any(|d| *d != 0.0))
    }

    /// Standard errors and correlations as they are reported: where parameters stand at ends of their
    /// ranges, those of the others with these held.
    pub(super) fn tabulated(&self) -> Option<&Uncertainty> {
        self.at_bounds.as_ref().map_or(self.uncertainty.as_ref(), |own| Some(&own.held))
    }

    /// How far the linear 95 % interval reaches below and above; `None` where it is not bounded.
    pub(super) fn reach(&self, k: usize) -> Option<[f64; 2]> {
        if let Some(at_bounds) = &self.at_bounds {
            return Some(at_bounds.reach[k])
                .filter(|reach| reach.iter().all(|own| own.is_finite()));
        }
        let deviation = self.uncertainty.as_ref()?.standard_deviations[k];
        Some([self.spread.quantile * deviation; 2]).filter(|_| deviation.is_finite())
    }

    /// The standard error of parameter `k` with parameter `held` fixed.
    pub(super) fn deviation_with(&self, k: usize, held: usize) -> Option<f64> {
        let kept = (0..self.jacobian.len()).filter(|j| *j != held);
        let columns: Vec<Vec<f64>> = kept.map(|j| self.jacobian[j].clone()).collect();
        let found = uncertainty_given(&self.weighted(&columns), self.spread.variance)?;
        let place = if k > held { k - 1 } else { k };
        Some(found.standard_deviations[place]).filter(|own| own.is_finite())
    }

    /// How far the linear fit would go beyond the end at which a parameter stands, if none were held
    /// at an end, in standard errors of the fit there; `None` where it stands at none, and beside groups that act only together:
    /// with three parameters at ends beside such a group (stack NedStack PS6), the linear model put the
    /// optimum 7e6 standard errors away.
    pub(super) fn pull(&self, k: usize) -> Option<f64> {
        if !self.rank.non_identifiable.is_empty() {
            return None;
        }
        let at_bounds = self.at_bounds.as_ref()?;
        let pull = at_bounds.ends.iter().find(|end| end.parameter == k)?.pull;
        if self.spread.believed || self.spread.robust || self.is_mixed() {
            return Some(pull);
        }
        // Residuals at the ends of ranges contain the misfit that the ends cause: an error estimated
        // from them makes any distance one of less than the root of the degrees of freedom.
        let left = self.square - at_bounds.fall;
        Some(pull * (self.square / left.max(ROUNDING * self.square)).sqrt())
    }
}

/// The side on which the range lies, for parameters that stand at an end of it: those that cannot be
/// distinguished from that end by their standard errors.
fn inward(problem: &Problem, values: &[f64], found: Option<&Uncertainty>) -> Vec<Option<f64>> {
    let side = |k: usize| {
        let (free, value) = (&problem.parameters[k], values[k]);
        let deviation = found.map(|own| own.standard_deviations[k]).filter(|own| own.is_finite());
        let place = free.fraction(value);
        let is_at = |fraction: f64, distance: f64| match deviation {
            Some(own) => distance == 0.0 || fraction <= NEAR_END && distance <= AT_END * own,
            None => fraction <= ON_END,
        };
        match (is_at(place, value - free.min), is_at(1.0 - place, free.max - value)) {
            (true, _) => Some(1.0),
            (_, true) => Some(-1.0),
            _ => None,
        }
    };
    (0..values.len()).map(side).collect()
}

/// By how much the weighted sum of squares, or twice the negative log-likelihood, rises from the best
/// simulation to another one.
fn rise_of_squares(
    problem: &Problem,
    evaluation: &Evaluation,
    data: &Data,
    (best, row): (&[f64], &[f64]),
) -> f64 {
    let is_other = !problem.is_normal() || is_joint(&problem.series);
    if ErrorModel::of(problem) == ErrorModel::Computed || is_other {
        return 2.0 * (evaluation.objective(problem, row) - evaluation.objective(problem, best));
    }
    let measured = problem.series.iter().flat_map(|series| &series.y);
    let points = measured.zip(row).zip(&data.scales.own);
    points.map(|((m, s), w)| elementary::powi(w * (m - s), 2)).sum::<f64>() - data.square
}

/// Series of the same numbers as an earlier one.
fn repeated(series: &[Series]) -> Vec<(usize, usize)> {
    let is_deviation = |own: &Series| matches!(own.role, Role::Deviation(_));
    let same = |a: &Series, b: &Series| {
        a.y.len() >= 3 && a.x == b.x && a.y == b.y && !is_deviation(a) && !is_deviation(b)
    };
    let pair = |k: usize| (0..k).find(|&l| same(&series[k], &series[l])).map(|l| (k, l));
    (0..series.len()).filter_map(pair).collect()
}

/// What each point counts: 1, or 1/m where m series hold the same numbers.
fn shares(series: &[Series], repeated: &[(usize, usize)]) -> Vec<f64> {
    let first = |k: usize| repeated.iter().find(|pair| pair.0 == k).map_or(k, |pair| pair.1);
    let count = |k: usize| (0..series.len()).filter(|l| first(*l) == first(k)).count() as f64;
    let share = |(k, own): (usize, &Series)| match own.role {
        Role::Deviation(_) => 0.0,
        _ => 1.0 / count(k),
    };
    let all = series.iter().enumerate();
    all.flat_map(|own| std::iter::repeat_n(share(own), own.1.y.len())).collect()
}

fn weighted(jacobian: &[Vec<f64>], scales: &Scales) -> Vec<Vec<f64>> {
    let column = |column: &Vec<f64>| {
        let mut column: Vec<f64> = column.iter().zip(&scales.own).map(|(j, s)| j * s).collect();
        if let Some(whitening) = &scales.whitening {
            whitening.apply(&mut column);
        }
        column
    };
    jacobian.iter().map(column).collect()
}

/// The largest effect of a parameter that changes by its own value: the length of its column.
fn largest_effect(columns: &[Vec<f64>], values: &[f64]) -> f64 {
    let effect = |(column, value): (&Vec<f64>, &f64)| {
        column.iter().map(|d| d * d).sum::<f64>().sqrt() * value.abs()
    };
    columns.iter().zip(values).map(effect).fold(0.0, f64::max)
}

fn size(simulated: &[f64], scales: &[f64]) -> f64 {
    simulated.iter().zip(scales).map(|(y, s)| elementary::powi(y * s, 2)).sum::<f64>().sqrt()
}

/// A singular value this far below the largest is none, where simulations have such errors.
fn rank_tolerance(noise: f64) -> f64 {
    elementary::powf(noise, 2.0 / 3.0).clamp(RANK[0], RANK[1])
}

/// The sensitivities at the best point, as exact as their rank needs them.
struct Fine {
    best: Sensitivities,
    jacobian: Vec<Vec<f64>>,
    fineness: f64,
    simulations: u64,
}

impl Fine {
    /// Errors of the simulation fill up a rank that is lacking, and make one lack that is small: where
    /// it lacks at the tolerance of the search, a finer one decides.
    fn at(
        problem: &Problem,
        evaluation: &Evaluation,
        (values, simulated): (&[f64], &[f64]),
        scales: &Scales,
    ) -> Fine {
        let at = |fineness: f64| {
            let (jacobian, simulations) = sensitivities(problem, evaluation, values, fineness);
            let columns = weighted(&jacobian, scales);
            let best = Sensitivities { values: values.to_vec(), columns };
            Fine { best, jacobian, fineness, simulations }
        };
        let mut coarse = at(1.0);
        let fineness = EXACT / problem.noise;
        let rank = |fine: &Fine| {
            non_identifiable::rank(&fine.best, &[], rank_tolerance(problem.noise * fine.fineness))
        };
        let is_made_up = |column: &Vec<f64>| column.iter().all(|own| *own == 0.0);
        let lacks = evaluation.relative().is_some() && coarse.jacobian.iter().any(is_made_up);
        if fineness >= 1.0 || rank(&coarse).non_identifiable.is_empty() && !lacks {
            return coarse;
        }
        let row = evaluation.simulate_scaled(&[values.to_vec()], fineness).pop();
        coarse.simulations += 1;
        // What has no tolerance is not finer than before.
        if row.is_none_or(|row| row.is_ok_and(|row| row == simulated)) {
            return coarse;
        }
        let fine = at(fineness);
        let simulations = coarse.simulations + fine.simulations;
        match fine.jacobian.iter().flatten().all(|value| value.is_finite()) {
            true => Fine { simulations, ..fine },
            false => Fine { simulations, ..coarse },
        }
    }
}

/// Derivatives of the simulated points, column by column, with the solver's tolerance times
/// `fineness`, and the simulations that they took. Columns that do not exceed the errors of the
/// simulation are zero.
pub fn sensitivities(
    problem: &Problem,
    evaluation: &Evaluation,
    values: &[f64],
    fineness: f64,
) -> (Vec<Vec<f64>>, u64) {
    let n = values.len();
    let found = evaluation.linearize_scaled(problem, &[values.to_vec()], fineness).pop();
    let Some(Ok(found)) = found else {
        return (vec![vec![f64::NAN; problem.n_points()]; n], 1);
    };
    let size = found.simulated.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    let made_up = rank_tolerance(problem.noise * fineness);
    let column = |k: usize| -> Vec<f64> {
        let free = &problem.parameters[k];
        let column: Vec<f64> = found.derivatives.iter().skip(k).step_by(n).copied().collect();
        let most = column.iter().fold(0.0, |most: f64, d| most.max(d.abs()));
        // What scales of relative data make up for.
        let is_made_up = found.shares.get(k).is_some_and(|share| *share <= made_up);
        match is_made_up || most * (free.max - free.min) <= NO_EFFECT * size {
            true => vec![0.0; column.len()],
            false => column,
        }
    };
    ((0..n).map(column).collect(), found.simulations)
}
