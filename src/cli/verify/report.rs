//! What verifying a collection found: a table for readers, JSON and CSV for programs.

use super::super::compare::verdict;
use crate::results::Compared;
use crate::script::models::verification::Stage;
use serde::Serialize;
use std::fmt::Write;

/// A case and what became of it.
#[derive(Debug, Serialize)]
pub(super) struct Row {
    /// The class.
    pub model: String,
    /// What became of it.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// Seconds (CPU time where known) from the class to the program, if it got there.
    pub(crate) compile_seconds: Option<f64>,
    /// Seconds (the same) of the simulation, if it got to its end.
    pub(crate) simulate_seconds: Option<f64>,
}

/// What became of a case.
#[derive(Debug, Serialize)]
#[serde(tag = "outcome", rename_all = "kebab-case")]
pub(super) enum Outcome {
    /// All signals are inside their tubes.
    Agreed {
        /// How many.
        signals: usize,
    },
    /// A signal is not.
    Differs {
        /// The first that is not.
        signal: String,
        /// Where it is farthest outside.
        reason: String,
    },
    /// It was simulated, but the collection holds no reference for it.
    Unjudged,
    /// It did not pass a stage.
    Failed {
        /// Which.
        stage: &'static str,
        /// The diagnostic's code, or `panic` or `timeout`.
        code: String,
        /// The diagnostic.
        reason: String,
    },
    /// Its reference cannot be read.
    BadReference {
        /// Why.
        reason: String,
    },
}

impl Outcome {
    /// The outcome of comparing signals.
    pub(super) fn of(compared: &[Compared]) -> Outcome {
        if compared.is_empty() {
            let reason = "it names no signal to compare".to_owned();
            return Outcome::BadReference { reason };
        }
        match compared.iter().find(|one| !one.agrees()) {
            None => Outcome::Agreed { signals: compared.len() },
            Some(Compared { signal, agreement }) => {
                Outcome::Differs { signal: signal.clone(), reason: verdict(agreement) }
            }
        }
    }

    /// Whether the case counts as a success.
    pub(super) fn is_good(&self) -> bool {
        matches!(self, Outcome::Agreed { .. } | Outcome::Unjudged)
    }

    fn has_passed(&self, passed: Stage) -> bool {
        match self {
            Outcome::Failed { stage, .. } => {
                let reached = Stage::ALL.into_iter().find(|s| s.name() == *stage);
                reached.is_some_and(|reached| reached > passed)
            }
            Outcome::BadReference { .. } => false,
            _ => true,
        }
    }

    fn word(&self) -> String {
        match self {
            Outcome::Agreed { .. } => "agreed".to_owned(),
            Outcome::Differs { .. } => "differs".to_owned(),
            Outcome::Unjudged => "no reference".to_owned(),
            Outcome::Failed { stage, code, .. } => format!("{stage}: {code}"),
            Outcome::BadReference { .. } => "bad reference".to_owned(),
        }
    }

    fn reason(&self) -> String {
        match self {
            Outcome::Agreed { signals } => format!("{signals} signals"),
            Outcome::Differs { signal, reason } => format!("{signal} {reason}"),
            Outcome::Unjudged => String::new(),
            Outcome::Failed { reason, .. } | Outcome::BadReference { reason } => reason.clone(),
        }
    }
}

/// One line a case, then the counts.
pub(super) fn table(rows: &[Row]) -> String {
    let width = rows.iter().map(|row| row.model.len()).max().unwrap_or(0);
    let mut text = String::new();
    for row in rows {
        let times = [row.compile_seconds, row.simulate_seconds].map(seconds);
        let (word, reason) = (row.outcome.word(), row.outcome.reason());
        let line =
            format!("{:width$}  {word:28}  {:>8}  {:>8}  {reason}", row.model, times[0], times[1]);
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text.push_str(&counts(rows));
    text
}

fn seconds(time: Option<f64>) -> String {
    time.map_or("-".to_owned(), |time| format!("{time:.3} s"))
}

fn counts(rows: &[Row]) -> String {
    let count = |is: &dyn Fn(&Outcome) -> bool| rows.iter().filter(|row| is(&row.outcome)).count();
    let compiled = count(&|outcome| outcome.has_passed(Stage::Compile));
    let simulated = count(&|outcome| outcome.has_passed(Stage::Simulate));
    let agreed = count(&|outcome| matches!(outcome, Outcome::Agreed { .. }));
    let differ = count(&|outcome| matches!(outcome, Outcome::Differs { .. }));
    let unjudged = count(&|outcome| matches!(outcome, Outcome::Unjudged));
    format!(
        "{} cases: {compiled} compiled, {simulated} simulated, {agreed} agreed, {differ} differ, \
         {unjudged} without a reference\n",
        rows.len()
    )
}

/// An array of objects, one a case.
pub(super) fn json(rows: &[Row]) -> String {
    let mut text = serde_json::to_string_pretty(rows).unwrap_or_default();
    text.push('\n');
    text
}

/// A header line, then one line a case.
pub(super) fn csv(rows: &[Row]) -> String {
    let mut text = "model,outcome,compile_seconds,simulate_seconds,reason\n".to_owned();
    for row in rows {
        let number = |time: Option<f64>| time.map_or(String::new(), |time| time.to_string());
        let _ = writeln!(
            text,
            "{},{},{},{},{}",
            quoted(&row.model),
            quoted(&row.outcome.word()),
            number(row.compile_seconds),
            number(row.simulate_seconds),
            quoted(&row.outcome.reason())
        );
    }
    text
}

fn quoted(cell: &str) -> String {
    crate::results::quoted(&cell.replace(['\n', '\r'], " "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::Agreement;

    fn rows() -> Vec<Row> {
        let compared = |signal: &str, agreement| Compared { signal: signal.to_owned(), agreement };
        let row = |model: &str, outcome| Row {
            model: model.to_owned(),
            outcome,
            compile_seconds: Some(0.5),
            simulate_seconds: None,
        };
        let failed = Outcome::Failed {
            stage: "compile",
            code: "panic".to_owned(),
            reason: "said \"no\"\nand ended".to_owned(),
        };
        vec![
            row("A", Outcome::of(&[compared("x", Agreement::Inside)])),
            row(
                "B",
                Outcome::of(&[compared("x", Agreement::Inside), compared("y", Agreement::Missing)]),
            ),
            row("C", failed),
            row("D", Outcome::Unjudged),
        ]
    }

    #[test]
    fn nothing_compared_is_no_agreement() {
        let outcome = Outcome::of(&[]);
        assert!(!outcome.is_good(), "{outcome:?}");
    }

    #[test]
    fn the_table_ends_with_counts() {
        let text = table(&rows());
        let last = text.lines().last().unwrap();
        assert_eq!(
            last,
            "4 cases: 3 compiled, 3 simulated, 1 agreed, 1 differ, 1 without a reference"
        );
        assert!(text.contains("y missing from the result"), "{text}");
    }

    #[test]
    fn programs_read_the_same() {
        let json: serde_json::Value = serde_json::from_str(&json(&rows())).unwrap();
        assert_eq!(json[0]["outcome"], "agreed");
        assert_eq!(json[1]["signal"], "y");
        assert_eq!(json[2]["compile_seconds"], 0.5);
        let csv = csv(&rows());
        assert_eq!(csv.lines().count(), 5);
        assert!(csv.contains("\"said \"\"no\"\" and ended\""), "{csv}");
    }
}
