//! Nonlinear loops that leave unknowns open: not at one point, as at a turning point or a multiple
//! zero, but everywhere around a solution, as the voltage of a network that is grounded nowhere.
//!
//! There the equations depend on each other, and the Jacobian has the same rank, less than the number
//! of unknowns, at the solution and beside it. Which of the solutions is taken changes nothing that
//! the equations determine.

use crate::sim::Equations;

/// How far beside the solution the Jacobian is looked at, relative to the magnitudes of the unknowns:
/// at x |x| = 0 its only entry is 1e-3 there.
const DISTANCE: f64 = 1e-3;
/// Pivots below this part of the first are zero.
const RANK: f64 = 1e-12;
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

/// The rank of the Jacobian; `None` where it has no values.
fn rank(equations: &mut dyn Equations, x: &[f64], scale: &[f64]) -> Option<usize> {
    let n = x.len();
    let mut entries = vec![0.0; n * n];
    equations.jacobian(x, &mut entries).ok()?;
    let mut matrix = nalgebra::DMatrix::from_column_slice(n, n, &entries);
    for (mut column, scale) in matrix.column_iter_mut().zip(scale) {
        column *= *scale;
    }
    for mut row in matrix.row_iter_mut() {
        let largest = row.amax();
        if largest > 0.0 {
            row /= largest;
        }
    }
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    let pivots = matrix.full_piv_lu().u().diagonal();
    let first = pivots.amax();
    Some(pivots.iter().filter(|pivot| pivot.abs() > RANK * first).count())
}
