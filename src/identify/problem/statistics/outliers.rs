//! Outliers: externally studentized residuals of the linearized problem, one point after the other
//! left out, so that two outliers do not hide each other.
//!
//! ```text
//! tᵢ = rᵢ / (s₍ᵢ₎ √(1 − hᵢ)),  hᵢ the leverage, s₍ᵢ₎ from the residuals without point i
//! ```
//!
//! With independent normal noise tᵢ follows Student's distribution with one degree of freedom less
//! than the residuals have; the largest of n is compared at 1/n of the level (Bonferroni).
//!
//! Reference: [Cook & Weisberg 1982](gapilib_base::bibliography#cook-weisberg-1982), chapter 2.

use super::distributions::student_two_sided;
use nalgebra::{DMatrix, DVector};

/// At most this part of the points is looked at as outliers: beyond it, it is the distribution.
const PART: f64 = 0.2;

/// A point far from the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in super::super) struct Outlier {
    /// Its place.
    pub point: usize,
    /// Its studentized residual without it.
    pub(crate) studentized: f64,
    /// Probability of one as large by chance among all points.
    pub probability: f64,
}

/// Outliers among weighted residuals at the level `alpha`. `jacobian`: columns of weighted
/// derivatives. Leverages that are not determined count as 1, and such points are never outliers.
pub(in super::super) fn outliers(
    jacobian: &[Vec<f64>],
    residuals: &[f64],
    alpha: f64,
) -> Vec<Outlier> {
    let n = residuals.len();
    let mut kept: Vec<usize> = (0..n).collect();
    let mut found = Vec::new();
    let most = (PART * n as f64) as usize;
    while found.len() < most {
        let Some(worst) = largest(jacobian, residuals, &kept) else { break };
        if worst.probability.is_nan() || worst.probability > alpha {
            break;
        }
        kept.retain(|k| *k != worst.point);
        found.push(worst);
    }
    found
}

/// The largest studentized residual of the points in `kept`.
fn largest(jacobian: &[Vec<f64>], residuals: &[f64], kept: &[usize]) -> Option<Outlier> {
    let basis = basis(jacobian, kept);
    let rank = basis.ncols();
    let freedom = kept.len().checked_sub(rank + 1).filter(|freedom| *freedom >= 2)? as f64;
    let rest = beside(&basis, residuals, kept);
    let square = rest.norm_squared();
    let studentized = |j: usize| {
        let free = 1.0 - basis.row(j).norm_squared();
        if free < 1e-8 {
            return 0.0;
        }
        let without = (square - rest[j] * rest[j] / free).max(0.0) / freedom;
        if without > 0.0 { rest[j] / (without * free).sqrt() } else { 0.0 }
    };
    let all: Vec<f64> = (0..kept.len()).map(studentized).collect();
    let worst = (0..all.len()).max_by(|a, b| all[*a].abs().total_cmp(&all[*b].abs()))?;
    let probability = (kept.len() as f64 * student_two_sided(all[worst], freedom)).min(1.0);
    Some(Outlier { point: kept[worst], studentized: all[worst], probability })
}

/// The residuals of the points in `kept` when the parameters are fitted to these alone.
pub(in super::super) fn rest_of(
    jacobian: &[Vec<f64>],
    residuals: &[f64],
    kept: &[usize],
) -> Vec<f64> {
    beside(&basis(jacobian, kept), residuals, kept).as_slice().to_vec()
}

/// The part of the residuals in `kept` that is orthogonal to the basis.
fn beside(basis: &DMatrix<f64>, residuals: &[f64], kept: &[usize]) -> DVector<f64> {
    let own = DVector::from_iterator(kept.len(), kept.iter().map(|&k| residuals[k]));
    &own - basis * basis.tr_mul(&own)
}

/// An orthonormal basis of the columns, dependent ones left out.
pub(in super::super) fn basis(jacobian: &[Vec<f64>], kept: &[usize]) -> DMatrix<f64> {
    let mut columns: Vec<DVector<f64>> = Vec::new();
    for column in jacobian {
        let own = DVector::from_iterator(kept.len(), kept.iter().map(|&k| column[k]));
        let size = own.norm();
        if size == 0.0 || !size.is_finite() {
            continue;
        }
        let mut rest = own / size;
        // Twice is enough (Kahan).
        for _ in 0..2 {
            for known in &columns {
                let part = known.dot(&rest);
                rest.axpy(-part, known, 1.0);
            }
        }
        let left = rest.norm();
        if left > 1e-7 {
            columns.push(rest / left);
        }
    }
    if columns.is_empty() {
        return DMatrix::zeros(kept.len(), 0);
    }
    DMatrix::from_columns(&columns).resize_vertically(kept.len(), 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line() -> (Vec<Vec<f64>>, Vec<f64>) {
        let mut rng = crate::ga::Mrg32k3a::new(&[12345.0; 6]).unwrap();
        let x: Vec<f64> = (0..40).map(f64::from).collect();
        let noise: Vec<f64> = (0..40).map(|_| 0.1 * rng.normal()).collect();
        (vec![vec![1.0; 40], x], noise)
    }

    #[test]
    fn two_outliers_do_not_hide_each_other_and_noise_has_none() {
        let (jacobian, mut r) = line();
        assert!(outliers(&jacobian, &r, 1e-3).is_empty());
        r[5] += 2.0;
        r[6] += 1.9;
        let mut found: Vec<usize> =
            outliers(&jacobian, &r, 1e-3).iter().map(|outlier| outlier.point).collect();
        found.sort_unstable();
        assert_eq!(found, [5, 6]);
    }

    /// The studentized residual of the textbook: the shift of a mean with a dummy for the point.
    #[test]
    fn one_outlier_has_the_t_value_of_its_dummy_variable() {
        let (mut jacobian, mut r) = line();
        r[39] += 1.0;
        let found = outliers(&jacobian, &r, 0.5)[0];
        let mut dummy = vec![0.0; 40];
        dummy[39] = 1.0;
        jacobian.push(dummy);
        let uncertainty = crate::uncertainty;
        let all: Vec<usize> = (0..40).collect();
        let basis = basis(&jacobian, &all);
        let own = DVector::from_vec(r.clone());
        let rest = &own - &basis * basis.tr_mul(&own);
        let se = uncertainty(&jacobian, rest.as_slice()).unwrap().standard_deviations[2];
        // The last vector of the basis is the dummy without what the line explains of it.
        let last = basis.column(2);
        let shift = last.dot(&own) / last[39];
        assert_eq!(found.point, 39);
        assert!((found.studentized - shift / se).abs() < 1e-9, "{found:?} {}", shift / se);
    }

    #[test]
    fn without_derivatives_residuals_are_compared_as_they_are() {
        let (_, mut r) = line();
        r[7] = 3.0;
        let found = outliers(&[vec![0.0; 40]], &r, 1e-3);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].point, 7);
    }

    #[test]
    fn a_point_that_a_parameter_follows_alone_is_not_an_outlier() {
        let mut spike = vec![0.0; 40];
        spike[3] = 1.0;
        let (mut jacobian, mut r) = line();
        jacobian.push(spike);
        r[3] = 5.0;
        assert!(outliers(&jacobian, &r, 1e-3).iter().all(|outlier| outlier.point != 3));
    }
}
