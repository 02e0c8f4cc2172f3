//! Ranges that loops run over.

use super::failure::Reason;

/// Most iterations of a loop.
const MAX_ITERATIONS: f64 = 1e15;

/// The number of iterations over `start : step : stop` (MLS §10.4.3).
pub(super) fn iterations(start: f64, step: f64, stop: f64) -> Result<f64, Reason> {
    if start.is_nan() || step.is_nan() || stop.is_nan() {
        return Err(Reason::Unassigned);
    }
    let count = ((stop - start) / step * (1.0 + f64::EPSILON)).floor() + 1.0;
    match count.is_finite() && count < MAX_ITERATIONS {
        true => Ok(count.max(0.0)),
        false => Err(Reason::Range),
    }
}
