//! What predictions from earlier measurements show: whether what they miss is white noise, by its
//! cumulated periodogram, and whether the data need the process noise at all.
//!
//! ```text
//!   C(k) = Σ_{j≤k} I(j) / Σ I(j),   I(j) = |Σ e_t exp(−2πi j t/n)|²     white: |C(k) − k/m| < 1.36/√m
//!   2 (log L − log L₀) ~ Σ_j 2^−k (k over j) χ²_j                        k densities at their bound 0
//! ```
//!
//! References: [Bartlett 1954](gapilib_base::bibliography#bartlett-1954) (periodogram),
//! [Self & Liang 1987](gapilib_base::bibliography#self-liang-1987) (parameters at bounds).

use super::distributions::chi_square_tails;
use super::{Finding, FindingKind, Severity, Solution, SolvedSeries};
use crate::elementary;
use crate::table::significant;
use std::f64::consts::TAU;

/// The names of densities of process noise begin so.
pub const NOISE_OF: &str = "noise of ";
/// Quantile 0.95 of the Kolmogorov distribution.
const KOLMOGOROV: f64 = 1.358_1;
/// Fewer values have no periodogram that says anything.
const FEW: usize = 20;
/// Probability below which the data need the noise.
const ALPHA: f64 = 0.05;

/// The cumulated periodogram of a series.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Periodogram {
    /// Shares of the power up to frequencies that are evenly spread to half of a cycle per value.
    pub cumulated: Vec<f64>,
    /// Half-width of the band in which 95 % of the periodograms of white noise lie.
    pub band: f64,
}

impl Periodogram {
    /// That of values in their order; `None` for few.
    pub(crate) fn of(values: &[f64]) -> Option<Periodogram> {
        let n = values.len();
        let m = n.saturating_sub(1) / 2;
        if n < FEW || values.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let mut total = 0.0;
        let mut cumulated: Vec<f64> = (1..=m)
            .map(|j| {
                total += power(values, TAU * j as f64 / n as f64);
                total
            })
            .collect();
        cumulated.iter_mut().for_each(|own| *own /= total);
        let root = (m as f64).sqrt();
        let band = KOLMOGOROV / (root + 0.12 + 0.11 / root);
        (total > 0.0).then_some(Periodogram { cumulated, band })
    }

    /// Where it is farthest from that of white noise: the number of its frequency, and the difference.
    fn farthest(&self) -> (usize, f64) {
        let m = self.cumulated.len() as f64;
        let differences =
            self.cumulated.iter().enumerate().map(|(k, own)| (k + 1, own - (k + 1) as f64 / m));
        differences.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).unwrap_or((0, 0.0))
    }
}

/// |Σ e_t exp(−i ω t)|² by Goertzel's recurrence.
fn power(values: &[f64], omega: f64) -> f64 {
    let factor = 2.0 * elementary::cos(omega);
    let (mut last, mut before) = (0.0, 0.0);
    for value in values {
        (last, before) = (value + factor * last - before, last);
    }
    last * last + before * before - factor * last * before
}

impl SolvedSeries {
    /// Residuals in their standard deviations by ascending X, where the model computes these.
    pub(crate) fn innovations(&self) -> Vec<f64> {
        let pairs = self.points.iter().zip(&self.deviations);
        let mut all: Vec<[f64; 2]> =
            pairs.map(|(point, sigma)| [point[0], (point[1] - point[2]) / sigma]).collect();
        all.sort_by(|a, b| a[0].total_cmp(&b[0]));
        all.iter().map(|own| own[1]).collect()
    }

    /// The root mean squared residual of a simulation from the start, where predictions see the data.
    pub(crate) fn error_of_simulation(&self) -> Option<f64> {
        let pairs = self.points.iter().zip(&self.simulation);
        let squares: f64 = pairs.map(|(p, s)| elementary::powi(p[1] - s[1], 2)).sum();
        let n = self.simulation.len();
        (n > 0).then(|| (squares / n as f64).sqrt())
    }

    /// The root mean squared residual of predictions over several samples.
    pub(crate) fn error_ahead(&self) -> Option<f64> {
        let ahead = self.ahead.as_ref()?;
        let measured =
            |x: f64| self.points.iter().find(|point| point[0] == x).map(|point| point[1]);
        let residuals = ahead.points.iter().filter_map(|[x, y, _]| Some(measured(*x)? - y));
        let squares: Vec<f64> = residuals.map(|own| own * own).collect();
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        (!squares.is_empty()).then(|| mean.sqrt())
    }

    /// Whether what a prediction misses is white noise, in words.
    fn whiteness(&self) -> Option<Finding> {
        let periodogram = Periodogram::of(&self.innovations())?;
        let (place, difference) = periodogram.farthest();
        let label = self.label();
        let is_white = difference.abs() <= periodogram.band;
        let duration = self.points.iter().map(|point| point[0]);
        let (low, high) =
            duration.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)));
        let count = self.points.len() as f64;
        let period = (high - low) / (count - 1.0) * count / place as f64;
        let sentence = match is_white {
            true => format!(
                "The innovations of {label} are white noise: their cumulated periodogram lies within its \
                 95 % band."
            ),
            false => format!(
                "The innovations of {label} are not white noise: their cumulated periodogram leaves its \
                 95 % band, with too much power at periods {} than {} s. The model predicts less than \
                 these data allow: try noise on other states, or one more state.",
                if difference > 0.0 { "longer" } else { "shorter" },
                significant(period, 3)
            ),
        };
        let severity = if is_white { Severity::Information } else { Severity::Warning };
        let finding = Finding::new(FindingKind::ProcessNoise, sentence).severity(severity);
        Some(finding.series(&label))
    }
}

/// What a fit with process noise is compared with.
pub struct NoiseComparison<'a> {
    /// The densities that were estimated.
    pub names: &'a [String],
    /// The least -log L with all of them 0.
    pub without: Option<f64>,
    /// For each series a simulation that does not see the data, at its points.
    pub simulated: Option<Vec<Vec<f64>>>,
}

impl Solution {
    /// Says what the process noise explains.
    pub fn judge_noise(&mut self, compared: &NoiseComparison<'_>) {
        let names = crate::diag::suggest::listed(
            &compared.names.iter().map(String::as_str).collect::<Vec<_>>(),
        );
        if let Some(without) = compared.without.filter(|_| !compared.names.is_empty()) {
            let rise = (without - self.fitness).max(0.0);
            let p = tail(2.0 * rise, compared.names.len());
            let (rise, p_text) = (significant(rise, 3), significant(p, 2));
            let sentence = match p < ALPHA {
                true => format!(
                    "The data need the process noise: without {names}, -log L is larger by {rise} \
                     (likelihood-ratio test at the bound 0, p-value {p_text})."
                ),
                false => format!(
                    "The data do not need the process noise: without {names}, -log L is larger by {rise} \
                     only (likelihood-ratio test at the bound 0, p-value {p_text}); errors of \
                     measurement alone explain them."
                ),
            };
            let finding = Finding::new(FindingKind::ProcessNoise, sentence);
            self.findings.push(finding.severity(Severity::Information).statistic(p, ALPHA));
        }
        let white: Vec<Finding> = self.series.iter().filter_map(SolvedSeries::whiteness).collect();
        self.findings.extend(white);
        for (own, simulated) in self.series.iter_mut().zip(compared.simulated.iter().flatten()) {
            let points = own.points.iter().zip(simulated);
            own.simulation = points.map(|(point, simulated)| [point[0], *simulated]).collect();
        }
        let words: Vec<String> = self
            .series
            .iter()
            .filter_map(|own| Some((own, own.error_of_simulation()?)))
            .map(|(own, simulated)| {
                let unit =
                    if own.y[1].is_empty() { String::new() } else { format!(" {}", own.y[1]) };
                let ahead = own.ahead.as_ref().zip(own.error_ahead());
                let ahead = ahead.map(|(ahead, error)| {
                    format!(", over {} samples: {}{unit}", ahead.samples, significant(error, 3))
                });
                format!(
                    "{}: {}{unit} (predictions: {}{unit}{})",
                    own.label(),
                    significant(simulated, 3),
                    significant(own.rmse, 3),
                    ahead.unwrap_or_default()
                )
            })
            .collect();
        if !words.is_empty() {
            let sentence = format!(
                "RMSE is that of predictions of one sample from all earlier ones. Simulations from the \
                 start, which see no measurements, have: {}.",
                words.join("; ")
            );
            let finding = Finding::new(FindingKind::ProcessNoise, sentence);
            self.findings.push(finding.severity(Severity::Information));
        }
    }
}

/// Probability of a larger likelihood ratio where so many densities are 0.
fn tail(ratio: f64, count: usize) -> f64 {
    let mut weight = elementary::powi(0.5, count as i32);
    let mut sum = if ratio > 0.0 { 0.0 } else { weight };
    for j in 1..=count {
        weight *= (count - j + 1) as f64 / j as f64;
        sum += weight * chi_square_tails(ratio, j as f64)[1];
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that are as good as random: multiples of the golden ratio, normal by the sum of 12.
    fn noise(n: usize) -> Vec<f64> {
        let mut state: u64 = 49;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..n).map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0).collect()
    }

    /// The largest difference by the definition.
    fn farthest(values: &[f64]) -> f64 {
        let n = values.len();
        let m = (n - 1) / 2;
        let power = |j: usize| {
            let part = |f: fn(f64) -> f64| {
                let terms = values.iter().enumerate();
                terms.map(|(t, e)| e * f(TAU * (j * t) as f64 / n as f64)).sum::<f64>()
            };
            part(f64::cos).powi(2) + part(f64::sin).powi(2)
        };
        let all: Vec<f64> = (1..=m).map(power).collect();
        let total: f64 = all.iter().sum();
        let mut sum = 0.0;
        let differences = all.iter().enumerate().map(|(k, own)| {
            sum += own / total;
            (sum - (k + 1) as f64 / m as f64).abs()
        });
        differences.fold(0.0, f64::max)
    }

    #[test]
    fn white_noise_lies_within_the_band_and_its_running_mean_does_not() {
        let white = noise(201);
        let found = Periodogram::of(&white).unwrap();
        let difference = found.farthest().1.abs();
        assert!((difference - farthest(&white)).abs() < 1e-9, "{difference}");
        assert!(difference < found.band, "{difference} {}", found.band);
        assert!((found.cumulated.last().unwrap() - 1.0).abs() < 1e-12);
        let slow: Vec<f64> = white.windows(3).map(|three| three.iter().sum()).collect();
        let found = Periodogram::of(&slow).unwrap();
        assert!(found.farthest().1 > found.band);
        assert!(Periodogram::of(&white[..10]).is_none());
    }

    /// Half of the time the ratio is 0; 2.706 is the quantile 0.95 of the mixture for one density.
    #[test]
    fn the_ratio_of_a_density_at_its_bound_is_a_mixture() {
        assert!((tail(2.705_543_454_095_404, 1) - 0.05).abs() < 1e-9);
        assert!((tail(0.0, 1) - 1.0).abs() < 1e-12 && (tail(0.0, 2) - 1.0).abs() < 1e-12);
        // 1/2 P(χ²₁ > 4.231) + 1/4 P(χ²₂ > 4.231) by SciPy.
        assert!((tail(4.231, 2) - 0.049_989_271_146_945).abs() < 1e-9, "{}", tail(4.231, 2));
    }
}
