//! Prediction bands by the delta method: 95 % confidence of the simulated curve, and 95 %
//! prediction of a new measurement.
//!
//! At a point of gradient g the curve has the variance v = gᵀCg, C being the covariance of the
//! estimates, and a new measurement of standard deviation σ the variance v + σ². Half-widths are
//! Student's quantile times the roots. Both are pointwise, and linear in the parameters.
//!
//! Reference: [Seber & Wild 1989](gapilib_base::bibliography#seber-wild-1989), section 5.1.

use super::predictions::{Curve, Linear, linear};
use super::{CurveRequest, Local, Predict, Reach};
use crate::diag::Fault;
use crate::frequency::Number;
use crate::problem::Problem;
use crate::spectrum::PARTS;
use crate::table::significant;
use serde::{Deserialize, Serialize};

/// Points of a curve: as many as a plot of usual width shows.
const POINTS: usize = 101;

/// Bands about one curve.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Band {
    /// The experiment.
    pub experiment: String,
    /// The variable and its unit.
    pub y: [String; 2],
    /// What it is given over, and the unit.
    pub x: [String; 2],
    /// The measured series that it belongs to; `None` for a variable that was not measured.
    pub series: Option<usize>,
    /// The curve.
    pub points: Vec<BandPoint>,
}

/// A point of a curve with its 95 % half-widths.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BandPoint {
    /// X.
    pub x: f64,
    /// The simulated value.
    pub y: f64,
    /// Half-width of the confidence band; `None` where the data leave the curve open.
    pub confidence: Option<f64>,
    /// Half-width of the prediction band; `None` also for variables that were not measured, where the
    /// loss is robust, and beyond the measured points whose standard deviations differ.
    pub prediction: Option<f64>,
}

/// The confidence band of a spectrum.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpectrumBand {
    /// The experiment.
    pub experiment: String,
    /// Frequency, real and imaginary part, and the 95 % half-widths of the logarithm of the magnitude and of
    /// the phase in degrees.
    pub points: Vec<[f64; 5]>,
}

/// The bands of all experiments, and those of spectra by magnitude and phase.
pub fn bands(
    problem: &Problem,
    predict: &dyn Predict,
    local: &Local,
    refusals: &mut Vec<String>,
) -> Result<(Vec<Band>, Vec<SpectrumBand>), Fault> {
    let variables = &problem.inference.band_variables;
    let request =
        CurveRequest { variables, reach: Reach::Measured, points: POINTS, proposes: false };
    let (curves, linear) = linear(problem, predict, &local.values, &request)?;
    refusals.extend(curves.refusals);
    let linear = match linear {
        Ok(linear) => linear,
        Err(failed) => {
            refusals.push(format!("There are no bands: {}.", failed.cause));
            return Ok((Vec::new(), Vec::new()));
        }
    };
    let spectra = spectra(&curves.curves, &linear, local);
    let (mut place, mut bands) = (0, Vec::new());
    for curve in curves.curves {
        let point = |(k, x): (usize, &f64)| {
            let (value, gradient) = (linear.values[place + k], &linear.gradients[place + k]);
            let (value, variance) = local.point_of_curve(curve.series, value, gradient);
            let half = |variance: f64| local.quantile * variance.sqrt();
            let noise = curve.series.filter(|_| !local.robust);
            let noise = noise.and_then(|series| local.known_noise_at(problem, series, *x));
            let both = variance.zip(noise).map(|(variance, noise)| variance + noise * noise);
            BandPoint {
                x: *x,
                y: value,
                confidence: variance.map(half),
                prediction: both.map(half),
            }
        };
        let points = curve.points.iter().enumerate().map(point).collect();
        place += curve.points.len();
        // Among those that are data.
        let series = curve
            .series
            .map(|own| problem.series[..own].iter().filter(|series| series.is_data()).count());
        let experiment = curve.experiment;
        bands.push(Band { experiment, y: curve.y, x: curve.x, series, points });
    }
    Ok((bands, spectra))
}

/// The bands of spectra: ln H = ln |H| + i φ has the derivatives H'/H. Points that are not
/// identifiable from the data are left out.
fn spectra(curves: &[Curve], linear: &Linear, local: &Local) -> Vec<SpectrumBand> {
    let ends = curves.iter().scan(0, |end, curve| {
        let begin = *end;
        *end += curve.points.len();
        Some((begin, curve))
    });
    let all: Vec<(usize, &Curve)> = ends.filter(|(_, curve)| curve.is_over_frequency).collect();
    let part = |experiment: &str, name: &str| {
        let mut own = all.iter().filter(|(_, curve)| curve.experiment == experiment);
        own.find(|(_, curve)| curve.y[0] == name)
    };
    let band = |(re, real): &(usize, &Curve)| {
        let (im, imaginary) = part(&real.experiment, PARTS[1])?;
        let point = |(k, x): (usize, &f64)| {
            let [re, im] = [re + k, im + k];
            let value = Number::new(linear.values[re], linear.values[im]);
            let pairs = linear.gradients[re].iter().zip(&linear.gradients[im]);
            let (magnitude, phase): (Vec<f64>, Vec<f64>) = pairs
                .map(|(re, im)| Number::new(*re, *im) / value)
                .map(|own| (own.re, own.im.to_degrees()))
                .unzip();
            let half = |gradient: &[f64]| {
                let variance = local.information.variance_of(gradient)?;
                Some(local.quantile * variance.sqrt())
            };
            let halves = half(&magnitude).zip(half(&phase));
            halves.map(|(magnitude, phase)| [*x, value.re, value.im, magnitude, phase])
        };
        let points = real.points.iter().enumerate().filter_map(point).collect();
        let is_one = real.points == imaginary.points;
        is_one.then(|| SpectrumBand { experiment: real.experiment.clone(), points })
    };
    all.iter().filter(|(_, curve)| curve.y[0] == PARTS[0]).filter_map(band).collect()
}

impl Band {
    /// What is worth a word: how well a variable is known that was not measured, and where the
    /// data leave a curve open.
    pub(super) fn sentence(&self) -> Option<String> {
        let open = |point: &&BandPoint| point.confidence.is_none();
        let name = format!("{} of {}", self.y[0], self.experiment);
        let [x, unit] = &self.x;
        let x = if unit.is_empty() { x.clone() } else { format!("{x} in {unit}") };
        if let Some(first) = self.points.iter().find(open) {
            let last = self.points.iter().rev().find(open).unwrap_or(first);
            let [low, high] = [first.x, last.x].map(|x| significant(x, 3));
            return Some(format!(
                "The data do not determine {name} between {low} and {high} ({x})."
            ));
        }
        if self.series.is_some() {
            return None;
        }
        let half = |point: &BandPoint| point.confidence.unwrap_or(f64::INFINITY);
        let widest = self.points.iter().max_by(|a, b| half(a).total_cmp(&half(b)))?;
        Some(format!(
            "{name}, which was not measured, is known to ±{} {} or better (95 %); the band is widest at {} ({x}).",
            significant(half(widest), 2),
            self.y[1],
            significant(widest.x, 3),
        ))
    }
}
