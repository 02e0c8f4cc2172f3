//! What must be known about a solution, in words.

use super::{
    FailureRegion, Form, Inseparable, Profiles, Solution, SolvedParameter, SolvedSeries, Statistics,
};
use crate::identify::table::significant;

/// Residuals whose runs are less probable than this are no noise.
const NO_NOISE: f64 = 0.01;
/// Residuals below this many times the error of the simulation come from the simulation.
const FROM_THE_SOLVER: f64 = 100.0;
/// Beyond this condition number digits of the sensitivities are lost.
const ILL_CONDITIONED: f64 = 1e4;

/// Factors and exponents below this are those of rounding.
const NEGLIGIBLE: f64 = 1e-12;

/// The sentences, most important first. `noise`: relative error of the simulated values.
pub(super) fn notes(solution: &Solution, statistics: &Statistics, noise: f64) -> Vec<String> {
    let mut notes = Vec::new();
    let name = |k: usize| solution.parameters[k].name.as_str();
    for &k in &statistics.without_effect {
        notes.push(format!("{} has no effect on the compared points.", name(k)));
    }
    for group in &statistics.inseparable {
        notes.push(inseparable(group, &name));
    }
    let alone = |k: usize| {
        !statistics.without_effect.contains(&k)
            && !statistics.inseparable.iter().any(|group| group.parameters.contains(&k))
    };
    for (k, parameter) in solution.parameters.iter().enumerate() {
        if parameter.determined == Some(false) && alone(k) {
            notes.push(undetermined(parameter));
        }
        if parameter.at_bound {
            let Some(end) = parameter.range.iter().min_by(|a, b| {
                (*a - parameter.value).abs().total_cmp(&(*b - parameter.value).abs())
            }) else {
                continue;
            };
            notes.push(format!(
                "{} lies at the end {} of its search range: the best value may lie beyond it.",
                parameter.name,
                significant(*end, 5)
            ));
        }
    }
    let pairs = solution.strongly_correlated();
    if !pairs.is_empty() {
        let text = |(k, l, c): &(usize, usize, f64)| {
            format!("{} and {} ({})", name(*k), name(*l), significant(*c, 4))
        };
        let pairs: Vec<String> = pairs.iter().map(text).collect();
        notes.push(format!("Hardly told apart (correlation): {}.", pairs.join(", ")));
    }
    if let Some(condition) = solution.condition.filter(|condition| *condition > ILL_CONDITIONED) {
        notes.push(format!(
            "The sensitivities are ill-conditioned ({}): small errors of the data change the \
             parameters much.",
            significant(condition, 2)
        ));
    }
    notes.extend(solution.series.iter().filter_map(|series| about_residuals(series, noise)));
    notes.extend(solution.failure_region.as_ref().map(about_failures));
    if statistics.uncertainty.is_none() {
        notes.push(
            "Deviations could not be computed: there are not more points than parameters, or the \
             simulation fails beside the best point."
                .to_owned(),
        );
    }
    notes
}

fn inseparable<'a>(group: &Inseparable, name: &impl Fn(usize) -> &'a str) -> String {
    let names: Vec<&str> = group.parameters.iter().map(|&k| name(k)).collect();
    let all = names.join(", ");
    let what = |combination: &Vec<f64>| {
        let parts = names.iter().zip(combination).filter(|(_, part)| part.abs() > NEGLIGIBLE);
        match group.form {
            Form::Sum => sum(parts),
            Form::Product => product(parts),
            Form::Local => {
                let change =
                    |(name, part): (&&str, &f64)| format!("{name} by {} %", significant(*part, 3));
                parts.map(change).collect::<Vec<_>>().join(", ")
            }
        }
    };
    let combinations: Vec<String> = group.combinations.iter().map(what).collect();
    let fix = match group.excess {
        1 => "one".to_owned(),
        excess => excess.to_string(),
    };
    if group.form == Form::Local {
        return format!(
            "{all} cannot be determined separately about the best values: changing {} together changes nothing. Fix {fix} of them.",
            combinations.join(", or ")
        );
    }
    format!(
        "{all} cannot be determined separately by any data of this kind: the model depends on {} alone. Fix {fix} of them.",
        combinations.join(" and ")
    )
}

fn sum<'a>(parts: impl Iterator<Item = (&'a &'a str, &'a f64)>) -> String {
    let mut text = String::new();
    for (name, factor) in parts {
        let sign = match (text.is_empty(), *factor < 0.0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        let size = significant(factor.abs(), 4);
        text += sign;
        text += &if size == "1" { (*name).to_owned() } else { format!("{size}*{name}") };
    }
    text
}

fn product<'a>(parts: impl Iterator<Item = (&'a &'a str, &'a f64)>) -> String {
    let power = |(name, exponent): (&&str, &f64)| match significant(*exponent, 4).as_str() {
        "1" => (*name).to_owned(),
        negative if negative.starts_with('-') => format!("{name}^({negative})"),
        exponent => format!("{name}^{exponent}"),
    };
    parts.map(power).collect::<Vec<_>>().join("*")
}

fn undetermined(parameter: &SolvedParameter) -> String {
    let [min, max] = parameter.range;
    let (low, high) = match parameter.interval {
        Some([low, high]) => (low.clamp(min, max), high.clamp(min, max)),
        None => (min, max),
    };
    format!(
        "{} cannot be determined from these data: it may be anything between {} and {}{}.",
        parameter.name,
        significant(low, 4),
        significant(high, 4),
        if (low, high) == (min, max) { ", its whole search range" } else { "" }
    )
}

/// What the profiles say beyond the linear intervals.
pub(super) fn profile_notes(solution: &Solution, found: &Profiles) -> Vec<String> {
    let mut notes = Vec::new();
    for (parameter, profile) in solution.parameters.iter().zip(&found.profiles) {
        let [min, max] = parameter.range.map(|end| significant(end, 4));
        let name = &parameter.name;
        let note = match profile.interval.map(|end| end.map(|end| significant(end, 4))) {
            [Some(_), Some(_)] => continue,
            [None, None] => format!(
                "By its profile {name} may be anything in its search range, {min} to {max}."
            ),
            [Some(low), None] => format!(
                "By its profile {name} is at least {low}; up to the end {max} of its range the data do not bound it."
            ),
            [None, Some(high)] => format!(
                "By its profile {name} is at most {high}; down to the end {min} of its range the data do not bound it."
            ),
        };
        notes.push(note);
    }
    if let Some((values, sum)) = &found.better {
        let pairs = solution.parameters.iter().zip(values);
        let values: Vec<String> =
            pairs.map(|(p, value)| format!("{} = {}", p.name, significant(*value, 6))).collect();
        notes.push(format!(
            "The profiles came upon a better fit ({}): {}. Run again, with a larger budget or these starts.",
            significant(*sum, 7),
            values.join(", ")
        ));
    }
    notes
}

pub(super) fn about_failures(region: &FailureRegion) -> String {
    let [inside, outside] = region.failed.map(|part| format!("{:.0} %", 100.0 * part));
    let [low, high] = region.range.map(|end| significant(end, 3));
    format!(
        "Simulations fail where {} is between {low} and {high}: {inside} of the individuals there failed, {outside} elsewhere.",
        region.parameter
    )
}

fn about_residuals(series: &SolvedSeries, noise: f64) -> Option<String> {
    let square: f64 = series.points.iter().map(|point| point[1] * point[1]).sum();
    let size = (square / series.points.len() as f64).sqrt();
    if series.rmse <= FROM_THE_SOLVER * noise * size {
        return Some(format!(
            "The residuals of {} are as small as the errors of the simulation: these data have no \
             noise, and deviations and intervals say nothing about measured ones.",
            series.y[0]
        ));
    }
    not_noise(series)
}

fn not_noise(series: &SolvedSeries) -> Option<String> {
    let [runs, expected, probability, autocorrelation] = series.residual_test?;
    (probability < NO_NOISE && runs < expected).then(|| {
        format!(
            "The residuals of {} are no noise: {runs} runs of equal sign where {} are expected, \
             correlation of neighbours {}. The model misses something of these data, so the \
             deviations are too small.",
            series.y[0],
            significant(expected, 3),
            significant(autocorrelation, 2)
        )
    })
}
