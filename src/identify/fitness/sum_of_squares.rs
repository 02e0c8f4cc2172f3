//! Σ (wⱼ (yⱼ − ŷⱼ))².
//!
//! Reference: [Rubio et al. 2006](gapilib_base::bibliography#rubio-2006), equation (1).

use super::{Fitness, checked, differences};
use crate::ga::FAILED_FITNESS;
use crate::registry::Entry;

/// The table entry.
pub const ENTRY: Entry<dyn Fitness> = Entry {
    name: "sum_of_squares",
    aliases: &["sse", "wsse"],
    summary: "sum of the squared differences",
    reference: "rubio-2006",
    make: |_| Ok(Box::new(SumOfSquares)),
};

struct SumOfSquares;

impl Fitness for SumOfSquares {
    fn fitness(&self, simulated: &[f64], measured: &[f64], weights: &[f64]) -> f64 {
        checked(differences(simulated, measured, weights).map(|d| d * d).sum())
    }

    fn least_squares(&self, _: &[f64], weights: &[f64]) -> Option<Vec<f64>> {
        Some(weights.to_vec())
    }
}

/// The sum of squared differences; [`FAILED_FITNESS`] when it is not below that.
pub fn sum_of_squares(simulated: &[f64], measured: &[f64]) -> f64 {
    let square = |(s, m): (&f64, &f64)| (m - s) * (m - s);
    let sum: f64 = simulated.iter().zip(measured).map(square).sum();
    // Not `sum.min(…)`, which would let NaN, the mark of a failed simulation, pass.
    if sum < FAILED_FITNESS { sum } else { FAILED_FITNESS }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn failed_simulations_are_worst() {
        assert_eq!(sum_of_squares(&[1.0, f64::NAN], &[1.0, 2.0]), FAILED_FITNESS);
        assert_eq!(sum_of_squares(&[1e200], &[0.0]), FAILED_FITNESS);
        assert_eq!(sum_of_squares(&[1.0, 2.0], &[0.0, 4.0]), 5.0);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        #[test]
        fn zero_only_for_equal_series_and_quadratic_in_scale(
            series in prop::collection::vec(-10.0..10.0_f64, 1..20),
            shift in 0.1..1.0_f64,
        ) {
            prop_assert_eq!(sum_of_squares(&series, &series), 0.0);
            let shifted: Vec<f64> = series.iter().map(|value| value + shift).collect();
            let expected = shift * shift * series.len() as f64;
            prop_assert!((sum_of_squares(&shifted, &series) - expected).abs() < 1e-9);
        }
    }
}
