//! A solution read back from the files of a run, so that its report can be drawn again.

use super::Solution;
use crate::diag::Fault;
use crate::fault;
use crate::ga::Generation;
use crate::registry::BAD_OPTION;

impl Solution {
    /// The solution that `result.json`, `history.csv` and `individuals.csv` hold.
    ///
    /// # Errors
    ///
    /// Files of another kind, or damaged ones.
    pub fn read(json: &str, history: &str, individuals: &str) -> Result<Solution, Fault> {
        let solution: Result<Solution, _> = serde_json::from_str(json);
        let mut solution = solution.map_err(|error| {
            fault!(BAD_OPTION, "`result.json` was not written by `gapi identify`: {error}")
        })?;
        let n = solution.parameters.len();
        for row in rows("history.csv", history, 5)? {
            let [_, best, mean, worst, failures] = row[..5] else { continue };
            let failures = failures as usize;
            solution.course.history.push(Generation { best, mean, worst, failures });
            solution.course.trace.push(row[5..].to_vec());
        }
        for mut row in rows("individuals.csv", individuals, n + 1)? {
            let fitness = row.pop().unwrap_or(f64::NAN);
            solution.course.individuals.push((row, fitness));
        }
        Ok(solution)
    }
}

/// The rows after the heading, of at least so many numbers each.
fn rows(name: &str, text: &str, columns: usize) -> Result<Vec<Vec<f64>>, Fault> {
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(text.as_bytes());
    let mut rows = Vec::new();
    for (k, record) in reader.records().enumerate() {
        let row: Option<Vec<f64>> =
            record.ok().and_then(|record| record.iter().map(|cell| cell.parse().ok()).collect());
        let row = row.filter(|row| row.len() >= columns);
        rows.push(row.ok_or_else(|| fault!(BAD_OPTION, "line {} of `{name}` is damaged", k + 2))?);
    }
    Ok(rows)
}
