//! RMSE divided by the range of the measured values.
//!
//! Reference: [walter-pronzato-1997](gapilib_base::bibliography#walter-pronzato-1997).

use super::{Fitness, checked, differences};
use crate::registry::Entry;

/// The table entry.
pub const ENTRY: Entry<dyn Fitness> = Entry {
    name: "nrmse",
    aliases: &["normalized"],
    summary: "root of the mean squared difference relative to the measured range",
    reference: "walter-pronzato-1997",
    make: |_| Ok(Box::new(Normalized)),
};

struct Normalized;

impl Fitness for Normalized {
    fn fitness(&self, simulated: &[f64], measured: &[f64], weights: &[f64]) -> f64 {
        let low = measured.iter().copied().fold(f64::INFINITY, f64::min);
        let high = measured.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let sum: f64 = differences(simulated, measured, weights).map(|d| d * d).sum();
        checked((sum / measured.len() as f64).sqrt() / (high - low))
    }

    fn least_squares(&self, _: &[f64], weights: &[f64]) -> Option<Vec<f64>> {
        Some(weights.to_vec())
    }
}
