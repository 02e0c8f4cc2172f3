//! Quantiles and probabilities of the distributions that tests need, from `statrs`.
//!
//! Where a distribution does not exist (no degree of freedom) the answer is NaN, which no test
//! takes for significant.

use statrs::distribution::{
    Binomial, ChiSquared, ContinuousCDF, DiscreteCDF, FisherSnedecor, Normal, StudentsT,
};
use statrs::function::factorial::ln_binomial;

/// The `p` quantile of Student's distribution with `freedom` degrees of freedom.
pub fn student_quantile(p: f64, freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom).map_or(f64::NAN, |t| t.inverse_cdf(p))
}

/// Probability that a Student variable is farther from 0 than `t`.
pub fn student_two_sided(t: f64, freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom).map_or(f64::NAN, |own| 2.0 * own.sf(t.abs()))
}

/// The `p` quantile of the standard normal distribution.
pub fn normal_quantile(p: f64) -> f64 {
    Normal::standard().inverse_cdf(p)
}

/// Probability that a standard normal variable is farther from 0 than `z`.
pub fn normal_two_sided(z: f64) -> f64 {
    2.0 * Normal::standard().sf(z.abs())
}

/// Probabilities of a smaller and of a larger value of χ².
pub fn chi_square_tails(value: f64, freedom: f64) -> [f64; 2] {
    ChiSquared::new(freedom).map_or([f64::NAN; 2], |own| [own.cdf(value), own.sf(value)])
}

/// The `p` quantile of χ².
pub fn chi_square_quantile(p: f64, freedom: f64) -> f64 {
    ChiSquared::new(freedom).map_or(f64::NAN, |own| own.inverse_cdf(p))
}

/// Probability of a larger ratio of two variances.
pub fn f_upper(ratio: f64, freedom: [f64; 2]) -> f64 {
    FisherSnedecor::new(freedom[0], freedom[1]).map_or(f64::NAN, |own| own.sf(ratio.max(0.0)))
}

/// Probability of a split of `n` signs at least as uneven as `positive` to the rest.
pub fn signs_two_sided(positive: u64, n: u64) -> f64 {
    let least = positive.min(n - positive);
    Binomial::new(0.5, n).map_or(f64::NAN, |own| (2.0 * own.cdf(least)).min(1.0))
}

/// Probability of as few or as many runs by chance among `above` and `below` signs, exactly:
/// twice the smaller tail of the distribution of Wald and Wolfowitz.
pub fn runs_two_sided(runs: usize, above: u64, below: u64) -> f64 {
    if above == 0 || below == 0 {
        return 1.0;
    }
    let all = ln_binomial(above + below, above);
    let choose = |n: u64, k: u64| if k > n { 0.0 } else { (ln_binomial(n, k) - 0.5 * all).exp() };
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
        near(chi_square_tails(3.086_18, 78.0)[0], 2.424_304_037_184_524_4e-40);
        near(f_upper(3.0, [4.0, 10.0]), 0.072_323_222_288_140_21);
        near(signs_two_sided(1, 12), 0.006_347_656_25);
        assert!(student_quantile(0.975, 0.0).is_nan());
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
