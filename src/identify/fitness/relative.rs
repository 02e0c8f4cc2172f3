//! Σ (wⱼ (yⱼ − ŷⱼ) / yⱼ)² / n; a measured 0 makes it useless, which shows as a failure.
//!
//! Reference: [walter-pronzato-1997](gapilib_base::bibliography#walter-pronzato-1997).

use super::{Fitness, checked, differences};
use crate::registry::Entry;

/// The table entry.
pub const ENTRY: Entry<dyn Fitness> = Entry {
    name: "relative",
    aliases: &["mean_relative"],
    summary: "mean squared relative difference",
    reference: "walter-pronzato-1997",
    make: |_| Ok(Box::new(Relative)),
};

struct Relative;

impl Fitness for Relative {
    fn fitness(&self, simulated: &[f64], measured: &[f64], weights: &[f64]) -> f64 {
        let relative = differences(simulated, measured, weights).zip(measured).map(|(d, y)| d / y);
        checked(relative.map(|d| d * d).sum::<f64>() / measured.len() as f64)
    }

    fn least_squares(&self, measured: &[f64], weights: &[f64]) -> Option<Vec<f64>> {
        let scales: Vec<f64> = weights.iter().zip(measured).map(|(w, y)| w / y.abs()).collect();
        scales.iter().all(|scale| scale.is_finite()).then_some(scales)
    }
}
