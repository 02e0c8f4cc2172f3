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
mod inferred;
mod least_squares;
mod likelihood;
mod local;
mod posterior;
mod predictions;
mod prior_data;
mod term;

pub use adjusted::{Adjustments, Distribution, Prior, adjust};

pub(crate) use adjusted::{PRIOR, adjusted_from};
pub use bands::{Band, BandPoint};
pub use bootstrap::{Bootstrap, BootstrapSettings, Bootstrapped, IntervalKind, Resampling};
pub use comparison::{Compared, Comparison, Nested, compare};
pub use constraint::Constraint;
pub(crate) use constraint::PortableConstraint;
pub use design::{DesignSettings, NextMeasurement, Plan, Proposal};
pub use inferred::Inferred;
pub use likelihood::{Likelihood, logarithms};
pub use local::Local;
pub use posterior::{Posterior, PosteriorSettings, Sampled, diagnostics};
pub use predictions::{Curve, Curves, ModelPredictions, Predict, Reach, Wanted};
pub use term::{Function, Operator, Term};

use super::{FindingKind, Run, Solution};
use crate::diag::Fault;

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

/// Infers at the best point of a run what the problem asks for.
///
/// # Errors
///
/// Settings that do not fit the problem.
pub(crate) fn infer(run: &Run) -> Result<Inferred, Fault> {
    let wanted = &run.problem.inference;
    let mut found = Inferred::default();
    let Some(best) = &run.best else { return Ok(found) };
    found.likelihood = Likelihood::of(run, &best.values);
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
        let refusals = &mut found.refusals;
        found.bands = bands::bands(&run.problem, predict.as_ref(), &local, refusals)?;
    }
    if let Some(settings) = &wanted.design {
        let refusals = &mut found.refusals;
        found.next_measurement =
            design::next_measurement(&run.problem, settings, &local, refusals)?;
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
        found.bootstrap = bootstrap::bootstrap(run, settings, &local, &mut found.refusals)?;
    }
    if let Some(settings) = &wanted.posterior {
        found.posterior = posterior::posterior(run, settings, &local, &mut found.refusals)?;
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

#[cfg(test)]
mod tests;
