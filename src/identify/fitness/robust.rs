//! Robust fitness functions of the weighted differences: Huber's, Tukey's biweight, mean absolute.
//!
//! `delta` counts standard deviations of the errors. These are those of the given sigmas, or a
//! scale s is estimated: during the search with the parameters (Huber's proposal 2, which has a
//! gradient), at its end as s = 1.4826 median |r| (MAD), with which the fit is repeated.
//!
//! ```text
//! search:   Σ min(r²/σ², δ²) = n E min(u², δ²), u normal, gives σ; fitness F²/n, F = Σ r ψ(r/σ)
//! at last:  s² Σ 2ρ(r/s)
//! ```
//!
//! Both are sums of squares when nothing lies beyond `delta`. As least squares: r √(F w/(n σ))
//! with w = ψ(u)/u in the search, √(2ρ) at last; their gradients are exact. The covariance of the
//! parameters is that of M-estimators, v (JᵀJ)⁻¹ (Huber 1981, (7.6.5)).
//!
//! Reference: [Huber & Ronchetti 2009](gapilib_base::bibliography#huber-ronchetti-2009), chapters 6, 7.

use super::{Fitness, Robustness, checked, differences};
use crate::elementary;
use crate::problem::distributions::{normal_density, normal_two_sided};
use crate::registry::Entry;

/// 95 % efficient for normal errors.
const HUBER: f64 = 1.345;
const TUKEY: f64 = 4.685;
/// The absolute value is rounded off below this many standard deviations, for least squares.
const ROUNDED: f64 = 0.05;
/// The same during the search, where the scale is not known.
const ROUNDED_IN_SEARCH: f64 = 0.3;
/// Efficiency of the MAD as an estimate of a normal standard deviation: its relative variance is that
/// of so many times the degrees of freedom (Huber & Ronchetti, table 5.1).
const MAD_EFFICIENCY: f64 = 0.37;
/// Steps of Newton's iteration for the scale; it ends after a few.
const STEPS: usize = 60;

/// Huber's function.
pub(crate) const HUBER_ENTRY: Entry<dyn Fitness> = Entry {
    name: "huber",
    aliases: &[],
    summary: "Huber loss: quadratic for small and linear for large differences; settings \
              `delta`, `scale`",
    reference: "huber-ronchetti-2009",
    make: |options| {
        let delta = options.take("delta", 1e-3..=f64::MAX, HUBER)?;
        let scale = options.take("scale", 0.0..=f64::MAX, 0.0)?;
        Ok(Box::new(Robust { loss: Loss::Huber, delta, scale }))
    },
};

/// Tukey's biweight.
pub(crate) const TUKEY_ENTRY: Entry<dyn Fitness> = Entry {
    name: "tukey",
    aliases: &["biweight"],
    summary: "Tukey's biweight loss: quadratic for small differences, constant for large ones; \
              settings `delta`, `scale`",
    reference: "huber-ronchetti-2009",
    make: |options| {
        let delta = options.take("delta", 1e-3..=f64::MAX, TUKEY)?;
        let scale = options.take("scale", 0.0..=f64::MAX, 0.0)?;
        Ok(Box::new(Robust { loss: Loss::Tukey, delta, scale }))
    },
};

/// Mean absolute difference.
pub(crate) const ABSOLUTE_ENTRY: Entry<dyn Fitness> = Entry {
    name: "mae",
    aliases: &["mean_absolute"],
    summary: "mean absolute difference",
    reference: "huber-ronchetti-2009",
    make: |options| {
        let scale = options.take("scale", 0.0..=f64::MAX, 0.0)?;
        Ok(Box::new(Robust { loss: Loss::Absolute, delta: ROUNDED, scale }))
    },
};

#[derive(Debug, Clone, Copy, PartialEq)]
enum Loss {
    Huber,
    Tukey,
    Absolute,
}

#[derive(Debug, Clone, Copy)]
struct Robust {
    loss: Loss,
    delta: f64,
    /// The standard deviation of the weighted differences; 0 while it is estimated.
    scale: f64,
}

impl Robust {
    /// ρ, its derivative ψ and the derivative of that.
    fn at(&self, u: f64) -> [f64; 3] {
        let (delta, size) = (self.delta, u.abs());
        match self.loss {
            Loss::Huber | Loss::Absolute if size <= delta => [0.5 * u * u, u, 1.0],
            Loss::Huber | Loss::Absolute => [delta * (size - 0.5 * delta), delta.copysign(u), 0.0],
            Loss::Tukey if size >= delta => [delta * delta / 6.0, 0.0, 0.0],
            Loss::Tukey => {
                let q = 1.0 - elementary::powi(u / delta, 2);
                let rho = delta * delta / 6.0 * (1.0 - elementary::powi(q, 3));
                [rho, u * q * q, q * (5.0 * q - 4.0)]
            }
        }
    }

    /// δ of Huber's function during the search.
    fn search_delta(&self) -> f64 {
        match self.loss {
            Loss::Huber => self.delta,
            Loss::Tukey => HUBER,
            Loss::Absolute => ROUNDED_IN_SEARCH,
        }
    }

    /// Huber's proposal 2: the scale of the differences, and F.
    fn proposal(&self, differences: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
        let delta = self.search_delta();
        let outside = normal_two_sided(delta);
        let b = 1.0 - outside - 2.0 * delta * normal_density(delta) + delta * delta * outside;
        let (n, square) =
            differences.clone().fold((0.0, 0.0), |(n, sum), r| (n + 1.0, sum + r * r));
        // Σ min(r², δ² v) - n b v is concave in v = σ²: from above, Newton's steps fall to its root.
        let mut v: f64 = square / (n * b);
        for _ in 0..STEPS {
            let (inside, count) = differences.clone().fold((0.0, 0.0), |(sum, count), r| {
                if r * r <= delta * delta * v { (sum + r * r, count) } else { (sum, count + 1.0) }
            });
            let next = inside / (n * b - count * delta * delta);
            if next.is_nan() || next >= v || next <= 0.0 {
                break;
            }
            v = next;
        }
        let sigma = v.sqrt();
        let f = differences.map(|r| r.abs() * r.abs().min(delta * sigma) / sigma).sum();
        (sigma, f)
    }
}

impl Fitness for Robust {
    fn fitness(&self, simulated: &[f64], measured: &[f64], weights: &[f64]) -> f64 {
        let own = differences(simulated, measured, weights);
        let n = measured.len() as f64;
        if self.loss == Loss::Absolute {
            return checked(own.map(f64::abs).sum::<f64>() / n);
        }
        let value = if self.scale > 0.0 {
            let s = self.scale;
            2.0 * s * s * own.map(|r| self.at(r / s)[0]).sum::<f64>()
        } else {
            let differences: Vec<f64> = own.collect();
            let (sigma, f) = self.proposal(differences.iter().copied());
            // An exact fit has no scale.
            if sigma == 0.0 { 0.0 } else { f * f / n }
        };
        // A rejected NaN would be taken for an outlier.
        let failed = simulated.iter().any(|value| value.is_nan());
        checked(if failed { f64::NAN } else { value })
    }

    fn least_squares(&self, _: &[f64], weights: &[f64]) -> Option<Vec<f64>> {
        Some(weights.to_vec())
    }

    fn scaled(
        &self,
        [simulated, measured, weights]: [&[f64]; 3],
        residuals: &mut [f64],
        factors: &mut [f64],
    ) -> bool {
        for (r, difference) in residuals.iter_mut().zip(differences(simulated, measured, weights)) {
            *r = -difference;
        }
        if self.scale > 0.0 {
            for ((r, factor), w) in residuals.iter_mut().zip(factors).zip(weights) {
                let u = *r / self.scale;
                let [rho, psi, _] = self.at(u);
                // The limit of √(2ρ)/|u| and of ψ/√(2ρ) at 0 is 1.
                let root = if u.abs() < 1e-8 { u } else { (2.0 * rho).sqrt().copysign(u) };
                *factor = if u.abs() < 1e-8 { *w } else { w * psi / root };
                *r = if u.is_nan() { f64::NAN } else { self.scale * root };
            }
            return true;
        }
        let (sigma, f) = self.proposal(residuals.iter().copied());
        if sigma == 0.0 || sigma.is_nan() {
            factors.copy_from_slice(weights);
            return true;
        }
        let (delta, n) = (self.search_delta() * sigma, weights.len() as f64);
        for ((r, factor), w) in residuals.iter_mut().zip(factors).zip(weights) {
            let part = if r.abs() <= delta { 1.0 } else { delta / r.abs() };
            let own = (f / (n * sigma) * part).sqrt();
            *factor = own * w;
            *r *= own;
        }
        true
    }

    fn with_scale(&self, scale: f64) -> Option<Box<dyn Fitness>> {
        (self.scale == 0.0).then(|| Box::new(Robust { scale, ..*self }) as Box<dyn Fitness>)
    }

    fn robustness(&self, residuals: &[f64], freedom: f64) -> Option<Robustness> {
        let n = residuals.len() as f64;
        let scale = match self.scale {
            0.0 => self.proposal(residuals.iter().copied()).0,
            scale => scale,
        };
        let parts: Vec<[f64; 3]> = residuals.iter().map(|r| self.at(r / scale)).collect();
        let square: f64 = parts.iter().map(|part| part[1] * part[1]).sum::<f64>() / freedom;
        if self.loss == Loss::Absolute {
            let density = density_at_zero(residuals) * scale;
            // ψ = ± δ beyond the rounding; its mean derivative is 2 δ times the density at 0.
            let variance = scale * scale * n / freedom / (4.0 * density * density);
            return Some(Robustness {
                variance,
                freedom: MAD_EFFICIENCY * freedom,
                scale,
                rise: square / (2.0 * self.delta * density),
            });
        }
        let mean = parts.iter().map(|part| part[2]).sum::<f64>() / n;
        let spread = parts.iter().map(|part| elementary::powi(part[2] - mean, 2)).sum::<f64>() / n;
        // Huber's correction for small samples.
        let k = 1.0 + (n - freedom) / n * spread / (mean * mean);
        let variance = scale * scale * k * k * square / (mean * mean);
        Some(Robustness { variance, freedom: MAD_EFFICIENCY * freedom, scale, rise: square / mean })
    }
}

/// The density of the residuals at 0: the share within ±h, h by the normal rule from the MAD.
fn density_at_zero(residuals: &[f64]) -> f64 {
    let n = residuals.len() as f64;
    let h = 1.06 * super::median_deviation(residuals) * elementary::powf(n, -0.2);
    let inside = residuals.iter().filter(|r| r.abs() <= h).count() as f64;
    inside / (2.0 * n * h)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::distributions::normal_quantile;
    use crate::registry::Options;

    fn make(entry: &Entry<dyn Fitness>, scale: f64) -> Box<dyn Fitness> {
        let mut options = Options::default();
        options.set("scale", scale);
        (entry.make)(&mut options).unwrap()
    }

    const MEASURED: [f64; 8] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
    const WEIGHTS: [f64; 8] = [1.0, 1.0, 2.0, 1.0, 1.0, 0.5, 1.0, 1.0];

    fn simulated(p: f64) -> [f64; 8] {
        [1.1 + p, 1.8, 3.1 - p, 4.3, 14.0 + p, 6.4 - p * p, 6.9, 7.7 + 2.0 * p]
    }

    #[test]
    fn squares_grow_with_the_fitness_and_their_gradient_is_exact() {
        let entries =
            [(&HUBER_ENTRY, 0.0), (&HUBER_ENTRY, 0.3), (&TUKEY_ENTRY, 0.0), (&TUKEY_ENTRY, 0.3)];
        for (entry, scale) in entries {
            let own = make(entry, scale);
            let (mut r, mut f) = ([0.0; 8], [0.0; 8]);
            let mut square = |p: f64| {
                assert!(own.scaled([&simulated(p), &MEASURED, &WEIGHTS], &mut r, &mut f));
                (r.iter().map(|r| r * r).sum::<f64>(), r, f)
            };
            let (sum, r0, f0) = square(0.2);
            let value = own.fitness(&simulated(0.2), &MEASURED, &WEIGHTS);
            assert!((sum - value).abs() < 1e-10 * value, "{} {sum} {value}", entry.name);
            let h = 1e-6;
            let expected = (square(0.2 + h).0 - square(0.2 - h).0) / (2.0 * h);
            let derivative = [1.0, 0.0, -1.0, 0.0, 1.0, -0.4, 0.0, 2.0];
            let found: f64 = (0..8).map(|k| 2.0 * f0[k] * r0[k] * derivative[k]).sum();
            assert!((found - expected).abs() < 1e-5 * expected.abs(), "{found} {expected}");
        }
    }

    /// Ten normal quantiles and one outlier: the scale is about 1, not that of the outlier.
    #[test]
    fn the_scale_does_not_follow_an_outlier() {
        let quantile = |k: u32| normal_quantile(f64::from(k) / 41.0);
        let mut r: Vec<f64> = (1..41).map(quantile).collect();
        let own = Robust { loss: Loss::Huber, delta: HUBER, scale: 0.0 };
        let clean = own.proposal(r.iter().copied()).0;
        assert!((clean - 1.0).abs() < 0.1, "{clean}");
        r[0] = 1e6;
        let spoilt = own.proposal(r.iter().copied()).0;
        assert!(spoilt < 1.2, "{spoilt}");
    }

    /// Without anything beyond delta the variance is that of least squares.
    #[test]
    fn without_outliers_the_variance_is_that_of_least_squares() {
        let r = [0.1, -0.2, 0.15, 0.05, -0.1, 0.0];
        let own = Robust { loss: Loss::Huber, delta: 100.0, scale: 1.0 };
        let expected = r.iter().map(|r| r * r).sum::<f64>() / 4.0;
        let found = own.robustness(&r, 4.0).unwrap();
        assert!((found.variance - expected).abs() < 1e-15 && found.rise > 0.0);
    }
}
