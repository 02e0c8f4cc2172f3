//! The solution as text: for people, as CSV, as Modelica and as script.

use super::{
    EndingKind, ScriptError, Solution, SolvedCoefficient, SolvedCovariance, SolvedParameter,
    SolvedSeries, Verdict, planes,
};
use crate::Descriptions;
use crate::plot::{self, Comparison, Figure};
use crate::table::{counted, digits_of, ends, quoted, significant};
use serde::Serialize;
use std::fmt::Write;

/// How many causes of failure are shown.
const CAUSES: usize = 5;
/// Digits of the brief report: more than the comparison with a tolerance needs.
const BRIEF_DIGITS: usize = 10;
const HEADING: [&str; 7] =
    ["parameter", "value", "unit", "standard error", "95 % interval", "range", ""];

/// What `result.json` holds.
#[derive(Serialize)]
struct Document<'a> {
    #[serde(flatten)]
    solution: &'a Solution,
    /// What the verdicts assume although the residuals contradict it.
    #[serde(skip_serializing_if = "Option::is_none")]
    verdicts_assume: Option<&'static str>,
}

impl Solution {
    /// The report that ends a run.
    pub fn text(&self) -> String {
        self.text_after(&[])
    }

    /// The same on a screen that shows these sentences already.
    pub fn text_after(&self, said: &[String]) -> String {
        let mut text = format!("\n{}\n\n{}\n", self.subject.title, self.parameter_table());
        if self.profiles.is_some() {
            let row = |own: &SolvedParameter| {
                let Some(profile) = self.profile_of(own) else { return format!("{} -", own.name) };
                let ends =
                    profile.interval.map(|end| end.map_or("-".into(), |e| significant(e, 4)));
                format!("{} in {} to {}", profile.name, ends[0], ends[1])
            };
            let rows: Vec<String> = self.parameters.iter().map(row).collect();
            _ = writeln!(text, "  95 % by profiles: {}\n", rows.join("; "));
        }
        for (label, value) in self.facts() {
            // Writing into a String cannot fail.
            _ = writeln!(text, "  {label:<12} {value}");
        }
        let new = self.findings.iter().filter(|finding| !said.contains(&finding.sentence));
        for (k, finding) in new.enumerate() {
            let gap = if k == 0 { "\n" } else { "" };
            _ = writeln!(text, "{gap}  {}", finding.sentence);
        }
        text += &self.inferred.text();
        text
    }

    /// What the report says in numbers: objective and estimates, without the sentences, which another
    /// version may choose otherwise.
    pub fn brief(&self) -> String {
        let fitness = significant(self.fitness, BRIEF_DIGITS);
        let mut text =
            format!("{}\n  {} = {fitness}\n", self.subject.title, self.subject.fitness_name);
        if let Some(error) = self.script_error() {
            _ = writeln!(text, "  {}", error.place());
        }
        for SolvedParameter { name, value, unit, .. } in &self.parameters {
            let value = significant(*value, BRIEF_DIGITS);
            _ = writeln!(text, "  {}", format!("{name} = {value} {unit}").trim_end());
        }
        text
    }

    /// Labels and values of the report.
    fn facts(&self) -> Vec<(&'static str, String)> {
        let mut facts = Vec::new();
        if self.script_error().is_some() {
            facts.push(("stopped", self.outcome.stop.clone()));
        }
        facts.extend([
            ("model", self.subject.model.clone()),
            ("objective", self.objective_values()),
        ]);
        facts.extend(self.series.iter().map(|series| ("series", series_line(series))));
        facts.extend(self.validation.iter().map(|series| ("validation", series_line(series))));
        let covariances = self.likelihood.covariances.iter();
        facts.extend(covariances.map(|own| ("covariance", covariance_line(own))));
        if let Some(chi) = &self.likelihood.chi_square {
            let text = format!(
                "{} for {} degrees of freedom, p-value {}",
                significant(chi.value, 5),
                chi.freedom,
                significant(chi.probability, 3)
            );
            facts.push(("chi-square", text));
        }
        if let Some(value) = self.likelihood.negative_log_likelihood {
            facts.push(("-log L", significant(value, 7)));
        }
        if let Some(condition) = self.condition {
            facts.push(("condition", significant(condition, 3)));
        }
        if !self.pareto.front.is_empty() {
            let knee = self.pareto.knee.map_or(String::new(), |knee| {
                format!(", knee at {}", objectives(&self.pareto.front[knee].1))
            });
            let volume =
                self.pareto.hypervolume.as_ref().map_or(String::new(), |(volume, reference)| {
                    let reference = objectives(reference);
                    format!(", hypervolume {} from {reference}", significant(*volume, 4))
                });
            facts.push(("front", format!("{} points{knee}{volume}", self.pareto.front.len())));
        }
        facts.extend(self.search_facts());
        facts.push(("version", format!("gapilib {}", self.provenance.version)));
        if let Some(seed) = self.provenance.seed {
            facts.push(("seed", seed.map(|entry| entry.to_string()).join(" ")));
        }
        facts
    }

    fn evaluations_line(&self) -> String {
        let failed: u64 = self.effort.failures.values().sum();
        let share = 100.0 * failed as f64 / self.effort.evaluations.max(1) as f64;
        let statistics = match self.script {
            Some(_) => "least squares and standard errors",
            None => "the standard errors",
        };
        let profiles = self
            .profiles
            .as_ref()
            .map_or(String::new(), |all| format!(", {} for the profiles", all.simulations));
        format!(
            "{} in {}, {failed} failed ({share:.1} %); {}, {} more for {statistics}{profiles}",
            self.effort.evaluations,
            counted(self.effort.generations, "generation"),
            counted(self.effort.simulations, "simulation"),
            self.effort.simulations_for_statistics
        )
    }

    /// How the search went.
    fn search_facts(&self) -> Vec<(&'static str, String)> {
        let mut facts = vec![("method", self.subject.method.clone())];
        let operator = |(kind, label): (&String, &String)| format!("{kind} {label}");
        let operators: Vec<String> = self.subject.operators.iter().map(operator).collect();
        if !operators.is_empty() {
            facts.push(("operators", operators.join(", ")));
        }
        if self.script_error().is_none() {
            facts.push(("stopped", self.outcome.stop.clone()));
        }
        if self.outcome.ending.kind == EndingKind::Minimum {
            facts.push(("ending", self.outcome.ending.words.clone()));
        }
        facts.extend(self.searches_line().map(|line| ("searches", line)));
        facts.extend(self.outcome.ending.derivatives.clone().map(|how| ("derivatives", how)));
        facts.push(("evaluations", self.evaluations_line()));
        let mut causes: Vec<(&String, &u64)> = self.effort.causes.iter().collect();
        causes.sort_by(|a, b| b.1.cmp(a.1));
        facts.extend(
            causes.iter().take(CAUSES).map(|(cause, count)| ("", format!("{count} x {cause}"))),
        );
        for (generation, statement) in self.script.iter().flat_map(|script| &script.changes) {
            facts.push(("changed", format!("{statement} in generation {generation}")));
        }
        for (generation, setting, value) in &self.effort.changes {
            facts.push(("changed", format!("{setting} = {value} after generation {generation}")));
        }
        facts
    }

    /// The error that the script did not handle: what is said first.
    pub(crate) fn script_error(&self) -> Option<&ScriptError> {
        self.script.as_ref()?.error.as_ref()
    }

    fn objective_values(&self) -> String {
        let found = format!("{} ({})", significant(self.fitness, 7), self.subject.fitness_name);
        match self.script.as_ref().filter(|script| script.probed) {
            Some(script) => format!(
                "{} by the script ({}), {} by least squares",
                significant(script.fitness, 5),
                script.fitness_name,
                significant(self.fitness, 7)
            ),
            None => found,
        }
    }

    fn parameter_table(&self) -> String {
        let mut rows = vec![HEADING.map(str::to_owned).to_vec()];
        rows.extend(self.parameters.iter().map(|parameter| cells(parameter).to_vec()));
        if let Some(script) = self.script.as_ref().filter(|script| script.probed) {
            rows[0][1] = "least squares".to_owned();
            rows[0].insert(1, "script's best".to_owned());
            for (row, value) in rows[1..].iter_mut().zip(script.parameters.values()) {
                row.insert(1, significant(*value, 5));
                // Least squares follow the logarithm; the script does not.
                row[6] = row[6].trim_end_matches(" log").to_owned();
            }
        }
        aligned(&rows)
    }

    /// `result.json`.
    pub fn to_json(&self) -> String {
        let document = Document { solution: self, verdicts_assume: self.assumption() };
        let text = serde_json::to_string_pretty(&document);
        text.unwrap_or_else(|error| unreachable!("strings, numbers and lists only: {error}")) + "\n"
    }

    /// `history.csv`: one line for each generation, with the values of its best individual.
    pub fn history_csv(&self) -> String {
        let mut text = String::from("generation,best,mean,worst,failures");
        self.parameters
            .iter()
            .for_each(|parameter| text += &format!(",{}", quoted(&parameter.name)));
        text.push('\n');
        for (k, (generation, values)) in
            self.course.history.iter().zip(&self.course.trace).enumerate()
        {
            let crate::ga::Generation { best, mean, worst, failures } = generation;
            _ = write!(text, "{},{best:e},{mean:e},{worst:e},{failures}", k + 1);
            values.iter().for_each(|value| text += &format!(",{value}"));
            text.push('\n');
        }
        text
    }

    /// `fit.csv`: one line for each point; residual = measured − simulated.
    pub fn fit_csv(&self) -> String {
        let mut text = String::from("experiment,variable,use,x,measured,simulated,residual\n");
        let used = self.series.iter().map(|series| ("fit", series));
        for (kind, series) in
            used.chain(self.validation.iter().map(|series| ("validation", series)))
        {
            for [x, measured, simulated] in &series.points {
                let (experiment, variable) = (quoted(&series.experiment), quoted(&series.y[0]));
                let residual = measured - simulated;
                _ = writeln!(
                    text,
                    "{experiment},{variable},{kind},{x},{measured},{simulated},{residual}"
                );
            }
        }
        text
    }

    /// `individuals.csv`: an even choice of what was evaluated.
    pub fn individuals_csv(&self) -> String {
        let names: Vec<String> = self.parameters.iter().map(|p| quoted(&p.name)).collect();
        let mut text = format!("{},fitness\n", names.join(","));
        for (values, fitness) in &self.course.individuals {
            values.iter().for_each(|value| text += &format!("{value},"));
            _ = writeln!(text, "{fitness:e}");
        }
        text
    }

    /// `profiles.csv`: one line for each value; empty without profiles.
    pub fn profiles_csv(&self) -> String {
        let mut text = String::from("parameter,value,sum_of_squares,limit\n");
        for profile in self.profiles.iter().flat_map(|profiles| &profiles.profiles) {
            for [value, sum] in &profile.points {
                let (name, limit) = (quoted(&profile.name), profile.limit);
                _ = writeln!(text, "{name},{value},{sum:e},{limit:e}");
            }
        }
        text
    }

    /// The objective values of the generations.
    pub fn convergence_figure(&self) -> Figure {
        let best: Vec<f64> = self.course.history.iter().map(|generation| generation.best).collect();
        let mean: Vec<f64> = self.course.history.iter().map(|generation| generation.mean).collect();
        plot::convergence(self.class_name(), &best, &mean)
    }

    /// The model's class without packages and modification.
    pub(crate) fn class_name(&self) -> &str {
        let class = self.subject.model.split('(').next().unwrap_or_default().trim();
        class.rsplit('.').next().unwrap_or(class)
    }

    /// The title with the name of the class alone, where it contains the model.
    pub(crate) fn short_title(&self) -> String {
        match self.subject.model.as_str() {
            "" => self.subject.title.clone(),
            model => self.subject.title.replace(model, self.class_name()),
        }
    }

    /// Measured and simulated points of each series with their residuals, and the names of files.
    pub fn fit_figures(&self) -> Vec<(String, Figure)> {
        let named = |(k, series): (usize, &SolvedSeries)| {
            let name = if k == 0 { "fit.svg".to_owned() } else { format!("fit-{}.svg", k + 1) };
            Some((name, series.figure(self.class_name(), &self.subject.descriptions)?))
        };
        let mut figures: Vec<(String, Figure)> =
            self.series.iter().enumerate().filter_map(named).collect();
        for (k, own) in planes(&self.series, &self.inferred.spectra).into_iter().enumerate() {
            let number = if k == 0 { String::new() } else { format!("-{}", k + 1) };
            figures.push((format!("nyquist{number}.svg"), own.plane));
            figures.push((format!("bode{number}.svg"), own.bode));
        }
        figures
    }

    /// The calibrated model: the model with the values found.
    pub fn modelica(&self) -> String {
        let (class, inner) = match self.subject.model.split_once('(') {
            Some((class, inner)) => (class.trim(), inner.trim_end().trim_end_matches(')')),
            None => (self.subject.model.as_str(), ""),
        };
        let shared = self.parameters.iter().filter(|p| !p.name.contains('@'));
        let found =
            || shared.map(|p| format!("{} = {}", p.name, modelica_number(p.value))).collect();
        let (values, remarks) = match &self.calibrated {
            Some(model) => (model.modifications.clone(), model.remarks.as_slice()),
            None => (found(), &[][..]),
        };
        let remarks: String = remarks.iter().map(|remark| format!("  // {remark}\n")).collect();
        let all: Vec<String> = std::iter::once(inner.to_owned())
            .filter(|inner| !inner.is_empty())
            .chain(values)
            .collect();
        let modification = match all.is_empty() {
            true => String::new(),
            false => format!("(\n    {})", all.join(",\n    ")),
        };
        format!(
            "model Calibrated \"{}\"\n  extends {class}{modification};\n{remarks}end Calibrated;\n",
            self.subject.title.replace(['"', '\\'], "'"),
        )
    }

    /// The values found as assignments of a script, to be run after the model was translated.
    pub fn script(&self) -> String {
        if let Some(model) = &self.calibrated {
            let remarks = model.remarks.iter().map(|remark| format!("// {remark}\n"));
            let lines = model.assignments.iter().map(|line| format!("{line}\n"));
            return lines.chain(remarks).collect();
        }
        let shared = self.parameters.iter().filter(|p| !p.name.contains('@'));
        shared.map(|p| format!("{} = {};\n", p.name, modelica_number(p.value))).collect()
    }
}

impl SolvedSeries {
    /// Measured and simulated points and their residuals; `None` where a simulation failed.
    fn figure(&self, title: &str, descriptions: &Descriptions) -> Option<Figure> {
        let column = |j: usize| self.points.iter().map(|point| point[j]).collect::<Vec<f64>>();
        let (x, measured, simulated) = (column(0), column(1), column(2));
        let (curve_x, curve_y): (Vec<f64>, Vec<f64>) =
            self.curve.iter().map(|[x, y]| (*x, *y)).unzip();
        simulated.iter().all(|value| value.is_finite()).then(|| {
            plot::fit(Comparison {
                title,
                x_axis: descriptions.axis(&self.x),
                y_axis: descriptions.axis(&self.y),
                x: &x,
                measured: &measured,
                simulated: &simulated,
                curve: (&curve_x, &curve_y),
            })
        })
    }
}

/// A number that reads back to the same bits.
pub fn modelica_number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

fn objectives(values: &[f64]) -> String {
    values.iter().map(|value| significant(*value, 4)).collect::<Vec<_>>().join(", ")
}

fn series_line(series: &SolvedSeries) -> String {
    let of = match series.experiment.is_empty() {
        true => String::new(),
        false => format!("{} / ", series.experiment),
    };
    let mut line = format!("{of}{}: {}", series.y[0], counted(series.points.len() as u64, "point"));
    if series.points.iter().all(|point| point[1].is_nan()) {
        return line + ", whose measured values are known only to the script";
    }
    let rmse = format!("{} {}", significant(series.rmse, 4), series.y[1]);
    _ = write!(line, ", RMSE {}", rmse.trim_end());
    if let Some(sigma) = series.sigma {
        let how = match (series.sigma_estimated, series.sigma_computed) {
            (true, _) => "estimated",
            (_, true) => "root mean square, from the model",
            _ => "given",
        };
        _ = write!(line, ", sigma {} ({how})", significant(sigma, 4));
    }
    for (what, own) in [("scale", &series.scale), ("offset", &series.offset)] {
        let Some(own) = own else { continue };
        let name = if own.name.is_empty() { String::new() } else { format!(" {}", own.name) };
        _ = write!(line, ", {what}{name} {} ({})", significant(own.value, 5), error_in_words(own));
    }
    if let Some(r_squared) = series.r_squared {
        _ = write!(line, ", R2 {}", significant(r_squared, 6));
    }
    if let Some([runs, expected, _, autocorrelation]) = series.residual_test {
        _ = write!(
            line,
            ", {} ({} expected), autocorrelation {}",
            counted(runs as u64, "run"),
            significant(expected, 3),
            significant(autocorrelation, 2)
        );
    }
    line
}

/// Standard deviations and correlations of outputs.
pub(crate) fn covariance_line(own: &SolvedCovariance) -> String {
    let how = if own.estimated { "estimated" } else { "given" };
    let mut line = own.experiments.join(", ");
    let sigmas = own.outputs.iter().zip(&own.sigmas);
    let sigmas: Vec<String> =
        sigmas.map(|(name, sigma)| format!("{name} {}", significant(*sigma, 4))).collect();
    _ = write!(line, ": sigma ({how}) {}", sigmas.join(", "));
    for (a, row) in own.correlations.iter().enumerate() {
        for (b, value) in row.iter().enumerate().take(a) {
            let pair = [&own.outputs[b], &own.outputs[a]];
            _ = write!(line, "; correlation of {} and {} ", pair[0], pair[1]);
            line.push_str(&significant(*value, 4));
        }
    }
    if own.incomplete > 0 {
        _ = write!(line, "; {} of {} rows lack an output", own.incomplete, own.rows);
    }
    line
}

/// The standard error of a scale or an offset.
fn error_in_words(own: &SolvedCoefficient) -> String {
    match own.deviation {
        Some(deviation) => format!("standard error {}", significant(deviation, 3)),
        None => "no standard error".to_owned(),
    }
}

/// Rows of one length, their columns under each other.
fn aligned(rows: &[Vec<String>]) -> String {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max();
    let widths: Vec<usize> = (0..rows[0].len()).map(|column| width(column).unwrap_or(0)).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:<width$}"));
        let cells: Vec<String> = cells.collect();
        format!("  {}\n", cells.join("  ").trim_end())
    };
    rows.iter().map(line).collect()
}

impl SolvedParameter {
    /// Digits of the value: two of its standard error, and five at least.
    pub fn digits(&self) -> usize {
        let digits = self.deviation.map(|own| digits_of(own, self.value.abs()));
        digits.unwrap_or(0).max(5)
    }

    /// The standard error: as a part of the value, where it is not larger than that.
    pub(crate) fn deviation_text(&self) -> String {
        match self.deviation {
            Some(own) if own <= self.value.abs() => {
                format!("{} %", significant(100.0 * own / self.value.abs(), 2))
            }
            // The value may be zero, or the error may be a multiple of it.
            Some(own) => format!("{} {}", significant(own, 3), self.unit).trim_end().to_owned(),
            None if self.determined == Some(false) => "unbounded".to_owned(),
            None => "-".to_owned(),
        }
    }

    /// The 95 % interval, as far as the data end it.
    pub(crate) fn interval_text(&self) -> String {
        let Some(interval) = self.interval else { return "-".to_owned() };
        let [low, high] = interval.map(|end| significant(end, 4));
        match self.open {
            [false, false] if self.pieces.is_empty() => ends(interval, self.value),
            [false, false] => format!("{}, and others", ends(interval, self.value)),
            [false, true] => format!("at least {low}"),
            [true, false] => format!("at most {high}"),
            [true, true] => "the whole range".to_owned(),
        }
    }
}

fn cells(parameter: &SolvedParameter) -> [String; 7] {
    let mut remarks = Vec::new();
    if let Some(verdict) = parameter.verdict.filter(|verdict| *verdict != Verdict::Identifiable) {
        remarks.push(verdict.words());
    }
    if parameter.at_bound {
        remarks.push("at the end of its range");
    }
    let range = parameter.range.map(|end| significant(end, 4)).join(" to ");
    [
        parameter.name.clone(),
        significant(parameter.value, parameter.digits()),
        parameter.unit.clone(),
        parameter.deviation_text(),
        parameter.interval_text(),
        format!("{}{}", range, if parameter.logarithmic { " log" } else { "" }),
        remarks.join(", "),
    ]
}
