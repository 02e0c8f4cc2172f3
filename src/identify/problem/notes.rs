//! Findings about parameters and data: what the intervals mean, and what the data cannot say.

use super::checks::residual_findings;
use super::effects::{Effect, How};
use super::verdict_notes::about_parameter;
use super::verdicts::Judged;
use super::{
    ErrorModel, FailureRegion, Finding, FindingKind, Form, NonIdentifiable, OtherMinimum, Run,
    Severity, Sigma, Solution, SolvedSeries, Statistics,
};
use crate::diag::suggest;
use crate::elementary;
use crate::table::{digits_of, ends, significant};
use crate::uncertainty_given;
use indexmap::IndexMap;

/// Beyond this condition number digits of the sensitivities are lost.
const ILL_CONDITIONED: f64 = 1e4;
/// Factors and exponents below this are those of rounding.
const NEGLIGIBLE: f64 = 1e-12;
/// Of changes that together change nothing, those below this part of the largest are not worth a word.
const SMALL_CHANGE: f64 = 1e-3;
/// A point that is alone in its series dominates a parameter whose standard error is so many times
/// as large without it.
const DOMINANT: f64 = 3.0;
/// Estimated standard deviations that are listed, and outputs of each.
const SIGMAS: usize = 20;
const OUTPUTS: usize = 3;
/// Rows that are listed.
const LISTED: usize = 10;
/// Held-out data of the same kind have ratios of the errors up to this by chance and by the
/// parameters' own errors; beyond ten the model is said not to hold.
const RATIOS: [f64; 2] = [1.5, 10.0];

/// All findings, most important first. `judged`: how each parameter was judged.
pub fn findings(
    solution: &Solution,
    run: &Run,
    (statistics, effects, judged): (&Statistics, &[(usize, Effect)], &[Judged]),
    simulated: &[f64],
) -> Vec<Finding> {
    let mut findings: Vec<Finding> = about_count(solution, run, statistics).into_iter().collect();
    findings.extend(about_effects(solution, statistics, effects));
    findings.extend(about_parameters(solution, statistics, judged));
    if run.problem.objectives.len() > 1 {
        findings.push(several_objectives(solution));
    }
    findings.extend(run.conclusion.findings.clone());
    findings.extend(super::error_model::decided(&run.problem.series));
    findings.extend(estimated(run, solution));
    findings.extend(solution.series.iter().filter_map(without_scale));
    findings.extend(equal_columns(run, statistics));
    findings.extend(dominant(run, statistics));
    findings.extend(residual_findings(
        &run.problem,
        statistics,
        simulated,
        run.conclusion.resolved,
    ));
    findings.extend(solution.validation.iter().map(|own| about_validation(own, solution)));
    findings.extend(about_missing(run));
    findings.extend(solution.effort.failure_region.as_ref().map(about_failures));
    findings
}

/// Points against parameters.
fn about_count(solution: &Solution, run: &Run, statistics: &Statistics) -> Option<Finding> {
    let (points, parameters) = (run.problem.n_points(), solution.parameters.len());
    let few = statistics.spread.freedom < 1.0;
    if !few && statistics.uncertainty.is_some() {
        return None;
    }
    if !few {
        let sentence = "Standard errors could not be computed: the simulation fails near the \
                        best point, or its derivatives are not finite.";
        return Some(Finding::new(FindingKind::Missing, sentence));
    }
    let kind = FindingKind::TooFewPoints;
    let sentence = format!(
        "{points} points for {parameters} parameters leave no degrees of freedom: {}. Any model \
         with that many parameters fits such data; measure more points or fix parameters.",
        match statistics.spread.believed && statistics.uncertainty.is_some() {
            true =>
                "the standard errors are based only on the given sigma, and no test is possible",
            false => "there are no standard errors, and no test is possible",
        }
    );
    let finding = Finding::new(kind, sentence).severity(Severity::Serious);
    Some(finding.statistic(statistics.spread.freedom, 1.0))
}

fn about_effects(
    solution: &Solution,
    statistics: &Statistics,
    effects: &[(usize, Effect)],
) -> Vec<Finding> {
    let one = |(k, effect): &(usize, Effect)| {
        let parameter = &solution.parameters[*k];
        let name = &parameter.name;
        let end = |end: f64| significant(end, 4);
        let [min, max] = parameter.range;
        let (kind, sentence) = match effect {
            Effect::None if statistics.is_made_up_for(*k) => (
                FindingKind::StructurallyNonIdentifiable,
                format!(
                    "The data do not determine {name}: it does the same as an estimated scale or \
                     offset of an output. Fix it, or give the scale."
                ),
            ),
            Effect::None => {
                (FindingKind::NoEffect, format!("{name} has no effect on the measured points."))
            }
            Effect::Finite(finite) => {
                let acts = match finite.how {
                    How::InSteps => "has a step-wise effect: its derivative is zero",
                    How::Vanishing => "has a derivative that vanishes at the best values",
                    How::Cancelling => "has a derivative that cancels with those of others",
                };
                let within = match finite.how {
                    How::InSteps => " Within the step, the data contain no information.",
                    How::Vanishing | How::Cancelling => "",
                };
                match finite.ends {
                    [Some(low), Some(high)] => (
                        FindingKind::Interval,
                        format!(
                            "{name} {acts}, but only values from {} to {} fit these data when \
                             the other parameters are refitted; the intervals of the others are \
                             valid for all of these values.{within}",
                            end(low),
                            end(high)
                        ),
                    ),
                    [low, high] => (
                        FindingKind::PracticallyNonIdentifiable,
                        format!(
                            "{name} {acts}, and values from {} to {} fit these data when the \
                             other parameters are refitted; the range ends before the data bound \
                             it.",
                            end(low.unwrap_or(min)),
                            end(high.unwrap_or(max))
                        ),
                    ),
                }
            }
        };
        Finding::new(kind, sentence).parameters([name.as_str()])
    };
    effects.iter().map(one).collect()
}

fn about_parameters(
    solution: &Solution,
    statistics: &Statistics,
    judged: &[Judged],
) -> Vec<Finding> {
    let mut findings = Vec::new();
    let name = |k: usize| solution.parameters[k].name.as_str();
    for group in &statistics.rank.non_identifiable {
        let kind = match group.form {
            Form::Sum | Form::Product | Form::Function => FindingKind::StructurallyNonIdentifiable,
            Form::Local => FindingKind::PracticallyNonIdentifiable,
        };
        let names = group.parameters.iter().map(|&k| name(k));
        let mut sentence = non_identifiable(group, &name);
        if !judged.contains(&Judged::Exact) {
            sentence += &determined(group, solution, statistics);
        }
        findings.push(Finding::new(kind, sentence).parameters(names));
    }
    for (k, judged) in judged.iter().enumerate() {
        findings.extend(about_parameter(solution, k, judged));
    }
    findings.extend(super::valley::determined(solution, statistics));
    let pairs = solution.strongly_correlated();
    if !pairs.is_empty() {
        let text = |(k, l, c): &(usize, usize, f64)| {
            format!("{} and {} ({})", name(*k), name(*l), significant(*c, 4))
        };
        let pairs: Vec<String> = pairs.iter().map(text).collect();
        let sentence = format!("Strongly correlated: {}.", pairs.join(", "));
        findings
            .push(Finding::new(FindingKind::Correlated, sentence).severity(Severity::Information));
    }
    // A lack of rank has been reported.
    let condition = solution.condition.filter(|_| statistics.rank.non_identifiable.is_empty());
    if let Some(condition) = condition.filter(|condition| *condition > ILL_CONDITIONED) {
        let sentence = format!(
            "The sensitivities are ill-conditioned ({}): small errors in the data cause large \
             changes of the parameters.",
            significant(condition, 2)
        );
        let finding = Finding::new(FindingKind::IllConditioned, sentence);
        findings.push(finding.statistic(condition, ILL_CONDITIONED));
    }
    findings
}

fn several_objectives(solution: &Solution) -> Finding {
    Finding::new(
        FindingKind::Missing,
        format!(
            "Values, intervals and tests refer to the end of the Pareto front with the smallest \
             `{}`; other points of the front are other compromises.",
            solution.subject.fitness_name
        ),
    )
    .severity(Severity::Information)
}

fn estimated(run: &Run, solution: &Solution) -> Option<Finding> {
    if solution.likelihood.error_model != ErrorModel::Estimated {
        return None;
    }
    // By the name of the estimate, which outputs share.
    let mut sigmas: IndexMap<String, Vec<&str>> = IndexMap::new();
    let data = run.problem.series.iter().filter(|series| series.is_data());
    for (series, solved) in data.zip(&solution.series) {
        let (Some(sigma), Some(name)) = (solved.sigma, series.deviation()) else { continue };
        let size = format!("{} {}", significant(sigma, 4), series.y_unit);
        let (name, of) = match series.sigma {
            Sigma::Shared(_) if series.joint.is_none() => (name, series.y_name.as_str()),
            _ => (series.y_name.as_str(), ""),
        };
        let outputs = sigmas.entry(format!("{name} {}", size.trim_end())).or_default();
        if !of.is_empty() && !outputs.contains(&of) {
            outputs.push(of);
        }
    }
    let one = |(sigma, outputs): (&String, &Vec<&str>)| match abridged(outputs, OUTPUTS) {
        of if of.is_empty() => sigma.clone(),
        of => format!("{sigma} ({of})"),
    };
    let all: Vec<String> = sigmas.iter().map(one).collect();
    let what = match run.problem.is_normal() {
        true => "Standard deviations",
        false => "Scales of the errors",
    };
    let source = if all.len() > SIGMAS { ": all are in `result.json`" } else { "" };
    let sentence =
        format!("{what} estimated with the parameters: {}{source}.", abridged(&all, SIGMAS));
    Some(Finding::new(FindingKind::ErrorModel, sentence).severity(Severity::Information))
}

/// The first of these, and how many there are more.
fn abridged<T: AsRef<str>>(all: &[T], most: usize) -> String {
    let shown: Vec<&str> = all.iter().take(most).map(AsRef::as_ref).collect();
    match all.len().checked_sub(most).filter(|more| *more > 0) {
        Some(more) => format!("{} and {more} more", shown.join(", ")),
        None => shown.join(", "),
    }
}

/// A series that the model follows with a negative scale only.
fn without_scale(series: &SolvedSeries) -> Option<Finding> {
    series.scale.as_ref().filter(|own| own.value == 0.0)?;
    let name = match series.experiment.is_empty() {
        true => series.y[0].clone(),
        false => format!("{} / {}", series.experiment, series.y[0]),
    };
    let sentence = format!(
        "The scale of {name} is 0: no positive one fits better than none, so that these data say \
         nothing about the parameters. Check the variable and the column, or allow a negative scale, \
         `scale = {{ sign = \"any\" }}`."
    );
    let finding = Finding::new(FindingKind::ScaleOfOutputs, sentence).severity(Severity::Serious);
    Some(finding.series(&name))
}

fn equal_columns(run: &Run, statistics: &Statistics) -> Vec<Finding> {
    let series = &run.problem.series;
    let one = |&(later, earlier): &(usize, usize)| {
        let (a, b) = (&series[earlier], &series[later]);
        let column = |own: &super::Series| match own.column.is_empty() {
            true => own.label(),
            false => format!("`{}`", own.column),
        };
        Finding::new(
            FindingKind::ColumnsEqual,
            format!(
                "The columns {} and {} contain the same numbers: they are {} points, not {}, and \
                 count once in the standard errors.",
                column(a),
                column(b),
                a.y.len(),
                a.y.len() + b.y.len()
            ),
        )
        .series(a.label())
        .series(b.label())
    };
    statistics.repeated.iter().map(one).collect()
}

/// Single points, such as a value known before, that determine a parameter against the data.
fn dominant(run: &Run, statistics: &Statistics) -> Vec<Finding> {
    let Some(all) = &statistics.uncertainty else { return Vec::new() };
    let (mut findings, mut first) = (Vec::new(), 0);
    for series in &run.problem.series {
        let place = first;
        first += series.x.len();
        // Priors are compared with the data elsewhere.
        let is_prior = !series.is_data();
        if series.x.len() != 1 || is_prior || statistics.spread.freedom < 1.0 {
            continue;
        }
        let mut rest = statistics.weighted(&statistics.jacobian);
        for column in &mut rest {
            column.remove(place);
        }
        let Some(without) = uncertainty_given(&rest, statistics.spread.variance) else { continue };
        for (k, free) in run.problem.parameters.iter().enumerate() {
            let ratio = without.standard_deviations[k] / all.standard_deviations[k];
            if ratio.is_nan() || ratio <= DOMINANT {
                continue;
            }
            let alone = match ratio.is_finite() {
                true => format!(
                    "with the other data alone, its standard error is {}, {} times as large",
                    significant(without.standard_deviations[k], 3),
                    significant(ratio, 3)
                ),
                false => "it is not identifiable from the other data".to_owned(),
            };
            findings.push(
                Finding::new(
                    FindingKind::Dominant,
                    format!(
                        "{} is determined by the single point {} of {}, as by a prior: {alone}. \
                         These data cannot show whether that value is correct.",
                        free.name,
                        significant(series.y[0], 5),
                        series.label()
                    ),
                )
                .series(series.label())
                .parameters([free.name.as_str()])
                .statistic(ratio, DOMINANT),
            );
        }
    }
    findings
}

impl Solution {
    /// Says again how held-out data compare, after predictions were replaced.
    pub fn compare_validation_again(&mut self) {
        let said: Vec<Finding> =
            self.validation.iter().map(|own| about_validation(own, self)).collect();
        let places = self.findings.iter_mut().filter(|own| own.kind == FindingKind::Validation);
        for own in places {
            if let Some(found) = said.iter().find(|other| other.series == own.series) {
                own.clone_from(found);
            }
        }
    }
}

/// Held-out data beside those of the fit.
fn about_validation(own: &SolvedSeries, solution: &Solution) -> Finding {
    let label = match own.experiment.is_empty() {
        true => own.y[0].clone(),
        false => format!("{} / {}", own.experiment, own.y[0]),
    };
    if !own.rmse.is_finite() {
        let sentence = format!("{label}, held out for validation, could not be simulated.");
        return Finding::new(FindingKind::Validation, sentence).series(label);
    }
    let same: Vec<&SolvedSeries> =
        solution.series.iter().filter(|fitted| fitted.y[0] == own.y[0]).collect();
    let points: usize = same.iter().map(|fitted| fitted.points.len()).sum();
    let square: f64 = same.iter().map(|f| f.rmse * f.rmse * f.points.len() as f64).sum();
    let fitted = (square / points as f64).sqrt();
    let ratio = own.rmse / fitted;
    if !ratio.is_finite() {
        let sentence = format!(
            "{label}, held out for validation, has an RMSE of {}; the fit of {} has no error \
             to compare it with.",
            format!("{} {}", significant(own.rmse, 3), own.y[1]).trim_end(),
            own.y[0]
        );
        let finding = Finding::new(FindingKind::Validation, sentence);
        return finding.severity(Severity::Information).series(label);
    }
    let (severity, words) = if ratio <= RATIOS[0] {
        (Severity::Information, "the model describes data that it was not fitted to equally well")
    } else if ratio <= RATIOS[1] {
        (Severity::Warning, "the model describes data that it was not fitted to less well")
    } else {
        (Severity::Serious, "the model does not describe data that it was not fitted to")
    };
    let sentence = format!(
        "{label}, held out for validation: RMSE {} against {} of the fit, {} times; {words}.",
        significant(own.rmse, 3),
        significant(fitted, 3),
        significant(ratio, 3)
    );
    let finding = Finding::new(FindingKind::Validation, sentence).severity(severity);
    finding.series(label).statistic(ratio, RATIOS[0])
}

fn about_missing(run: &Run) -> Vec<Finding> {
    // Replicates are one output.
    let mut outputs: IndexMap<String, (usize, Vec<usize>, usize)> = IndexMap::new();
    for series in &run.problem.series {
        let own = outputs.entry(series.label()).or_default();
        own.0 += series.missing.len();
        own.1.extend(&series.missing);
        own.2 += series.x.len();
    }
    let one = |(label, (n, mut rows, used)): (String, (usize, Vec<usize>, usize))| {
        rows.sort_unstable();
        rows.dedup();
        let listed: Vec<String> = rows.iter().take(LISTED).map(usize::to_string).collect();
        let sentence = format!(
            "{} of {label} {} no number and {} left out (row{} {}{}); {} {} used.",
            suggest::counted(n as u64, "point"),
            if n == 1 { "has" } else { "have" },
            if n == 1 { "is" } else { "are" },
            if rows.len() == 1 { "" } else { "s" },
            listed.join(", "),
            if rows.len() > listed.len() { ", ..." } else { "" },
            suggest::counted(used as u64, "point"),
            if used == 1 { "is" } else { "are" },
        );
        Finding::new(FindingKind::MissingPoints, sentence)
            .severity(Severity::Information)
            .series(label)
            .rows(rows)
    };
    outputs.into_iter().filter(|(_, (n, ..))| *n > 0).map(one).collect()
}

fn non_identifiable<'a>(group: &NonIdentifiable, name: &impl Fn(usize) -> &'a str) -> String {
    let names: Vec<&str> = group.parameters.iter().map(|&k| name(k)).collect();
    let all = names.join(", ");
    let what = |combination: &Vec<f64>| {
        let least = if group.form == Form::Local { SMALL_CHANGE } else { NEGLIGIBLE };
        let parts = names.iter().zip(combination).filter(|(_, part)| part.abs() > least);
        match group.form {
            Form::Sum => sum(parts),
            Form::Product => product(parts),
            Form::Function | Form::Local => {
                let change =
                    |(name, part): (&&str, &f64)| format!("{name} by {} %", significant(*part, 3));
                parts.map(change).collect::<Vec<_>>().join(", ")
            }
        }
    };
    if group.form == Form::Function {
        return match &group.function {
            Some(function) => format!(
                "{all} are structurally non-identifiable from data of this kind: the model depends \
                 only on {}. Fix {} of them.",
                function.text(name),
                fix(group.excess)
            ),
            None => format!(
                "{all} are structurally non-identifiable from data of this kind: wherever they were \
                 changed, changes of the others have made good for it. Fix {} of them.",
                fix(group.excess)
            ),
        };
    }
    let combinations: Vec<String> = group.combinations.iter().map(what).collect();
    let fix = fix(group.excess);
    if group.form == Form::Local {
        return format!(
            "{all} are not separately identifiable near the best values: changing {} \
             simultaneously changes nothing. Fix {fix} of them.",
            combinations.join(", or ")
        );
    }
    format!(
        "{all} are structurally non-identifiable from data of this kind: the model depends only \
         on {}. Fix {fix} of them.",
        combinations.join(" and ")
    )
}

fn fix(excess: usize) -> String {
    if excess == 1 { "one".to_owned() } else { excess.to_string() }
}

/// Value and interval of a function of parameters that is determined.
fn determined_function(
    group: &NonIdentifiable,
    solution: &Solution,
    statistics: &Statistics,
) -> Option<String> {
    let function = group.function.as_ref()?;
    let values: Vec<f64> = solution.parameters.iter().map(|own| own.value).collect();
    let (value, gradient) = function.at(&values);
    let reach = statistics.spread.quantile * statistics.error_of(&gradient)?;
    let name = |k: usize| solution.parameters[k].name.as_str();
    let digits = digits_of(reach, value.abs());
    let interval = ends([value - reach, value + reach], value);
    Some(format!(
        " {} is {} (95 % interval {interval}).",
        function.text(&name),
        significant(value, digits)
    ))
}

/// Value and interval of what the model depends on: " a + b is 0.7005 (95 % interval 0.696 .. 0.705)."
fn determined(group: &NonIdentifiable, solution: &Solution, statistics: &Statistics) -> String {
    let name = |k: usize| solution.parameters[k].name.as_str();
    let names: Vec<&str> = group.parameters.iter().map(|&k| name(k)).collect();
    let one = |combination: &Vec<f64>| -> Option<String> {
        let values = group.parameters.iter().map(|&k| solution.parameters[k].value);
        let parts = names.iter().zip(combination).filter(|(_, part)| part.abs() > NEGLIGIBLE);
        let mut weights = vec![0.0; solution.parameters.len()];
        let is_product = group.form == Form::Product;
        // Ratios, as the parameters have them; a parameter that may be zero or change its sign has none.
        let is_ratio =
            is_product && group.parameters.iter().all(|&k| solution.parameters[k].logarithmic);
        let mut value = if is_product { 1.0 } else { 0.0 };
        for ((&k, own), part) in group.parameters.iter().zip(values).zip(combination) {
            weights[k] = if is_product { part / own } else { *part };
            value =
                if is_product { value * elementary::powf(own, *part) } else { value + part * own };
        }
        let reach = statistics.spread.quantile * statistics.error_of(&weights)?;
        let [low, high] = match (is_product, is_ratio) {
            (true, true) => [-reach, reach].map(|reach| value * elementary::exp(reach)),
            (true, false) => [-reach, reach].map(|reach| value + value.abs() * reach),
            (false, _) => [value - reach, value + reach],
        };
        let text = if is_product { product(parts) } else { sum(parts) };
        let [value, low, high] = [value, low, high].map(|value| significant(value, 4));
        (value != "NaN").then(|| format!("{text} is {value} (95 % interval {low} to {high})"))
    };
    if group.form == Form::Function {
        return determined_function(group, solution, statistics).unwrap_or_default();
    }
    if group.form == Form::Local {
        return String::new();
    }
    let all: Option<Vec<String>> = group.combinations.iter().map(one).collect();
    all.filter(|all| !all.is_empty())
        .map_or_else(String::new, |all| format!(" {}.", all.join("; ")))
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
    let power = |(name, exponent): (&&str, f64)| match significant(exponent, 4).as_str() {
        "1" => (*name).to_owned(),
        exponent => format!("{name}^{exponent}"),
    };
    let (below, above): (Vec<_>, Vec<_>) = parts.partition(|(_, exponent)| **exponent < 0.0);
    let above: Vec<String> = above.into_iter().map(|(name, e)| power((name, *e))).collect();
    let below: Vec<String> = below.into_iter().map(|(name, e)| power((name, -*e))).collect();
    let above = if above.is_empty() { "1".to_owned() } else { above.join("*") };
    match below.as_slice() {
        [] => above,
        [one] => format!("{above}/{one}"),
        several => format!("{above}/({})", several.join("*")),
    }
}

fn about_failures(region: &FailureRegion) -> Finding {
    let [inside, outside] = region.failed.map(|part| format!("{:.0} %", 100.0 * part));
    let [low, high] = region.range.map(|end| significant(end, 3));
    let sentence = format!(
        "Simulations fail where {} is between {low} and {high}: {inside} of the individuals there failed, {outside} elsewhere.",
        region.parameter
    );
    let finding = Finding::new(FindingKind::Failures, sentence).severity(Severity::Information);
    finding.parameters([region.parameter.as_str()])
}

/// A finding for each other minimum.
pub(crate) fn about_other_minima(solution: &Solution) -> Vec<Finding> {
    let one = |other: &OtherMinimum| {
        let pairs = solution.parameters.iter().zip(&other.values);
        let values: Vec<String> =
            pairs.map(|(p, value)| format!("{} = {}", p.name, significant(*value, 5))).collect();
        let sentence = format!(
            "Another minimum fits these data as well within the 95 % limit ({} against {}): {}.",
            significant(other.objective, 6),
            significant(solution.fitness, 6),
            values.join(", ")
        );
        Finding::new(FindingKind::OtherMinimum, sentence).severity(Severity::Serious)
    };
    solution.outcome.other_minima.iter().map(one).collect()
}
