//! Densities of the errors of measurement, in the form that least squares need.
//!
//! A point with the weight w, the scale σ of its errors and u = w (ŷ − y)/σ has the density
//! (w/σ) g(u), -ln g(u) = ρ(u) + c. Its residual r and its factor f have the gradient as their product,
//! r f = ψ(u) = ρ'(u), and f² is what the steps of least squares take for the second derivative:
//! iteratively reweighted least squares, for counts Fisher scoring. The scale that is most likely has
//! Σ u ψ(u) = n, so that squares of these residuals are 1 on average, as those of normal errors are.
//!
//! | density | ρ(u) | r | f | information of ŷ, in (w/σ)² | of ln σ |
//! |---|---|---|---|---|---|
//! | normal | u²/2 | u | 1 | 1 | 2 |
//! | Laplace | abs(u) | u f | 1/√abs(u) | 1 | 1 |
//! | Student, ν | (ν+1)/2 ln(1 + u²/ν) | u f | √((ν+1)/(ν+u²)) | (ν+1)/(ν+3) | 2ν/(ν+3) |
//!
//! Of a value below a limit of detection y, the probability of that is the likelihood, with the normal
//! distribution Φ: ρ = −ln Φ(−u), and −ln Φ(u) above one. Its hazard h = φ/Φ is ψ, and h (h ± u), its
//! derivative, is f². Such points have no density, and so no scale of their own.
//!
//! A count y of a Poisson distribution has no scale: ŷ is its variance, 1/ŷ its information, and
//! ρ = ŷ − y − y ln(ŷ/y).
//!
//! References: [Lange, Little & Taylor 1989](gapilib_base::bibliography#lange-1989) for Student's,
//! [McCullagh & Nelder 1989](gapilib_base::bibliography#mccullagh-nelder-1989) for counts.

use crate::elementary;
use crate::problem::distributions::{ln_gamma, normal_below, normal_density};
use serde::{Deserialize, Serialize};
use std::f64::consts::{LN_2, PI, TAU};

/// Below this size of u, the corner of the density of Laplace is rounded off for the steps of least
/// squares: there, -log L is at most half of it too large. With an exponential decay of 25 points the fit
/// was 0.006 above the minimum with 0.01, 0.0006 with this; with 1e-5 51 descents were needed instead of 21.
const ROUNDED: f64 = 1e-3;

/// How errors of measurement are distributed.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub enum Law {
    /// Normal: the scale is the standard deviation.
    #[default]
    Normal,
    /// Of Laplace: the scale is the mean absolute error.
    Laplace,
    /// Of Student with so many degrees of freedom.
    Student(f64),
    /// The measured value is a count, the simulated one its expectation.
    Poisson,
    /// Normal, and known to be less than the measured value only.
    Below,
    /// Normal, and known to be more than the measured value only.
    Above,
}

/// From here on the normal distribution is its asymptotic series, to 1e-11; beyond 38 it has no value.
const FAR: f64 = 30.0;

/// −ln Φ(−u), and the hazard φ(u)/Φ(−u).
fn tail(u: f64) -> [f64; 2] {
    if u > FAR {
        let square = 1.0 / (u * u);
        let series = 1.0 - square * (1.0 - 3.0 * square * (1.0 - 5.0 * square));
        let log = 0.5 * u * u + elementary::ln(u) + 0.5 * elementary::ln(TAU);
        return [log - elementary::ln(series), u / series];
    }
    let probability = normal_below(-u);
    [-elementary::ln(probability), normal_density(u) / probability]
}

impl Law {
    /// 2ρ.
    pub(super) fn twice(self, u: f64) -> f64 {
        match self {
            Law::Normal | Law::Poisson => u * u,
            Law::Laplace => 2.0 * u.abs(),
            Law::Student(freedom) => (freedom + 1.0) * elementary::ln(1.0 + u * u / freedom),
            Law::Below => 2.0 * tail(u)[0],
            Law::Above => 2.0 * tail(-u)[0],
        }
    }

    /// Whether a limit was measured, not a value.
    pub(crate) fn is_censored(self) -> bool {
        matches!(self, Law::Below | Law::Above)
    }

    /// How many densities a point has in the likelihood: none where a limit was measured.
    pub(super) fn densities(self) -> f64 {
        if self.is_censored() { 0.0 } else { 1.0 }
    }

    /// ψ and its derivative where a limit was measured.
    fn hazard(self, u: f64) -> [f64; 2] {
        let side = if self == Law::Below { 1.0 } else { -1.0 };
        let own = tail(side * u)[1];
        // Rounding takes the difference of large numbers below 0.
        [side * own, (own * (own - side * u)).max(0.0)]
    }

    /// The residual r.
    pub(super) fn residual(self, u: f64) -> f64 {
        match self {
            Law::Below | Law::Above => {
                let [derivative, curvature] = self.hazard(u);
                if curvature > 0.0 { derivative / curvature.sqrt() } else { 0.0 * u }
            }
            _ => self.factor(u) * u,
        }
    }

    /// u ψ(u).
    pub(super) fn moment(self, u: f64, is_rounded: bool) -> f64 {
        match self {
            Law::Below | Law::Above => u * self.hazard(u)[0],
            _ => self.square(u, is_rounded),
        }
    }

    /// 2ρ of a count.
    pub(super) fn twice_of_count(simulated: f64, measured: f64) -> f64 {
        let of_ratio = match measured > 0.0 {
            true => measured * elementary::ln(simulated / measured),
            // Of what is no expectation.
            false if simulated.is_nan() || simulated < 0.0 => f64::NAN,
            false => 0.0,
        };
        2.0 * (simulated - measured - of_ratio)
    }

    /// 2ρ as the steps of least squares have it: without corners.
    pub(super) fn rounded(self, u: f64) -> f64 {
        match self {
            Law::Laplace if u.abs() < ROUNDED => u * u / ROUNDED + ROUNDED,
            _ => self.twice(u),
        }
    }

    /// f: but for limits, the residual is u times this.
    pub(super) fn factor(self, u: f64) -> f64 {
        match self {
            Law::Normal | Law::Poisson => 1.0,
            // Not `max`, which would let NaN pass.
            Law::Laplace if u.abs() < ROUNDED => 1.0 / ROUNDED.sqrt(),
            Law::Laplace => 1.0 / u.abs().sqrt(),
            Law::Student(freedom) => ((freedom + 1.0) / (freedom + u * u)).sqrt(),
            Law::Below | Law::Above => self.hazard(u)[1].sqrt(),
        }
    }

    /// The square of the residual, u ψ(u) but for limits.
    pub(super) fn square(self, u: f64, is_rounded: bool) -> f64 {
        match self {
            Law::Laplace if !is_rounded => u.abs(),
            Law::Normal => u * u,
            _ => elementary::powi(self.residual(u), 2),
        }
    }

    /// 2c, of a count with what depends on it.
    pub(super) fn constant(self, measured: f64) -> f64 {
        match self {
            Law::Normal => elementary::ln(TAU),
            Law::Laplace => 2.0 * LN_2,
            Law::Student(freedom) => {
                let half = 0.5 * freedom;
                elementary::ln(freedom * PI) + 2.0 * (ln_gamma(half) - ln_gamma(half + 0.5))
            }
            Law::Poisson if measured > 0.0 => {
                2.0 * (measured - measured * elementary::ln(measured) + ln_gamma(measured + 1.0))
            }
            Law::Poisson | Law::Below | Law::Above => 0.0,
        }
    }

    /// The root of the information that a point has of its expectation, in units of w/σ; that of a limit
    /// depends on how far it is.
    pub(crate) fn root_information(self, u: f64) -> f64 {
        match self {
            Law::Below | Law::Above => self.factor(u),
            Law::Normal | Law::Laplace | Law::Poisson => 1.0,
            Law::Student(freedom) => ((freedom + 1.0) / (freedom + 3.0)).sqrt(),
        }
    }

    /// The information that a point has of the logarithm of its scale.
    pub(super) fn information_of_scale(self) -> f64 {
        match self {
            Law::Normal | Law::Poisson | Law::Below | Law::Above => 2.0,
            Law::Laplace => 1.0,
            Law::Student(freedom) => 2.0 * freedom / (freedom + 3.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fitness::{Concentrated, Deviation, Fitness as _};

    const MEASURED: [f64; 6] = [1.0, 2.0, 3.0, 10.0, 20.0, 4.0];
    const WEIGHTS: [f64; 6] = [10.0, 5.0, 1.0, 1.0, 1.0, 0.5];

    fn simulated(p: f64) -> [f64; 6] {
        [1.1 + p, 1.8, 3.3 - p, 11.0 + p * p, 19.0 - 2.0 * p, 4.5 + p]
    }

    fn all(law: Law, deviation: Deviation) -> Concentrated {
        let groups = if deviation == Deviation::Given { Vec::new() } else { vec![1e-9] };
        Concentrated::new(vec![(law, deviation); 6], groups)
    }

    /// SciPy 1.17: `-sum(laplace.logpdf(y, s, 1/w))`, `t.logpdf(y, 4, s, 1/w)` with the numbers above at
    /// p = 0.2, and `poisson.logpmf(y, s)`.
    #[test]
    fn values_are_those_of_scipy() {
        for (law, expected) in [
            (Law::Laplace, 7.830_007_258_491_47),
            (Law::Student(4.0), 7.847_521_627_337_834),
            (Law::Poisson, 10.142_113_527_483_257),
        ] {
            let weights = if law == Law::Poisson { [1.0; 6] } else { WEIGHTS };
            let found = all(law, Deviation::Given).fitness(&simulated(0.2), &MEASURED, &weights);
            assert!((found - expected).abs() < 1e-10, "{law:?}: {found} instead of {expected}");
        }
    }

    /// SciPy 1.17: `-2 norm.logcdf(-u)`, and its hazard.
    #[test]
    fn limits_have_the_probability_of_the_tail() {
        for (u, twice, hazard) in [
            (-3.0, 0.002_701_619_929_496_385, 0.004_437_839_042_125_666),
            (0.5, 2.351_823_523_187_237_5, 1.141_077_770_368_064_8),
            (8.0, 70.026_874_319_829_12, 8.121_368_112_236_18),
            (40.0, 1_609.216_884_027_507_8, 40.024_968_847_210_886),
        ] {
            for (law, side) in [(Law::Below, 1.0), (Law::Above, -1.0)] {
                let found = law.twice(side * u);
                assert!((found / twice - 1.0).abs() < 1e-10, "{u}: {found} {twice}");
                let found = law.residual(side * u) * law.factor(side * u);
                assert!((found / (side * hazard) - 1.0).abs() < 1e-9, "{u}: {found} {hazard}");
            }
        }
    }

    /// The scales are those that SciPy finds to be most likely: for Laplace the mean absolute error.
    #[test]
    fn estimated_scales_are_most_likely() {
        for law in [Law::Laplace, Law::Student(4.0), Law::Student(1.5)] {
            let own = all(law, Deviation::Group(0));
            let found = own.fitness(&simulated(0.2), &MEASURED, &WEIGHTS);
            let root = law.root_information(0.0);
            let at = own.error_weights(&simulated(0.2), &MEASURED, &WEIGHTS).unwrap();
            let scale = WEIGHTS[0] * root / at[0];
            if law == Law::Laplace {
                let s = simulated(0.2);
                let sum: f64 = (0..6).map(|k| WEIGHTS[k] * (s[k] - MEASURED[k]).abs()).sum();
                assert!((scale - sum / 6.0).abs() < 1e-12, "{scale}");
            }
            let given = |scale: f64| {
                let weights = WEIGHTS.map(|w| w / scale);
                all(law, Deviation::Given).fitness(&simulated(0.2), &MEASURED, &weights)
            };
            assert!((found - given(scale)).abs() < 1e-10, "{law:?}: {found} {}", given(scale));
            assert!(given(1.01 * scale) > found && given(0.99 * scale) > found, "{law:?}");
        }
    }

    /// Σ r² = n exp(2 (-log L - constant)/n), and its derivative is 2 Σ f r ∂ŷ/∂p.
    #[test]
    fn squares_and_their_gradient_are_those_of_the_likelihood() {
        for (law, deviation) in [
            (Law::Laplace, Deviation::Given),
            (Law::Laplace, Deviation::Group(0)),
            (Law::Student(4.0), Deviation::Given),
            (Law::Student(4.0), Deviation::Group(0)),
            (Law::Poisson, Deviation::Given),
            (Law::Below, Deviation::Given),
            (Law::Above, Deviation::Given),
        ] {
            let own = all(law, deviation);
            let weights = if law == Law::Poisson { [1.0; 6] } else { WEIGHTS };
            let (mut r, mut f) = ([0.0; 6], [0.0; 6]);
            let mut square = |p: f64| {
                assert!(own.scaled([&simulated(p), &MEASURED, &weights], &mut r, &mut f));
                (r.iter().map(|r| r * r).sum::<f64>(), r, f)
            };
            let value = |p: f64| own.fitness(&simulated(p), &MEASURED, &weights);
            let ratio = (value(0.35) - value(0.2)) / 3.0;
            let found = (square(0.35).0 / square(0.2).0).ln();
            assert!((found - ratio).abs() < 1e-10, "{law:?}: {found} {ratio}");
            let h = 1e-6;
            let expected = (square(0.2 + h).0 - square(0.2 - h).0) / (2.0 * h);
            let (_, r, f) = square(0.2);
            let derivative = [1.0, 0.0, -1.0, 0.4, -2.0, 1.0];
            let found: f64 = (0..6).map(|k| 2.0 * f[k] * r[k] * derivative[k]).sum();
            assert!((found - expected).abs() < 1e-6 * expected.abs(), "{found} {expected}");
        }
    }
}
