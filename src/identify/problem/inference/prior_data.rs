//! What priors and constraints did to the estimates, in words.

use super::Local;
use crate::elementary;
use crate::problem::{Finding, FindingKind, Problem};
use crate::table::significant;

/// A posterior standard deviation above this fraction of the prior one comes from the prior: the
/// data hold less than a quarter of what the prior does.
const DOMINATES: f64 = 0.9;
/// Estimates farther from a prior than this many of its standard deviations contradict it.
const CONTRADICTS: f64 = 3.0;

/// Priors that dominate the data, and priors that contradict them.
pub fn compared(problem: &Problem, local: &Local) -> Vec<Finding> {
    let mut remarks = Vec::new();
    let finding = |sentence: String, name: &str, value: f64, threshold: f64| Finding {
        parameters: vec![name.to_owned()],
        value: Some(value),
        threshold: Some(threshold),
        ..Finding::new(FindingKind::Prior, sentence)
    };
    let variances = local.information.variances();
    for prior in &problem.inference.priors {
        let Some((mean, sd)) = prior.spread() else { continue };
        let logarithm = prior.is_logarithmic();
        let name = &problem.parameters[prior.parameter].name;
        let value = local.values[prior.parameter];
        let own = if logarithm { elementary::ln(value) } else { value };
        let unit = if logarithm { value } else { 1.0 };
        let what = if logarithm { format!("ln({name})") } else { name.clone() };
        if let Some(variance) = variances[prior.parameter] {
            let posterior = variance.sqrt() / unit;
            if posterior > DOMINATES * sd {
                let [before, after] = [sd, posterior].map(|own| significant(own, 3));
                // The weights of outputs are estimates, which may add more than the data take away.
                let sentence = match before == after || posterior >= sd {
                    true => format!(
                        "The estimate of {name} comes only from its prior: the data do not reduce \
                         the standard deviation {before} of {what}."
                    ),
                    false => format!(
                        "The estimate of {name} comes mainly from its prior: the data reduce the \
                         standard deviation of {what} only from {before} to {after}."
                    ),
                };
                remarks.push(finding(sentence, name, posterior / sd, DOMINATES));
            }
        }
        let distance = (own - mean).abs() / sd;
        if distance > CONTRADICTS {
            let sentence = format!(
                "The data contradict the prior of {name}: the estimate lies {} prior standard \
                 deviations from its centre.",
                significant(distance, 2)
            );
            remarks.push(finding(sentence, name, distance, CONTRADICTS));
        }
    }
    remarks
}

/// Constraints at whose limit the estimates lie.
pub(crate) fn at_constraints(problem: &Problem, values: &[f64]) -> Vec<Finding> {
    let active =
        problem.inference.constraints.iter().filter(|constraint| constraint.is_active(values));
    let remark = |text: &str| {
        let sentence = format!(
            "The best values lie at the limit of the constraint `{text}`: a better fit may lie \
             beyond it. There are no standard errors and intervals on the limit: computed along \
             it they would be too small, because the true values may lie inside."
        );
        Finding::new(FindingKind::Constraint, sentence)
    };
    active.map(|constraint| remark(&constraint.text)).collect()
}
