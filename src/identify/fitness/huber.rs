//! Huber's function of the weighted differences: squares up to `delta`, beyond it straight lines.
//!
//! Reference: [huber-1964](crate::bibliography#huber-1964).

use super::{Fitness, checked, differences};
use crate::registry::Entry;

/// The table entry.
pub(super) const ENTRY: Entry<dyn Fitness> = Entry {
    name: "huber",
    aliases: &[],
    summary: "squares of small and absolute values of large differences",
    reference: "huber-1964",
    make: |options| Ok(Box::new(Huber { delta: options.take("delta", 1e-300..=f64::MAX, 1.345)? })),
};

struct Huber {
    delta: f64,
}

impl Fitness for Huber {
    fn fitness(&self, simulated: &[f64], measured: &[f64], weights: &[f64]) -> f64 {
        let delta = self.delta;
        let part = |d: f64| match d.abs() {
            d if d <= delta => 0.5 * d * d,
            d => delta * (d - 0.5 * delta),
        };
        checked(differences(simulated, measured, weights).map(part).sum())
    }

    fn least_squares(&self, _: &[f64], _: &[f64]) -> Option<Vec<f64>> {
        None
    }
}
