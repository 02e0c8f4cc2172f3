//! Minima that the gradient does not show, although nothing nearby is better: the objective has a kink
//! in a parameter, such as a switching time at a sampling instant, or a parameter can change to
//! the end of its range without any effect on it, such as the rate of a response that is over before
//! the second sample.
//!
//! With such parameters held, the others are at a minimum by the test of Bates and Watts. Whether they
//! are rightly held is tried out: they are moved to both sides, near and far, and the others fitted
//! again; nothing may be better by more than the test leaves open.
//!
//! Reference: [Bates & Watts 1981](gapilib_base::bibliography#bates-watts-1981).

use super::limits::along;
use super::minimum_test::is_at_minimum;
use super::refit::{Fitted, Refit};
use super::run::Cause;
use super::{Linearization, Problem, Run};
use crate::diag::Fault;
use crate::ga::optimizer::{MINIMUM, test_minimum};

/// Parameters that are held at most.
const MOST: usize = 3;
/// Moves to a better point, after each of which the test is repeated.
const MOVES: usize = 6;
/// Simulations that trying may take.
const BUDGET: u64 = 2000;
/// Places that are tried on each side, as parts of the way to the end of the range.
const PARTS: [f64; 9] = [1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.4, 1.0];

/// Places nearer than this are the same, and a step of the golden section.
const SAME: f64 = 1e-12;
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// Holds parameters where that shows a minimum, and goes to better points that are come upon.
///
/// # Errors
///
/// Those of least squares.
pub fn finish(run: &mut Run) -> Result<(), Fault> {
    let is_open = run.cause() == Cause::Converged && run.conclusion.by_curvature.is_none();
    for _ in 0..MOVES {
        let is_at_limit = run
            .observed
            .best
            .as_ref()
            .is_some_and(|best| along(&run.problem, &best.values).is_some());
        if !is_open || is_at_limit {
            break;
        }
        let Some((false, simulations)) = is_at_minimum(run) else { break };
        run.conclusion.simulations += simulations;
        let found = match candidates(run) {
            Some(held) => match tried(run, &held)? {
                Tried::Holds => {
                    run.conclusion.held = held;
                    break;
                }
                Tried::Better(values) => Some(values),
                Tried::Nothing => None,
            },
            None => with_one_held(run)?,
        };
        let Some(values) = found else { break };
        if !run.continue_from(&values)? {
            break;
        }
    }
    Ok(())
}

/// Whether a point is a minimum with the parameters held that [`finish`] has found.
pub fn is_minimum(run: &Run, values: &[f64], found: &Linearization) -> bool {
    let held = &run.conclusion.held;
    !held.is_empty() && holds(run, values, found, held).0
}

/// The fewest parameters with which held the others are at a minimum.
fn candidates(run: &mut Run) -> Option<Vec<usize>> {
    let values = run.observed.best.as_ref()?.values.clone();
    let found =
        run.evaluation.linearize(&run.problem, std::slice::from_ref(&values)).pop()?.ok()?;
    run.conclusion.simulations += found.simulations;
    let mut held: Vec<usize> = Vec::new();
    // One parameter at least is at its minimum by the gradient, unless there is no other.
    let most = MOST.min(values.len().saturating_sub(1)).max(1);
    while held.len() < most {
        let with = |k: usize| [&held[..], &[k]].concat();
        let open = (0..values.len()).filter(|k| !held.contains(k));
        let (_, best, passes) = open
            .map(|k| {
                let (passes, offset) = holds(run, &values, &found, &with(k));
                (if passes { -1.0 } else { offset }, k, passes)
            })
            .min_by(|a, b| a.0.total_cmp(&b.0))?;
        held.push(best);
        if passes {
            held.sort_unstable();
            return Some(held);
        }
    }
    None
}

/// The test with parameters held, and the relative offset that it leaves.
fn holds(run: &Run, values: &[f64], found: &Linearization, held: &[usize]) -> (bool, f64) {
    let (problem, evaluation) = (&run.problem, &run.evaluation);
    if held.len() == values.len() {
        return (true, 0.0);
    }
    let point: Vec<f64> =
        problem.parameters.iter().zip(values).map(|(f, v)| f.fraction(*v)).collect();
    let residuals = evaluation.residuals(problem, &found.simulated);
    let mut jacobian = evaluation.weighted(problem, values, found);
    for row in jacobian.chunks_exact_mut(values.len()) {
        held.iter().for_each(|&k| row[k] = 0.0);
    }
    let accuracy = [problem.noise, evaluation.size()];
    let (offset, passes) = test_minimum(&point, &residuals, &jacobian, accuracy);
    (passes, offset.relative.unwrap_or(offset.step))
}

/// A better point, where a descent that met a kink has ended before the other parameters had come to
/// their minimum: with one parameter held, least squares go on.
fn with_one_held(run: &mut Run) -> Result<Option<Vec<f64>>, Fault> {
    let Some(best) = run.observed.best.clone() else { return Ok(None) };
    let Some(mut refit) = Refit::new(&run.problem, &run.evaluation) else { return Ok(None) };
    let mut lowest: Option<Fitted> = None;
    for k in 0..best.values.len() {
        let found = refit.from(&best.values, Some(k))?;
        if refit.simulations > BUDGET || refit.is_cancelled() {
            return Ok(None);
        }
        let is_lower = |sum: f64| lowest.as_ref().is_none_or(|known| sum < known.1);
        lowest = found.filter(|found| is_lower(found.1)).or(lowest);
    }
    let simulations = refit.simulations;
    run.conclusion.simulations += simulations;
    Ok(lowest.map(|(values, _)| values))
}

/// What came of moving the held parameters.
enum Tried {
    /// Nothing could be simulated.
    Nothing,
    /// Nothing is better.
    Holds,
    /// This is.
    Better(Vec<f64>),
}

fn tried(run: &mut Run, held: &[usize]) -> Result<Tried, Fault> {
    let Some(best) = run.observed.best.clone() else { return Ok(Tried::Nothing) };
    let Some(mut refit) = Refit::new(&run.problem, &run.evaluation) else {
        return Ok(Tried::Nothing);
    };
    let Some(residuals) = refit.searched_residuals(&best.values) else { return Ok(Tried::Nothing) };
    let square: f64 = residuals.iter().map(|r| r * r).sum();
    // What the test of a minimum leaves open.
    let freedom = residuals.len().saturating_sub(best.values.len()).max(1) as f64;
    let open = MINIMUM * MINIMUM * best.values.len() as f64 * square / freedom;
    let mut lowest: Option<(usize, Fitted)> = None;
    for (k, place) in held.iter().flat_map(|&k| places(&run.problem, &best.values, k)) {
        let Some(found) = at_place(&mut refit, (k, place), &best.values)? else { continue };
        if refit.simulations > BUDGET || refit.is_cancelled() {
            return Ok(Tried::Nothing);
        }
        if lowest.as_ref().is_none_or(|(_, known)| found.1 < known.1) {
            lowest = Some((k, found));
        }
    }
    let tried = match lowest {
        None => Tried::Nothing,
        Some((k, found)) if found.1 < square - open => {
            Tried::Better(located(&mut refit, &best.values, (k, found))?)
        }
        Some(_) => Tried::Holds,
    };
    run.conclusion.simulations += refit.simulations;
    Ok(tried)
}

/// The others fitted again with parameter `k` at a place of its range.
fn at_place(
    refit: &mut Refit<'_>,
    (k, place): (usize, f64),
    values: &[f64],
) -> Result<Option<Fitted>, Fault> {
    let mut from = values.to_vec();
    from[k] = refit.parameter(k).value(place);
    refit.from(&from, Some(k))
}

/// The least along a parameter between the neighbours of the best place tried: by the golden section,
/// for the objective may have a kink there, to which descents come slowly.
fn located(
    refit: &mut Refit<'_>,
    before: &[f64],
    (k, found): (usize, Fitted),
) -> Result<Vec<f64>, Fault> {
    let fraction = |values: &[f64]| refit.parameter(k).fraction(values[k]);
    let (here, mut middle) = (fraction(before), fraction(&found.0));
    let mut all: Vec<f64> = to_ends(here).collect();
    let (mut low, mut high) = (middle, middle);
    all.push(here);
    all.sort_by(f64::total_cmp);
    if let Some(at) = all.iter().position(|place| (place - middle).abs() <= SAME) {
        low = all[at.saturating_sub(1)];
        high = all[(at + 1).min(all.len() - 1)];
    }
    let mut best = found;
    let last = refit.simulations + BUDGET;
    while high - low > SAME && refit.simulations < last && !refit.is_cancelled() {
        let is_above = high - middle > middle - low;
        let end = if is_above { high } else { low };
        let place = middle + GOLDEN * (end - middle);
        let fitted = at_place(refit, (k, place), &best.0)?;
        let (beyond, inner) = match fitted {
            Some(fitted) if fitted.1 < best.1 => {
                best = fitted;
                (std::mem::replace(&mut middle, place), true)
            }
            _ => (place, false),
        };
        match is_above == inner {
            true => low = beyond,
            false => high = beyond,
        }
    }
    Ok(best.0)
}

/// Places to both sides of a parameter, as fractions of its range.
fn places(problem: &Problem, values: &[f64], k: usize) -> Vec<(usize, f64)> {
    let here = problem.parameters[k].fraction(values[k]);
    to_ends(here).filter(|place| *place != here).map(|place| (k, place)).collect()
}

fn to_ends(here: f64) -> impl Iterator<Item = f64> {
    let to = move |end: f64| PARTS.iter().map(move |part| here + part * (end - here));
    to(0.0).chain(to(1.0))
}
