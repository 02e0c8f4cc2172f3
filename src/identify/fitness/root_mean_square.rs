//! √(Σ (wⱼ (yⱼ − ŷⱼ))² / n), in the unit of the measured variable.
//!
//! Reference: [walter-pronzato-1997](gapilib_base::bibliography#walter-pronzato-1997).

use super::{Fitness, checked, differences};
use crate::registry::Entry;

/// The table entry.
pub const ENTRY: Entry<dyn Fitness> = Entry {
    name: "rmse",
    aliases: &["root_mean_square"],
    summary: "root of the mean squared difference",
    reference: "walter-pronzato-1997",
    make: |_| Ok(Box::new(RootMeanSquare)),
};

struct RootMeanSquare;

impl Fitness for RootMeanSquare {
    fn fitness(&self, simulated: &[f64], measured: &[f64], weights: &[f64]) -> f64 {
        let sum: f64 = differences(simulated, measured, weights).map(|d| d * d).sum();
        checked((sum / measured.len() as f64).sqrt())
    }

    fn least_squares(&self, _: &[f64], weights: &[f64]) -> Option<Vec<f64>> {
        Some(weights.to_vec())
    }
}
