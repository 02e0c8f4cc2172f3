//! Quantiles and probabilities of the distributions that tests need.
//!
//! Not those of the crate statrs: its normal probabilities have an error of 4e-11 (version 0.19, erfc
//! of 1.96/√2), and its logarithms and exponentials are those of the platform.
//!
//! Where a distribution does not exist (no degree of freedom) the answer is NaN, which no test
//! takes for significant.

pub(crate) use super::special_functions::ln_gamma;
use super::special_functions::{beta_tails, falls_to, gamma_tails, ln_binomial};
use crate::elementary;

/// The `p` quantile of Student's distribution with `freedom` degrees of freedom.
pub(crate) fn student_quantile(p: f64, freedom: f64) -> f64 {
    match exists(freedom) {
        true => symmetric_quantile(p, |t| student_two_sided(t, freedom)),
        false => f64::NAN,
    }
}

/// Probability that a Student variable is farther from 0 than `t`.
pub(crate) fn student_two_sided(t: f64, freedom: f64) -> f64 {
    if !exists(freedom) || t.is_nan() {
        return f64::NAN;
    }
    let square = t * t;
    let x = [freedom / (freedom + square), 1.0 / (1.0 + freedom / square)];
    beta_tails(0.5 * freedom, 0.5, x)[0]
}

/// The `p` quantile of the standard normal distribution.
pub(crate) fn normal_quantile(p: f64) -> f64 {
    symmetric_quantile(p, normal_two_sided)
}

/// The `p` quantile of a distribution that is symmetric to 0, from the probability that a variable
/// is farther from 0 than a number.
fn symmetric_quantile(p: f64, two_sided: impl Fn(f64) -> f64) -> f64 {
    if !(0.0..=1.0).contains(&p) {
        return f64::NAN;
    }
    let outside = 2.0 * p.min(1.0 - p);
    let size = match outside {
        0.0 => f64::INFINITY,
        1.0 => return 0.0,
        _ => falls_to(outside, two_sided),
    };
    if p < 0.5 { -size } else { size }
}

/// Probability that a standard normal variable is less than `z`.
pub(crate) fn normal_below(z: f64) -> f64 {
    let half = 0.5 * normal_two_sided(z);
    if z < 0.0 { half } else { 1.0 - half }
}

/// Density of the standard normal distribution.
pub(crate) fn normal_density(z: f64) -> f64 {
    elementary::exp(-0.5 * z * z) / std::f64::consts::TAU.sqrt()
}

/// Probability that a standard normal variable is farther from 0 than `z`.
pub(crate) fn normal_two_sided(z: f64) -> f64 {
    if z.is_nan() { f64::NAN } else { gamma_tails(0.5, 0.5 * z * z)[1] }
}

/// Probabilities of a smaller and of a larger value of χ².
pub(crate) fn chi_square_tails(value: f64, freedom: f64) -> [f64; 2] {
    if exists(freedom) && !value.is_nan() {
        gamma_tails(0.5 * freedom, 0.5 * value)
    } else {
        [f64::NAN; 2]
    }
}

/// The `p` quantile of χ².
pub(crate) fn chi_square_quantile(p: f64, freedom: f64) -> f64 {
    if !exists(freedom) || !(0.0..=1.0).contains(&p) {
        return f64::NAN;
    }
    falls_to(1.0 - p, |value| chi_square_tails(value, freedom)[1])
}

/// Probability of a larger ratio of two variances.
pub(crate) fn f_upper(ratio: f64, [above, below]: [f64; 2]) -> f64 {
    if !exists(above) || !exists(below) || ratio.is_nan() {
        return f64::NAN;
    }
    let weight = above * ratio.max(0.0) / below;
    beta_tails(0.5 * below, 0.5 * above, [1.0 / (1.0 + weight), 1.0 / (1.0 + 1.0 / weight)])[0]
}

/// Probability of values at least as far from the mean between -1 and 1, from the beta distribution with
/// this mean and variance.
pub(crate) fn beta_two_sided(value: f64, mean: f64, variance: f64) -> f64 {
    let [place, mean] = [value, mean].map(|own| 0.5 * (1.0 + own));
    let both = mean * (1.0 - mean) / (0.25 * variance) - 1.0;
    if both.is_nan() || both <= 0.0 {
        return f64::NAN;
    }
    let [lower, upper] = beta_tails(mean * both, (1.0 - mean) * both, [place, 1.0 - place]);
    2.0 * lower.min(upper)
}

/// Probability of a split of `n` signs at least as uneven as `positive` to the rest.
pub(crate) fn signs_two_sided(positive: u64, n: u64) -> f64 {
    let least = positive.min(n - positive) as f64;
    (2.0 * beta_tails(n as f64 - least, least + 1.0, [0.5; 2])[0]).min(1.0)
}

fn exists(freedom: f64) -> bool {
    freedom > 0.0 && freedom.is_finite()
}

/// Probability of as few or as many runs by chance among `above` and `below` signs, exactly:
/// twice the smaller tail of the distribution of Wald and Wolfowitz.
pub(crate) fn runs_two_sided(runs: usize, above: u64, below: u64) -> f64 {
    if above == 0 || below == 0 {
        return 1.0;
    }
    let all = ln_binomial(above + below, above);
    let choose =
        |n: u64, k: u64| if k > n { 0.0 } else { elementary::exp(ln_binomial(n, k) - 0.5 * all) };
    let probability = |runs: u64| {
        let half = runs / 2;
        match runs % 2 {
            0 => 2.0 * choose(above - 1, half - 1) * choose(below - 1, half - 1),
            _ => {
                choose(above - 1, half) * choose(below - 1, half - 1)
                    + choose(above - 1, half - 1) * choose(below - 1, half)
            }
        }
    };
    let runs = runs as u64;
    let most = (2 * above.min(below) + 1).min(above + below);
    let below: f64 = (2..=runs.min(most)).map(probability).sum();
    let above: f64 = (runs.max(2)..=most).map(probability).sum();
    (2.0 * below.min(above)).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: f64, expected: f64) {
        assert!((found - expected).abs() <= 1e-8 * expected.abs(), "{found} {expected}");
    }

    /// Values of scipy 1.17: stats.t.ppf, stats.t.sf, stats.chi2, stats.f.sf, stats.binom.
    #[test]
    fn quantiles_and_probabilities_are_those_of_scipy() {
        near(student_quantile(0.975, 1.0), 12.706_204_736_174_694);
        near(student_quantile(0.975, 3.0), 3.182_446_305_283_707_8);
        near(student_quantile(0.975, 24.0), 2.063_898_561_628_023_8);
        near(student_two_sided(-4.0, 7.0), 0.005_189_913_349_296_813);
        near(normal_two_sided(1.96), 0.049_995_790_296_440_87);
        near(normal_two_sided(9.0), 2.257_176_811_907_681e-19);
        near(normal_below(-3.0), 0.001_349_898_031_630_094_6);
        near(chi_square_tails(3.086_18, 78.0)[0], 2.424_304_037_184_524_4e-40);
        near(f_upper(3.0, [4.0, 10.0]), 0.072_323_222_288_140_21);
        near(signs_two_sided(1, 12), 0.006_347_656_25);
        assert!(student_quantile(0.975, 0.0).is_nan());
    }

    /// Values of the inverse error function with 60 digits.
    #[test]
    fn normal_quantiles_have_fifteen_digits() {
        let table = [
            (0.975, 1.959_963_984_540_054_2),
            (0.6, 0.253_347_103_135_799_8),
            (0.9999, 3.719_016_485_455_708_4),
            (1e-20, -9.262_340_089_798_408),
        ];
        for (p, expected) in table {
            let found = normal_quantile(p);
            assert!((found - expected).abs() <= 4e-15 * expected.abs(), "{found} {expected}");
        }
        assert_eq!(normal_quantile(0.5), 0.0);
        assert_eq!(normal_quantile(0.0), f64::NEG_INFINITY);
        assert!(normal_quantile(1.5).is_nan());
    }

    /// A quantile is where its probability is reached.
    #[test]
    fn quantiles_invert_probabilities() {
        for freedom in [1.0, 2.0, 7.5, 400.0] {
            let t = student_quantile(0.9, freedom);
            assert!((student_two_sided(t, freedom) - 0.2).abs() < 1e-12);
            // 1 - 0.9 is not 0.1 to the last bit.
            assert!((student_quantile(0.1, freedom) + t).abs() < 1e-13 * t);
            let value = chi_square_quantile(0.9, freedom);
            assert!((chi_square_tails(value, freedom)[0] - 0.9).abs() < 1e-12);
        }
        assert_eq!(student_quantile(0.5, 3.0), 0.0);
    }

    /// All 70 orders of four and four signs, counted.
    #[test]
    fn runs_are_counted_exactly() {
        let mut counts = [0usize; 9];
        for word in 0u32..256 {
            if word.count_ones() == 4 {
                let runs = 1 + (0..7).filter(|k| (word >> k ^ word >> (k + 1)) & 1 == 1).count();
                counts[runs] += 1;
            }
        }
        for runs in 2..=8 {
            let tail =
                |from: usize, to: usize| counts[from..=to].iter().sum::<usize>() as f64 / 70.0;
            let expected = (2.0 * tail(2, runs).min(tail(runs, 8))).min(1.0);
            let found = runs_two_sided(runs, 4, 4);
            assert!((found - expected).abs() < 1e-12, "{runs}: {found} {expected}");
        }
        assert_eq!(runs_two_sided(1, 5, 0), 1.0);
    }
}
