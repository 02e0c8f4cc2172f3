//! Quantiles and probabilities of the distributions that tests need.
//!
//! Where a distribution does not exist (no degree of freedom) the answer is NaN, which no test
//! takes for significant.

use super::special_functions::{beta_tails, falls_to, gamma_tails, ln_binomial};
use crate::elementary;

/// The `p` quantile of Student's distribution with `freedom` degrees of freedom.
pub fn student_quantile(p: f64, freedom: f64) -> f64 {
    if !exists(freedom) || !(0.0..=1.0).contains(&p) {
        return f64::NAN;
    }
    let outside = 2.0 * p.min(1.0 - p);
    if outside == 1.0 {
        return 0.0;
    }
    let size = falls_to(outside, |t| student_two_sided(t, freedom));
    if p < 0.5 { -size } else { size }
}

/// Probability that a Student variable is farther from 0 than `t`.
pub fn student_two_sided(t: f64, freedom: f64) -> f64 {
    if !exists(freedom) || t.is_nan() {
        return f64::NAN;
    }
    let square = t * t;
    let x = [freedom / (freedom + square), 1.0 / (1.0 + freedom / square)];
    beta_tails(0.5 * freedom, 0.5, x)[0]
}

/// The `p` quantile of the standard normal distribution, to 16 digits by the rational functions of
/// Wichura (Applied Statistics 37 (1988), algorithm AS 241).
pub fn normal_quantile(p: f64) -> f64 {
    const CENTRE: [[f64; 8]; 2] = [
        [
            3.387_132_872_796_366_5,
            133.141_667_891_784_38,
            1_971.590_950_306_551_4,
            13_731.693_765_509_46,
            45_921.953_931_549_87,
            67_265.770_927_008_7,
            33_430.575_583_588_13,
            2_509.080_928_730_122_7,
        ],
        [
            1.0,
            42.313_330_701_600_91,
            687.187_007_492_057_9,
            5_394.196_021_424_751,
            21_213.794_301_586_597,
            39_307.895_800_092_71,
            28_729.085_735_721_943,
            5_226.495_278_852_854,
        ],
    ];
    const TAIL: [[f64; 8]; 2] = [
        [
            1.423_437_110_749_683_5,
            4.630_337_846_156_546,
            5.769_497_221_460_691,
            3.647_848_324_763_204_5,
            1.270_458_252_452_368_4,
            0.241_780_725_177_450_6,
            0.022_723_844_989_269_184,
            7.745_450_142_783_414e-4,
        ],
        [
            1.0,
            2.053_191_626_637_759,
            1.676_384_830_183_803_8,
            0.689_767_334_985_1,
            0.148_103_976_427_480_08,
            0.015_198_666_563_616_457,
            5.475_938_084_995_345e-4,
            1.050_750_071_644_416_9e-9,
        ],
    ];
    const FAR: [[f64; 8]; 2] = [
        [
            6.657_904_643_501_103,
            5.463_784_911_164_114,
            1.784_826_539_917_291_3,
            0.296_560_571_828_504_87,
            0.026_532_189_526_576_124,
            0.001_242_660_947_388_078_4,
            2.711_555_568_743_487_6e-5,
            2.010_334_399_292_288_1e-7,
        ],
        [
            1.0,
            0.599_832_206_555_888,
            0.136_929_880_922_735_8,
            0.014_875_361_290_850_615,
            7.868_691_311_456_133e-4,
            1.846_318_317_510_054_8e-5,
            1.421_511_758_316_446e-7,
            2.044_263_103_389_939_8e-15,
        ],
    ];
    let ratio = |[above, below]: [[f64; 8]; 2], x: f64| {
        let polynomial = |all: [f64; 8]| all.iter().rev().fold(0.0, |sum, next| sum * x + next);
        polynomial(above) / polynomial(below)
    };
    if !(0.0..=1.0).contains(&p) {
        return f64::NAN;
    }
    let off = p - 0.5;
    if off.abs() <= 0.425 {
        return off * ratio(CENTRE, 0.180_625 - off * off);
    }
    let tail = p.min(1.0 - p);
    if tail <= 0.0 {
        return f64::INFINITY.copysign(off);
    }
    let root = (-elementary::ln(tail)).sqrt();
    let size = if root <= 5.0 { ratio(TAIL, root - 1.6) } else { ratio(FAR, root - 5.0) };
    size.copysign(off)
}

/// Probability that a standard normal variable is less than `z`.
pub fn normal_below(z: f64) -> f64 {
    let half = 0.5 * normal_two_sided(z);
    if z < 0.0 { half } else { 1.0 - half }
}

/// Density of the standard normal distribution.
pub fn normal_density(z: f64) -> f64 {
    elementary::exp(-0.5 * z * z) / std::f64::consts::TAU.sqrt()
}

/// Probability that a standard normal variable is farther from 0 than `z`.
pub fn normal_two_sided(z: f64) -> f64 {
    if z.is_nan() { f64::NAN } else { gamma_tails(0.5, 0.5 * z * z)[1] }
}

/// Probabilities of a smaller and of a larger value of χ².
pub fn chi_square_tails(value: f64, freedom: f64) -> [f64; 2] {
    if exists(freedom) && !value.is_nan() {
        gamma_tails(0.5 * freedom, 0.5 * value)
    } else {
        [f64::NAN; 2]
    }
}

/// The `p` quantile of χ².
pub fn chi_square_quantile(p: f64, freedom: f64) -> f64 {
    if !exists(freedom) || !(0.0..=1.0).contains(&p) {
        return f64::NAN;
    }
    falls_to(1.0 - p, |value| chi_square_tails(value, freedom)[1])
}

/// Probability of a larger ratio of two variances.
pub fn f_upper(ratio: f64, [above, below]: [f64; 2]) -> f64 {
    if !exists(above) || !exists(below) || ratio.is_nan() {
        return f64::NAN;
    }
    let weight = above * ratio.max(0.0) / below;
    beta_tails(0.5 * below, 0.5 * above, [1.0 / (1.0 + weight), 1.0 / (1.0 + 1.0 / weight)])[0]
}

/// Probability of a split of `n` signs at least as uneven as `positive` to the rest.
pub fn signs_two_sided(positive: u64, n: u64) -> f64 {
    let least = positive.min(n - positive) as f64;
    (2.0 * beta_tails(n as f64 - least, least + 1.0, [0.5; 2])[0]).min(1.0)
}

fn exists(freedom: f64) -> bool {
    freedom > 0.0 && freedom.is_finite()
}

/// Probability of as few or as many runs by chance among `above` and `below` signs, exactly:
/// twice the smaller tail of the distribution of Wald and Wolfowitz.
pub fn runs_two_sided(runs: usize, above: u64, below: u64) -> f64 {
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
