//! Tests of residuals that need no distribution of their own: serial correlation, mean, spread,
//! normality.
//!
//! The residuals of a fit are not independent: what the parameters follow is missing from them. With
//! the orthonormal basis Q of that, their covariance is that of noise times S = 1 − Q Qᵀ, from which mean
//! and variance of the correlation of neighbours follow as Durbin and Watson (1950) have them; it is
//! compared with the beta distribution that has both.
//!
//! References: [Wald & Wolfowitz 1940](gapilib_base::bibliography#wald-wolfowitz-1940) (runs);
//! [Durbin & Watson 1950](gapilib_base::bibliography#durbin-watson-1950) (correlation);
//! [Anderson & Darling 1952](gapilib_base::bibliography#anderson-darling-1952), p-values of D'Agostino and
//! Stephens 1986, table 4.9, for mean and variance estimated (normality).

use super::distributions::{
    beta_two_sided, normal_below, normal_two_sided, runs_two_sided, student_two_sided,
};
use crate::elementary;
use nalgebra::{DMatrix, DVector};

/// With more degrees of freedom, the beta distribution is the normal one to 1e-3 of probabilities of 1e-3.
const MANY: f64 = 5000.0;

/// Whether residuals in the order of X look like noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ResidualTest {
    /// Runs of the same sign.
    pub runs: usize,
    /// How many would be expected.
    pub(crate) expected_runs: f64,
    /// Probability of as few or as many runs by chance.
    pub(crate) runs_probability: f64,
    /// Correlation of neighbours.
    pub(crate) autocorrelation: f64,
    /// Probability of a correlation as far from 0 by chance.
    pub(crate) autocorrelation_probability: f64,
}

/// The tests of residuals in their order; `None` for fewer than three. `followed`: rows of an orthonormal
/// basis of what the parameters follow.
pub(crate) fn residual_test(residuals: &[f64], followed: &DMatrix<f64>) -> Option<ResidualTest> {
    let n = residuals.len();
    if n < 3 {
        return None;
    }
    let signs: Vec<bool> = residuals.iter().map(|r| *r >= 0.0).collect();
    let runs = 1 + signs.windows(2).filter(|pair| pair[0] != pair[1]).count();
    let above = signs.iter().filter(|sign| **sign).count();
    let below = n - above;
    let count = n as f64;
    let mean = mean(residuals);
    let square: f64 = residuals.iter().map(|r| elementary::powi(r - mean, 2)).sum();
    let neighbours: f64 =
        residuals.windows(2).map(|pair| (pair[0] - mean) * (pair[1] - mean)).sum();
    let autocorrelation = if square > 0.0 { neighbours / square } else { 0.0 };
    Some(ResidualTest {
        runs,
        expected_runs: 1.0 + 2.0 * above as f64 * below as f64 / count,
        runs_probability: runs_two_sided(runs, above as u64, below as u64),
        autocorrelation,
        autocorrelation_probability: by_chance(autocorrelation, followed),
    })
}

/// Probability of a correlation of neighbours at least as far from its mean, in the residuals of white noise.
/// NaN where the parameters follow all but two degrees of freedom.
fn by_chance(autocorrelation: f64, followed: &DMatrix<f64>) -> f64 {
    let n = followed.nrows();
    let count = n as f64;
    // The mean is taken from the residuals as well.
    let mut columns = vec![DVector::from_element(n, 1.0 / count.sqrt())];
    columns.extend(followed.column_iter().map(|own| own.add_scalar(-own.mean())));
    let basis = DMatrix::from_columns(&columns);
    // Half the sum of both neighbours, whose product with the residuals is their correlation.
    let neighbours = DMatrix::from_fn(n, basis.ncols(), |j, c| {
        let at = |j: Option<usize>| j.and_then(|j| basis.get((j, c))).copied().unwrap_or(0.0);
        0.5 * (at(j.checked_sub(1)) + at(Some(j + 1)))
    });
    let (own, product) = (basis.tr_mul(&basis), basis.tr_mul(&neighbours));
    let squared = |own: &DMatrix<f64>| own.component_mul(&own.transpose()).sum();
    // Traces of S, S², B S and (B S)², where r = eᵀ B e / eᵀ e.
    let trace = count - own.trace();
    let of_square = count - 2.0 * own.trace() + squared(&own);
    let first = -product.trace();
    let second = 0.5 * (count - 1.0) - 2.0 * neighbours.norm_squared() + squared(&product);
    // As of a projection to so many dimensions: S is one where the series is all of the data.
    let freedom = trace * trace / of_square;
    if freedom.is_nan() || freedom <= 2.0 {
        return f64::NAN;
    }
    let mean = first / trace;
    let of_second = second * freedom / of_square - mean * mean * freedom;
    let variance = 2.0 * of_second / (freedom * (freedom + 2.0));
    match freedom > MANY {
        true => normal_two_sided((autocorrelation - mean) / variance.sqrt()),
        false => beta_two_sided(autocorrelation, mean, variance),
    }
}

pub(in super::super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Standard deviation about the mean; NaN for one value.
pub(in super::super) fn deviation(values: &[f64]) -> f64 {
    let mean = mean(values);
    let square: f64 = values.iter().map(|v| elementary::powi(v - mean, 2)).sum();
    (square / (values.len() as f64 - 1.0)).sqrt()
}

/// Standard deviation of independent noise beneath a slow pattern, from successive differences
/// (von Neumann 1941).
pub(in super::super) fn noise_beneath(values: &[f64]) -> f64 {
    let square: f64 = values.windows(2).map(|pair| elementary::powi(pair[1] - pair[0], 2)).sum();
    (0.5 * square / (values.len() as f64 - 1.0)).sqrt()
}

/// Spearman's rank correlation and its probability by chance, from Student's distribution.
pub(in super::super) fn spearman(a: &[f64], b: &[f64]) -> (f64, f64) {
    let (a, b) = (ranks(a), ranks(b));
    let (ma, mb) = (mean(&a), mean(&b));
    let product: f64 = a.iter().zip(&b).map(|(a, b)| (a - ma) * (b - mb)).sum();
    let square = |v: &[f64], m: f64| v.iter().map(|v| elementary::powi(v - m, 2)).sum::<f64>();
    let size = (square(&a, ma) * square(&b, mb)).sqrt();
    if size == 0.0 {
        return (0.0, 1.0);
    }
    let rho = (product / size).clamp(-1.0, 1.0);
    let freedom = a.len() as f64 - 2.0;
    let t = rho * (freedom / (1.0 - rho * rho).max(1e-300)).sqrt();
    (rho, student_two_sided(t, freedom))
}

/// Ranks from 1; equal values share the mean of theirs.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    while first < order.len() {
        let same =
            order[first..].iter().take_while(|k| values[**k] == values[order[first]]).count();
        let rank = first as f64 + 0.5 * (same as f64 + 1.0);
        order[first..first + same].iter().for_each(|k| ranks[*k] = rank);
        first += same;
    }
    ranks
}

/// Probability of values that are as far from normal ones, mean and variance estimated: the test of
/// Anderson and Darling, which weighs the tails. NaN for fewer than eight values.
pub(in super::super) fn normality(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let (mean, size) = (mean(values), deviation(values));
    if n < 8.0 || size.is_nan() || size <= 0.0 {
        return f64::NAN;
    }
    let mut z: Vec<f64> = values.iter().map(|v| (v - mean) / size).collect();
    z.sort_by(f64::total_cmp);
    let part = |k: usize| {
        let ln = |p: f64| elementary::ln(p.max(f64::MIN_POSITIVE));
        (2 * k + 1) as f64 * (ln(normal_below(z[k])) + ln(normal_below(-z[z.len() - 1 - k])))
    };
    let a = -n - (0..z.len()).map(part).sum::<f64>() / n;
    let a = a * (1.0 + 0.75 / n + 2.25 / (n * n));
    let p = match a {
        a if a >= 0.6 => elementary::exp(1.2937 - 5.709 * a + 0.0186 * a * a),
        a if a > 0.34 => elementary::exp(0.9177 - 4.279 * a - 1.38 * a * a),
        a if a > 0.2 => 1.0 - elementary::exp(-8.318 + 42.796 * a - 59.938 * a * a),
        a => 1.0 - elementary::exp(-13.436 + 101.14 * a - 223.73 * a * a),
    };
    // Beyond 13 the formula, a parabola, would rise again.
    if a > 13.0 { 0.0 } else { p.clamp(0.0, 1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::statistics::outliers::basis;

    fn alone(residuals: &[f64]) -> Option<ResidualTest> {
        residual_test(residuals, &DMatrix::zeros(residuals.len(), 0))
    }

    /// A basis of polynomials of this degree, as smooth models follow them.
    fn polynomials(n: usize, degree: i32) -> DMatrix<f64> {
        let column = |power: i32| -> Vec<f64> {
            (0..n).map(|j| elementary::powi(j as f64 / n as f64 - 0.5, power)).collect()
        };
        let columns: Vec<Vec<f64>> = (0..=degree).map(column).collect();
        basis(&columns, &(0..n).collect::<Vec<usize>>())
    }

    /// Residuals of white noise have correlated neighbours as often as the level says, and those of
    /// correlated noise much more often: fits with one to five parameters to 10 to 60 points.
    #[test]
    fn white_noise_has_correlated_neighbours_as_often_as_the_level_says() {
        const DRAWS: usize = 4000;
        let mut rng = crate::ga::Mrg32k3a::new(&[2006.0; 6]).unwrap();
        for (n, degree) in [(10, 0), (10, 2), (20, 4), (40, 1), (60, 3)] {
            let followed = polynomials(n, degree);
            let mut share = |memory: f64, level: f64| {
                let is_below = |_: &usize| {
                    let mut last = 0.0;
                    let mut next = || {
                        last = memory * last + rng.normal();
                        last
                    };
                    let noise = DVector::from_fn(n, |_, _| next());
                    let left = &noise - &followed * followed.tr_mul(&noise);
                    let test = residual_test(left.as_slice(), &followed).unwrap();
                    test.autocorrelation_probability < level
                };
                (0..DRAWS).filter(is_below).count() as f64 / DRAWS as f64
            };
            for level in [0.05_f64, 0.01] {
                let error = (level * (1.0 - level) / DRAWS as f64).sqrt();
                let found = share(0.0, level);
                assert!((found - level).abs() < 4.0 * error, "{n} {degree} {level}: {found}");
            }
            let found = share(0.7, 0.01);
            assert!(found > 0.05 || n < 20, "{n} {degree}: {found}");
        }
    }

    #[test]
    fn waves_are_not_noise_and_noise_is() {
        let wave: Vec<f64> = (0..60).map(|k| (f64::from(k) / 10.0).sin()).collect();
        let test = alone(&wave).unwrap();
        assert_eq!(test.runs, 2);
        assert!(test.runs_probability < 1e-6 && test.autocorrelation > 0.9);
        assert!(test.autocorrelation_probability < 1e-6);
        let mut rng = crate::ga::Mrg32k3a::new(&[12345.0; 6]).unwrap();
        let noise: Vec<f64> = (0..60).map(|_| rng.normal()).collect();
        let test = alone(&noise).unwrap();
        assert!(test.runs_probability > 0.01 && test.autocorrelation_probability > 0.01);
        assert!((noise_beneath(&noise) / deviation(&noise) - 1.0).abs() < 0.2);
    }

    /// scipy.stats.spearmanr of the same values.
    #[test]
    fn ranks_are_correlated_as_scipy_does() {
        let a = [1.0, 2.0, 2.0, 4.0, 5.0, 6.0, 7.0, 8.0];
        let b = [2.0, 1.0, 4.0, 3.0, 7.0, 8.0, 6.0, 5.0];
        let (rho, p) = spearman(&a, &b);
        assert!((rho - 0.7065994945288229).abs() < 1e-12, "{rho}");
        assert!((p - 0.05006339467042145).abs() < 1e-9, "{p}");
    }

    #[test]
    fn heavy_tails_are_not_normal() {
        let grid =
            |f: fn(f64) -> f64| -> Vec<f64> { (1..80).map(|k| f(f64::from(k) / 80.0)).collect() };
        let normal = grid(super::super::distributions::normal_quantile);
        assert!(normality(&normal) > 0.9, "{}", normality(&normal));
        let cauchy = grid(|p| (std::f64::consts::PI * (p - 0.5)).tan());
        assert!(normality(&cauchy) < 1e-6, "{}", normality(&cauchy));
        assert!(normality(&normal[..5]).is_nan());
    }
}
