//! Inference at the minimum: what follows from the data beyond the estimates.
//!
//! Prediction bands about the curves, the next measurement (optimal design of experiments), all
//! from the Jacobian and the covariance of the estimates. Everything here is a function of the
//! problem and the best point; nothing changes the fit.

mod bands;
mod design;
mod local;
mod predictions;

pub use bands::{Band, BandPoint};
pub use design::{DesignSettings, NextMeasurement, Plan, Proposal};
pub use local::Local;
pub use predictions::{Curve, Curves, ModelPredictions, Predict, Reach, Wanted};

use super::Run;
use crate::diag::Fault;
use serde::{Deserialize, Serialize};

/// What a problem wants to know beyond the estimates.
#[derive(Default)]
pub struct Inference {
    /// Simulates variables at points that were not measured; without it there are neither bands
    /// nor designs.
    pub predict: Option<Box<dyn Predict>>,
    /// Whether bands are computed.
    pub bands: bool,
    /// Variables beside the measured ones that get a band.
    pub band_variables: Vec<String>,
    /// The next measurement, where it is asked for.
    pub design: Option<DesignSettings>,
}

/// What inference has found.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Inferred {
    /// Bands about the curves, for each experiment and variable.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bands: Vec<Band>,
    /// The next measurement.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub next_measurement: Option<NextMeasurement>,
    /// What could not be inferred, and why.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub refusals: Vec<String>,
}

/// Infers at the best point of a run what the problem asks for.
///
/// # Errors
///
/// Settings that do not fit the problem.
pub fn infer(run: &Run) -> Result<Inferred, Fault> {
    let wanted = &run.problem.inference;
    let mut found = Inferred::default();
    let asked = wanted.bands || wanted.design.is_some();
    let (Some(best), true) = (&run.best, asked) else { return Ok(found) };
    let local = match Local::at(&run.problem, &run.evaluation, &best.values) {
        Ok(local) => local,
        Err(why) => {
            if wanted.design.is_some() || !wanted.band_variables.is_empty() {
                found.refusals.push(format!("There are no bands and no plan: {why}."));
            }
            return Ok(found);
        }
    };
    if wanted.bands
        && let Some(predict) = &wanted.predict
    {
        bands::add(&run.problem, predict.as_ref(), &local, &mut found)?;
    }
    if let Some(settings) = &wanted.design {
        design::add(&run.problem, settings, &local, &mut found)?;
    }
    Ok(found)
}

impl Inferred {
    /// The sentences of the report, with an empty line before each group.
    pub fn text(&self) -> String {
        let mut text = String::new();
        let mut group = |heading: &str, sentences: &[String]| {
            if sentences.is_empty() {
                return;
            }
            text += &format!("\n{heading}");
            sentences.iter().for_each(|sentence| text += &format!("  {sentence}\n"));
        };
        if let Some(next) = &self.next_measurement {
            group("  The next measurement\n", &next.sentences());
        }
        let bands: Vec<String> = self.bands.iter().filter_map(Band::sentence).collect();
        group("", &bands);
        group("", &self.refusals);
        text
    }
}

#[cfg(test)]
mod tests;
