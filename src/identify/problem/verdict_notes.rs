//! Sentences about single parameters. They say what the verdict says, and where it comes from.

use super::profile::RangeEnd;
use super::range_notes::{is_upper, remedy};
use super::verdicts::{ByProfile, Judged};
use super::{Finding, FindingKind, Profiles, Severity, Solution, SolvedParameter, Verdict};
use crate::table::{ends, significant};

/// Standard errors that are not counted any more: where a bound causes the whole misfit, their number is
/// one of rounding (5.6e6 in data in kW for a range that was meant in W).
const MANY: f64 = 1e3;

/// What must be known about parameter `k`.
pub(super) fn about_parameter(solution: &Solution, k: usize, judged: &Judged) -> Vec<Finding> {
    let parameter = &solution.parameters[k];
    let name = &parameter.name;
    let missing = |sentence: String| {
        let finding = Finding::new(FindingKind::Missing, sentence);
        vec![finding.parameters([name.as_str()])]
    };
    match judged {
        Judged::Effect | Judged::Group | Judged::Exact | Judged::Nothing => Vec::new(),
        Judged::Linear => match parameter.verdict {
            Some(Verdict::PracticallyNonIdentifiable) => vec![undetermined(parameter, false)],
            _ => Vec::new(),
        },
        Judged::Profile(found) => by_profile(parameter, found, solution.parameters.len() == 1),
        Judged::Budget(budget) => missing(format!(
            "What these data say of {name} was not computed: its profile likelihood takes more \
             than {budget} simulations. `--profile` allows more."
        )),
        Judged::Stopped => missing(format!(
            "What these data say of {name} was not computed: the run was stopped before its \
             profile likelihood."
        )),
        Judged::Cut(cut) => missing(format!(
            "The profile likelihood of {name} ends at {}, before its 95 % limit: beyond it a \
             constraint is violated or simulations fail.",
            significant(*cut, 4)
        )),
    }
}

/// The same, where a profile has replaced what was said before. `alone`: there is no other parameter.
fn by_profile(parameter: &SolvedParameter, found: &ByProfile, alone: bool) -> Vec<Finding> {
    if let Some(pull) = found.pull {
        return vec![beyond(parameter, pull, alone)];
    }
    let mut findings = Vec::new();
    if parameter.verdict == Some(Verdict::PracticallyNonIdentifiable) {
        findings.push(undetermined(parameter, found.falls));
    } else if let Some(linear) = found.linear {
        findings.push(nonlinear(parameter, linear));
    }
    if parameter.verdict == Some(Verdict::Identifiable) {
        findings.extend(within_ranges(parameter));
    }
    if !parameter.pieces.is_empty() {
        let part = |ends_of: &[f64; 2]| ends(*ends_of, parameter.value);
        let parts: Vec<String> = parameter.pieces.iter().map(part).collect();
        let sentence = format!(
            "The values of {} within the 95 % limit are at least {} separate parts: {}.",
            parameter.name,
            parts.len(),
            parts.join("; ")
        );
        let finding = Finding::new(FindingKind::Interval, sentence).severity(Severity::Information);
        findings.push(finding.parameters([parameter.name.as_str()]));
    }
    findings
}

/// That the data do not bound a parameter on one side or on both. `falls`: whether the objective still
/// falls at the end of the range at which it stands.
fn undetermined(parameter: &SolvedParameter, falls: bool) -> Finding {
    let name = &parameter.name;
    let [min, max] = parameter.range.map(|end| significant(end, 4));
    let [low, high] = parameter.interval.unwrap_or(parameter.range).map(|end| significant(end, 4));
    let (side, end) = if is_upper(parameter) { ("upper", &max) } else { ("lower", &min) };
    let stands = match (parameter.at_bound, falls) {
        (false, _) => String::new(),
        (true, false) => format!(" The best value is the {side} end of the range."),
        (true, true) => format!(
            " The best value is the {side} end {end} of the range, and the objective still falls \
             there. {}",
            remedy(parameter)
        ),
    };
    let is_twice = parameter.open == [false; 2] && has_same_ends(&parameter.held);
    // Where the interval ends and the data do not end it.
    let beyond = |side: usize| match (parameter.open[side], &parameter.held[side][..]) {
        (true, _) => Some(format!("the end {} of its search range", [&min, &max][side])),
        (false, []) => None,
        (false, held) => {
            let place = format!(", where {}", RangeEnd::words(held));
            let place = if is_twice { "" } else { &place };
            Some(format!("{}{place}", [&low, &high][side]))
        }
    };
    let what = match [beyond(0), beyond(1)] {
        [Some(_), Some(_)] if parameter.open == [true; 2] => {
            format!("it can have any value in its whole search range, {min} to {max}")
        }
        [Some(below), Some(above)] => {
            let both = match is_twice {
                true => format!(", both where {}", RangeEnd::words(&parameter.held[0])),
                false => String::new(),
            };
            format!(
                "they do not bound it from below, down to {below}, nor from above, up to \
                 {above}{both}"
            )
        }
        [None, None] => format!("it can have any value between {low} and {high}"),
        [None, Some(above)] => {
            format!("it is at least {low}; they do not bound it from above, up to {above}")
        }
        [Some(below), None] => {
            format!("it is at most {high}; they do not bound it from below, down to {below}")
        }
    };
    let sentence =
        format!("{name} is practically non-identifiable from these data: {what}.{stands}");
    Finding::new(FindingKind::PracticallyNonIdentifiable, sentence).parameters([name.as_str()])
}

/// That the optimum lies beyond the end of the range, where the linear model is true of it.
fn beyond(parameter: &SolvedParameter, [pull, limit]: [f64; 2], alone: bool) -> Finding {
    let [min, max] = parameter.range.map(|end| significant(end, 5));
    let (side, end) = if is_upper(parameter) { ("upper", max) } else { ("lower", min) };
    let name = &parameter.name;
    let distance = match pull < MANY {
        true => significant(pull, 2),
        false => format!("more than {MANY}"),
    };
    let others = match alone {
        true => String::new(),
        false => format!(", and the intervals of the others are valid for {name} = {end}"),
    };
    let sentence = format!(
        "{name} lies at the {side} end {end} of its search range: the optimum lies beyond it, by \
         {distance} standard errors for a linear model, so it has no interval{others}. {}",
        remedy(parameter)
    );
    let finding = Finding::new(FindingKind::AtBound, sentence);
    finding.parameters([name.as_str()]).statistic(pull, limit)
}

/// That the range of another parameter ends an interval.
fn within_ranges(parameter: &SolvedParameter) -> Option<Finding> {
    let ends = ending_sides(&parameter.held)?;
    let sentence = format!(
        "The 95 % interval of {} ends {ends}: with a wider range it would be wider.",
        parameter.name
    );
    let finding = Finding::new(FindingKind::Interval, sentence).severity(Severity::Information);
    Some(finding.parameters([parameter.name.as_str()]))
}

/// On which sides the ranges of other parameters end an interval, and where; `None` if on none.
fn ending_sides(held: &[Vec<RangeEnd>; 2]) -> Option<String> {
    if has_same_ends(held) {
        return Some(format!("below and above where {}", RangeEnd::words(&held[0])));
    }
    let sides = ["below", "above"].into_iter().zip(held).filter(|(_, held)| !held.is_empty());
    let ends: Vec<String> =
        sides.map(|(side, held)| format!("{side} where {}", RangeEnd::words(held))).collect();
    (!ends.is_empty()).then(|| ends.join(", and "))
}

/// Whether the same ends of ranges end an interval on both sides.
fn has_same_ends([below, above]: &[Vec<RangeEnd>; 2]) -> bool {
    !below.is_empty() && below == above
}

fn nonlinear(parameter: &SolvedParameter, linear: [f64; 2]) -> Finding {
    let own = parameter.interval.unwrap_or(parameter.range);
    let sentence = format!(
        "The model is strongly nonlinear in {} near the fit: its 95 % interval {} comes from its \
         profile likelihood. The linearized interval, {}, is not valid.",
        parameter.name,
        ends(own, parameter.value),
        ends(linear, parameter.value)
    );
    let finding = Finding::new(FindingKind::Interval, sentence).severity(Severity::Information);
    finding.parameters([parameter.name.as_str()])
}

/// A better fit that the profiles have come upon.
pub(crate) fn profile_findings(solution: &Solution, found: &Profiles) -> Option<Finding> {
    let (values, sum) = found.better.as_ref()?;
    let pairs = solution.parameters.iter().zip(values);
    let values: Vec<String> =
        pairs.map(|(p, value)| format!("{} = {}", p.name, significant(*value, 6))).collect();
    let sentence = format!(
        "The profile likelihoods found a better fit ({}): {}. Run again with a larger budget \
         or with these start values.",
        significant(*sum, 7),
        values.join(", ")
    );
    let finding = Finding::new(FindingKind::OtherMinimum, sentence);
    Some(finding.severity(Severity::Serious))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_ends_an_interval_on_both_sides_is_said_once() {
        let end = |name: &str, end: f64| RangeEnd { parameter: name.to_owned(), end };
        let (b, c) = (end("b", 0.5), end("c", -2.0));
        for (below, above, expected) in [
            (vec![], vec![], ""),
            (vec![b.clone()], vec![], "below where b is at the end 0.5 of its search range"),
            (
                vec![b.clone()],
                vec![b.clone()],
                "below and above where b is at the end 0.5 of its search range",
            ),
            (
                vec![b.clone(), c.clone()],
                vec![b.clone(), c.clone()],
                "below and above where b is at the end 0.5 and c is at the end -2 of their search \
                 ranges",
            ),
            (
                vec![b.clone()],
                vec![end("b", 1.0)],
                "below where b is at the end 0.5 of its search range, and above where b is at the \
                 end 1 of its search range",
            ),
        ] {
            assert_eq!(ending_sides(&[below, above]).unwrap_or_default(), expected);
        }
    }
}
