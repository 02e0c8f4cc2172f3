//! The result of an identification as text for people.

use super::{Correlated, Identified, Outcome};
use std::fmt::Write;

/// How many causes of failure are shown.
const CAUSES_SHOWN: usize = 5;

impl Outcome {
    /// The table that ends a run: parameters with units and ranges, fit, counts, seed, time.
    pub fn table(&self) -> String {
        let mut text = format!("\nIdentified parameters of {}\n\n", self.model);
        text.push_str(&parameter_table(&self.details));
        text.push('\n');
        for (label, value) in self.facts() {
            // Writing into a String cannot fail.
            _ = writeln!(text, "  {label:<13} {value}");
        }
        let notes = self.notes();
        if !notes.is_empty() {
            _ = writeln!(text, "\n  {}", notes.join("\n  "));
        }
        text
    }

    fn facts(&self) -> Vec<(&'static str, String)> {
        let mut facts =
            vec![("fit", format!("{} ({})", significant(self.best_fit, 5), self.fitness))];
        if let Some(rmse) = self.rmse {
            let quantity = with_unit(rmse, &self.rmse_unit);
            facts.push(("RMSE", format!("{quantity} over {} points", self.points)));
        }
        facts.extend(self.data.clone().map(|file| ("data", file)));
        facts.push(("generations", self.generations.to_string()));
        let share = 100.0 * self.failures as f64 / self.evaluations.max(1) as f64;
        let counts = format!("{}, {} failed ({share:.1} %)", self.evaluations, self.failures);
        facts.push(("simulations", counts));
        let mut causes: Vec<(&String, &u64)> = self.failure_causes.iter().collect();
        causes.sort_by(|a, b| b.1.cmp(a.1));
        for (cause, count) in causes.iter().take(CAUSES_SHOWN) {
            facts.push(("", format!("{count} x {cause}")));
        }
        for (generation, statement) in &self.changes {
            facts.push(("changed", format!("{statement} in generation {generation}")));
        }
        if let Some(seed) = self.seed {
            facts.push(("seed", seed.map(|entry| entry.to_string()).join(" ")));
        }
        facts.push(("time", format!("{:.2} s", self.wall_seconds)));
        facts
    }

    /// What a reader must know about these numbers.
    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.interrupted {
            notes.push("Interrupted: these are the best values found so far.".to_owned());
        }
        let undetermined: Vec<&str> = self
            .details
            .iter()
            .filter(|parameter| parameter.determined == Some(false))
            .map(|parameter| parameter.name.as_str())
            .collect();
        if !undetermined.is_empty() {
            notes.push(format!(
                "Not determined by these data: {}. Other values fit about as well.",
                undetermined.join(", ")
            ));
        }
        if !self.correlated.is_empty() {
            let pairs: Vec<String> = self.correlated.iter().map(Correlated::text).collect();
            notes.push(format!("Hardly told apart (correlation): {}.", pairs.join(", ")));
        }
        if self.details.iter().any(|parameter| parameter.determined.is_some()) {
            notes.push(
                "Deviations are one standard deviation, estimated from the residuals at the best \
                 individual."
                    .to_owned(),
            );
        }
        notes
    }
}

impl Correlated {
    fn text(&self) -> String {
        let [first, second] = &self.pair;
        format!("{first} and {second} ({:.3})", self.correlation)
    }
}

fn parameter_table(details: &[Identified]) -> String {
    let heading = ["parameter", "value", "unit", "range", "deviation", ""].map(str::to_owned);
    let rows: Vec<[String; 6]> =
        std::iter::once(heading).chain(details.iter().map(cells)).collect();
    let width =
        |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: [usize; 6] = std::array::from_fn(width);
    let line = |row: &[String; 6]| {
        let cells = row.iter().zip(widths).map(|(cell, width)| format!("{cell:<width$}"));
        format!("  {}\n", cells.collect::<Vec<_>>().join("  ").trim_end())
    };
    rows.iter().map(line).collect()
}

fn cells(parameter: &Identified) -> [String; 6] {
    let range = match parameter.range {
        Some([min, max]) => format!("{} .. {}", significant(min, 5), significant(max, 5)),
        None => "-".to_owned(),
    };
    let mut remarks = Vec::new();
    if parameter.determined == Some(false) {
        remarks.push("not determined by these data");
    }
    if parameter.at_end_of_range {
        remarks.push("at the end of its range");
    }
    [
        parameter.name.clone(),
        significant(parameter.value, 5),
        parameter.unit.clone(),
        range,
        deviation(parameter),
        remarks.join(", "),
    ]
}

fn deviation(parameter: &Identified) -> String {
    match (parameter.standard_deviation, parameter.determined) {
        (Some(deviation), _) if parameter.value != 0.0 => {
            let percent = 100.0 * deviation / parameter.value.abs();
            if percent < 10.0 { format!("{percent:.1} %") } else { format!("{percent:.0} %") }
        }
        (Some(deviation), _) => significant(deviation, 2),
        (None, Some(false)) => "unbounded".to_owned(),
        _ => "-".to_owned(),
    }
}

/// A number with its unit; units that take prefixes get `m` for small numbers.
fn with_unit(value: f64, unit: &str) -> String {
    let takes_prefix =
        ["V", "A", "W", "m", "s", "Pa", "Ohm", "F", "H", "N", "J", "S"].contains(&unit);
    if takes_prefix && value < 1.0 {
        return format!("{} m{unit}", significant(1000.0 * value, 4));
    }
    format!("{} {unit}", significant(value, 4)).trim_end().to_owned()
}

/// A number to this many significant digits, without trailing zeros.
pub(super) fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let rounded: f64 = scientific.parse().unwrap_or(value);
    if (1e-3..1e6).contains(&rounded.abs()) { rounded.to_string() } else { format!("{rounded:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_significant_digits() {
        let cases = [
            (0.0285634, "0.028563"),
            (2.3379e-7, "2.3379e-7"),
            (123456.7, "123460"),
            (0.01, "0.01"),
            (1e60, "1e60"),
            (-0.5, "-0.5"),
            (0.0, "0"),
        ];
        for (value, expected) in cases {
            assert_eq!(significant(value, 5), expected);
        }
        assert_eq!(with_unit(0.0004193, "V"), "0.4193 mV");
        assert_eq!(with_unit(0.0004193, "A/cm2"), "4.193e-4 A/cm2");
        assert_eq!(with_unit(2.0, ""), "2");
    }

    #[test]
    fn table_reads_alone() {
        insta::assert_snapshot!(super::super::outcome::tests::outcome().table());
    }
}
