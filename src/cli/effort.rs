//! `--stats`: the table of what cost a simulation the most effort.

use crate::runtime::LoopEffort;
use crate::script::models::hardest::Hardest;

/// Rows of each part.
const MOST_ROWS: usize = 5;
/// Unknowns of a loop that are named.
const MOST_NAMES: usize = 3;

/// The hardest variables, relations and loops; empty where there are none.
pub(crate) fn table(hardest: &Hardest) -> String {
    let steps: u64 = hardest.unknowns.iter().map(|(_, count)| count).sum();
    let share = |count: u64| 100.0 * count as f64 / steps as f64;
    let unknowns = hardest
        .unknowns
        .iter()
        .map(|(name, count)| format!("{count:>10} steps  {:>3.0} %  `{name}`", share(*count)));
    let relations =
        hardest.relations.iter().map(|(relation, count)| format!("{count:>10} events  {relation}"));
    let loops = hardest.loops.iter().map(|effort| {
        let each = effort.evaluations as f64 / effort.solutions as f64;
        format!("{:>10} times  {each:.1} evaluations each  {}", effort.solutions, names(effort))
    });
    [
        part("largest part of the error, which limits the step", unknowns),
        part("relations that caused events", relations),
        part("nonlinear algebraic loops that were solved", loops),
    ]
    .concat()
}

fn part(title: &str, rows: impl ExactSizeIterator<Item = String>) -> String {
    let n = rows.len();
    if n == 0 {
        return String::new();
    }
    let rows: String = rows.take(MOST_ROWS).map(|row| format!("  {row}\n")).collect();
    match n.saturating_sub(MOST_ROWS) {
        0 => format!("  {title}:\n{rows}"),
        others => format!("  {title}:\n{rows}            and {others} more\n"),
    }
}

/// `{a, b, c and 12 more}`
fn names(effort: &LoopEffort) -> String {
    let names: Vec<&str> = effort.unknowns.iter().take(MOST_NAMES).map(|name| &**name).collect();
    match effort.unknowns.len().saturating_sub(MOST_NAMES) {
        0 => format!("{{{}}}", names.join(", ")),
        others => format!("{{{} and {others} more}}", names.join(", ")),
    }
}
