//! Newton's method with damping on one torn loop.

use super::memory::Memory;
use super::program::Newton;
use super::system::run;
use crate::sim::Failure;

/// Most iterations.
const MAX_ITERATIONS: usize = 100;
/// Relative size of the last correction.
const TOLERANCE: f64 = 1e-11;
/// Most halvings of a correction.
const MAX_HALVINGS: usize = 30;

/// Solves a loop from the values its unknowns have.
pub(super) fn solve_loop(newton: &Newton, r: &mut Memory) -> Result<(), Failure> {
    let n = newton.unknowns.len();
    let (mut matrix, mut step, mut before) = (vec![0.0; n * n], vec![0.0; n], vec![0.0; n]);
    run(&newton.tape, r)?;
    for _ in 0..MAX_ITERATIONS {
        let size = residual_size(newton, r);
        if size == 0.0 {
            return Ok(());
        }
        correction(newton, r, &mut matrix, &mut step)?;
        for (value, unknown) in before.iter_mut().zip(&newton.unknowns) {
            *value = r[*unknown as usize];
        }
        let small = step
            .iter()
            .zip(&before)
            .all(|(step, value)| step.abs() <= TOLERANCE * value.abs().max(1e-6));
        let mut share = 1.0;
        let mut accepted = false;
        for _ in 0..MAX_HALVINGS {
            for ((unknown, value), step) in newton.unknowns.iter().zip(&before).zip(&step) {
                r[*unknown as usize] = value - share * step;
            }
            let done = run(&newton.tape, r);
            let now = residual_size(newton, r);
            if done.is_ok() && now.is_finite() && (small || now < size * (1.0 - 1e-4 * share)) {
                accepted = true;
                break;
            }
            share *= 0.5;
        }
        if small && accepted {
            return Ok(());
        }
        if !accepted {
            // No descent is left: a solution to rounding, or none.
            restore(newton, &before, r)?;
            let near = step
                .iter()
                .zip(&before)
                .all(|(step, value)| step.abs() <= 1e-7 * value.abs().max(1e-6));
            return if near { Ok(()) } else { Err(Failure::Newton { block: newton.block }) };
        }
    }
    Err(Failure::Newton { block: newton.block })
}

fn restore(newton: &Newton, values: &[f64], r: &mut Memory) -> Result<(), Failure> {
    for (unknown, value) in newton.unknowns.iter().zip(values) {
        r[*unknown as usize] = *value;
    }
    run(&newton.tape, r)
}

fn residual_size(newton: &Newton, r: &[f64]) -> f64 {
    newton.residuals.iter().map(|at| r[*at as usize] * r[*at as usize]).sum::<f64>().sqrt()
}

/// Solves J step = residual by elimination with row scaling and column pivots.
fn correction(
    newton: &Newton,
    r: &[f64],
    matrix: &mut [f64],
    step: &mut [f64],
) -> Result<(), Failure> {
    let n = step.len();
    let singular = Failure::Singular { block: newton.block };
    for row in 0..n {
        let line = &newton.jacobian[row * n..(row + 1) * n];
        let scale = line.iter().map(|at| r[*at as usize].abs()).fold(0.0, f64::max);
        if scale == 0.0 || !scale.is_finite() {
            return Err(singular);
        }
        for column in 0..n {
            matrix[row * n + column] = r[line[column] as usize] / scale;
        }
        step[row] = r[newton.residuals[row] as usize] / scale;
    }
    for k in 0..n {
        let pivot = (k..n)
            .max_by(|a, b| matrix[a * n + k].abs().total_cmp(&matrix[b * n + k].abs()))
            .unwrap_or(k);
        if matrix[pivot * n + k].abs() < 1e-14 {
            return Err(singular);
        }
        if pivot != k {
            for column in 0..n {
                matrix.swap(k * n + column, pivot * n + column);
            }
            step.swap(k, pivot);
        }
        for row in k + 1..n {
            let factor = matrix[row * n + k] / matrix[k * n + k];
            for column in k..n {
                matrix[row * n + column] -= factor * matrix[k * n + column];
            }
            step[row] -= factor * step[k];
        }
    }
    for k in (0..n).rev() {
        for column in k + 1..n {
            step[k] -= matrix[k * n + column] * step[column];
        }
        step[k] /= matrix[k * n + k];
    }
    Ok(())
}
