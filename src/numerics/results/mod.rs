//! Results of simulations as files, both ways: a [`ResultTable`] and the formats that hold it.
//!
//! | name | extension | layout |
//! |---|---|---|
//! | `mat` | `.mat` | MAT version 4 with the matrices `Aclass`, `name`, `description`, `dataInfo`, `data_1`, `data_2` |
//! | `csv` | `.csv` | a header line, then one line per point in time |

mod comparison;
mod csv;
pub mod errors;
mod mat;
mod sampled;
mod table;
mod tube;

pub use comparison::{Agreement, Compared, compare, compare_samples, signals_to_compare};
pub use csv::quoted;
pub use sampled::{between_samples, read_sampled};
pub use table::{ResultTable, Series, Values};
pub use tube::{Deviation, TUBE_TOLERANCE, Tube};

use crate::diag::Fault;
use crate::mat::{MatFile, Version};
use crate::registry::{self, Entry, Options};
use std::io;

/// Values of results with constants repeated at every point: half a gigabyte.
const MOST_VALUES: usize = 1 << 26;

/// Measured data in a file: a table, matrices, or the results of a simulation, which have a column for
/// each variable.
///
/// # Errors
///
/// Those of [`mat::read_named`](crate::mat::read_named), and of damaged results.
pub fn read_data(file_name: &str, bytes: &[u8]) -> Result<MatFile, Fault> {
    let file = crate::mat::read_named(file_name, bytes)?;
    if !mat::holds_results(&file) {
        return Ok(file);
    }
    let table = (mat::ENTRY.make)(&mut Options::default())?.read(bytes)?;
    let time = [(table.time_name.clone(), Some("s".to_owned()), table.time.clone())];
    // Constants are worth a column each where that takes little memory.
    let is_small = table.time.len().saturating_mul(table.series.len()) <= MOST_VALUES;
    let series = table.series.iter().enumerate();
    let series = series.filter(|(_, one)| is_small || !matches!(one.values, Values::Constant(_)));
    let columns = series.map(|(at, series)| {
        let unit = Some(series.unit.clone()).filter(|unit| !unit.is_empty());
        (series.name.clone(), unit, table.expand(at))
    });
    let mut data = MatFile::of_columns(Version::Results, time.into_iter().chain(columns));
    data.file_name = file.file_name;
    Ok(data)
}

/// A way to write results into a file and to read them.
pub trait Format {
    /// The end of its file names, without the point.
    fn extension(&self) -> &'static str;
    /// The file.
    fn write(&self, table: &ResultTable) -> Result<Vec<u8>, Fault>;
    /// The same, without all of it in memory where the format allows that. The table is one that
    /// [`ResultTable::check`] accepts.
    ///
    /// # Errors
    /// Those of the writer.
    fn write_to(&self, table: &ResultTable, to: &mut dyn io::Write) -> io::Result<()> {
        to.write_all(&self.write(table).map_err(|fault| io::Error::other(fault.message))?)
    }
    /// The results in a file.
    fn read(&self, bytes: &[u8]) -> Result<ResultTable, Fault>;
}

/// All formats; the first is the default.
pub const FORMATS: &[&Entry<dyn Format>] = &[&mat::ENTRY, &csv::ENTRY];

/// The format of this name, such as `mat`.
pub fn format(name: &str) -> Result<Box<dyn Format>, Fault> {
    (registry::find("result format", FORMATS, name)?.make)(&mut Options::default())
}

/// The format for a file of this name: by its extension, `mat` if it has none.
pub fn format_of_file(file_name: &str) -> Result<Box<dyn Format>, Fault> {
    let last = file_name.rsplit(['/', '\\']).next().unwrap_or(file_name);
    format(last.rsplit_once('.').map_or(FORMATS[0].name, |(_, extension)| extension))
}

/// Bytes at the beginning of a file by which [`are_results`] recognizes it.
pub const BEGINNING: usize = 64;

/// Whether a file that begins so holds what a simulation or linearization writes, by this program or
/// another Modelica tool: MAT version 4 or text whose first matrix is `Aclass`, CSV whose first
/// header cell is a quoted time, as data of other origin hardly have it, or a linearized model.
pub fn are_results(beginning: &[u8]) -> bool {
    /// Length of the header of a matrix of MAT version 4; its name follows.
    const HEADER: usize = 20;
    let is_binary = beginning.get(HEADER..).is_some_and(|rest| rest.starts_with(b"Aclass\0"));
    let text = String::from_utf8_lossy(beginning);
    let mut lines = text.lines();
    let (first, second) = (lines.next().unwrap_or_default(), lines.next().unwrap_or_default());
    let is_text = first.trim_end() == "#1" && second.starts_with("char Aclass(");
    let cell = first.split([',', ';', '\t']).next().unwrap_or_default();
    let is_table = ["\"time\"", "\"Time\""].contains(&cell.trim_end());
    is_binary || is_text || is_table || first.starts_with("model linearized_model ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_without_room_is_a_fault() {
        let table = ResultTable::new(vec![0.0, 1.0]);
        assert!(table.has_room(16).is_ok());
        let fault = table.has_room(usize::MAX).expect_err("no machine has so much");
        assert!(fault.message.contains("no memory for a result file with 2 values"));
    }

    #[test]
    fn results_are_recognized_and_data_are_not() {
        let mut table = ResultTable::new(vec![0.0, 1.0]);
        table.series.push(Series::new("x".to_owned(), Values::Trajectory(vec![1.0, 2.0])));
        for format in FORMATS {
            let format = (format.make)(&mut Options::default()).expect("a format");
            let bytes = format.write(&table).expect("written");
            assert!(are_results(&bytes[..BEGINNING.min(bytes.len())]), "{}", format.extension());
        }
        assert!(are_results(b"#1\nchar Aclass(4,24)\nAtrajectory\n"));
        assert!(are_results(b"model linearized_model \"M\"\n"));
        let matrix = crate::mat::Matrix::from_rows(&[vec![1.0]]);
        let data = crate::mat::write_v4([("data", &matrix)]).expect("written");
        let others: [&[u8]; 6] =
            [&data, b"", b"time,y\n0,1\n", b"#1\ndouble t(2,2)\n", b"\"time", b"model M Real x;"];
        for other in others {
            assert!(!are_results(other), "{}", String::from_utf8_lossy(other));
        }
    }
}
