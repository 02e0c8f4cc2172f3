//! What priors and constraints did to the estimates, in words.

use super::Local;
use crate::identify::problem::Problem;
use crate::identify::table::significant;

/// A posterior standard deviation above this fraction of the prior one comes from the prior: the
/// data hold less than a quarter of what the prior does.
const DOMINATES: f64 = 0.9;
/// Estimates farther from a prior than this many of its standard deviations contradict it.
const CONTRADICTS: f64 = 3.0;

/// Priors that dominate the data, and priors that contradict them.
pub(super) fn compared(problem: &Problem, local: &Local) -> Vec<String> {
    let mut remarks = Vec::new();
    let variances = local.information.variances();
    for prior in &problem.inference.priors {
        let Some((mean, sd, logarithm)) = prior.point() else { continue };
        let name = &problem.parameters[prior.parameter].name;
        let value = local.values[prior.parameter];
        let own = if logarithm { value.ln() } else { value };
        let unit = if logarithm { value } else { 1.0 };
        let what = if logarithm { format!("ln({name})") } else { name.clone() };
        if let Some(variance) = variances[prior.parameter] {
            let posterior = variance.sqrt() / unit;
            if posterior > DOMINATES * sd {
                remarks.push(format!(
                    "What is known of {name} comes from its prior: the data bring the standard deviation of {what} from {} to {} only.",
                    significant(sd, 3),
                    significant(posterior, 3)
                ));
            }
        }
        let distance = (own - mean).abs() / sd;
        if distance > CONTRADICTS {
            remarks.push(format!(
                "The data contradict the prior of {name}: the estimate lies {} of its standard deviations from its centre.",
                significant(distance, 2)
            ));
        }
    }
    remarks
}

/// Constraints at whose limit the estimates lie.
pub(super) fn at_constraints(problem: &Problem, values: &[f64]) -> Vec<String> {
    let active =
        problem.inference.constraints.iter().filter(|constraint| constraint.is_active(values));
    let remark = |text: &str| {
        format!(
            "The best values lie at the limit of the constraint `{text}`: a better fit may lie beyond it, and intervals take no account of it."
        )
    };
    active.map(|constraint| remark(&constraint.text)).collect()
}
