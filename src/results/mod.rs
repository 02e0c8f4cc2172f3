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
use crate::registry::{self, Entry, Options};
use std::io;

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
