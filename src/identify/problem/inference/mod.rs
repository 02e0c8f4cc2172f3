//! Inference at the minimum: what follows from the data beyond the estimates.
//!
//! Prediction bands about the curves and the next measurement (optimal design of experiments) from
//! the Jacobian and the covariance of the estimates, the bootstrap, the posterior distribution.
//! They are functions of the problem and the best point and do not change the fit. Priors,
//! constraints and log-normal data do: they are part of the problem that is solved.

mod adjusted;
mod bands;
mod bootstrap;
mod comparison;
mod constraint;
mod design;
mod least_squares;
mod local;
mod posterior;
mod predictions;
mod prior_data;

pub use adjusted::{Adjustments, Distribution, PRIOR, Prior, adjust};
pub use bands::{Band, BandPoint};
pub use bootstrap::{Bootstrap, BootstrapSettings, Bootstrapped, IntervalKind, Resampling};
pub use comparison::{Compared, Comparison, Likelihood, Nested, compare};
pub use constraint::{Constraint, Sides};
pub use design::{DesignSettings, NextMeasurement, Plan, Proposal};
pub use local::Local;
pub use posterior::{Posterior, PosteriorSettings, Sampled, diagnostics};
pub use predictions::{Curve, Curves, ModelPredictions, Predict, Reach, Wanted};

use super::{Finding, FindingKind, Run, Solution};
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
    /// The bootstrap, where it is asked for.
    pub bootstrap: Option<BootstrapSettings>,
    /// The posterior, where it is asked for.
    pub posterior: Option<PosteriorSettings>,
    /// Priors; those with a width are points behind the measured ones.
    pub priors: Vec<Prior>,
    /// Constraints, which the simulator checks.
    pub constraints: Vec<Constraint>,
    /// Series whose logarithms are compared.
    pub logarithmic: Vec<usize>,
}

/// What inference has found.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Inferred {
    /// The likelihood of the fit, for comparisons; `None` where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub likelihood: Option<Likelihood>,
    /// Bands about the curves, for each experiment and variable.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bands: Vec<Band>,
    /// The next measurement.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub next_measurement: Option<NextMeasurement>,
    /// The bootstrap.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bootstrap: Option<Bootstrap>,
    /// The posterior.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub posterior: Option<Posterior>,
    /// About priors and constraints; they go to the findings of the solution.
    #[serde(skip)]
    pub findings: Vec<Finding>,
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
    let Some(best) = &run.best else { return Ok(found) };
    found.likelihood = comparison::likelihood(run, &best.values);
    found.findings.extend(prior_data::at_constraints(&run.problem, &best.values));
    if wanted.is_empty() {
        return Ok(found);
    }
    let local = match Local::at(&run.problem, &run.evaluation, &best.values) {
        Ok(local) => local,
        Err(why) => {
            if wanted.more_than_bands() {
                found.refusals.push(format!("Nothing is inferred beyond the estimates: {why}."));
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
    found.findings.extend(prior_data::compared(&run.problem, &local));
    if local.robust {
        found.likelihood = None;
        if wanted.bootstrap.is_some() || wanted.posterior.is_some() {
            found.refusals.push(format!(
                "There is no bootstrap and no posterior for the robust loss `{}`: minimise \
                 `sum_of_squares` instead.",
                run.problem.objectives[0].0
            ));
        }
        return Ok(found);
    }
    if let Some(settings) = &wanted.bootstrap {
        bootstrap::add(run, settings, &local, &mut found)?;
    }
    if let Some(settings) = &wanted.posterior {
        posterior::add(run, settings, &local, &mut found)?;
    }
    Ok(found)
}

impl Solution {
    /// Adds what is inferred at the best point of its run.
    ///
    /// # Errors
    ///
    /// As [`infer`].
    pub fn add_inference(&mut self, run: &Run) -> Result<(), Fault> {
        let mut found = infer(run)?;
        if let Some(why) = self.keeps_chains().filter(|_| found.posterior.is_some()) {
            found.posterior = None;
            found.refusals.push(format!(
                "There is no posterior: {why}, and chains that start at the best values would \
                 not reach it."
            ));
        }
        self.findings.append(&mut found.findings);
        self.inferred = found;
        Ok(())
    }
}

impl Solution {
    /// Why chains from the best values may miss a part of the posterior.
    fn keeps_chains(&self) -> Option<String> {
        let has = |kind: FindingKind| self.findings.iter().any(|finding| finding.kind == kind);
        if has(FindingKind::OtherMinimum) {
            return Some("another minimum fits these data as well".to_owned());
        }
        let steps = self.parameters.iter().find(|own| own.in_steps);
        if let Some(own) = steps {
            return Some(format!("{} acts in steps, or its derivative vanishes", own.name));
        }
        let curved = self.parameters.iter().find(|own| own.by_profile && own.deviation.is_none());
        curved.map(|own| format!("the derivative by {} vanishes at the best values", own.name))
    }
}

impl Inference {
    fn is_empty(&self) -> bool {
        !self.bands && self.priors.is_empty() && !self.more_than_bands()
    }

    /// Whether something was asked for that is not computed anyway.
    fn more_than_bands(&self) -> bool {
        !self.band_variables.is_empty()
            || self.design.is_some()
            || self.bootstrap.is_some()
            || self.posterior.is_some()
    }
}

/// A table of numbers below names.
fn table_csv<'a>(names: impl Iterator<Item = &'a str>, rows: &[Vec<f64>]) -> String {
    let names: Vec<String> = names.map(super::text::quoted).collect();
    let mut text = names.join(",") + "\n";
    for row in rows {
        let cells: Vec<String> = row.iter().map(f64::to_string).collect();
        text += &(cells.join(",") + "\n");
    }
    text
}

impl Inferred {
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
        for (heading, sentences) in self.intervals() {
            group(&format!("  {heading}\n"), &sentences);
        }
        group("", &self.refusals);
        text
    }
}

#[cfg(test)]
mod tests;
