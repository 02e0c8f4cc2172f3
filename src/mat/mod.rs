//! Matrices in files: MAT versions 4, 5 and 7, text in the `#1` format, CSV and XLSX.
//!
//! [`read`] recognises the format by content and [`read_csv`] reads tables; both return a
//! [`MatFile`] of real matrices by name. [`write_v4`] and [`write_v5`] make files.
//!
//! What cannot be a real matrix is skipped, with a warning that names it, and asking for it is a
//! fault that says why: complex numbers (never silently their real part), sparse matrices, cells,
//! objects, functions, and arrays of more than two dimensions. Structures are read field by
//! field, under dotted names (`run.current`). Version 7.3, which is HDF5, is refused.
//!
//! Files may be damaged or hostile: every size is compared with the bytes that remain before
//! memory is taken, compressed elements are inflated up to [`MAX_INFLATED`] bytes a file, and
//! nesting ends at 32 levels.
//!
//! References: *MAT-File Format*, The MathWorks, R2024a (version 5: chapter 1; version 4:
//! appendix).

mod csv;
pub mod errors;
mod matrix;
mod number;
mod reader;
mod spreadsheet;
mod text;
mod v4;
mod v5;
mod write;

pub use csv::read_csv;
pub use matrix::{Kind, MatFile, Matrix, Version};
pub use number::Storage;
pub use v5::MAX_INFLATED;
pub use write::{append_v4, write_v4, write_v5};

use crate::diag::Fault;
use crate::fault;

/// Reads all matrices of a MAT file of version 4, 5 or 7, or of a text file in the `#1` format.
///
/// ```
/// use gapilib::mat::{self, Matrix};
/// let x = Matrix::from_rows(&[vec![0.1], vec![0.2]]);
/// let bytes = mat::write_v4([("Xexp", &x)])?;
/// assert_eq!(mat::read(&bytes)?.matrix("Xexp")?.values, [0.1, 0.2]);
/// # Ok::<(), gapilib::diag::Fault>(())
/// ```
pub fn read(bytes: &[u8]) -> Result<MatFile, Fault> {
    refuse_hdf5(bytes)?;
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

/// Reads a data file by the end of its name: `.csv` (also `.tsv`, `.txt` with columns) as a table;
/// by its content: the first sheet of an XLSX file as a table, anything else with [`read`].
pub fn read_named(file_name: &str, bytes: &[u8]) -> Result<MatFile, Fault> {
    let lower = file_name.to_lowercase();
    let table = [".csv", ".tsv"].iter().any(|end| lower.ends_with(end))
        || lower.ends_with(".txt") && !text::looks_like(bytes);
    if table {
        return read_csv(bytes);
    }
    if spreadsheet::looks_like(bytes) {
        return spreadsheet::read(bytes);
    }
    read(bytes)
}

fn refuse_hdf5(bytes: &[u8]) -> Result<(), Fault> {
    const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";
    let signed = |at: usize| bytes.get(at..).is_some_and(|rest| rest.starts_with(SIGNATURE));
    if signed(0) || signed(512) || bytes.starts_with(b"MATLAB 7.3 MAT-file") {
        return Err(fault!(
            errors::UNSUPPORTED_MAT_FILE,
            "the file is of version 7.3 (HDF5), which is not read"
        )
        .help("save it with `save -v7 file.mat`"));
    }
    Ok(())
}
