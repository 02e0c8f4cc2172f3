//! Negative logarithm of the likelihood of normal errors whose variance is estimated along:
//! n/2 (ln(2π s²) + 1) with s² = Σ (wⱼ (yⱼ − ŷⱼ))² / n. Where the standard deviations 1/wⱼ are known,
//! ½ Σ (wⱼ (yⱼ − ŷⱼ))² − Σ ln wⱼ + n/2 ln 2π.
//!
//! Reference: [walter-pronzato-1997](gapilib_base::bibliography#walter-pronzato-1997).

use super::{Fitness, checked, differences};
use crate::elementary;
use crate::registry::Entry;

/// The table entry.
pub const ENTRY: Entry<dyn Fitness> = Entry {
    name: "log_likelihood",
    aliases: &["likelihood", "nll"],
    summary: "negative log-likelihood of normal errors, of unknown variance unless sigmas are given",
    reference: "walter-pronzato-1997",
    make: |options| {
        let scale = options.take("scale", 0.0..=f64::MAX, 0.0)?;
        Ok(Box::new(LogLikelihood { scale }))
    },
};

struct LogLikelihood {
    /// The standard deviation of the weighted differences; 0 where it is estimated.
    scale: f64,
}

impl Fitness for LogLikelihood {
    fn fitness(&self, simulated: &[f64], measured: &[f64], weights: &[f64]) -> f64 {
        let n = measured.len() as f64;
        let sum: f64 = differences(simulated, measured, weights).map(|d| d * d).sum();
        let value = if self.scale > 0.0 {
            let weights: f64 = weights.iter().map(|w| elementary::ln(w / self.scale)).sum();
            let constant = 0.5 * n * elementary::ln(std::f64::consts::TAU);
            0.5 * sum / (self.scale * self.scale) - weights + constant
        } else {
            // An exact fit would be infinitely likely.
            let variance = (sum / n).max(f64::MIN_POSITIVE);
            0.5 * n * (elementary::ln(std::f64::consts::TAU * variance) + 1.0)
        };
        if sum.is_nan() { checked(sum) } else { checked(value) }
    }

    fn least_squares(&self, _: &[f64], weights: &[f64]) -> Option<Vec<f64>> {
        Some(weights.to_vec())
    }
}
