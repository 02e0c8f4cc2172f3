//! Minima at the limit of a constraint, such as `a + b <= 1` where the unconstrained minimum lies
//! beyond: the gradient does not vanish there, but it points out of what is allowed, and along the
//! limit nothing is better.
//!
//! Steps of Gauss and Newton are taken in the null space of the constraints' gradients and then put
//! back onto the limits; the test of Bates and Watts is made in the same space, and the multipliers
//! tell whether the constraints hold the point at all (an active-set method for inequalities).
//!
//! Reference: [Nocedal & Wright 2006](gapilib_base::bibliography#nocedal-wright-2006), §12.3 and §15.3.

use super::inference::Constraint;
use super::minimum_test::is_at_minimum;
use super::run::Cause;
use super::{Best, Linearization, Problem, Run};
use crate::ga::optimizer::{Offset, test_minimum};
use crate::singular_values::SingularValues;
use nalgebra::{DMatrix, DVector};

/// Points stand this far inside a limit, as a fraction of its sides, and those nearer than `ON` are on
/// it; those nearer than `NEAR` are moved onto it.
const INSIDE: f64 = 1e-9;
const ON: f64 = 1e-7;
const NEAR: f64 = 1e-2;
/// Steps along the limits at most.
const STEPS: usize = 40;
/// Parts of a step that are tried.
const PARTS: [f64; 6] = [1.0, 0.5, 0.2, 0.05, 0.01, 0.001];
/// Corrections that put a point back onto a limit.
const CORRECTIONS: usize = 8;
/// Step of the differences of a constraint, as a fraction of the ranges.
const DIFFERENCE: f64 = 1e-6;
/// Singular values below this part of the largest belong to null directions.
const NULL: f64 = 1e-9;

/// The space along the limits that hold a point.
pub struct Along {
    /// Gradients of the margins by the fractions of the ranges, a row for each constraint.
    gradients: DMatrix<f64>,
    /// An orthonormal basis of the directions along the limits, in columns.
    pub basis: DMatrix<f64>,
}

/// The constraints at whose limits the values stand.
fn active<'a>(problem: &'a Problem, values: &[f64], within: f64) -> Vec<&'a Constraint> {
    let constraints = problem.inference.constraints.iter();
    constraints.filter(|own| own.margin(values).abs() <= within).collect()
}

/// The directions along the limits at which the values stand; `None` where they stand at none.
pub fn along(problem: &Problem, values: &[f64]) -> Option<Along> {
    let held = active(problem, values, ON);
    (!held.is_empty()).then(|| Along::of(problem, values, &held)).flatten()
}

/// The constraints at whose limits the values stand, as they are written.
pub(crate) fn active_constraints(problem: &Problem, values: &[f64]) -> Vec<String> {
    active(problem, values, ON).into_iter().map(|own| own.text.clone()).collect()
}

impl Along {
    fn of(problem: &Problem, values: &[f64], held: &[&Constraint]) -> Option<Along> {
        let n = values.len();
        let derivative = |own: &Constraint, k: usize| {
            let free = &problem.parameters[k];
            let at = free.fraction(values[k]);
            let [low, high] = [at - DIFFERENCE, at + DIFFERENCE].map(|end| end.clamp(0.0, 1.0));
            let margin = |place: f64| {
                let mut moved = values.to_vec();
                moved[k] = free.value(place);
                own.margin(&moved)
            };
            (margin(high) - margin(low)) / (high - low)
        };
        let gradients = DMatrix::from_fn(held.len(), n, |row, k| derivative(held[row], k));
        // Rows of zeros make the null space part of the decomposition.
        let rows = held.len().max(n);
        let padded =
            DMatrix::from_fn(
                rows,
                n,
                |row, k| {
                    if row < held.len() { gradients[(row, k)] } else { 0.0 }
                },
            );
        let found = SingularValues::of(&padded)?;
        let null: Vec<usize> = (0..n).filter(|&k| found.s[k] <= NULL * found.largest()).collect();
        let basis = DMatrix::from_fn(n, null.len(), |k, column| found.v_t[(null[column], k)]);
        Some(Along { gradients, basis })
    }

    /// Jacobian along the limits, residuals × directions, row by row.
    fn projected(&self, jacobian: &[f64]) -> Vec<f64> {
        let n = self.basis.nrows();
        let row = |row: &[f64]| {
            let row = DVector::from_column_slice(row);
            self.basis.column_iter().map(move |column| column.dot(&row)).collect::<Vec<f64>>()
        };
        jacobian.chunks_exact(n).flat_map(row).collect()
    }

    /// By how much the sum of squares rises when the point moves inwards from each limit; negative
    /// where a limit does not hold it.
    fn multipliers(&self, gradient: &DVector<f64>) -> Option<DVector<f64>> {
        let gram = &self.gradients * self.gradients.transpose();
        Some(gram.cholesky()?.solve(&(&self.gradients * gradient)))
    }
}

/// What is known of a point at limits.
pub(crate) struct AtLimits {
    /// The relative offset along the limits.
    pub offset: Option<Offset>,
    /// Whether it is a minimum there: stationary along them, and held by each.
    pub is_minimum: bool,
    is_stationary: bool,
    multipliers: DVector<f64>,
    /// The step of Gauss and Newton along the limits, in fractions of the ranges.
    step: DVector<f64>,
}

/// Tests a point that stands at limits.
pub fn test(run: &Run, values: &[f64], along: &Along, found: &Linearization) -> Option<AtLimits> {
    let residuals = run.evaluation.residuals(&run.problem, &found.simulated);
    let jacobian = run.evaluation.weighted(&run.problem, values, found);
    if jacobian.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    let n = values.len();
    let own = DMatrix::from_row_slice(residuals.len(), n, &jacobian);
    let r = DVector::from_column_slice(&residuals);
    let multipliers = along.multipliers(&own.tr_mul(&r))?;
    let holds = multipliers.iter().all(|own| *own >= 0.0);
    let directions = along.basis.ncols();
    if directions == 0 {
        let step = DVector::zeros(n);
        let (is_minimum, is_stationary) = (holds, true);
        return Some(AtLimits { offset: None, is_minimum, is_stationary, multipliers, step });
    }
    let projected = along.projected(&jacobian);
    let inside = vec![0.5; directions];
    let accuracy = [run.problem.noise, run.evaluation.size()];
    let (offset, is_stationary) = test_minimum(&inside, &residuals, &projected, accuracy);
    let reduced = DMatrix::from_row_slice(residuals.len(), directions, &projected);
    let newton = reduced.svd(true, true).solve(&-r, NULL).ok()?;
    let step = &along.basis * newton;
    let (offset, is_minimum) = (Some(offset), is_stationary && holds);
    Some(AtLimits { offset, is_minimum, is_stationary, multipliers, step })
}

/// Goes to the minimum at the limits beside which the search has ended, unless the user has ended it.
pub fn finish(run: &mut Run) {
    if run.problem.inference.constraints.is_empty() || run.cause() == Cause::User {
        return;
    }
    let Some((false, simulations)) = is_at_minimum(run) else { return };
    run.conclusion.simulations += simulations;
    let Some(first) = run.observed.best.clone() else { return };
    let constraints: Vec<String> =
        active(&run.problem, &first.values, NEAR).iter().map(|own| own.text.clone()).collect();
    let Some(reached) = descend(run, &first, constraints) else { return };
    // Beside the limit the point may have been lower by the errors of the simulation.
    if reached.fitness <= first.fitness * (1.0 + 1e-6) {
        run.observed.best = Some(reached);
    }
}

/// Steps along the limits of these constraints, which are left where they do not hold.
fn descend(run: &mut Run, first: &Best, mut constraints: Vec<String>) -> Option<Best> {
    let mut best: Option<Best> = None;
    for _ in 0..STEPS {
        if constraints.is_empty() {
            break;
        }
        let from = best.as_ref().map_or(&first.values, |best| &best.values).clone();
        let values = onto(run, &from, &constraints)?;
        let along = Along::of(&run.problem, &values, &named(&run.problem, &constraints))?;
        let linearized =
            run.evaluation.linearize(&run.problem, std::slice::from_ref(&values)).pop()?.ok()?;
        run.conclusion.simulations += linearized.simulations;
        let fitness = run.evaluation.objective(&run.problem, &linearized.simulated);
        if best.as_ref().is_none_or(|best| fitness <= best.fitness) {
            best = Some(Best { values: values.clone(), fitness });
        }
        let found = test(run, &values, &along, &linearized)?;
        if found.is_minimum {
            break;
        }
        // Multipliers say something only where nothing is better along the limits.
        match lower(run, (&values, fitness), &found.step, &constraints)
            .filter(|_| !found.is_stationary)
        {
            Some(lower) => best = Some(lower),
            None => match found.multipliers.iter().position(|own| *own < 0.0) {
                Some(loose) => {
                    constraints.remove(loose);
                }
                None => break,
            },
        }
    }
    best
}

/// The best of some parts of a step along the limits, if it is better.
fn lower(
    run: &mut Run,
    (values, fitness): (&[f64], f64),
    step: &DVector<f64>,
    constraints: &[String],
) -> Option<Best> {
    let parameters = &run.problem.parameters;
    let moved = |part: &f64| {
        let pairs = parameters.iter().zip(values).zip(step.iter());
        let place = pairs.map(|((free, value), by)| {
            free.value((free.fraction(*value) + part * by).clamp(0.0, 1.0))
        });
        onto(run, &place.collect::<Vec<f64>>(), constraints)
    };
    let places: Vec<Vec<f64>> = PARTS.iter().filter_map(moved).collect();
    let rows = run.evaluation.simulate_all(&places);
    run.conclusion.simulations += places.len() as u64;
    let rated = places.into_iter().zip(rows).filter_map(|(values, row)| {
        let fitness = run.evaluation.objective(&run.problem, &row.ok()?);
        Some(Best { values, fitness })
    });
    let lowest = rated.min_by(|a, b| a.fitness.total_cmp(&b.fitness))?;
    (lowest.fitness < fitness).then_some(lowest)
}

fn named<'a>(problem: &'a Problem, constraints: &[String]) -> Vec<&'a Constraint> {
    problem.inference.constraints.iter().filter(|own| constraints.contains(&own.text)).collect()
}

/// The values moved onto the limits of these constraints, just inside.
fn onto(run: &Run, values: &[f64], constraints: &[String]) -> Option<Vec<f64>> {
    let problem = &run.problem;
    let held = named(problem, constraints);
    let mut values = values.to_vec();
    for _ in 0..CORRECTIONS {
        let missing =
            DVector::from_iterator(held.len(), held.iter().map(|own| INSIDE - own.margin(&values)));
        if missing.amax() <= 0.5 * INSIDE {
            break;
        }
        let along = Along::of(problem, &values, &held)?;
        let gram = &along.gradients * along.gradients.transpose();
        let by = along.gradients.tr_mul(&gram.cholesky()?.solve(&missing));
        for ((value, free), by) in values.iter_mut().zip(&problem.parameters).zip(by.iter()) {
            *value = free.value((free.fraction(*value) + by).clamp(0.0, 1.0));
        }
    }
    let holds = problem.inference.constraints.iter().all(|own| own.violation(&values) == 0.0);
    holds.then_some(values)
}

#[cfg(test)]
mod tests;
