//! Negative logarithm of the likelihood of normal errors, some of whose standard deviations are
//! given and others estimated along with the parameters, one for each group of points:
//!
//! ```text
//! -log L = n/2 ln 2π + Σ_given (½ uᵢ² - ln wᵢ) + Σ_groups n_g/2 (ln s_g² + 1) - Σ ln wᵢ,
//! uᵢ = wᵢ (yᵢ − ŷᵢ),  s_g² = Σ_g uᵢ² / n_g
//! ```
//!
//! The estimated deviations have been put in (the likelihood is concentrated), so that only the
//! parameters are searched. For least squares, with G = exp((Σ_given uᵢ² + Σ_g n_g ln s_g²) / n),
//! which grows with -log L: residuals √G κ uᵢ (given) and √G κ uᵢ / s_g (estimated), whose squares
//! add up to n G, and factors √G wᵢ/κ and √G wᵢ/(κ s_g), for which the gradient is exact;
//! κ² = n / (Σ_given uᵢ² + Σ_g n_g).
//!
//! Reference: [Seber & Wild 1989](gapilib_base::bibliography#seber-wild-1989), section 2.2 and chapter 11.

use super::{Fitness, checked};
use crate::elementary;

/// A group whose points are given their deviations.
const GIVEN: usize = usize::MAX;

/// The concentrated likelihood of some groups of points.
pub(crate) struct Concentrated {
    /// The group of each point.
    group: Vec<usize>,
    /// Points of each group.
    count: Vec<f64>,
    /// The smallest deviation of each group: that of the simulation's own errors.
    floor: Vec<f64>,
}

/// What one simulation has: Σ u² of the given, s_g² of the others.
struct Scales {
    given: f64,
    variance: Vec<f64>,
}

impl Concentrated {
    /// `group`: for each point the number of its group, `None` where its sigma is given.
    /// `floor`: the smallest standard deviation of each group, in units of the weighted points.
    pub fn new(group: &[Option<usize>], floor: Vec<f64>) -> Concentrated {
        let mut count = vec![0.0; floor.len()];
        group.iter().flatten().for_each(|g| count[*g] += 1.0);
        Concentrated { group: group.iter().map(|g| g.unwrap_or(GIVEN)).collect(), count, floor }
    }

    fn scales(&self, simulated: &[f64], measured: &[f64], weights: &[f64]) -> Scales {
        let mut scales = Scales { given: 0.0, variance: vec![0.0; self.count.len()] };
        for (u, &g) in super::differences(simulated, measured, weights).zip(&self.group) {
            *(if g == GIVEN { &mut scales.given } else { &mut scales.variance[g] }) += u * u;
        }
        for ((variance, n), floor) in scales.variance.iter_mut().zip(&self.count).zip(&self.floor) {
            // Not `max`, which would let NaN, the mark of a failed simulation, pass.
            let own = *variance / n;
            *variance = if own < floor * floor { floor * floor } else { own };
        }
        scales
    }

    /// Twice the part of -log L that depends on the parameters, but for a constant.
    fn exponent(&self, scales: &Scales) -> f64 {
        let groups = scales.variance.iter().zip(&self.count);
        scales.given + groups.map(|(variance, n)| n * elementary::ln(*variance)).sum::<f64>()
    }
}

impl Fitness for Concentrated {
    fn fitness(&self, simulated: &[f64], measured: &[f64], weights: &[f64]) -> f64 {
        let scales = self.scales(simulated, measured, weights);
        let n = measured.len() as f64;
        let constant: f64 = self.count.iter().sum::<f64>()
            + n * elementary::ln(std::f64::consts::TAU)
            - 2.0 * weights.iter().map(|w| elementary::ln(*w)).sum::<f64>();
        checked(0.5 * (self.exponent(&scales) + constant))
    }

    fn least_squares(&self, _: &[f64], weights: &[f64]) -> Option<Vec<f64>> {
        Some(weights.to_vec())
    }

    fn scaled(
        &self,
        simulated: &[f64],
        measured: &[f64],
        weights: &[f64],
        residuals: &mut [f64],
        factors: &mut [f64],
    ) -> bool {
        let scales = self.scales(simulated, measured, weights);
        let n = measured.len() as f64;
        let root = elementary::exp(0.5 * self.exponent(&scales) / n);
        let kappa = (n / (scales.given + self.count.iter().sum::<f64>())).sqrt();
        for (k, &g) in self.group.iter().enumerate() {
            let own = if g == GIVEN { 1.0 } else { scales.variance[g].sqrt() };
            residuals[k] = root * kappa * weights[k] / own * (simulated[k] - measured[k]);
            factors[k] = root / kappa * weights[k] / own;
        }
        true
    }

    fn error_weights(
        &self,
        simulated: &[f64],
        measured: &[f64],
        weights: &[f64],
    ) -> Option<Vec<f64>> {
        let scales = self.scales(simulated, measured, weights);
        let own = |(w, &g): (&f64, &usize)| match g {
            GIVEN => *w,
            g => w / scales.variance[g].sqrt(),
        };
        Some(weights.iter().zip(&self.group).map(own).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cases() -> [Concentrated; 3] {
        let all = |g: [Option<usize>; 6], n| Concentrated::new(&g, vec![1e-9; n]);
        let (a, b) = (Some(0), Some(1));
        [all([a; 6], 1), all([a, a, a, b, b, b], 2), all([None, None, a, a, a, a], 1)]
    }

    const MEASURED: [f64; 6] = [1.0, 2.0, 3.0, 10.0, 20.0, 30.0];
    const WEIGHTS: [f64; 6] = [10.0, 5.0, 1.0, 1.0, 1.0, 0.5];

    fn simulated(p: f64) -> [f64; 6] {
        [1.1 + p, 1.8, 3.3 - p, 11.0 + p * p, 19.0 - 2.0 * p, 31.0 + p]
    }

    /// -log L as the sum of logarithms of normal densities with the maximum likelihood deviations.
    #[test]
    fn the_value_is_the_sum_of_the_logarithms_of_the_densities() {
        let s = simulated(0.2);
        for own in cases() {
            let weights = own.error_weights(&s, &MEASURED, &WEIGHTS).unwrap();
            let density = |k: usize| {
                let u = weights[k] * (MEASURED[k] - s[k]);
                0.5 * u * u - weights[k].ln() + 0.5 * std::f64::consts::TAU.ln()
            };
            let expected: f64 = (0..6).map(density).sum();
            let found = own.fitness(&s, &MEASURED, &WEIGHTS);
            assert!((found - expected).abs() < 1e-10, "{found} {expected}");
        }
    }

    /// Σ r² = n exp(2 (-log L - constant)/n), and its derivative is 2 Σ f r ∂ŷ/∂p.
    #[test]
    fn squares_and_their_gradient_are_those_of_the_likelihood() {
        for own in cases() {
            let (mut r, mut f) = ([0.0; 6], [0.0; 6]);
            let mut square = |p: f64| {
                assert!(own.scaled(&simulated(p), &MEASURED, &WEIGHTS, &mut r, &mut f));
                (r.iter().map(|r| r * r).sum::<f64>(), r, f)
            };
            let value = |p: f64| own.fitness(&simulated(p), &MEASURED, &WEIGHTS);
            let (a, b) = (square(0.2).0, square(0.3).0);
            let ratio = (value(0.3) - value(0.2)) / 3.0;
            assert!(((b / a).ln() - ratio).abs() < 1e-10, "{} {ratio}", (b / a).ln());
            let h = 1e-6;
            let expected = (square(0.2 + h).0 - square(0.2 - h).0) / (2.0 * h);
            let (_, r, f) = square(0.2);
            let derivative = [1.0, 0.0, -1.0, 0.4, -2.0, 1.0];
            let found: f64 = (0..6).map(|k| 2.0 * f[k] * r[k] * derivative[k]).sum();
            assert!((found - expected).abs() < 1e-6 * expected.abs(), "{found} {expected}");
        }
    }

    #[test]
    fn an_exact_fit_is_not_infinitely_likely_and_a_failed_one_is_worst() {
        for own in cases() {
            assert!(own.fitness(&MEASURED, &MEASURED, &WEIGHTS).is_finite());
            let failed = own.fitness(&[f64::NAN; 6], &MEASURED, &WEIGHTS);
            assert_eq!(failed, crate::ga::FAILED_FITNESS);
        }
    }
}
