//! Fitness functions: how far the simulation is from the measurement; smaller is better.

mod concentrated;
mod joint;
mod law;
mod log_likelihood;
mod normalized;
mod relative;
mod robust;
mod root_mean_square;
mod sum_of_squares;

pub(crate) use concentrated::{Concentrated, Deviation, raised, twice_negative_log};
pub(crate) use joint::JointGroup;
pub use joint::Whitening;
pub use law::Law;
pub use sum_of_squares::sum_of_squares;

use crate::ga::FAILED_FITNESS;
use crate::registry::Entry;

/// Compares one simulation with the measurement.
pub trait Fitness: Send + Sync {
    /// [`FAILED_FITNESS`] where a simulated value is not a number. Every
    /// difference counts times its weight; all slices have the same length.
    fn fitness(&self, simulated: &[f64], measured: &[f64], weights: &[f64]) -> f64;

    /// What each difference is multiplied with where the minimum is that of a sum of squares;
    /// `None` where it is not, so that least squares cannot find it.
    fn least_squares(&self, measured: &[f64], weights: &[f64]) -> Option<Vec<f64>>;

    /// Where the minimum is that of a sum of squares whose factors depend on the simulation:
    /// writes residuals r with Σ r² growing with the fitness, and factors f such that
    /// 2 Σ f r ∂ŷ/∂p is the gradient of Σ r². `false`: the constant factors of
    /// [`least_squares`](Fitness::least_squares) hold. Derivatives that have been multiplied with the
    /// factors then pass [`whitening`](Fitness::whitening), which the residuals have passed.
    fn scaled(
        &self,
        [_simulated, _measured, _weights]: [&[f64]; 3],
        _residuals: &mut [f64],
        _factors: &mut [f64],
    ) -> bool {
        false
    }

    /// The weights that the errors have at this simulation, where they are estimated with it:
    /// reciprocal standard deviations.
    fn error_weights(
        &self,
        _simulated: &[f64],
        _measured: &[f64],
        _weights: &[f64],
    ) -> Option<Vec<f64>> {
        None
    }

    /// What makes residuals in units of their standard deviations uncorrelated, where errors of several
    /// points are correlated.
    fn whitening(&self, _compared: [&[f64]; 3]) -> Option<Whitening> {
        None
    }

    /// The covariances of the groups of points whose errors are correlated, in units of their weights.
    fn covariances(&self, _compared: [&[f64]; 3]) -> Vec<nalgebra::DMatrix<f64>> {
        Vec::new()
    }

    /// The same function with the standard deviation of the weighted differences known; `None`
    /// where it does not depend on that.
    fn with_scale(&self, _scale: f64) -> Option<Box<dyn Fitness>> {
        None
    }

    /// What takes the place of the residual variance where not the squares of the weighted
    /// `residuals` are minimized.
    fn robustness(&self, _residuals: &[f64], _freedom: f64) -> Option<Robustness> {
        None
    }
}

/// The asymptotic behaviour of a robust fitness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Robustness {
    /// v of the covariance v (JᵀJ)⁻¹.
    pub variance: f64,
    /// Degrees of freedom of that variance: fewer than those of the points, as the scale of the bulk
    /// is known less well than a standard deviation of all.
    pub freedom: f64,
    /// The scale s: standard deviation of the bulk of the weighted residuals.
    pub scale: f64,
    /// The sum of squares, s² Σ 2ρ, rises by this times s² χ² within a likelihood region.
    pub rise: f64,
}

/// Standard deviation of normal errors from the median of their absolute values (MAD).
pub(crate) fn median_deviation(residuals: &[f64]) -> f64 {
    let mut size: Vec<f64> = residuals.iter().map(|r| r.abs()).collect();
    size.sort_by(f64::total_cmp);
    let n = size.len();
    // 1/Φ⁻¹(3/4)
    match n {
        0 => f64::NAN,
        n if n % 2 == 1 => 1.482_602_218_505_602 * size[n / 2],
        n => 1.482_602_218_505_602 * 0.5 * (size[n / 2 - 1] + size[n / 2]),
    }
}

/// All fitness functions; the first is the default.
pub const FITNESSES: &[&Entry<dyn Fitness>] = &[
    &sum_of_squares::ENTRY,
    &root_mean_square::ENTRY,
    &normalized::ENTRY,
    &robust::ABSOLUTE_ENTRY,
    &relative::ENTRY,
    &robust::HUBER_ENTRY,
    &robust::TUKEY_ENTRY,
    &log_likelihood::ENTRY,
];

/// Weighted differences, measured less simulated.
fn differences<'a>(
    simulated: &'a [f64],
    measured: &'a [f64],
    weights: &'a [f64],
) -> impl Iterator<Item = f64> + Clone + 'a {
    simulated.iter().zip(measured).zip(weights).map(|((s, m), w)| w * (m - s))
}

/// NaN and what is too large become the fitness of a failed simulation.
fn checked(value: f64) -> f64 {
    if value < FAILED_FITNESS { value } else { FAILED_FITNESS }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::{self, Options};

    fn fitness(name: &str, simulated: &[f64], measured: &[f64], weights: &[f64]) -> f64 {
        let entry = registry::find("fitness function", FITNESSES, name).unwrap();
        let fitness = (entry.make)(&mut Options::default()).unwrap();
        fitness.fitness(simulated, measured, weights)
    }

    #[test]
    fn each_has_the_value_of_its_formula() {
        let (simulated, measured, weights) = ([1.0, 2.0, 5.0], [1.0, 4.0, 2.0], [1.0, 0.5, 1.0]);
        // Weighted differences: 0, 1, -3.
        for (name, expected) in [
            ("sse", 10.0),
            ("rmse", (10.0_f64 / 3.0).sqrt()),
            ("nrmse", (10.0_f64 / 3.0).sqrt() / 3.0),
            ("mae", 4.0 / 3.0),
            ("relative", (0.25_f64.powi(2) + 1.5_f64.powi(2)) / 3.0),
            ("log_likelihood", 1.5 * ((2.0 * std::f64::consts::PI * 10.0 / 3.0).ln() + 1.0)),
        ] {
            let found = fitness(name, &simulated, &measured, &weights);
            assert!((found - expected).abs() < 1e-12, "{name}: {found} instead of {expected}");
        }
    }

    #[test]
    fn what_is_not_a_number_is_a_failure() {
        for entry in FITNESSES {
            let found = fitness(entry.name, &[f64::NAN, 1.0], &[1.0, 2.0], &[1.0, 1.0]);
            assert_eq!(found, FAILED_FITNESS, "{}", entry.name);
        }
    }
}
