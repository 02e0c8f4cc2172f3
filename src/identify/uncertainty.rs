//! What the data can tell: standard deviations and correlations of the identified parameters.
//!
//! With the sensitivities J of the simulated points and the residual variance
//! s² = Σ residual² / (points − parameters), the covariance of the parameters is s² (JᵀJ)⁻¹. It is
//! computed from the singular values of J, whose columns are scaled to length one, so that
//! parameters of very different size do not disturb each other. A direction in which the simulation
//! does not change at all has no finite deviation.
//!
//! Reference: [Walter and Pronzato 1997](gapilib_base::bibliography#walter-pronzato-1997), chapter 4.

use crate::elementary;
use crate::singular_values::SingularValues;
use nalgebra::DMatrix;

/// Singular values below this fraction of the largest count as zero.
const RANK_TOLERANCE: f64 = 1e-10;

/// Standard deviations and correlations.
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertainty {
    /// One standard deviation for each parameter, in its unit; infinite where the simulation does
    /// not depend on the parameter, or only together with others.
    pub(crate) standard_deviations: Vec<f64>,
    /// Correlation matrix, row by row; NaN in rows of infinite deviation.
    pub correlations: Vec<f64>,
}

/// From the sensitivities ∂ŷⱼ/∂pₖ (`jacobian[k]` is the column of parameter k) and the residuals;
/// `None` when there are not more points than parameters or a number is not finite.
pub fn uncertainty(jacobian: &[Vec<f64>], residuals: &[f64]) -> Option<Uncertainty> {
    let (points, parameters) = (residuals.len(), jacobian.len());
    if points <= parameters {
        return None;
    }
    let variance = residuals.iter().map(|r| r * r).sum::<f64>() / (points - parameters) as f64;
    uncertainty_given(jacobian, variance)
}

/// From the sensitivities and the variance of the residuals, known or estimated elsewhere; `None`
/// when there are fewer points than parameters or a number is not finite.
pub(crate) fn uncertainty_given(jacobian: &[Vec<f64>], variance: f64) -> Option<Uncertainty> {
    let (points, parameters) = (jacobian.first().map_or(0, Vec::len), jacobian.len());
    let finite = jacobian.iter().flatten().all(|value| value.is_finite()) && variance.is_finite();
    if points < parameters || parameters == 0 || !finite {
        return None;
    }
    let norms: Vec<f64> =
        jacobian.iter().map(|column| column.iter().map(|v| v * v).sum::<f64>().sqrt()).collect();
    let scaled = DMatrix::from_fn(points, parameters, |j, k| {
        if norms[k] > 0.0 { jacobian[k][j] / norms[k] } else { 0.0 }
    });
    let covariance = scaled_covariance(&scaled)?;
    let deviations: Vec<f64> = (0..parameters)
        .map(|k| if norms[k] > 0.0 { covariance[(k, k)].sqrt() / norms[k] } else { f64::INFINITY })
        .map(|deviation| deviation * if deviation.is_finite() { variance.sqrt() } else { 1.0 })
        .collect();
    let correlation = |k: usize, l: usize| {
        let scale = (covariance[(k, k)] * covariance[(l, l)]).sqrt();
        if scale.is_finite() && scale > 0.0 { covariance[(k, l)] / scale } else { f64::NAN }
    };
    let correlations = (0..parameters * parameters)
        .map(|place| correlation(place / parameters, place % parameters))
        .collect();
    Some(Uncertainty { standard_deviations: deviations, correlations })
}

/// (SᵀS)⁻¹; infinite in the rows and columns that take part in a null direction.
fn scaled_covariance(scaled: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let parameters = scaled.ncols();
    let found = SingularValues::of(scaled)?;
    let (directions, largest) = (&found.v_t, found.largest());
    let mut covariance = DMatrix::zeros(parameters, parameters);
    let mut undetermined = vec![false; parameters];
    for (d, &value) in found.s.iter().enumerate() {
        if value > RANK_TOLERANCE * largest {
            for k in 0..parameters {
                for l in 0..parameters {
                    covariance[(k, l)] += directions[(d, k)] * directions[(d, l)] / (value * value);
                }
            }
        } else {
            for (k, undetermined) in undetermined.iter_mut().enumerate() {
                *undetermined |= directions[(d, k)].abs() > 1e-6;
            }
        }
    }
    for k in (0..parameters).filter(|&k| undetermined[k]) {
        covariance.row_mut(k).fill(f64::INFINITY);
        covariance.column_mut(k).fill(f64::INFINITY);
    }
    Some(covariance)
}

/// The standard error of Σ wₖ pₖ from the sensitivities and the variance of the residuals, in the
/// directions whose singular values are above `tolerance` times the largest; `None` when a number is
/// not finite.
pub(crate) fn error_of_combination(
    jacobian: &[Vec<f64>],
    weights: &[f64],
    variance: f64,
    tolerance: f64,
) -> Option<f64> {
    let (points, parameters) = (jacobian.first().map_or(0, Vec::len), jacobian.len());
    let norms: Vec<f64> =
        jacobian.iter().map(|column| column.iter().map(|v| v * v).sum::<f64>().sqrt()).collect();
    let used: Vec<usize> = (0..parameters).filter(|&k| norms[k] > 0.0).collect();
    let scaled = DMatrix::from_fn(points, used.len(), |j, k| jacobian[used[k]][j] / norms[used[k]]);
    let found = SingularValues::of(&scaled)?;
    let along = |d: usize| -> f64 {
        used.iter().enumerate().map(|(k, &own)| found.v_t[(d, k)] * weights[own] / norms[own]).sum()
    };
    let directions = (0..found.s.len()).filter(|&d| found.s[d] > tolerance * found.largest());
    let square: f64 = directions.map(|d| elementary::powi(along(d) / found.s[d], 2)).sum();
    Some((variance * square).sqrt()).filter(|error| error.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of y = (a + b) x only the sum is determined: s²/Σx² is its variance, as of one slope.
    #[test]
    fn a_sum_has_a_standard_error_where_its_parts_have_none() {
        let jacobian = [vec![1.0, 2.0, 3.0], vec![1.0, 2.0, 3.0]];
        let error = error_of_combination(&jacobian, &[1.0, 1.0], 0.5, 1e-10).unwrap();
        assert!((error - (0.5_f64 / 14.0).sqrt()).abs() < 1e-15, "{error}");
        let difference = error_of_combination(&jacobian, &[1.0, -1.0], 0.5, 1e-10).unwrap();
        assert!(difference < 1e-15, "nothing of the data says anything of it");
    }

    /// A straight line a + b x at x = 0, 1, 2, 3 with residuals of known variance: the textbook
    /// formulas s² Σx²/(n Sxx) and s²/Sxx hold.
    #[test]
    fn straight_line_has_the_textbook_deviations() {
        let jacobian = [vec![1.0; 4], vec![0.0, 1.0, 2.0, 3.0]];
        let residuals = [0.1, -0.1, -0.1, 0.1];
        let found = uncertainty(&jacobian, &residuals).unwrap();
        let variance: f64 = 0.04 / 2.0;
        let expected = [(variance * 14.0 / (4.0 * 5.0)).sqrt(), (variance / 5.0).sqrt()];
        for (found, expected) in found.standard_deviations.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12 * expected, "{found} {expected}");
        }
        let correlation = -6.0 / (4.0_f64 * 14.0).sqrt();
        assert!((found.correlations[1] - correlation).abs() < 1e-12);
        assert!((found.correlations[0] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_the_data_do_not_show_is_infinite() {
        let jacobian = [vec![1.0, 2.0, 3.0, 4.0], vec![0.0; 4], vec![1.0, 0.0, 0.0, 1.0]];
        let found = uncertainty(&jacobian, &[0.1, 0.1, -0.1, 0.1]).unwrap();
        assert!(found.standard_deviations[1].is_infinite());
        assert!(found.standard_deviations[0].is_finite());
        let non_identifiable = [vec![1.0, 2.0, 3.0], vec![2.0, 4.0, 6.0]];
        let found = uncertainty(&non_identifiable, &[0.1, 0.1, -0.1]).unwrap();
        assert!(found.standard_deviations.iter().all(|deviation| deviation.is_infinite()));
    }

    #[test]
    fn too_few_points_tell_nothing() {
        assert_eq!(uncertainty(&[vec![1.0]], &[0.1]), None);
        assert_eq!(uncertainty(&[vec![1.0, f64::NAN]], &[0.1, 0.2]), None);
        assert_eq!(uncertainty(&[], &[0.1]), None);
    }
}
