//! What each experiment contributes to what is known of each parameter.
//!
//! The Fisher information of all data is the sum of those of the experiments, F = Σ Fₑ. With z = F⁻¹eₖ,
//! the direction in which parameter k is least known, the variance of k is zᵀFz = Σ zᵀFₑz: the terms are
//! the shares of the experiments, correlations of the parameters counted. What would be left without an
//! experiment is the inverse of F − Fₑ.
//!
//! Reference: [Walter & Pronzato 1997](gapilib_base::bibliography#walter-pronzato-1997), chapter 6.

use super::Local;
use super::local::Information;
use crate::problem::Problem;
use crate::table::significant;
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// Shares below this are not named.
const SMALL: f64 = 0.1;
/// From this share on, an experiment counts as the only one.
const ALONE: f64 = 0.995;
/// Intervals that widen by less without an experiment stay as they are.
const WIDER: f64 = 1.1;

/// What an experiment contributes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Contribution {
    /// The experiment.
    pub experiment: String,
    /// For each parameter its share of the information, from 0 to 1; `None` where the parameter is not
    /// determined.
    pub shares: Vec<Option<f64>>,
    /// For each parameter the factor by which its interval is wider without this experiment; `None` where
    /// it is then not determined, or never was.
    pub without: Vec<Option<f64>>,
}

/// Those of all experiments; none where there is one alone.
pub(crate) fn contributions(problem: &Problem, local: &Local) -> Vec<Contribution> {
    let units: Vec<f64> =
        local.values.iter().map(|own| if *own == 0.0 { 1.0 } else { own.abs() }).collect();
    let n = units.len();
    let mut parts: Vec<(String, DMatrix<f64>)> = Vec::new();
    let mut first = 0;
    for own in problem.series.chunk_by(|a, b| a.experiment == b.experiment) {
        let count: usize = own.iter().map(|series| series.x.len()).sum();
        let rows = local.jacobian.rows(first, count);
        let gram = rows.tr_mul(&rows) / local.variance;
        let gram = DMatrix::from_fn(n, n, |k, l| gram[(k, l)] * units[k] * units[l]);
        parts.push((own[0].experiment.clone(), gram));
        first += count;
    }
    if parts.len() < 2 {
        return Vec::new();
    }
    let tolerance = Local::tolerance(problem.noise);
    let whole = parts.iter().fold(DMatrix::zeros(n, n), |sum, (_, part)| sum + part);
    let now = Information::new(&whole, tolerance);
    let (variances, covariance) = (now.variances(), now.covariance());
    let share = |part: &DMatrix<f64>, k: usize| -> Option<f64> {
        let z: DVector<f64> = covariance.as_ref()?.column(k).into_owned();
        let own = (z.transpose() * part * &z)[0];
        Some(own / variances[k]?).filter(|own| own.is_finite())
    };
    let one = |(experiment, part): &(String, DMatrix<f64>)| {
        let left = Information::new(&(&whole - part), tolerance).variances();
        let factor = |k: usize| Some((left[k]? / variances[k]?).sqrt());
        Contribution {
            experiment: experiment.clone(),
            shares: (0..n).map(|k| share(part, k)).collect(),
            without: (0..n).map(factor).collect(),
        }
    };
    parts.iter().map(one).collect()
}

/// What is said of each parameter.
pub(crate) fn sentences(all: &[Contribution], parameters: &[String]) -> Vec<String> {
    parameters.iter().enumerate().filter_map(|(k, name)| sentence(all, (k, name))).collect()
}

fn sentence(all: &[Contribution], (k, name): (usize, &str)) -> Option<String> {
    let share = |own: &Contribution| own.shares[k];
    let mut known: Vec<(&Contribution, f64)> =
        all.iter().filter_map(|own| Some((own, share(own)?))).collect();
    known.sort_by(|a, b| b.1.total_cmp(&a.1));
    let (most, largest) = *known.first()?;
    let experiment = &most.experiment;
    if largest >= ALONE {
        return Some(format!("{name} is known from {experiment} alone."));
    }
    let named = known.iter().take_while(|own| own.1 >= SMALL || own.1 == largest);
    let parts: Vec<String> = named
        .map(|(own, share)| {
            let percent = significant(100.0 * share, 2);
            let of = if own.experiment == *experiment { " of what the data say" } else { "" };
            format!("{percent} %{of} from {}", own.experiment)
        })
        .collect();
    let without = match most.without[k] {
        None => format!("without {experiment} it would not be determined"),
        Some(factor) if factor < WIDER => {
            format!("without {experiment} its interval would hardly be wider")
        }
        Some(factor) => format!(
            "without {experiment} its interval would be {} times as wide",
            significant(factor, 2)
        ),
    };
    Some(format!("{name}: {}; {without}.", parts.join(", ")))
}
