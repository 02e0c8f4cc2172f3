//! Difference quotients where a derivative has no finite value: `sqrt(x)` at 0, and `sqrt(x^2)`,
//! whose symbolic derivative there is 0/0. The functions themselves have values, and a quotient
//! over a short distance is a Jacobian entry with which Newton's method continues.

use super::execution::FailedOperation;
use crate::sim::Failure;

/// Length of the way relative to the size of the variable: between rounding errors of the function
/// and its curvature.
const RELATIVE_STEP: f64 = 1.5e-8;

/// Writes (f(x + h eⱼ) − f(x)) / h, or the same with −h where f has no value there. `at` evaluates f
/// where one entry of x is another; `column` receives the quotients.
pub fn quotient(
    x: f64,
    nominal: f64,
    before: &[f64],
    column: &mut [f64],
    mut at: impl FnMut(f64, &mut [f64]) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let size = RELATIVE_STEP * x.abs().max(nominal);
    let forward = (x + size) - x;
    let step = match at(x + forward, column) {
        Ok(()) => forward,
        Err(_) => {
            let backward = (x - size) - x;
            at(x + backward, column)?;
            backward
        }
    };
    column.iter_mut().zip(before).for_each(|(after, before)| *after = (*after - before) / step);
    match column.iter().all(|entry| entry.is_finite()) {
        true => Ok(()),
        false => Err(Failure::Domain { origin: u32::MAX, operation: FailedOperation::OTHER }),
    }
}
