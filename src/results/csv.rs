//! Results as text: a header with the names in double quotes, then one line per point in time.
//! Constants are repeated, aliases written out; units and descriptions are not kept.

use super::errors::BAD_RESULT_FILE;
use super::{Format, ResultTable, Series, Values};
use crate::bail;
use crate::diag::Fault;
use crate::mat;
use crate::registry::Entry;
use std::fmt::Write;

pub(super) const ENTRY: Entry<dyn Format> = Entry {
    name: "csv",
    aliases: &[],
    summary: "text with a header line, one line per point in time",
    reference: "",
    make: |_| Ok(Box::new(Csv)),
};

struct Csv;

impl Format for Csv {
    fn extension(&self) -> &'static str {
        "csv"
    }

    fn write(&self, table: &ResultTable) -> Result<Vec<u8>, Fault> {
        table.check()?;
        let names: Vec<String> = table.names().map(quoted).collect();
        let columns: Vec<Vec<f64>> = (0..table.series.len()).map(|i| table.expand(i)).collect();
        let mut text = names.join(",");
        for (row, time) in table.time.iter().enumerate() {
            text.push('\n');
            push_number(&mut text, *time);
            for column in &columns {
                text.push(',');
                push_number(&mut text, column[row]);
            }
        }
        text.push('\n');
        Ok(text.into_bytes())
    }

    fn read(&self, bytes: &[u8]) -> Result<ResultTable, Fault> {
        let file = mat::read_csv(bytes)?;
        let mut columns = file.arrays.into_iter();
        let Some((time_name, time)) = columns.next().filter(|(name, _)| is_time(name)) else {
            bail!(BAD_RESULT_FILE, "the first column is not `time`");
        };
        let series = columns
            .map(|(name, matrix)| Series::new(unmarked(name), Values::Trajectory(matrix.values)))
            .collect();
        let table = ResultTable { time_name, time: time.values, series };
        table.check()?;
        Ok(table)
    }
}

/// A text as a cell in double quotes. Spreadsheets would compute what begins as a formula does: an
/// apostrophe before it, as they write themselves, says that it is text.
pub fn quoted(text: &str) -> String {
    let is_formula = text.starts_with(['=', '+', '-', '@', '\t', '\r']);
    let mark = if is_formula { "'" } else { "" };
    format!("\"{mark}{}\"", text.replace('"', "\"\""))
}

/// The name in a cell that [`quoted`] has written. Quoted identifiers of Modelica have an even number
/// of apostrophes.
fn unmarked(name: String) -> String {
    let is_marked = name.matches('\'').count() % 2 == 1;
    match name.strip_prefix('\'') {
        Some(rest) if is_marked => rest.to_owned(),
        _ => name,
    }
}

fn is_time(name: &str) -> bool {
    name.eq_ignore_ascii_case("time")
}

/// The shortest text that reads back as the same number.
fn push_number(text: &mut String, value: f64) {
    write!(text, "{value:?}").expect("writing into a String does not fail");
}
