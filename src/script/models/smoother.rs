//! Smoothed states: each from all measurements, also those after it (fixed interval).
//!
//! With the filter the model computes how a deviation of the states at one row moves to the next one, Φ.
//! A pass from the last row to the first one then carries what later measurements say, λ and its
//! information Λ. No covariance is inverted, so that states which are known exactly need no care.
//!
//! ```text
//!   xₛ = x + P λ,  Pₛ = P − P Λ P                                            at a row, after its samples
//!   λ ← h e/s² + (I − h gᵀ/s²) λ,  Λ ← h hᵀ/s² + (I − h gᵀ/s²) Λ (I − g hᵀ/s²)     over a sample, g = P hᵀ
//!   λ ← Φᵀ λ,  Λ ← Φᵀ Λ Φ                                                        to the row before
//! ```
//!
//! This is the smoother of Rauch, Tung and Striebel in the form of Bryson and Frazier.
//!
//! References: [Rauch, Tung & Striebel 1965](gapilib_base::bibliography#rauch-tung-striebel-1965),
//! [Bierman 1973](gapilib_base::bibliography#bierman-1973).

use nalgebra::{DMatrix, DVector};

/// Variables of a filtered model that a smoother needs. All hold their values from one row to the next.
#[derive(Debug, Clone, Default)]
pub(crate) struct Smoothing {
    /// Φ from the row before, by rows.
    pub transitions: Vec<String>,
    /// For each output P hᵀ before its sample.
    pub products: Vec<Vec<String>>,
    /// For each output h, where it is not zero: the state, and the variable.
    pub gains: Vec<Vec<(usize, String)>>,
}

/// A row of a filter.
#[derive(Debug, Clone)]
pub(crate) struct Row {
    /// The states after its samples, and their covariance.
    pub state: DVector<f64>,
    pub covariance: DMatrix<f64>,
    /// Φ from the row before.
    pub transition: DMatrix<f64>,
    /// h of all outputs.
    pub gains: Vec<DVector<f64>>,
    /// Its samples, in the order in which the filter takes them.
    pub samples: Vec<Sample>,
}

/// A sample of an output.
#[derive(Debug, Clone)]
pub(crate) struct Sample {
    /// h
    pub gain: DVector<f64>,
    /// P hᵀ
    pub product: DVector<f64>,
    /// s²
    pub variance: f64,
    /// e
    pub innovation: f64,
}

/// The smoothed states of all rows, and their covariances.
pub(crate) fn smoothed(rows: &[Row]) -> Vec<(DVector<f64>, DMatrix<f64>)> {
    let n = rows.first().map_or(0, |row| row.state.len());
    let (mut lambda, mut information) = (DVector::zeros(n), DMatrix::zeros(n, n));
    let mut all = Vec::with_capacity(rows.len());
    for row in rows.iter().rev() {
        let p = &row.covariance;
        all.push((&row.state + p * &lambda, p - p * &information * p));
        for own in row.samples.iter().rev() {
            let h = &own.gain;
            let kept = DMatrix::identity(n, n) - h * own.product.transpose() / own.variance;
            lambda = h * (own.innovation / own.variance) + &kept * lambda;
            information = h * h.transpose() / own.variance + &kept * information * kept.transpose();
        }
        let phi = &row.transition;
        lambda = phi.tr_mul(&lambda);
        information = phi.tr_mul(&(information * phi));
    }
    all.reverse();
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A state that does not move and has no noise: each row has the mean of all measurements.
    #[test]
    fn a_constant_is_known_from_all_measurements_at_each_row() {
        let measured = [1.0, 4.0, 2.0, 5.0];
        let (mut state, mut p) = (0.0, 1e6);
        let rows: Vec<Row> = measured
            .iter()
            .map(|y| {
                let (variance, product, innovation) = (p + 1.0, p, y - state);
                state += product * innovation / variance;
                p -= product * product / variance;
                let one = |value: f64| DVector::from_element(1, value);
                Row {
                    state: one(state),
                    covariance: DMatrix::from_element(1, 1, p),
                    transition: DMatrix::identity(1, 1),
                    gains: vec![one(1.0)],
                    samples: vec![Sample {
                        gain: one(1.0),
                        product: one(product),
                        variance,
                        innovation,
                    }],
                }
            })
            .collect();
        let information = 4.0 + 1e-6;
        for (x, p) in smoothed(&rows) {
            assert!((x[0] - 12.0 / information).abs() < 1e-9, "{x}");
            assert!((p[(0, 0)] - 1.0 / information).abs() < 1e-9, "{p}");
        }
        assert!(smoothed(&[]).is_empty());
    }
}
