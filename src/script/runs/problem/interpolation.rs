//! Inputs of which neither the file nor the problem says how they continue between samples: after the
//! fit the other way is tried, and both objectives are reported.

use super::file::{Column, ProblemFile};
use super::inputs::{Between, Undecided};
use super::searches::{Again, Change};
use crate::Session;
use crate::diag::Fault;
use crate::identify::problem::{EndingKind, Finding, FindingKind, Run, Severity, Solution};
use crate::identify::significant;

/// Objectives that differ by less than this part are equal: these data do not show the difference.
const EQUAL: f64 = 1e-3;
/// Ratios of objectives below this are said in percent: a factor of 1.00 says nothing.
const FEW_PERCENT: f64 = 1.1;

/// The columns of inputs before a change: experiment, input, column.
pub(super) type Before = Vec<(usize, String, Column)>;

/// Sets how inputs continue between samples; returns what they were.
pub(super) fn set(file: &mut ProblemFile, names: &[&str], between: Between) -> Before {
    let mut before = Vec::new();
    for (number, experiment) in file.experiment.iter_mut().enumerate() {
        let inputs = experiment.inputs.iter_mut();
        for (name, column) in inputs.filter(|(name, _)| names.contains(&name.as_str())) {
            let mut entry = column.entry();
            if entry.interpolation.is_some() {
                continue;
            }
            entry.interpolation = Some(between.name().to_owned());
            let own = std::mem::replace(column, Column::More(Box::new(entry)));
            before.push((number, name.clone(), own));
        }
    }
    before
}

/// Puts back what [`set`] has replaced.
pub(super) fn restore(file: &mut ProblemFile, before: Before) {
    for (number, name, column) in before {
        if let Some(own) = file.experiment[number].inputs.get_mut(&name) {
            *own = column;
        }
    }
}

/// Fits once more with the other interpolation, and reports which of the two fits better.
///
/// # Errors
///
/// Those of the problem that is made again.
pub(super) fn try_others(
    session: &mut Session,
    (run, solution): (&mut Run, &mut Solution),
    undecided: &[Undecided],
    again: &mut Again<'_>,
) -> Result<(), Fault> {
    if solution.outcome.ending.kind != EndingKind::Minimum || session.world.interrupted() {
        return Ok(());
    }
    for assumed in [Between::Constant, Between::Linear] {
        let of_kind = undecided.iter().filter(|own| own.assumed == assumed);
        let names: Vec<&str> = of_kind.map(|own| own.name.as_str()).collect();
        if names.is_empty() {
            continue;
        }
        let other = again(session, Change::Interpolation(&names, assumed.other()))?;
        let processors = session.world.processors();
        let (found, simulations) = run.objective_with(other.problem.simulator, &processors)?;
        solution.effort.simulations_for_statistics += simulations;
        if session.world.interrupted() {
            let sentence = "Other interpolations of the inputs were not tried: the run was stopped \
                            before.";
            solution.findings.push(Finding::new(FindingKind::Missing, sentence));
            return Ok(());
        }
        solution.findings.push(finding(&names, assumed, [Some(solution.fitness), found]));
    }
    Ok(())
}

fn finding(names: &[&str], assumed: Between, [own, other]: [Option<f64>; 2]) -> Finding {
    let inputs = names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    let (Some(own), Some(other)) = (own, other) else {
        let sentence = format!(
            "With `interpolation = \"{}\"` of {inputs}, the best point could not be simulated.",
            assumed.other().name()
        );
        return Finding::new(FindingKind::Data, sentence).severity(Severity::Information);
    };
    let is_equal = (other - own).abs() <= EQUAL * own.abs();
    let better = if other < own { assumed.other() } else { assumed };
    let ratio = own.max(other) / own.min(other);
    let by = match ratio.is_finite() && own.min(other) > 0.0 {
        true if ratio < FEW_PERCENT => format!(" by {} %", significant(100.0 * (ratio - 1.0), 2)),
        true => format!(" by a factor of {}", significant(ratio, 3)),
        false => String::new(),
    };
    let verdict = match is_equal {
        true => "these data do not show which is right".to_owned(),
        false => format!("\"{}\" fits better{by}", better.name()),
    };
    let write = match (is_equal, better == assumed) {
        (false, false) => format!(
            "; write `interpolation = \"{}\"` in the entry of each in `inputs`",
            better.name()
        ),
        _ => String::new(),
    };
    let sentence = format!(
        "The interpolation of {inputs} is not given: with \"{}\" the objective is {}, with \"{}\" \
         {} after another fit: {verdict}{write}.",
        assumed.name(),
        significant(own, 5),
        assumed.other().name(),
        significant(other, 5)
    );
    let severity = match write.is_empty() {
        true => Severity::Information,
        false => Severity::Warning,
    };
    Finding::new(FindingKind::Data, sentence).severity(severity)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_differences_are_said_in_percent() {
        let said = |other| finding(&["I"], Between::Constant, [Some(0.0025), Some(other)]).sentence;
        assert!(said(0.00245).contains("\"linear\" fits better by 2 %;"), "{}", said(0.00245));
        assert!(
            said(0.001).contains("\"linear\" fits better by a factor of 2.5;"),
            "{}",
            said(0.001)
        );
        assert!(said(0.0025001).contains("do not show which is right"), "{}", said(0.0025001));
    }
}
