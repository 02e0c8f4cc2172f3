//! Nonlinear loops that leave unknowns open: not at one point, as at a turning point or a multiple
//! zero, but everywhere around a solution, as the voltage of a network that is grounded nowhere.
//!
//! There the equations depend on each other, and the Jacobian has the same rank, less than the number
//! of unknowns, at the solution and beside it. Which of the solutions is taken changes nothing that
//! the equations determine.
//!
//! Others leave unknowns open at some solutions only: the energy balance of a pump without flow, 0 = 0,
//! lets its enthalpy be anything. Beside such a solution, along the kernel of the Jacobian, there are
//! others; beside a turning point there are none. The solution nearest to the values before is taken, so
//! that an enthalpy stays what it was.

use crate::sim::Equations;

/// How far beside the solution the Jacobian is looked at, relative to the magnitudes of the unknowns:
/// at x |x| = 0 its only entry is 1e-3 there.
const DISTANCE: f64 = 1e-3;
/// Pivots below this part of the first are zero.
const RANK: f64 = 1e-12;
/// Steps of [`polish`]; each leaves the square of the error.
const CORRECTIONS: usize = 3;
/// Iterations for singular values.
const MOST_SWEEPS: usize = 1000;
/// More unknowns are not looked at: complete pivoting costs the cube of their number.
const MOST_UNKNOWNS: usize = 300;

/// Whether the Jacobian is singular with the same rank at a solution and beside it, on both sides.
pub(super) fn is_open(equations: &mut dyn Equations, x: &[f64], nominal: &[f64]) -> bool {
    if x.len() > MOST_UNKNOWNS {
        return false;
    }
    let scale: Vec<f64> = x.iter().zip(nominal).map(|(x, nominal)| x.abs().max(*nominal)).collect();
    let mut beside = |sign: f64| {
        // Different parts of their magnitudes: along (1, 1, …) a difference of unknowns does not move.
        let part = |i: usize| 0.5 + 0.5 * (i as f64 * 0.618_033_988_75).fract();
        let moved: Vec<f64> =
            (0..x.len()).map(|i| x[i] + sign * DISTANCE * part(i) * scale[i]).collect();
        rank(equations, &moved, &scale)
    };
    let ranks = [beside(0.0), beside(1.0), beside(-1.0)];
    ranks[0].is_some_and(|rank| rank < x.len()) && ranks.iter().all(|rank| *rank == ranks[0])
}

/// Residuals of solutions beside a solution, in units of what the rows of the Jacobian make of the
/// magnitudes of the unknowns; beside a turning point they are as large as [`DISTANCE`] squared, 1e-6,
/// and a 64th of this after [`CORRECTIONS`].
const ALONG: f64 = 1e-10;

/// Whether a solution is one of many along each direction in which the Jacobian is singular.
pub(super) fn is_on_a_line(equations: &mut dyn Equations, x: &[f64], nominal: &[f64]) -> bool {
    let n = x.len();
    if n > MOST_UNKNOWNS {
        return false;
    }
    let scale: Vec<f64> = x.iter().zip(nominal).map(|(x, nominal)| x.abs().max(*nominal)).collect();
    let Some((matrix, rows)) = scaled_jacobian(equations, x, &scale) else { return false };
    let Some(factors) = matrix.try_svd(false, true, f64::EPSILON, MOST_SWEEPS) else {
        return false;
    };
    let Some(directions) = factors.v_t else { return false };
    let smallest = RANK * factors.singular_values.amax();
    let kernel: Vec<usize> = (0..n).filter(|at| factors.singular_values[*at] <= smallest).collect();
    let mut continues = |direction: usize, sign: f64| {
        let step = |i: usize| sign * DISTANCE * directions[(direction, i)];
        let mut moved: Vec<f64> = (0..n).map(|i| x[i] + step(i) * scale[i]).collect();
        polish(equations, &mut moved, nominal);
        let way: f64 = (0..n).map(|i| (moved[i] - x[i]) / scale[i] * step(i)).sum();
        let mut residual = vec![0.0; n];
        equations.residual(&moved, &mut residual).is_ok()
            && residual.iter().zip(&rows).all(|(f, row)| (f * row).abs() <= ALONG)
            && way >= 0.5 * DISTANCE * DISTANCE
    };
    !kernel.is_empty() && kernel.iter().all(|at| continues(*at, 1.0) && continues(*at, -1.0))
}

/// Unknowns that Newton's method moves by so many of their magnitudes have leapt: a pivot was a rounding
/// error. The acceleration of an excavator's swing, which no initial equation determines, became 2e21.
const LEAP: f64 = 1e9;

/// How often [`polish`] is repeated for a solution near the start.
const MOST_POLISHED: usize = 5;

/// Where unknowns have leapt from `start` to `x` because equations that depend on each other do not
/// determine them: the solution nearest to `start`, in x. Whether that was so.
pub(super) fn return_from_leap(
    equations: &mut dyn Equations,
    (start, nominal): (&[f64], &[f64]),
    x: &mut [f64],
) -> bool {
    let n = x.len();
    let has_leapt = |((x, start), nominal): ((&f64, &f64), &f64)| {
        (x - start).abs() > LEAP * start.abs().max(*nominal)
    };
    if n > MOST_UNKNOWNS || !x.iter().zip(start).zip(nominal).any(has_leapt) {
        return false;
    }
    let (mut near, mut residual) = (start.to_vec(), vec![0.0; n]);
    for _ in 0..MOST_POLISHED {
        polish(equations, &mut near, nominal);
        let scale: Vec<f64> = near.iter().zip(nominal).map(|(x, n)| x.abs().max(*n)).collect();
        let Some((matrix, rows)) = scaled_jacobian(equations, &near, &scale) else { return false };
        let values = matrix.singular_values();
        if values.min() > RANK * values.max() || equations.residual(&near, &mut residual).is_err() {
            return false;
        }
        if residual.iter().zip(&rows).all(|(f, row)| (f * row).abs() <= ALONG) {
            x.copy_from_slice(&near);
            return true;
        }
    }
    false
}

/// Improves a solution by steps of Gauss and Newton, the shortest ones in units of the unknowns: least
/// squares end when residuals are small, here they become rounding errors.
pub(super) fn polish(equations: &mut dyn Equations, x: &mut [f64], nominal: &[f64]) {
    let n = x.len();
    let scale: Vec<f64> = x.iter().zip(nominal).map(|(x, nominal)| x.abs().max(*nominal)).collect();
    let (mut residual, mut trial) = (vec![0.0; n], vec![0.0; n]);
    for _ in 0..CORRECTIONS {
        if equations.residual(x, &mut residual).is_err() {
            return;
        }
        let Some((matrix, rows)) = scaled_jacobian(equations, x, &scale) else { return };
        let weighted = |f: &[f64]| {
            nalgebra::DVector::from_iterator(n, f.iter().zip(&rows).map(|(f, row)| f * row))
        };
        let right = weighted(&residual);
        let Some(factors) = matrix.try_svd(true, true, f64::EPSILON, MOST_SWEEPS) else { return };
        let smallest = RANK * factors.singular_values.amax();
        let Ok(step) = factors.solve(&right, smallest) else { return };
        for (at, value) in trial.iter_mut().enumerate() {
            *value = x[at] - step[at] * scale[at];
        }
        let is_better = equations.residual(&trial, &mut residual).is_ok()
            && weighted(&residual).amax() < right.amax();
        if !is_better {
            return;
        }
        x.copy_from_slice(&trial);
    }
}

/// The rank of the Jacobian; `None` where it has no values.
fn rank(equations: &mut dyn Equations, x: &[f64], scale: &[f64]) -> Option<usize> {
    let (matrix, _) = scaled_jacobian(equations, x, scale)?;
    let pivots = matrix.full_piv_lu().u().diagonal();
    let first = pivots.amax();
    Some(pivots.iter().filter(|pivot| pivot.abs() > RANK * first).count())
}

/// The Jacobian in units of the unknowns, its rows with largest entries of one, and what these were
/// multiplied by.
fn scaled_jacobian(
    equations: &mut dyn Equations,
    x: &[f64],
    scale: &[f64],
) -> Option<(nalgebra::DMatrix<f64>, Vec<f64>)> {
    let n = x.len();
    let mut entries = vec![0.0; n * n];
    equations.jacobian(x, &mut entries).ok()?;
    let mut matrix = nalgebra::DMatrix::from_column_slice(n, n, &entries);
    for (mut column, scale) in matrix.column_iter_mut().zip(scale) {
        column *= *scale;
    }
    let mut rows = Vec::with_capacity(n);
    for mut row in matrix.row_iter_mut() {
        let largest = row.amax();
        let factor = if largest > 0.0 { largest.recip() } else { 1.0 };
        row *= factor;
        rows.push(factor);
    }
    matrix.iter().all(|entry| entry.is_finite()).then_some((matrix, rows))
}
