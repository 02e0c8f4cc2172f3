//! Σ |wⱼ (yⱼ − ŷⱼ)| / n: outliers count less than in a sum of squares.
//!
//! Reference: [walter-pronzato-1997](crate::bibliography#walter-pronzato-1997).

use super::{Fitness, checked, differences};
use crate::registry::Entry;

/// The table entry.
pub(super) const ENTRY: Entry<dyn Fitness> = Entry {
    name: "mae",
    aliases: &["mean_absolute"],
    summary: "mean absolute difference",
    reference: "walter-pronzato-1997",
    make: |_| Ok(Box::new(MeanAbsolute)),
};

struct MeanAbsolute;

impl Fitness for MeanAbsolute {
    fn fitness(&self, simulated: &[f64], measured: &[f64], weights: &[f64]) -> f64 {
        let sum: f64 = differences(simulated, measured, weights).map(f64::abs).sum();
        checked(sum / measured.len() as f64)
    }

    fn least_squares(&self, _: &[f64], _: &[f64]) -> Option<Vec<f64>> {
        None
    }
}
