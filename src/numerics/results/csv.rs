//! Results as text: a header with the names in double quotes, then one line per point in time.
//! Constants are repeated, aliases written out; units and descriptions are not kept.

use super::errors::BAD_RESULT_FILE;
use super::{Format, ResultTable, Series, Values};
use crate::diag::Fault;
use crate::registry::Entry;
use crate::{bail, mat};
use std::fmt::Write;
use std::io;

pub(crate) const ENTRY: Entry<dyn Format> = Entry {
    name: "csv",
    aliases: &[],
    summary: "text with a header line and one line per time point",
    reference: "",
    make: |_| Ok(Box::new(Csv)),
};

struct Csv;

/// Bytes that a number and its comma take at most.
const LONGEST: usize = 25;

impl Format for Csv {
    fn extension(&self) -> &'static str {
        "csv"
    }

    fn write(&self, table: &ResultTable) -> Result<Vec<u8>, Fault> {
        table.check()?;
        table.has_room(LONGEST)?;
        let mut bytes = Vec::new();
        self.write_to(table, &mut bytes).expect("writing into memory does not fail");
        Ok(bytes)
    }

    fn write_to(&self, table: &ResultTable, to: &mut dyn io::Write) -> io::Result<()> {
        let names: Vec<String> = table.names().map(quoted).collect();
        to.write_all(names.join(",").as_bytes())?;
        let columns: Vec<Column> = (0..table.series.len()).map(|i| Column::of(table, i)).collect();
        let mut line = String::new();
        for (row, time) in table.time.iter().enumerate() {
            line.push('\n');
            push_number(&mut line, *time);
            for column in &columns {
                line.push(',');
                push_number(&mut line, column.value(row));
            }
            to.write_all(line.as_bytes())?;
            line.clear();
        }
        to.write_all(b"\n")
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

/// The values of a variable at their place in the table.
struct Column<'a> {
    values: &'a Values,
    sign: f64,
}

impl Column<'_> {
    fn of(table: &ResultTable, index: usize) -> Column<'_> {
        let (target, sign) = table.resolve(index);
        Column { values: &table.series[target].values, sign }
    }

    fn value(&self, row: usize) -> f64 {
        match self.values {
            Values::Constant(value) => self.sign * value,
            Values::Trajectory(values) => self.sign * values[row],
            Values::Alias { .. } => unreachable!("`resolve` ends at a series that is not an alias"),
        }
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
