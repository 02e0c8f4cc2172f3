//! The solution as text: for people, as CSV, as Modelica and as script.

use super::{EndingKind, Profile, Solution, SolvedParameter, SolvedSeries, Verdict};
use crate::identify::table::significant;
use std::fmt::Write;

/// How many causes of failure are shown.
const CAUSES: usize = 5;

impl Solution {
    /// The report that ends a run.
    pub fn text(&self) -> String {
        let mut text = format!("\n{}\n\n{}\n", self.title, parameter_table(&self.parameters));
        if let Some(profiles) = &self.profiles {
            let row = |profile: &Profile| {
                let ends =
                    profile.interval.map(|end| end.map_or("-".into(), |e| significant(e, 4)));
                format!("{} in {} .. {}", profile.name, ends[0], ends[1])
            };
            let rows: Vec<String> = profiles.profiles.iter().map(row).collect();
            _ = writeln!(text, "  95 % by profiles: {}\n", rows.join("; "));
        }
        for (label, value) in self.facts() {
            // Writing into a String cannot fail.
            _ = writeln!(text, "  {label:<12} {value}");
        }
        if !self.findings.is_empty() {
            text.push('\n');
        }
        for finding in &self.findings {
            _ = writeln!(text, "  {}", finding.sentence);
        }
        text += &self.inferred.text();
        text
    }

    fn facts(&self) -> Vec<(&'static str, String)> {
        let mut facts = vec![
            ("model", self.model.clone()),
            ("fit", format!("{} ({})", significant(self.fitness, 7), self.fitness_name)),
        ];
        facts.extend(self.series.iter().map(|series| ("series", series_line(series))));
        facts.extend(self.validation.iter().map(|series| ("validation", series_line(series))));
        if let Some(chi) = &self.chi_square {
            let text = format!(
                "{} for {} degrees of freedom, probability of more {}",
                significant(chi.value, 5),
                chi.freedom,
                significant(chi.probability, 3)
            );
            facts.push(("chi-square", text));
        }
        if let Some(value) = self.negative_log_likelihood {
            facts.push(("-log L", significant(value, 7)));
        }
        if let Some(condition) = self.condition {
            facts.push(("condition", significant(condition, 3)));
        }
        if !self.front.is_empty() {
            let knee = self.knee.map_or(String::new(), |knee| {
                format!(", knee at {}", objectives(&self.front[knee].1))
            });
            let volume = self.hypervolume.as_ref().map_or(String::new(), |(volume, reference)| {
                let reference = objectives(reference);
                format!(", hypervolume {} from {reference}", significant(*volume, 4))
            });
            facts.push(("front", format!("{} points{knee}{volume}", self.front.len())));
        }
        facts.push(("method", self.method.clone()));
        facts.push(("stopped", self.stop.clone()));
        if self.ending.kind == EndingKind::Minimum {
            facts.push(("ending", self.ending.words.clone()));
        }
        let failed: u64 = self.failures.values().sum();
        let share = 100.0 * failed as f64 / self.evaluations.max(1) as f64;
        facts.push((
            "evaluations",
            format!("{} in {} generations, {failed} failed ({share:.1} %); {} simulations, {} more for the standard errors{}", self.evaluations, self.generations, self.simulations, self.simulations_for_statistics, self.profiles.as_ref().map_or(String::new(), |all| format!(", {} for the profiles", all.simulations))),
        ));
        let mut causes: Vec<(&String, &u64)> = self.causes.iter().collect();
        causes.sort_by(|a, b| b.1.cmp(a.1));
        facts.extend(
            causes.iter().take(CAUSES).map(|(cause, count)| ("", format!("{count} x {cause}"))),
        );
        for (generation, setting, value) in &self.changes {
            facts.push(("changed", format!("{setting} = {value} after generation {generation}")));
        }
        facts.push(("version", format!("gapilib {}", self.version)));
        facts.push(("seed", self.seed.map(|entry| entry.to_string()).join(" ")));
        facts
    }

    /// `result.json`.
    pub fn to_json(&self) -> String {
        let text = serde_json::to_string_pretty(self);
        text.unwrap_or_else(|error| unreachable!("strings, numbers and lists only: {error}")) + "\n"
    }

    /// `history.csv`: one line for each generation, with the best values so far.
    pub fn history_csv(&self) -> String {
        let mut text = String::from("generation,best,mean,worst,failures");
        self.parameters
            .iter()
            .for_each(|parameter| text += &format!(",{}", quoted(&parameter.name)));
        text.push('\n');
        for (k, (generation, values)) in self.history.iter().zip(&self.trace).enumerate() {
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
        for (values, fitness) in &self.individuals {
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

    /// The calibrated model: the model with the values found.
    pub fn modelica(&self) -> String {
        let (class, inner) = match self.model.split_once('(') {
            Some((class, inner)) => (class.trim(), inner.trim_end().trim_end_matches(')')),
            None => (self.model.as_str(), ""),
        };
        let shared = self.parameters.iter().filter(|p| !p.name.contains('@'));
        let values: Vec<String> =
            shared.map(|p| format!("{} = {}", p.name, modelica_number(p.value))).collect();
        let all: Vec<String> = std::iter::once(inner.to_owned())
            .filter(|inner| !inner.is_empty())
            .chain(values)
            .collect();
        format!(
            "model Calibrated \"{}\"\n  extends {class}(\n    {});\nend Calibrated;\n",
            self.title.replace(['"', '\\'], "'"),
            all.join(",\n    ")
        )
    }

    /// The values found as assignments of a script.
    pub fn script(&self) -> String {
        let shared = self.parameters.iter().filter(|p| !p.name.contains('@'));
        shared.map(|p| format!("{} = {};\n", p.name, modelica_number(p.value))).collect()
    }
}

/// A number that reads back to the same bits.
fn modelica_number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

fn objectives(values: &[f64]) -> String {
    values.iter().map(|value| significant(*value, 4)).collect::<Vec<_>>().join(", ")
}

pub(super) fn quoted(text: &str) -> String {
    match text.contains([',', '"', '\n']) {
        true => format!("\"{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}

fn series_line(series: &SolvedSeries) -> String {
    let mut line = format!(
        "{}{}: {} points, RMSE {} {}",
        if series.experiment.is_empty() {
            String::new()
        } else {
            format!("{} / ", series.experiment)
        },
        series.y[0],
        series.points.len(),
        significant(series.rmse, 4),
        series.y[1]
    );
    if let Some(sigma) = series.sigma {
        let how = if series.sigma_estimated { "estimated" } else { "given" };
        _ = write!(line, ", sigma {} ({how})", significant(sigma, 4));
    }
    if let Some(r_squared) = series.r_squared {
        _ = write!(line, ", R2 {}", significant(r_squared, 6));
    }
    if let Some([runs, expected, _, autocorrelation]) = series.residual_test {
        _ = write!(
            line,
            ", {runs} runs ({} expected), autocorrelation {}",
            significant(expected, 3),
            significant(autocorrelation, 2)
        );
    }
    line
}

fn parameter_table(parameters: &[SolvedParameter]) -> String {
    let heading = ["parameter", "value", "unit", "std. error", "95 % interval", "range", ""];
    let mut rows = vec![heading.map(str::to_owned)];
    rows.extend(parameters.iter().map(cells));
    let widths: [usize; 7] = std::array::from_fn(|column| {
        rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0)
    });
    let line = |row: &[String; 7]| {
        let cells: Vec<String> =
            row.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}")).collect();
        format!("  {}\n", cells.join("  ").trim_end())
    };
    rows.iter().map(line).collect()
}

fn cells(parameter: &SolvedParameter) -> [String; 7] {
    let pair = |ends: [f64; 2], digits| {
        format!("{} .. {}", significant(ends[0], digits), significant(ends[1], digits))
    };
    let deviation = match parameter.deviation {
        Some(deviation) if parameter.value != 0.0 => {
            format!("{} %", significant(100.0 * deviation / parameter.value.abs(), 2))
        }
        Some(deviation) => significant(deviation, 2),
        None if parameter.determined == Some(false) => "unbounded".to_owned(),
        None => "-".to_owned(),
    };
    let mut remarks = Vec::new();
    if let Some(verdict) = parameter.verdict.filter(|verdict| *verdict != Verdict::Identifiable) {
        remarks.push(verdict.words());
    }
    if parameter.at_bound {
        remarks.push("at the end of its range");
    }
    [
        parameter.name.clone(),
        significant(parameter.value, 5),
        parameter.unit.clone(),
        deviation,
        parameter.interval.map_or("-".to_owned(), |ends| pair(ends, 4)),
        format!("{}{}", pair(parameter.range, 4), if parameter.logarithmic { " log" } else { "" }),
        remarks.join(", "),
    ]
}
