//! The linear approximation of a fit about its best point: weighted Jacobian, covariance of the
//! estimates, and variances of what depends on them (delta method).
//!
//! With the weighted Jacobian J and the variance s² of the weighted residuals, the Fisher
//! information is F = JᵀJ/s² and a quantity of gradient g has the variance gᵀF⁻¹g. Parameters are
//! scaled by the lengths of their columns, so that their units do not matter.
//!
//! Reference: [Walter & Pronzato 1997](gapilib_base::bibliography#walter-pronzato-1997), chapters 5 and 6.

use super::super::explicit::Explicit;
use super::super::statistics::Spread;
use super::super::{Evaluation, Problem, Statistics, limits};
use crate::elementary;
use crate::ga::optimizer::FROM_THE_SOLVER;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Singular values of the Jacobian below this fraction of the largest count as zero, however exact
/// or inexact the simulation is: the limits of `Statistics`, so that both name the same parameters.
const RANK: [f64; 2] = [1e-7, 1e-4];
/// A direction of the parameters counts for a gradient beyond this share of its length: far above
/// rounding (1e-16 times the condition), far below what a band could show.
const SHARE: f64 = 1e-6;
/// Beyond this relative offset the best values lie farther from the minimum than a tenth of their
/// standard errors, and what is linear about them does not hold about the minimum.
const MINIMUM: f64 = 0.1;
/// Values nearer to a bound than this fraction of the range are held by it.
const AT_BOUND: f64 = 1e-6;

/// Why there is none where the residuals say nothing of the noise.
const EXACT_FIT: &str =
    "the residuals are as small as the errors of the simulation, so the noise is unknown";

/// The fit about its best point.
pub struct Local {
    /// The estimates.
    pub values: Vec<f64>,
    /// Points simulated with them.
    pub simulated: Vec<f64>,
    /// What differences are multiplied with to become residuals.
    pub scales: Vec<f64>,
    /// Weighted residuals, measured less simulated.
    pub residuals: Vec<f64>,
    /// Jacobian of the weighted simulated points: points × parameters.
    pub jacobian: DMatrix<f64>,
    /// Variance of the weighted residuals: 1 where sigma is known, else their sum of squares by the
    /// degrees of freedom.
    pub variance: f64,
    /// That of a measurement, in units of its scale.
    pub(crate) variance_of_points: f64,
    /// Points less parameters.
    pub freedom: f64,
    /// Whether the standard deviations of the measurements are known, so that the variance is 1.
    pub known: bool,
    /// Whether the fit minimizes a robust loss: the variance is then that of its estimates, and not
    /// that of a measurement.
    pub(crate) robust: bool,
    /// Half-width of a 95 % interval as a multiple of the standard error.
    pub quantile: f64,
    /// The degrees of freedom of the quantile with as many points as there are: infinite where sigma is
    /// known.
    pub(crate) freedom_of_quantile: f64,
    /// The Fisher information.
    pub information: Information,
    /// Scales and offsets of relative data, and the information of the parameters with them.
    relative: Option<(Explicit, Information)>,
}

/// A Fisher information matrix and its inverse, in parameters scaled to unit diagonal.
#[derive(Debug, Clone)]
pub struct Information {
    /// Scaled parameter = parameter × size.
    sizes: Vec<f64>,
    /// Eigenvalues and eigenvectors of the scaled information.
    eigen: SymmetricEigen<f64, nalgebra::Dyn>,
    /// Eigenvalues below this are zero.
    zero: f64,
}

impl Local {
    /// The approximation at `values`.
    ///
    /// # Errors
    ///
    /// Why there is none, as the end of a sentence.
    pub fn at(
        problem: &Problem,
        evaluation: &Evaluation,
        values: &[f64],
    ) -> Result<Local, &'static str> {
        evaluation.scales().ok_or("the fitness is not a sum of squares")?;
        let simulated = evaluation.simulate(values);
        let simulated = simulated.map_err(|_| "the best point cannot be simulated")?;
        let found = Statistics::at(problem, evaluation, values, &simulated, &[]);
        if !found.repeated.is_empty() {
            return Err("two series contain the same numbers");
        }
        let columns = found.weighted(&found.jacobian);
        let relative = found.explicit.clone().zip(with_coefficients(&found));
        let gradient = found.gradient();
        let [residuals, scales] = found.reduced_points();
        let Spread { freedom, believed, variance, robust, .. } = found.spread;
        if freedom <= 0.0 {
            return Err("there are not more points than parameters");
        }
        let entry = |j: usize, k: usize| columns[k][j];
        let jacobian = DMatrix::from_fn(scales.len(), values.len(), entry);
        if jacobian.iter().any(|entry| !entry.is_finite()) {
            return Err("the simulation fails near the best point");
        }
        let square = residuals.iter().map(|residual| residual * residual).sum::<f64>();
        if !believed && square <= square_of_simulation(problem, &scales, &simulated) {
            return Err(EXACT_FIT);
        }
        let gram = jacobian.tr_mul(&jacobian) / variance;
        let information = Information::new(&gram, Local::tolerance(problem.noise));
        // Where sigma is believed, a standard error is 1 and not what is left of the residuals.
        let spread = if believed { variance.max(square / freedom) } else { square / freedom };
        if limits::along(problem, values).is_some() {
            return Err("the best values are at the limit of a constraint");
        }
        if !robust
            && offset(problem, values, gradient, &information) / variance.sqrt()
                > MINIMUM * spread.sqrt()
        {
            return Err("the best values are not a minimum of the sum of squares");
        }
        Ok(Local {
            values: values.to_vec(),
            simulated,
            scales,
            residuals,
            jacobian,
            variance,
            variance_of_points: found.variance_of_points(),
            freedom,
            known: believed,
            robust,
            quantile: found.spread.quantile,
            freedom_of_quantile: found.freedom_of_points(),
            information,
            relative,
        })
    }

    /// Singular values of a Jacobian below this fraction of the largest are those of its errors.
    /// `noise`: relative error of the simulation.
    pub fn tolerance(noise: f64) -> f64 {
        elementary::powf(noise, 2.0 / 3.0).clamp(RANK[0], RANK[1])
    }

    /// The value of a point of a curve, scaled as its series is, and its variance; `None` where the data
    /// leave it open.
    pub(crate) fn point_of_curve(
        &self,
        series: Option<usize>,
        value: f64,
        gradient: &[f64],
    ) -> (f64, Option<f64>) {
        let scaled = self.relative.as_ref().zip(series).and_then(|((own, information), series)| {
            own.scaled(series, value, gradient).map(|scaled| (scaled, information))
        });
        match scaled {
            Some(((value, gradient), information)) => (value, information.variance_of(&gradient)),
            None => (value, self.information.variance_of(gradient)),
        }
    }

    /// The standard deviation of a measurement of series `series` at `x`: that of the measured
    /// point nearest to it.
    pub(crate) fn noise_at(&self, problem: &Problem, series: usize, x: f64) -> f64 {
        let first: usize = problem.series[..series].iter().map(|series| series.x.len()).sum();
        let own = problem.series[series].x.iter().enumerate();
        let nearest = own.min_by(|a, b| (a.1 - x).abs().total_cmp(&(b.1 - x).abs()));
        let scale = nearest.map_or(1.0, |(k, _)| self.scales[first + k]);
        self.variance_of_points.sqrt() / scale
    }

    /// The same where it is known: beyond the measured points only if it is the same at all of them.
    pub(crate) fn known_noise_at(&self, problem: &Problem, series: usize, x: f64) -> Option<f64> {
        let first: usize = problem.series[..series].iter().map(|series| series.x.len()).sum();
        let own = &problem.series[series].x;
        let is_within = own.iter().any(|known| *known <= x) && own.iter().any(|known| *known >= x);
        let scales = &self.scales[first..first + own.len()];
        let is_constant = scales.iter().all(|scale| *scale == scales[0]);
        (is_within || is_constant).then(|| self.noise_at(problem, series, x))
    }
}

/// The sum of squares that errors of the simulation make.
fn square_of_simulation(problem: &Problem, scales: &[f64], simulated: &[f64]) -> f64 {
    let size = scales.iter().zip(simulated).map(|(w, s)| elementary::powi(w * s, 2)).sum::<f64>();
    elementary::powi(FROM_THE_SOLVER * problem.noise, 2) * size
}

/// The Fisher information of the parameters and of scales and offsets of relative data; `None` where
/// there are none.
pub fn with_coefficients(found: &Statistics) -> Option<Information> {
    let (columns, tolerance) = found.explicit_columns()?;
    let product = |a: usize, b: usize| -> f64 {
        columns[a].iter().zip(&columns[b]).map(|(a, b)| a * b).sum()
    };
    let n = columns.len();
    let gram = DMatrix::from_fn(n, n, |a, b| product(a, b) / found.spread.variance);
    gram.iter().all(|value| value.is_finite()).then(|| Information::new(&gram, tolerance))
}

/// Standard errors of scales and offsets; `None` where they are not determined.
pub fn errors_of_coefficients(found: &Statistics) -> Vec<Option<f64>> {
    let (Some(own), Some(information)) = (&found.explicit, with_coefficients(found)) else {
        return Vec::new();
    };
    let all = information.variances();
    let own = all[all.len() - own.count()..].iter();
    own.map(|variance| variance.map(f64::sqrt).filter(|own| own.is_finite())).collect()
}

/// How far the Gauss-Newton step would move the weighted points, root mean square over the
/// parameters, times the root of the variance, which the information holds: the numerator of the
/// relative offset of Bates and Watts. Parameters that a bound holds are left out.
fn offset(problem: &Problem, values: &[f64], gradient: Vec<f64>, information: &Information) -> f64 {
    let inside = |(k, part): (usize, f64)| {
        let place = problem.parameters[k].fraction(values[k]);
        if place.min(1.0 - place) < AT_BOUND { 0.0 } else { part }
    };
    let parts: Vec<f64> = gradient.into_iter().enumerate().map(inside).collect();
    let moved = information.variance_of(&parts).unwrap_or(0.0);
    (moved / values.len() as f64).sqrt()
}

impl Information {
    /// Of the matrix F in natural units. `tolerance`: singular values of the Jacobian that count
    /// as zero, as a fraction of the largest.
    pub fn new(information: &DMatrix<f64>, tolerance: f64) -> Information {
        let n = information.nrows();
        let size = |k: usize| information[(k, k)].sqrt();
        let sizes: Vec<f64> = (0..n).map(|k| if size(k) > 0.0 { size(k) } else { 1.0 }).collect();
        let scaled = DMatrix::from_fn(n, n, |k, l| information[(k, l)] / (sizes[k] * sizes[l]));
        let eigen = SymmetricEigen::new(scaled);
        let zero = tolerance * tolerance * eigen.eigenvalues.max().max(0.0);
        Information { sizes, eigen, zero }
    }

    /// gᵀF⁻¹g; `None` where the data leave a direction open on which g depends.
    pub(crate) fn variance_of(&self, gradient: &[f64]) -> Option<f64> {
        let scaled = gradient.iter().zip(&self.sizes).map(|(g, size)| g / size);
        let scaled = DVector::from_iterator(gradient.len(), scaled);
        let length = scaled.norm();
        let mut variance = 0.0;
        for (value, vector) in
            self.eigen.eigenvalues.iter().zip(self.eigen.eigenvectors.column_iter())
        {
            let part = vector.dot(&scaled);
            if *value > self.zero {
                variance += part * part / value;
            } else if part.abs() > SHARE * length {
                return None;
            }
        }
        variance.is_finite().then_some(variance)
    }

    /// The variance of every parameter; `None` where it is unbounded.
    pub(crate) fn variances(&self) -> Vec<Option<f64>> {
        let n = self.sizes.len();
        let unit = |k: usize| (0..n).map(|l| if k == l { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
        (0..n).map(|k| self.variance_of(&unit(k))).collect()
    }

    /// ln det F; −∞ where the data leave a direction open.
    pub(crate) fn log_determinant(&self) -> f64 {
        let values = self.eigen.eigenvalues.iter();
        let logs =
            values.map(
                |value| if *value > self.zero { elementary::ln(*value) } else { f64::NEG_INFINITY },
            );
        logs.sum::<f64>() + 2.0 * self.sizes.iter().map(|size| elementary::ln(*size)).sum::<f64>()
    }

    /// ln det F with open directions counted as the smallest information that counts, so that
    /// matrices with open directions can be compared.
    pub(crate) fn floored_log_determinant(&self) -> f64 {
        let logs = self.eigen.eigenvalues.iter().map(|value| elementary::ln(value.max(self.zero)));
        logs.sum::<f64>() + 2.0 * self.sizes.iter().map(|size| elementary::ln(*size)).sum::<f64>()
    }

    /// The sum of the variances, open directions counted in the same way.
    pub(crate) fn floored_trace_of_inverse(&self) -> f64 {
        let vectors = &self.eigen.eigenvectors;
        let entry = |(k, size): (usize, &f64)| {
            let values = self.eigen.eigenvalues.iter().enumerate();
            let parts = values
                .map(|(d, value)| elementary::powi(vectors[(k, d)], 2) / value.max(self.zero));
            parts.sum::<f64>() / (size * size)
        };
        self.sizes.iter().enumerate().map(entry).sum()
    }

    /// The covariance of the parameters; `None` where a direction is open.
    pub fn covariance(&self) -> Option<DMatrix<f64>> {
        let n = self.sizes.len();
        if self.eigen.eigenvalues.iter().any(|value| *value <= self.zero) {
            return None;
        }
        let vectors = &self.eigen.eigenvectors;
        let entry = |k: usize, l: usize| {
            let parts =
                (0..n).map(|d| vectors[(k, d)] * vectors[(l, d)] / self.eigen.eigenvalues[d]);
            parts.sum::<f64>() / (self.sizes[k] * self.sizes[l])
        };
        Some(DMatrix::from_fn(n, n, entry))
    }
}
