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
mod contributions;
mod design;
mod inferred;
mod least_squares;
mod likelihood;
mod local;
mod posterior;
mod predictions;
mod prior_data;
mod term;

pub use adjusted::{Adjustments, Cause, Distribution, Prior, adjust};

pub(crate) use adjusted::adjusted_from;
pub use bands::{Band, BandPoint, SpectrumBand};
pub use bootstrap::{Bootstrap, BootstrapSettings, Bootstrapped, IntervalKind, Resampling};
pub use comparison::{Compared, Comparison, Nested, compare};
pub use constraint::Constraint;
pub(crate) use constraint::PortableConstraint;
pub use contributions::Contribution;
pub use design::{DesignSettings, NextMeasurement, Plan, Proposal};
pub use inferred::Inferred;
pub use likelihood::{Likelihood, beside};
pub use local::Local;
pub(crate) use local::errors_of_coefficients;
pub use posterior::{Posterior, PosteriorSettings, Sampled, diagnostics};
pub use predictions::{Curve, CurveRequest, Curves, ModelPredictions, Predict, Proposed, Reach};
pub use term::{Function, Operator, Term};

use super::{ErrorModel, FindingKind, Problem, Run, Solution};
use crate::diag::Fault;

/// The parts, as the reader of a report knows them.
const BANDS: &str = "prediction bands";
const NEXT: &str = "next measurement";
const BOOTSTRAP: &str = "bootstrap";
const POSTERIOR: &str = "posterior";

/// What a problem requests beyond the estimates.
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
    /// Priors; those with a width are points after the measured ones.
    pub priors: Vec<Prior>,
    /// Constraints, which the simulator checks.
    pub constraints: Vec<Constraint>,
    /// Series whose logarithms are compared.
    pub logarithmic: Vec<usize>,
}

/// Infers at the best point of a run what the problem asks for. What was not made because the run was
/// stopped is said.
///
/// # Errors
///
/// Settings that do not fit the problem.
pub(crate) fn infer(run: &Run) -> Result<Inferred, Fault> {
    let requested = &run.problem.inference;
    let Some(best) = run.observed.best.as_ref().filter(|_| !run.evaluation.is_cancelled()) else {
        return Ok(Inferred::stopped(requested.parts()));
    };
    let mut found = Inferred {
        likelihood: Likelihood::of(run, &best.values),
        findings: prior_data::at_constraints(&run.problem, &best.values),
        ..Inferred::default()
    };
    let first = run.problem.series.first().map(|own| own.experiment.as_str());
    let is_joint = run.problem.series.iter().any(|own| Some(own.experiment.as_str()) != first);
    if requested.is_empty() && !is_joint {
        return Ok(found);
    }
    run.evaluation.show("intervals: derivatives at the best values");
    let local = match Local::at(&run.problem, &run.evaluation, &best.values) {
        Ok(local) => local,
        Err(_) if run.evaluation.is_cancelled() => return Ok(Inferred::stopped(requested.parts())),
        Err(why) => {
            if requested.more_than_bands() {
                found.refusals.push(format!("Nothing is inferred beyond the estimates: {why}."));
            }
            return Ok(found);
        }
    };
    found.contributions = contributions::contributions(&run.problem, &local);
    let mut parts = Made { run, refusals: Vec::new(), stopped: Vec::new() };
    if let Some(predict) = requested.predict.as_ref().filter(|_| requested.bands) {
        let make = |refusals: &mut Vec<String>| {
            bands::bands(&run.problem, predict.as_ref(), &local, refusals)
        };
        (found.bands, found.spectra) = parts.part(BANDS, make)?;
    }
    let settings = requested.design.as_ref().filter(|_| match without_design(&run.problem) {
        Some(why) => {
            parts.refusals.push(format!("There is no plan for the next measurement {why}."));
            false
        }
        None => true,
    });
    if let Some(settings) = settings {
        let make = |refusals: &mut Vec<String>| {
            design::next_measurement(&run.problem, settings, &local, refusals)
        };
        found.next_measurement = parts.part(NEXT, make)?;
    }
    found.findings.extend(prior_data::compared(&run.problem, &local));
    if local.robust {
        found.likelihood = None;
    }
    found.draw((&mut parts, &local), requested)?;
    found.refusals.append(&mut parts.refusals);
    found.refusals.append(&mut Inferred::stopped(parts.stopped).refusals);
    Ok(found)
}

/// Where there is no plan for the next measurement, in words that follow on it.
fn without_design(problem: &Problem) -> Option<&'static str> {
    if problem.series.iter().any(|own| !own.scaling.is_empty()) {
        return Some("where scales or offsets are estimated: a new measurement may have others");
    }
    if super::joint::is_joint(&problem.series) {
        return Some("where the errors of outputs are correlated");
    }
    // What further points would tell of their deviations is not counted.
    (ErrorModel::of(problem) == ErrorModel::Computed || !problem.is_normal()).then_some(
        "where the model computes the standard deviations, or where errors are not normal",
    )
}

impl Inferred {
    /// Bootstrap and posterior.
    fn draw(
        &mut self,
        (parts, local): (&mut Made<'_>, &Local),
        requested: &Inference,
    ) -> Result<(), Fault> {
        let run = parts.run;
        if local.robust {
            if requested.bootstrap.is_some() || requested.posterior.is_some() {
                parts.refusals.push(format!(
                    "There is no bootstrap and no posterior for the robust loss `{}`: minimize \
                     `sum_of_squares` instead.",
                    run.problem.objectives[0].0
                ));
            }
            return Ok(());
        }
        if let Some(settings) = &requested.bootstrap {
            let make = |refusals: &mut _| bootstrap::bootstrap(run, settings, local, refusals);
            self.bootstrap = parts.part(BOOTSTRAP, make)?;
        }
        let is_relative = run.problem.series.iter().any(|own| !own.scaling.is_empty());
        if is_relative && requested.posterior.is_some() {
            parts.refusals.push(
                "There is no posterior where scales or offsets are estimated: make them parameters of \
                 the model, with ranges."
                    .to_owned(),
            );
        } else if let Some(settings) = &requested.posterior {
            let make = |refusals: &mut _| posterior::posterior(run, settings, local, refusals);
            self.posterior = parts.part(POSTERIOR, make)?;
        }
        Ok(())
    }

    /// Nothing but a sentence on the parts that were not made, because the run was stopped.
    fn stopped(parts: Vec<&'static str>) -> Inferred {
        let sentence =
            || format!("Not computed, because the run was stopped before: {}.", parts.join(", "));
        let refusals = if parts.is_empty() { Vec::new() } else { vec![sentence()] };
        Inferred { refusals, ..Inferred::default() }
    }
}

/// The results of the parts that a problem requests.
struct Made<'a> {
    run: &'a Run,
    /// What cannot be made.
    refusals: Vec<String>,
    /// What was not made because the run was stopped.
    stopped: Vec<&'static str>,
}

impl Made<'_> {
    /// Makes a part, unless the run was stopped before or meanwhile.
    fn part<T: Default>(
        &mut self,
        name: &'static str,
        make: impl FnOnce(&mut Vec<String>) -> Result<T, Fault>,
    ) -> Result<T, Fault> {
        let mut refusals = Vec::new();
        let evaluation = &self.run.evaluation;
        evaluation.show(name);
        let made = match evaluation.is_cancelled() {
            true => Ok(T::default()),
            false => make(&mut refusals),
        };
        if evaluation.is_cancelled() {
            self.stopped.push(name);
            return Ok(T::default());
        }
        self.refusals.append(&mut refusals);
        made
    }
}

impl Solution {
    /// Says that nothing was inferred of what the problem requests, because the run was stopped.
    #[must_use]
    pub fn without_inference(self, run: &Run) -> Solution {
        Solution { inferred: Inferred::stopped(run.problem.inference.parts()), ..self }
    }

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
            return Some(format!(
                "{} has a step-wise effect, or its derivative vanishes",
                own.name
            ));
        }
        let mut all = self.parameters.iter().zip(&self.grounds.flat);
        let flat = all.find(|(own, is_flat)| own.by_profile && !own.at_bound && **is_flat);
        flat.map(|(own, _)| format!("the derivative by {} vanishes at the best values", own.name))
    }
}

impl Inference {
    fn is_empty(&self) -> bool {
        !self.bands && self.priors.is_empty() && !self.more_than_bands()
    }

    /// The names of what is requested.
    fn parts(&self) -> Vec<&'static str> {
        let all = [
            (BANDS, self.bands && self.predict.is_some()),
            (NEXT, self.design.is_some()),
            (BOOTSTRAP, self.bootstrap.is_some()),
            (POSTERIOR, self.posterior.is_some()),
        ];
        all.into_iter().filter(|(_, is_requested)| *is_requested).map(|(name, _)| name).collect()
    }

    /// Whether something was asked for that is not computed anyway.
    fn more_than_bands(&self) -> bool {
        !self.band_variables.is_empty()
            || self.design.is_some()
            || self.bootstrap.is_some()
            || self.posterior.is_some()
    }
}

#[cfg(test)]
mod tests;
