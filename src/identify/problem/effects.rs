//! Parameters whose derivative is zero at the best point: without any effect, or acting in steps, or
//! with a derivative that vanishes just there.
//!
//! An output that changes in steps (a switching time between two samples, a rounded number) has a
//! derivative of zero nearly everywhere. Only finite changes over the whole range tell: the
//! parameter is fixed at values there and the others are refitted, as for a profile.

use super::failure::Failed;
use super::profile::limit;
use super::refit::Refit;
use super::statistics::sensitivities;
use super::{Evaluation, Problem, Statistics};
use crate::diag::Fault;
use crate::uncertainty_given;

/// Fractions of the range that are tried on each side: from this on, each larger by the factor.
const FIRST: f64 = 1e-3;
const GROWTH: f64 = 1.5;
/// Halvings that locate where the limit is crossed.
const HALVINGS: usize = 20;
/// A change of a point below this many times the error of the simulation is that error.
const ERRORS: f64 = 10.0;

/// Fits nearer to each other than this, as parts of the way to the limit and of the ranges, belong to
/// the same step.
const SAME_STEP: f64 = 1e-3;
/// A derivative that accounts for less than this part of a change is that of a step, or an error.
const SMOOTH: f64 = 1e-3;
/// Steps whose standard errors are looked at.
const STEPS: usize = 40;

/// What a parameter without derivative does.
#[derive(Debug, Clone, PartialEq)]
pub enum Effect {
    /// Nothing, in its whole range.
    None,
    /// It acts at finite distances.
    Finite(Finite),
}

/// The effect of finite changes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Finite {
    /// The ends of the values whose sum of squares is within the 95 % limit, the others refitted;
    /// `None` where the range ends before.
    pub ends: [Option<f64>; 2],
    /// Why there is no derivative to go by.
    pub how: How,
    /// Fits within the limit.
    pub within: Vec<Within>,
}

/// Why a parameter has no derivative to go by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum How {
    /// Small changes change nothing.
    InSteps,
    /// The derivative is zero at the best values.
    Vanishing,
    /// It cancels with those of others.
    Cancelling,
}

/// A fit within the limit, with the parameter held.
#[derive(Debug, Clone, PartialEq)]
pub struct Within {
    /// Values of all parameters.
    pub values: Vec<f64>,
    /// What is left of the way to the limit: the root of the part of the rise that remains, 1 at the
    /// best point.
    pub left: f64,
    /// Standard errors of the others there; infinite where there are none.
    pub deviations: Vec<f64>,
}

/// What parameter `k` does at finite distances from the best `values`, and the simulations that
/// it took.
///
/// # Errors
///
/// Those of the method's maker.
pub fn effect(
    problem: &Problem,
    evaluation: &Evaluation,
    statistics: &Statistics,
    (values, simulated): (&[f64], &[f64]),
    k: usize,
) -> Result<(Effect, u64), Fault> {
    if statistics.is_made_up_for(k) {
        // Where scales are positive it may act at finite distances, but the others that they make up for
        // are not refitted then: their derivatives are zero as well.
        return Ok((Effect::None, 0));
    }
    let free = &problem.parameters[k];
    let here = free.fraction(values[k]);
    let places = [-1.0, 1.0].map(|side| outward(here, side));
    let at = |place: &f64| {
        let mut point = values.to_vec();
        point[k] = free.value(*place);
        point
    };
    let both: Vec<Vec<f64>> = places.iter().flatten().map(at).collect();
    let rows = evaluation.simulate_all(&both);
    let acts = |row: &Result<Vec<f64>, _>| {
        row.as_ref().map_or(true, |row| differs(problem, simulated, row))
    };
    let mut simulations = rows.len() as u64;
    if !rows.iter().any(acts) {
        return Ok((Effect::None, simulations));
    }
    let all = Places { points: &both, rows: &rows, sides: [0, places[0].len()] };
    let (how, took) = how((problem, evaluation), statistics, (values, simulated), &all, k);
    simulations += took;
    let mut found = Finite { ends: [None; 2], how, within: Vec::new() };
    let Some(mut scan) = Scan::new((problem, evaluation), values, k, statistics)? else {
        return Ok((Effect::Finite(found), simulations));
    };
    for (end, places) in found.ends.iter_mut().zip(&places) {
        *end = scan.side(here, values, places)?;
    }
    simulations += scan.refit.simulations;
    let mut within: Vec<Within> = Vec::new();
    for fit in std::mem::take(&mut scan.within) {
        let is_known = within.iter().any(|known| known.is_same_step(&fit, problem, k));
        if !is_known && within.len() < STEPS {
            within.push(fit);
        }
    }
    for fit in &mut within {
        let (jacobian, took) = sensitivities(problem, evaluation, &fit.values, 1.0);
        simulations += took;
        fit.deviations = deviations(&jacobian, statistics, k);
    }
    found.within = within;
    Ok((Effect::Finite(found), simulations))
}

/// Points at which one parameter was changed, with their simulations.
struct Places<'a> {
    points: &'a [Vec<f64>],
    rows: &'a [Result<Vec<f64>, Failed>],
    /// Where those of each side begin, the nearest first.
    sides: [usize; 2],
}

/// Why parameter `k` has no derivative to go by, and the simulations that it took.
fn how(
    (problem, evaluation): (&Problem, &Evaluation),
    statistics: &Statistics,
    (values, simulated): (&[f64], &[f64]),
    places: &Places<'_>,
    k: usize,
) -> (How, u64) {
    if statistics.cancelling.contains(&k) {
        return (How::Cancelling, 0);
    }
    let acts = |row: &Result<Vec<f64>, Failed>| {
        row.as_ref().map_or(true, |row| differs(problem, simulated, row))
    };
    if places.sides.iter().filter_map(|first| places.rows.get(*first)).any(acts) {
        return (How::Vanishing, 0);
    }
    let mut beside = places.points.iter().zip(places.rows);
    let Some((point, Ok(row))) = beside.find(|(_, row)| acts(row)) else {
        return (How::InSteps, 0);
    };
    let mut simulations = 0;
    let at = (values, simulated);
    match is_smooth((problem, evaluation), at, (point, row), k, &mut simulations) {
        true => (How::Vanishing, simulations),
        false => (How::InSteps, simulations),
    }
}

/// Whether parameter `k` has a derivative where it acts: steps have none, a transient that is over at
/// the best values does.
fn is_smooth(
    (problem, evaluation): (&Problem, &Evaluation),
    (values, simulated): (&[f64], &[f64]),
    (point, row): (&[f64], &[f64]),
    k: usize,
    simulations: &mut u64,
) -> bool {
    let (jacobian, took) = sensitivities(problem, evaluation, point, 1.0);
    *simulations += took;
    let most = |all: &mut dyn Iterator<Item = f64>| all.fold(0.0, |most: f64, own| most.max(own));
    let derivative = most(&mut jacobian[k].iter().map(|derivative| derivative.abs()));
    let change = most(&mut simulated.iter().zip(row).map(|(a, b)| (a - b).abs()));
    derivative * (point[k] - values[k]).abs() > SMOOTH * change
}

impl Within {
    /// Whether another fit has the same sum and the same values, but for parameter `k`.
    fn is_same_step(&self, other: &Within, problem: &Problem, k: usize) -> bool {
        let pairs = self.values.iter().zip(&other.values).zip(&problem.parameters).enumerate();
        let apart = |((a, b), free): ((&f64, &f64), &super::Free)| {
            (free.fraction(*a) - free.fraction(*b)).abs()
        };
        (self.left - other.left).abs() < SAME_STEP
            && pairs.filter(|(j, _)| *j != k).all(|(_, pair)| apart(pair) < SAME_STEP)
    }
}

/// Standard errors with parameter `k` held.
fn deviations(jacobian: &[Vec<f64>], statistics: &Statistics, k: usize) -> Vec<f64> {
    let mut columns = statistics.weighted(jacobian);
    columns.remove(k);
    let found = uncertainty_given(&columns, statistics.spread.variance);
    let mut all =
        found.map_or_else(|| vec![f64::INFINITY; columns.len()], |found| found.standard_deviations);
    all.insert(k, f64::INFINITY);
    all
}

/// Fractions of the range from `here` to its end.
fn outward(here: f64, side: f64) -> Vec<f64> {
    let end = if side < 0.0 { 0.0 } else { 1.0 };
    let mut places = Vec::new();
    let mut step = FIRST;
    while (end - here) * side > step {
        places.push(here + side * step);
        step *= GROWTH;
    }
    if here != end {
        places.push(end);
    }
    places
}

fn differs(problem: &Problem, a: &[f64], b: &[f64]) -> bool {
    let size = a.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    let change = a.iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
    change > ERRORS * problem.noise * size
}

/// Fits with one parameter held at places over its range.
struct Scan<'a> {
    refit: Refit<'a>,
    problem: &'a Problem,
    k: usize,
    smallest: f64,
    limit: f64,
    within: Vec<Within>,
}

impl<'a> Scan<'a> {
    /// `None` where the fitness is no sum of squares or there are not more points than parameters.
    fn new(
        (problem, evaluation): (&'a Problem, &'a Evaluation),
        values: &[f64],
        k: usize,
        statistics: &Statistics,
    ) -> Result<Option<Scan<'a>>, Fault> {
        let scale = [statistics.spread.freedom, statistics.quantile_of_squares()];
        let Some(mut refit) = Refit::new(problem, evaluation).filter(|_| scale[0] >= 1.0) else {
            return Ok(None);
        };
        let Some((best, smallest)) = refit.from(values, Some(k))? else { return Ok(None) };
        let residuals = refit.plain_residuals(&best);
        let limit = limit(problem, smallest, scale, residuals.as_deref());
        let within = vec![Within { values: best, left: 1.0, deviations: Vec::new() }];
        Ok(Some(Scan { refit, problem, k, smallest, limit, within }))
    }

    /// The end of the values within the limit on one side: beyond the farthest of the places whose
    /// sum is; `None` where that is the last.
    fn side(&mut self, here: f64, values: &[f64], places: &[f64]) -> Result<Option<f64>, Fault> {
        let (mut inside, mut outside) = (here, None);
        let (mut start, mut at_inside) = (values.to_vec(), values.to_vec());
        for &place in places {
            match self.fit(&start, place)? {
                Some(found) => {
                    (inside, outside) = (place, None);
                    (start, at_inside) = (found.clone(), found);
                }
                None => outside = outside.or(Some(place)),
            }
        }
        let Some(mut outside) = outside else { return Ok(None) };
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            match self.fit(&at_inside, middle)? {
                Some(found) => (inside, at_inside) = (middle, found),
                None => outside = middle,
            }
        }
        Ok(Some(self.problem.parameters[self.k].value(inside)))
    }

    /// The others fitted with the parameter at `place`; `None` where the sum is beyond the limit or
    /// nothing can be simulated.
    fn fit(&mut self, start: &[f64], place: f64) -> Result<Option<Vec<f64>>, Fault> {
        let mut from = start.to_vec();
        from[self.k] = self.problem.parameters[self.k].value(place);
        let Some((values, sum)) = self.refit.from(&from, Some(self.k))? else { return Ok(None) };
        if sum > self.limit {
            return Ok(None);
        }
        let left = (self.limit - sum) / (self.limit - self.smallest);
        let left = left.clamp(0.0, 1.0).sqrt();
        self.within.push(Within { values: values.clone(), left, deviations: Vec::new() });
        Ok(Some(values))
    }
}
