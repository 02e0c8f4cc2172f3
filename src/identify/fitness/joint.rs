//! Errors of several outputs at one instant that are correlated, with a covariance V that is given or
//! estimated along with the parameters.
//!
//! ```text
//! -log L = n m/2 ln 2π + ½ Σ ln det Vᵢ + ½ Σ rᵢᵀ Vᵢ⁻¹ rᵢ
//! ```
//!
//! Instants at which not all outputs were measured count with the marginal density of those that were:
//! Vᵢ has their rows and columns. The most likely covariance of residuals R is RᵀR/n where all rows are
//! complete, so that -log L is n/2 ln det RᵀR and a constant; else it is found in turn with the
//! expectation of what is missing (EM).
//!
//! Least squares have the residuals L⁻¹ r/σ and the derivatives L⁻¹ D/σ, with L Lᵀ the correlations. At
//! the most likely covariance the gradient is that with the covariance as it is.
//!
//! References: [Box & Draper 1965](gapilib_base::bibliography#box-draper-1965),
//! [Bates & Watts 1988](gapilib_base::bibliography#bates-watts-1988), chapter 4,
//! [Dempster, Laird & Rubin 1977](gapilib_base::bibliography#dempster-laird-rubin-1977).

use crate::elementary;
use nalgebra::{DMatrix, DVector};

/// Covariances that change by less in a round are those of the residuals, and so many rounds there are
/// at most.
const CONSTANT: f64 = 1e-14;
const ROUNDS: usize = 2000;

/// Outputs whose errors are correlated.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct JointGroup {
    /// How many outputs.
    pub size: usize,
    /// The correlations where these are given.
    pub given: Option<DMatrix<f64>>,
    /// For each instant the outputs that were measured, with their points.
    pub rows: Vec<Vec<(usize, usize)>>,
    /// The smallest standard deviations: those of the simulation's own errors.
    pub floor: Vec<f64>,
}

/// The residuals of a group at one simulation.
pub(crate) struct JointScales {
    /// The covariance of the weighted residuals.
    pub covariance: DMatrix<f64>,
    /// Σ ln det Vᵢ.
    pub log_determinants: f64,
    /// Σ rᵢᵀ Vᵢ⁻¹ rᵢ.
    pub square: f64,
    blocks: Vec<Block>,
}

#[derive(Debug, Clone, PartialEq)]
struct Block {
    points: Vec<usize>,
    /// The inverse of the Cholesky factor of the correlations.
    inverse: DMatrix<f64>,
}

/// What makes residuals that have been divided by their standard deviations uncorrelated.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Whitening {
    blocks: Vec<Block>,
}

impl Whitening {
    /// Changes a column of such residuals, or of derivatives of them.
    pub fn apply(&self, column: &mut [f64]) {
        for Block { points, inverse } in &self.blocks {
            let own = DVector::from_iterator(points.len(), points.iter().map(|p| column[*p]));
            let whitened = inverse * own;
            points.iter().zip(whitened.iter()).for_each(|(p, value)| column[*p] = *value);
        }
    }

    /// The same for rows of derivatives, points × parameters.
    pub fn apply_to_rows(&self, derivatives: &mut [f64], n: usize) {
        for Block { points, inverse } in &self.blocks {
            let own = DMatrix::from_fn(points.len(), n, |a, k| derivatives[points[a] * n + k]);
            let whitened = inverse * own;
            for (a, p) in points.iter().enumerate() {
                (0..n).for_each(|k| derivatives[p * n + k] = whitened[(a, k)]);
            }
        }
    }

    /// Adds the points of another group.
    pub(crate) fn add(&mut self, scales: &JointScales) {
        self.blocks.extend(scales.blocks.iter().cloned());
    }
}

impl JointGroup {
    /// Points of all instants.
    pub fn count(&self) -> f64 {
        self.rows.iter().map(Vec::len).sum::<usize>() as f64
    }

    /// The same where its points are places in this list.
    pub fn within(&self, points: &[usize]) -> JointGroup {
        let place = |(member, p): &(usize, usize)| Some((*member, points.binary_search(p).ok()?));
        let row = |row: &Vec<(usize, usize)>| row.iter().filter_map(place).collect();
        JointGroup { rows: self.rows.iter().map(row).collect(), ..self.clone() }
    }

    /// Covariance and what follows from it; `residuals`: those of all points, times their weights.
    pub fn scales(&self, residuals: &[f64]) -> JointScales {
        let covariance = match &self.given {
            Some(correlations) => correlations.clone(),
            None => self.positive(self.most_likely(residuals)),
        };
        let sigma = covariance.diagonal().map(f64::sqrt);
        let correlations = DMatrix::from_fn(self.size, self.size, |a, b| {
            covariance[(a, b)] / (sigma[a] * sigma[b])
        });
        // The factors of the correlations of those outputs that rows have.
        let (mut measured, mut factors) = (Vec::<Vec<usize>>::new(), Vec::new());
        let (mut log_determinants, mut square, mut blocks) = (0.0, 0.0, Vec::new());
        for row in &self.rows {
            let members: Vec<usize> = row.iter().map(|own| own.0).collect();
            let at = measured.iter().position(|own| *own == members).unwrap_or_else(|| {
                factors.push(factor(&correlations, &members));
                measured.push(members.clone());
                measured.len() - 1
            });
            let Some((inverse, log_determinant)) = &factors[at] else {
                (log_determinants, square) = (f64::NAN, f64::NAN);
                continue;
            };
            let own = row.iter().map(|(member, p)| residuals[*p] / sigma[*member]);
            let whitened = inverse * DVector::from_iterator(row.len(), own);
            square += whitened.norm_squared();
            let of_sigmas = members.iter().map(|k| 2.0 * elementary::ln(sigma[*k]));
            log_determinants += log_determinant + of_sigmas.sum::<f64>();
            let points = row.iter().map(|own| own.1).collect();
            blocks.push(Block { points, inverse: inverse.clone() });
        }
        JointScales { covariance, log_determinants, square, blocks }
    }

    /// The covariance under which these residuals are most likely.
    fn most_likely(&self, residuals: &[f64]) -> DMatrix<f64> {
        let m = self.size;
        let is_complete = self.rows.iter().all(|row| row.len() == m);
        let mut covariance = DMatrix::zeros(m, m);
        let mut counts = DVector::from_element(m, 0.0);
        for row in &self.rows {
            for (a, p) in row {
                counts[*a] += 1.0;
                for (b, q) in row {
                    covariance[(*a, *b)] += residuals[*p] * residuals[*q];
                }
            }
        }
        let n = self.rows.len() as f64;
        if is_complete {
            return covariance / n;
        }
        // From the variances alone: covariances of different rows need not be positive definite.
        let mut covariance = DMatrix::from_diagonal(&covariance.diagonal().component_div(&counts));
        for _ in 0..ROUNDS {
            let mut next = DMatrix::zeros(m, m);
            let mut known: Vec<(Vec<usize>, Option<Missing>)> = Vec::new();
            for row in &self.rows {
                let members: Vec<usize> = row.iter().map(|own| own.0).collect();
                let at = known.iter().position(|own| own.0 == members).unwrap_or_else(|| {
                    known.push((members.clone(), Missing::of(&covariance, &members)));
                    known.len() - 1
                });
                let Some(missing) = &known[at].1 else { return covariance };
                let own = row.iter().map(|own| residuals[own.1]);
                let whole = &missing.fill * DVector::from_iterator(row.len(), own);
                next += &whole * whole.transpose() + &missing.left;
            }
            next /= n;
            let change = |a: usize, b: usize| {
                (next[(a, b)] - covariance[(a, b)]).abs() / (next[(a, a)] * next[(b, b)]).sqrt()
            };
            let all = (0..m).flat_map(|a| (0..m).map(move |b| (a, b)));
            let most = all.map(|(a, b)| change(a, b)).fold(0.0, f64::max);
            covariance = next;
            if most.is_nan() || most < CONSTANT {
                break;
            }
        }
        covariance
    }

    /// Variances not below those of errors of the simulation, and a matrix that has an inverse.
    fn positive(&self, mut covariance: DMatrix<f64>) -> DMatrix<f64> {
        for (k, floor) in self.floor.iter().enumerate() {
            // Not `max`, which would let NaN, the mark of a failed simulation, pass.
            if covariance[(k, k)] < floor * floor {
                covariance[(k, k)] = floor * floor;
            }
        }
        let mut part = 1.0;
        while covariance.clone().cholesky().is_none() && part < 1e6 {
            for (k, floor) in self.floor.iter().enumerate() {
                covariance[(k, k)] += part * floor * floor;
            }
            part *= 10.0;
        }
        covariance
    }
}

/// The inverse of the Cholesky factor of some rows and columns, and the logarithm of the determinant.
fn factor(matrix: &DMatrix<f64>, members: &[usize]) -> Option<(DMatrix<f64>, f64)> {
    let n = members.len();
    let own = DMatrix::from_fn(n, n, |a, b| matrix[(members[a], members[b])]);
    let lower = own.cholesky()?.l();
    let log_determinant = lower.diagonal().iter().map(|own| 2.0 * elementary::ln(*own)).sum();
    Some((lower.solve_lower_triangular(&DMatrix::identity(n, n))?, log_determinant))
}

/// What is expected of outputs that were not measured.
struct Missing {
    /// All residuals from those that are known.
    fill: DMatrix<f64>,
    /// Their covariance given these.
    left: DMatrix<f64>,
}

impl Missing {
    fn of(covariance: &DMatrix<f64>, members: &[usize]) -> Option<Missing> {
        let (m, n) = (covariance.nrows(), members.len());
        let own = DMatrix::from_fn(n, n, |a, b| covariance[(members[a], members[b])]);
        let beside = DMatrix::from_fn(m, n, |a, b| covariance[(a, members[b])]);
        let fill = &beside * own.cholesky()?.inverse();
        let left = covariance - &fill * beside.transpose();
        // What was measured is known.
        let is_known = |k: usize| members.contains(&k);
        let fill = DMatrix::from_fn(m, n, |a, b| match is_known(a) {
            true => f64::from(u8::from(members[b] == a)),
            false => fill[(a, b)],
        });
        let left = DMatrix::from_fn(m, m, |a, b| match is_known(a) || is_known(b) {
            true => 0.0,
            false => left[(a, b)],
        });
        Some(Missing { fill, left })
    }
}
