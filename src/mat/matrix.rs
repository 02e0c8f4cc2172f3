//! What a file holds.

use super::errors::{BAD_MAT_FILE, UNKNOWN_MATRIX, UNREADABLE_MATRIX};
use crate::diag::{Fault, suggest};
use crate::{bail, fault};
use indexmap::IndexMap;

/// The format a file was read from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Version {
    /// MAT version 4.
    V4,
    /// MAT version 5, which includes 6 and 7.
    V5,
    /// Text in the `#1` format.
    Text,
    /// A table with a header line.
    Csv,
    /// The first sheet of an XLSX file.
    Spreadsheet,
}

/// What the values of a matrix stand for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Numbers.
    Numeric,
    /// Characters: UTF-16 code units or code points, or the bytes of a version 4 file.
    Char,
    /// 0 and 1.
    Logical,
}

/// A real matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// `rows * columns` values, column after column.
    pub values: Vec<f64>,
    /// What they stand for.
    pub kind: Kind,
}

impl Matrix {
    /// A numeric matrix from values stored column after column. Panics unless there are
    /// `rows * columns` of them.
    pub fn from_columns(rows: usize, columns: usize, values: Vec<f64>) -> Matrix {
        assert_eq!(values.len(), rows * columns, "a matrix has rows times columns values");
        Matrix { rows, columns, values, kind: Kind::Numeric }
    }

    /// A numeric matrix from its rows, all as long as the first. Panics if they are not.
    pub fn from_rows(rows: &[Vec<f64>]) -> Matrix {
        let columns = rows.first().map_or(0, Vec::len);
        assert!(rows.iter().all(|row| row.len() == columns), "rows of a matrix are equally long");
        let values = (0..columns).flat_map(|j| rows.iter().map(move |row| row[j])).collect();
        Matrix { rows: rows.len(), columns, values, kind: Kind::Numeric }
    }

    /// A numeric column.
    pub fn column_vector(values: Vec<f64>) -> Matrix {
        Matrix { rows: values.len(), columns: 1, values, kind: Kind::Numeric }
    }

    /// A character matrix with one line of text a row, as UTF-8 bytes, padded with blanks.
    pub fn from_text<S: AsRef<str>>(lines: &[S]) -> Matrix {
        let columns = lines.iter().map(|line| line.as_ref().len()).max().unwrap_or(0);
        let mut values = vec![f64::from(b' '); lines.len() * columns];
        for (i, line) in lines.iter().enumerate() {
            for (j, byte) in line.as_ref().bytes().enumerate() {
                values[i + j * lines.len()] = f64::from(byte);
            }
        }
        Matrix { rows: lines.len(), columns, values, kind: Kind::Char }
    }

    /// The value in row `i`, column `j`, counted from 0. Panics outside the matrix.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        assert!(i < self.rows, "row {i} of a matrix with {} rows", self.rows);
        self.values[i + j * self.rows]
    }

    /// Column `j`, counted from 0. Panics outside the matrix.
    pub fn column(&self, j: usize) -> &[f64] {
        &self.values[j * self.rows..(j + 1) * self.rows]
    }

    /// The values row after row.
    pub fn row_major(&self) -> Vec<f64> {
        self.transposed().values
    }

    /// The values of a matrix with one row or one column.
    pub fn as_vector(&self) -> Option<&[f64]> {
        (self.rows == 1 || self.columns == 1).then_some(&*self.values)
    }

    /// Rows and columns exchanged.
    pub fn transposed(&self) -> Matrix {
        let values = (0..self.rows).flat_map(|i| (0..self.columns).map(move |j| (i, j)));
        let values = values.map(|(i, j)| self.values[i + j * self.rows]).collect();
        Matrix { rows: self.columns, columns: self.rows, values, kind: self.kind }
    }

    /// Each row as text without the blanks and zeros at its end. Bytes above 127 are read as UTF-8
    /// where they form it, as Latin-1 otherwise.
    pub fn text_rows(&self) -> Vec<String> {
        (0..self.rows)
            .map(|i| decode_text((0..self.columns).map(|j| self.values[i + j * self.rows])))
            .collect()
    }

    /// Each column as text, see [`Matrix::text_rows`].
    pub fn text_columns(&self) -> Vec<String> {
        (0..self.columns).map(|j| decode_text(self.column(j).iter().copied())).collect()
    }
}

/// Number of values of a matrix that a file claims to hold. An empty matrix with a huge number of
/// rows or columns is refused: it costs a file nothing and whoever goes over its rows a lot.
pub(super) fn size(name: &str, rows: usize, columns: usize) -> Result<usize, Fault> {
    const MAX_EMPTY: usize = 1 << 16;
    match rows.checked_mul(columns) {
        Some(size) if size > 0 || rows.max(columns) <= MAX_EMPTY => Ok(size),
        _ => bail!(BAD_MAT_FILE, "matrix `{name}` claims {rows} rows and {columns} columns"),
    }
}

fn decode_text(codes: impl Iterator<Item = f64>) -> String {
    let codes: Vec<u32> = codes.map(|code| code as u32).collect();
    let bytes: Option<Vec<u8>> = codes.iter().map(|code| u8::try_from(*code).ok()).collect();
    let text = bytes.and_then(|bytes| String::from_utf8(bytes).ok()).unwrap_or_else(|| {
        let mut units = Vec::with_capacity(codes.len());
        for code in codes {
            match char::from_u32(code) {
                Some(letter) => units.extend_from_slice(letter.encode_utf16(&mut [0; 2])),
                None => units.push(code as u16),
            }
        }
        String::from_utf16_lossy(&units)
    });
    text.trim_end_matches([' ', '\0']).to_owned()
}

/// The matrices of a file, by name, in the order of the file.
#[derive(Debug, Clone, PartialEq)]
pub struct MatFile {
    /// The format it was read from.
    pub version: Version,
    /// Real matrices by name.
    pub arrays: IndexMap<String, Matrix>,
    /// One sentence for each variable that was skipped or changed in reading.
    pub warnings: Vec<String>,
    skipped: IndexMap<String, String>,
}

impl MatFile {
    pub(super) fn new(version: Version) -> MatFile {
        MatFile { version, arrays: IndexMap::new(), warnings: Vec::new(), skipped: IndexMap::new() }
    }

    /// The matrix of this name; the fault lists what there is, or says why it was skipped.
    pub fn matrix(&self, name: &str) -> Result<&Matrix, Fault> {
        if let Some(matrix) = self.arrays.get(name) {
            return Ok(matrix);
        }
        if let Some(reason) = self.skipped.get(name) {
            return Err(fault!(UNREADABLE_MATRIX, "`{name}` cannot be read: {reason}"));
        }
        let what = if matches!(self.version, Version::Csv | Version::Spreadsheet) {
            "column"
        } else {
            "matrix"
        };
        let names = self.arrays.keys().map(String::as_str);
        Err(fault!(UNKNOWN_MATRIX, "the file has no {what} `{name}`")
            .help_if(suggest::did_you_mean(name, names))
            .help(self.inventory()))
    }

    fn inventory(&self) -> String {
        const SHOWN: usize = 12;
        if self.arrays.is_empty() {
            return "the file holds no matrix".to_owned();
        }
        let names: Vec<String> =
            self.arrays.keys().take(SHOWN).map(|name| format!("`{name}`")).collect();
        let more = match self.arrays.len().saturating_sub(SHOWN) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        format!("the file holds {}{more}", names.join(", "))
    }

    pub(super) fn insert(&mut self, name: String, matrix: Matrix) {
        self.skipped.shift_remove(&name);
        if self.arrays.contains_key(&name) {
            self.warnings.push(format!("`{name}` occurs twice; the last one counts"));
        }
        self.arrays.insert(name, matrix);
    }

    /// Notes that `name` is not read; `reason` completes "`name` is skipped: …".
    pub(super) fn skip(&mut self, name: String, reason: &str) {
        self.arrays.shift_remove(&name);
        self.warnings.push(format!("`{name}` is skipped: {reason}"));
        self.skipped.insert(name, reason.to_owned());
    }
}
