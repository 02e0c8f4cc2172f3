//! What inference has found, and its tables and sentences.

use super::{
    Band, BandPoint, Bootstrap, Contribution, Likelihood, NextMeasurement, Posterior, SpectrumBand,
};
use crate::problem::{Finding, SolvedState};
use crate::table::quoted;
use serde::{Deserialize, Serialize};

/// What inference has found.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Inferred {
    /// The likelihood of the fit, for comparisons; `None` where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub likelihood: Option<Likelihood>,
    /// Bands about the curves, for each experiment and variable.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bands: Vec<Band>,
    /// Bands of spectra by magnitude and phase.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spectra: Vec<SpectrumBand>,
    /// The next measurement.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub next_measurement: Option<NextMeasurement>,
    /// The bootstrap.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bootstrap: Option<Bootstrap>,
    /// The posterior.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub posterior: Option<Posterior>,
    /// What each of several experiments contributes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contributions: Vec<Contribution>,
    /// States that a filter and a smoother have found.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub states: Vec<SolvedState>,
    /// About priors and constraints; they go to the findings of the solution.
    #[serde(skip)]
    pub findings: Vec<Finding>,
    /// What could not be inferred, and why.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) refusals: Vec<String>,
}

impl Inferred {
    /// `bands.csv`: all bands.
    pub(crate) fn bands_csv(&self) -> String {
        let mut text = String::from("experiment,variable,x,y,confidence_95,prediction_95\n");
        let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        for band in &self.bands {
            for BandPoint { x, y, confidence, prediction } in &band.points {
                text += &format!(
                    "{},{},{x},{y},{},{}\n",
                    quoted(&band.experiment),
                    quoted(&band.y[0]),
                    number(*confidence),
                    number(*prediction)
                );
            }
        }
        text
    }

    /// The tables for files: names and contents.
    pub fn tables(&self) -> Vec<(&'static str, String)> {
        let mut tables = Vec::new();
        if !self.bands.is_empty() {
            tables.push(("bands.csv", self.bands_csv()));
        }
        tables.extend(self.bootstrap.as_ref().map(|found| ("bootstrap.csv", found.csv())));
        tables.extend(self.posterior.as_ref().map(|found| ("posterior.csv", found.csv())));
        tables
    }

    /// Bootstrap and posterior in words, under their headings.
    pub fn intervals(&self) -> Vec<(&'static str, Vec<String>)> {
        let bootstrap = self.bootstrap.iter().map(|found| ("Bootstrap", found.sentences()));
        let posterior = self.posterior.iter().map(|found| ("Posterior", found.sentences()));
        bootstrap.chain(posterior).collect()
    }

    /// What each experiment contributes, in words.
    pub(crate) fn contributed(&self, parameters: &[String]) -> Vec<String> {
        super::contributions::sentences(&self.contributions, parameters)
    }

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
            let known = self.contributed(&next.parameters);
            group("  What each experiment contributes\n", &known);
            group("  The next measurement\n", &next.sentences());
        }
        let bands: Vec<String> = self.bands.iter().filter_map(Band::sentence).collect();
        group("", &bands);
        for (heading, sentences) in self.intervals() {
            group(&format!("  {heading}\n"), &sentences);
        }
        group("", &self.refusals);
        text
    }
}
