//! Matrices in files: MAT versions 4, 5, 7 and 7.3, text in the `#1` format, tables (CSV and what
//! instruments write), XLSX.
//!
//! [`read`] recognizes the format by content, [`read_named`] also tables, of which [`read_csv`]
//! reads those that hold numbers alone; all return a [`MatFile`] of real matrices by name. [`write_v4`] and [`write_v5`] make files.
//!
//! What cannot be a real matrix is skipped, with a warning that names it, and asking for it is a
//! fault that says why: complex numbers (never silently their real part), sparse matrices, cells,
//! objects, functions, and arrays of more than two dimensions. Structures are read field by
//! field, under dotted names (`run.current`).
//!
//! Files may be damaged or hostile: every size is compared with the bytes that remain before
//! memory is taken, compressed elements are inflated up to [`MAX_INFLATED`] bytes a file, and
//! nesting ends at 32 levels.
//!
//! References: *MAT-File Format*, The MathWorks, R2024a (version 5: chapter 1; version 4:
//! appendix).

#[cfg(feature = "xlsx")]
mod archive;
mod calendar;
pub mod errors;
mod matrix;
mod named_values;
mod number;
mod reader;
#[cfg(feature = "xlsx")]
mod references;
mod signatures;
#[cfg(feature = "xlsx")]
mod spreadsheet;
mod table;
mod text;
mod v4;
mod v5;
#[cfg(feature = "hdf5")]
mod v73;
mod words;
mod write;

pub use calendar::{Calendar, calendar};
pub use matrix::{About, Column, MatFile, Matrix, MatrixKind, Version};
pub use number::Storage;
pub use table::read_csv;
pub use v5::MAX_INFLATED;
pub use write::{append_v4, write_named, write_v4, write_v5};

#[cfg(feature = "xlsx")]
use spreadsheet::read as read_spreadsheet;
#[cfg(feature = "hdf5")]
use v73::read as read_hdf5;

use crate::diag::Fault;
use crate::fault;

/// Reads all matrices of a MAT file of version 4, 5, 7 or 7.3, or of a text file in the `#1` format.
///
/// ```
/// use gapilib_numerics::mat::{self, Matrix};
/// let x = Matrix::from_rows(&[vec![0.1], vec![0.2]]);
/// let bytes = mat::write_v4([("Xexp", &x)])?;
/// assert_eq!(mat::read(&bytes)?.matrix("Xexp")?.values, [0.1, 0.2]);
/// # Ok::<(), gapilib_base::diag::Fault>(())
/// ```
pub fn read(bytes: &[u8]) -> Result<MatFile, Fault> {
    if signatures::is_hdf5(bytes) {
        return read_hdf5(bytes);
    }
    if text::looks_like(bytes) {
        return text::read(bytes);
    }
    if bytes.starts_with(b"# Created by Octave") {
        return Err(fault!(errors::UNSUPPORTED_MAT_FILE, "the file is in Octave's text format")
            .help("save it with `save -v7 file.mat`"));
    }
    match v5::byte_order(bytes) {
        Some(order) => v5::read(bytes, order),
        None => v4::read(bytes),
    }
}

#[cfg(not(feature = "hdf5"))]
fn read_hdf5(_: &[u8]) -> Result<MatFile, Fault> {
    Err(fault!(
        errors::UNSUPPORTED_MAT_FILE,
        "MAT files of version 7.3 (HDF5) are not read by this build, which lacks the feature `hdf5`"
    )
    .help("save it with `save -v7 file.mat`"))
}

#[cfg(not(feature = "xlsx"))]
fn read_spreadsheet(_: &[u8]) -> Result<MatFile, Fault> {
    Err(fault!(
        errors::BAD_TABLE,
        "spreadsheets are not read by this build, which lacks the feature `xlsx`"
    )
    .help("save the table as CSV"))
}

/// Reads a data file: text in columns by the ending of its name, anything else by its content.
/// Faults name the file.
pub fn read_named(file_name: &str, bytes: &[u8]) -> Result<MatFile, Fault> {
    let read = if is_table(file_name, bytes) {
        table::read_text(bytes, false)
    } else if signatures::is_zip(bytes) {
        read_spreadsheet(bytes)
    } else {
        read(bytes)
    };
    let short = file_name.rsplit(['/', '\\']).next().unwrap_or(file_name);
    match read {
        Ok(mut file) => {
            short.clone_into(&mut file.file_name);
            Ok(file)
        }
        Err(mut fault) => {
            fault.message = format!("`{short}`: {}", fault.message);
            Err(fault)
        }
    }
}

/// Endings of files that hold text in columns.
const TABLES: [&str; 13] =
    ["csv", "tsv", "txt", "dat", "dta", "mpt", "asc", "prn", "tab", "log", "xy", "out", "z"];

/// The part of a file's name after its last point, in lower case.
fn ending(file_name: &str) -> String {
    let name = file_name.rsplit(['/', '\\']).next().unwrap_or(file_name);
    name.rsplit_once('.').map_or("", |(_, ending)| ending).to_lowercase()
}

/// Whether a file is text in columns.
fn is_table(file_name: &str, bytes: &[u8]) -> bool {
    let ending = ending(file_name);
    let ending = ending.as_str();
    let binary = signatures::is_zip(bytes) || signatures::is_hdf5(bytes);
    let is_delimited = ["csv", "tsv"].contains(&ending);
    TABLES.contains(&ending) && !binary && (is_delimited || !text::looks_like(bytes))
}
