//! What a file holds.

use super::errors::{BAD_MAT_FILE, UNKNOWN_MATRIX, UNREADABLE_MATRIX};
use super::words::Words;
use crate::diag::{Fault, suggest};
use crate::{bail, fault};
use indexmap::IndexMap;
use std::ops::Range;
use std::sync::Arc;

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
    /// MAT version 7.3, which is HDF5.
    V73,
    /// Results of a simulation.
    Results,
}

/// What the values of a matrix stand for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MatrixKind {
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
    pub kind: MatrixKind,
}

impl Matrix {
    /// A numeric matrix from values stored column after column. Panics unless there are
    /// `rows * columns` of them.
    pub fn from_columns(rows: usize, columns: usize, values: Vec<f64>) -> Matrix {
        assert_eq!(values.len(), rows * columns, "a matrix has rows times columns values");
        Matrix { rows, columns, values, kind: MatrixKind::Numeric }
    }

    /// A numeric matrix from its rows, all as long as the first. Panics if they are not.
    pub fn from_rows(rows: &[Vec<f64>]) -> Matrix {
        let columns = rows.first().map_or(0, Vec::len);
        assert!(rows.iter().all(|row| row.len() == columns), "rows of a matrix are equally long");
        let values = (0..columns).flat_map(|j| rows.iter().map(move |row| row[j])).collect();
        Matrix { rows: rows.len(), columns, values, kind: MatrixKind::Numeric }
    }

    /// A numeric column.
    pub fn column_vector(values: Vec<f64>) -> Matrix {
        Matrix { rows: values.len(), columns: 1, values, kind: MatrixKind::Numeric }
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
        Matrix { rows: lines.len(), columns, values, kind: MatrixKind::Char }
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

    /// Some of the rows.
    fn rows(&self, rows: Range<usize>) -> Matrix {
        let values = (0..self.columns).flat_map(|j| self.column(j)[rows.clone()].to_vec());
        Matrix {
            rows: rows.len(),
            columns: self.columns,
            values: values.collect(),
            kind: self.kind,
        }
    }

    /// The values row after row.
    pub fn row_major(&self) -> Vec<f64> {
        self.transposed().values
    }

    /// The values of a matrix with one row or one column.
    pub fn as_vector(&self) -> Option<&[f64]> {
        (self.rows == 1 || self.columns == 1).then_some(&*self.values)
    }

    /// A row or column; `name` is that of the matrix.
    fn part(&self, name: &str, part: Part) -> Result<Vec<f64>, Fault> {
        let (what, at, count) = match part {
            Part::Column(at) => ("column", at, self.columns),
            Part::Row(at) => ("row", at, self.rows),
        };
        if !(1..=count).contains(&at) {
            bail!(UNKNOWN_MATRIX, "`{name}` has no {what} {at}; it has {count}");
        }
        Ok(match part {
            Part::Column(at) => self.column(at - 1).to_vec(),
            Part::Row(at) => (0..self.columns).map(|j| self.get(at - 1, j)).collect(),
        })
    }

    /// Rows and columns exchanged.
    pub fn transposed(&self) -> Matrix {
        let values = (0..self.rows).flat_map(|i| (0..self.columns).map(move |j| (i, j)));
        let values = values.map(|(i, j)| self.values[i + j * self.rows]).collect();
        Matrix { rows: self.columns, columns: self.rows, values, kind: self.kind }
    }

    /// Each row as text without the blanks and zeros at its end. Bytes above 127 are read as UTF-8
    /// where they form it, as Latin-1 otherwise.
    pub fn row_strings(&self) -> Vec<String> {
        (0..self.rows)
            .map(|i| decode_text((0..self.columns).map(|j| self.values[i + j * self.rows])))
            .collect()
    }

    /// Each column as text, see [`Matrix::row_strings`].
    pub(crate) fn column_strings(&self) -> Vec<String> {
        (0..self.columns).map(|j| decode_text(self.column(j).iter().copied())).collect()
    }
}

/// Number of values of a matrix that a file claims to hold. An empty matrix with a huge number of
/// rows or columns is refused: it takes no space in a file, but much time in every loop over its
/// rows.
pub(crate) fn size(name: &str, rows: usize, columns: usize) -> Result<usize, Fault> {
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

/// What is known of a column beside its values.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct About {
    /// Its unit as the file writes it; `None` where it does not.
    pub unit: Option<String>,
    /// What the file writes in the place of a unit, where this is not a known one.
    pub unknown_unit: Option<String>,
    /// The line (in a spreadsheet the row) of each value, counted from 1; empty where there are none.
    pub lines: Arc<[usize]>,
    /// What was changed in reading, one sentence each.
    pub notes: Vec<String>,
    /// Rows of the file before the first value.
    pub rows_before: usize,
}

/// Measured values, see [`MatFile::column`].
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// The values; NaN where there is none.
    pub values: Vec<f64>,
    /// What is known of them.
    pub about: About,
    /// The sentence about values that are missing, if some are.
    pub missing: Option<String>,
}

impl Column {
    /// All that should be known: how the values were read, and which are missing.
    pub fn notes(&self) -> impl Iterator<Item = String> {
        self.about.notes.iter().chain(&self.missing).cloned()
    }
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
    /// The name of the file for messages; empty where it is not known.
    pub file_name: String,
    /// Variables that cannot be read, and why.
    failed: IndexMap<String, Fault>,
    about: IndexMap<String, About>,
    /// Rows of the file before the first one here, see [`MatFile::rows`].
    pub(super) rows_before: usize,
    /// Columns that are not all numbers.
    pub(super) words: IndexMap<String, Words>,
    /// Names of columns without their units, with the columns that they may mean.
    aliases: IndexMap<String, Vec<String>>,
}

impl MatFile {
    pub(super) fn new(version: Version) -> MatFile {
        MatFile {
            version,
            arrays: IndexMap::new(),
            warnings: Vec::new(),
            file_name: String::new(),
            failed: IndexMap::new(),
            about: IndexMap::new(),
            rows_before: 0,
            words: IndexMap::new(),
            aliases: IndexMap::new(),
        }
    }

    /// The matrix of this name, which may lack the unit that its head has; the fault lists what
    /// there is, or says why it cannot be read.
    pub fn matrix(&self, name: &str) -> Result<&Matrix, Fault> {
        let own = self.own_name(name)?;
        if let Some(matrix) = self.arrays.get(own) {
            return Ok(matrix);
        }
        if let Some(fault) = self.failed.get(own) {
            return Err(self.located(fault.clone()));
        }
        let what = if self.is_table() { "column" } else { "matrix" };
        let names = self.arrays.keys().chain(self.aliases.keys()).map(String::as_str);
        Err(fault!(UNKNOWN_MATRIX, "{} has no {what} `{name}`", self.file())
            .help_if(suggest::did_you_mean(name, names))
            .help_if(self.why_skipped(name))
            .help(self.inventory())
            .help_if(self.unread_columns()))
    }

    /// The columns that could not be read: one of them may be the one that is missing.
    pub fn unread_columns(&self) -> Option<String> {
        let reasons: Vec<&str> = self.failed.values().map(|fault| fault.message.as_str()).collect();
        let is_some = self.is_table() && !reasons.is_empty();
        is_some.then(|| format!("a column cannot be read: {}", reasons.join("; ")))
    }

    /// Why the variable to which a name belongs was not read.
    fn why_skipped(&self, name: &str) -> Option<String> {
        let is_part = |own: &str| {
            name.strip_prefix(own).is_some_and(|rest| rest.starts_with(['.', '(', '[', '{']))
        };
        let (_, fault) = self.failed.iter().find(|(own, _)| is_part(own))?;
        Some(fault.message.clone())
    }

    /// How columns of matrices are named, if there is a matrix that needs it.
    fn columns_of_matrices(&self) -> Option<String> {
        let is_wide =
            |matrix: &Matrix| matrix.kind != MatrixKind::Char && matrix.as_vector().is_none();
        let (name, matrix) = self.arrays.iter().find(|(_, matrix)| is_wide(matrix))?;
        let Matrix { rows, columns, .. } = matrix;
        Some(format!(
            "`{name}` has {rows} rows and {columns} columns: write `{name}[:,1]` for a column"
        ))
    }

    /// Measured values: a matrix with one row or one column, or a row or column of a larger one, as in
    /// `data[:,2]`.
    pub fn column(&self, name: &str) -> Result<Column, Fault> {
        let (values, about) = match part(name).filter(|_| self.own_name(name) == Ok(name)) {
            Some((matrix, part)) if !self.arrays.contains_key(name) => {
                let rows_before = self.rows_before;
                let values = self.numbers(matrix)?.part(matrix, part)?;
                (values, About { rows_before, ..About::default() })
            }
            _ => {
                let numbers = self.numbers(name);
                let matrix = numbers.map_err(|fault| fault.help_if(self.columns_of_matrices()))?;
                let Some(values) = matrix.as_vector() else {
                    let Matrix { rows, columns, .. } = matrix;
                    bail!(
                        UNKNOWN_MATRIX,
                        "`{name}` is a matrix of {rows} rows and {columns} columns";
                        help: "write a column, `{name}[:,1]`, or a row, `{name}[1,:]`"
                    );
                };
                let own = self.own_name(name)?;
                let about = self.about.get(own).cloned().unwrap_or_default();
                (values.to_vec(), About { rows_before: self.rows_before, ..about })
            }
        };
        let missing = missing(name, &values, self.rows_before);
        Ok(Column { values, about, missing })
    }

    /// A matrix whose values are measured ones.
    fn numbers(&self, name: &str) -> Result<&Matrix, Fault> {
        let matrix = self.matrix(name)?;
        if matrix.kind == MatrixKind::Char {
            return Err(fault!(UNKNOWN_MATRIX, "`{name}` contains text, not numbers")
                .help(self.inventory()));
        }
        Ok(matrix)
    }

    /// The same with these rows alone of all that have `count` rows; messages count the rows as in
    /// the whole file.
    pub fn rows(&self, rows: Range<usize>, count: usize) -> MatFile {
        let mut part = self.clone();
        for (name, matrix) in &mut part.arrays {
            *matrix = match (matrix.rows, matrix.columns) {
                (own, _) if own == count => matrix.rows(rows.clone()),
                (1, own) if own == count => matrix.transposed().rows(rows.clone()).transposed(),
                _ => continue,
            };
            if let Some(about) = part.about.get_mut(name).filter(|about| about.lines.len() == count)
            {
                about.lines = about.lines[rows.clone()].into();
            }
        }
        for words in part.words.values_mut().filter(|words| words.cells.len() == count) {
            *words = words.rows(rows.clone());
        }
        part.rows_before += rows.start;
        part
    }

    /// The name of a column without its unit, if that means no other one.
    pub fn short_name<'n>(&'n self, name: &'n str) -> &'n str {
        let only = |(_, names): &(&String, &Vec<String>)| names.len() == 1 && names[0] == name;
        let bare = self.aliases.iter().find(only).map(|(bare, _)| bare.as_str());
        bare.filter(|bare| self.own_name(bare) == Ok(name)).unwrap_or(name)
    }

    /// What is known of the columns by name, for those that were read from a table.
    pub fn about(&self, name: &str) -> Option<&About> {
        self.about.get(name)
    }

    /// Columns that cannot be read as numbers, with the reason.
    pub fn unreadable(&self) -> impl Iterator<Item = (&str, &Fault)> {
        self.failed.iter().map(|(name, fault)| (name.as_str(), fault))
    }

    /// Whether it has columns with names: text in columns, a spreadsheet, or results.
    pub fn is_table(&self) -> bool {
        matches!(self.version, Version::Csv | Version::Spreadsheet | Version::Results)
    }

    fn file(&self) -> String {
        if self.file_name.is_empty() {
            "the file".to_owned()
        } else {
            format!("`{}`", self.file_name)
        }
    }

    /// The fault with the name of the file.
    pub(super) fn located(&self, mut fault: Fault) -> Fault {
        if !self.file_name.is_empty() {
            fault.message = format!("`{}`: {}", self.file_name, fault.message);
        }
        fault
    }

    /// The name as the file has it.
    pub(super) fn own_name<'n>(&'n self, name: &'n str) -> Result<&'n str, Fault> {
        if self.arrays.contains_key(name) || self.failed.contains_key(name) {
            return Ok(name);
        }
        match self.aliases.get(name).map(Vec::as_slice) {
            None | Some([]) => Ok(self.name_in_parentheses(name).unwrap_or(name)),
            Some([own]) => Ok(own),
            Some(several) => bail!(
                UNKNOWN_MATRIX,
                "{} has several columns `{name}`: {}", self.file(), listed(several);
                help: "write the name with its unit, as in the header"
            ),
        }
    }

    /// The name of a variable whose indices are written in brackets, as `run[1].t` for `run(1).t`.
    fn name_in_parentheses(&self, name: &str) -> Option<&str> {
        let other = name.replace('[', "(").replace(']', ")");
        let known = self.arrays.keys().chain(self.failed.keys());
        known.map(String::as_str).find(|own| *own == other && other != name)
    }

    fn inventory(&self) -> String {
        const SHOWN: usize = 12;
        if self.arrays.is_empty() {
            return "the file contains no matrix".to_owned();
        }
        let names: Vec<String> = self.arrays.keys().take(SHOWN).cloned().collect();
        let more = match self.arrays.len().saturating_sub(SHOWN) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        format!("the file contains {}{more}", listed(&names))
    }

    /// Columns with their names and units; the last of several with one name counts.
    pub fn of_columns(
        version: Version,
        columns: impl IntoIterator<Item = (String, Option<String>, Vec<f64>)>,
    ) -> MatFile {
        let mut file = MatFile::new(version);
        for (name, unit, values) in columns {
            let about = About { unit, ..About::default() };
            file.insert_column(name, Matrix::column_vector(values), about);
        }
        file
    }

    pub(super) fn insert(&mut self, name: String, matrix: Matrix) {
        self.failed.shift_remove(&name);
        if self.arrays.contains_key(&name) {
            self.warnings.push(format!("`{name}` occurs twice; the last one is used"));
        }
        self.arrays.insert(name, matrix);
    }

    pub(super) fn insert_column(&mut self, name: String, matrix: Matrix, about: About) {
        self.about.insert(name.clone(), about);
        self.arrays.insert(name, matrix);
    }

    /// Notes that `bare` means the column `name` unless another one has this very name.
    pub(super) fn alias(&mut self, bare: &str, name: &str) {
        let names = self.aliases.entry(bare.to_owned()).or_default();
        if !names.iter().any(|known| known == name) {
            names.push(name.to_owned());
        }
    }

    /// Notes that `name` cannot be read.
    pub(super) fn fail(&mut self, name: String, fault: Fault) {
        self.arrays.shift_remove(&name);
        self.failed.insert(name, fault);
    }

    /// Notes that `name` is not read; `reason` completes "`name` is skipped: …".
    pub(super) fn skip(&mut self, name: String, reason: &str) {
        self.warnings.push(format!("`{name}` is skipped: {reason}"));
        let fault = fault!(UNREADABLE_MATRIX, "`{name}` cannot be read: {reason}");
        self.fail(name, fault);
    }
}

impl Column {
    /// Where value number `row`, counted from 0, stands: `line 5`, or `row 4` without lines.
    pub fn place(&self, row: usize) -> String {
        match self.about.lines.get(row) {
            Some(line) => format!("line {line}"),
            None => format!("row {}", self.about.rows_before + row + 1),
        }
    }

    /// Sentences about values that fall or occur twice, where they are the X of an experiment.
    pub fn order(&self, name: &str) -> Vec<String> {
        self.fall(name).into_iter().chain(self.repetition(name)).collect()
    }

    /// The values that there are, with their rows counted from 0.
    pub fn known(&self) -> impl Iterator<Item = (usize, f64)> {
        self.values.iter().copied().enumerate().filter(|(_, value)| value.is_finite())
    }

    /// A sentence about values that rise and fall.
    pub fn fall(&self, name: &str) -> Option<String> {
        let known: Vec<(usize, f64)> = self.known().collect();
        let falling = known.windows(2).find(|pair| pair[1].1 < pair[0].1);
        let rises = known.windows(2).any(|pair| pair[1].1 > pair[0].1);
        let Some([before, after]) = falling.filter(|_| rises) else { return None };
        Some(format!(
            "`{name}` decreases from {} to {} at {}: all rows are treated as points of one \
             experiment; write consecutive runs to separate files, or cut them with `segments` in a \
             problem file",
            before.1,
            after.1,
            self.place(after.0)
        ))
    }

    /// A sentence about values that occur more than once.
    pub fn repetition(&self, name: &str) -> Option<String> {
        let mut sorted: Vec<f64> = self.known().map(|(_, value)| value).collect();
        sorted.sort_by(f64::total_cmp);
        let twice = sorted.windows(2).filter(|pair| pair[0] == pair[1]).count();
        let first = sorted.windows(2).find(|pair| pair[0] == pair[1])?[0];
        Some(format!(
            "{twice} values of `{name}` repeat an earlier one, such as {first}: each row counts as \
             one point"
        ))
    }
}

fn listed(names: &[String]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// A row or column of a matrix, counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    Column(usize),
    Row(usize),
}

/// `data` and the second column of `data[:,2]` or `data(:,2)`; of `data[2,:]` the second row.
fn part(name: &str) -> Option<(&str, Part)> {
    let inner = name.strip_suffix([']', ')'])?;
    let (matrix, index) = inner.rsplit_once(['[', '('])?;
    let (row, column) = index.split_once(',')?;
    let part = match (row.trim(), column.trim()) {
        (":", column) => Part::Column(column.parse().ok()?),
        (row, ":") => Part::Row(row.parse().ok()?),
        _ => return None,
    };
    Some((matrix.trim_end(), part))
}

/// The sentence about values that are missing.
pub(super) fn missing(name: &str, values: &[f64], rows_before: usize) -> Option<String> {
    const SHOWN: usize = 10;
    let rows: Vec<usize> = (0..values.len()).filter(|&k| !values[k].is_finite()).collect();
    if rows.is_empty() {
        return None;
    }
    let shown: Vec<String> =
        rows.iter().take(SHOWN).map(|row| (rows_before + row + 1).to_string()).collect();
    let more = if rows.len() > SHOWN { ", …" } else { "" };
    let (what, verb) = if rows.len() == 1 { ("row", "is") } else { ("rows", "are") };
    Some(format!(
        "{} of {} values of `{name}` {verb} missing: {what} {}{more}",
        rows.len(),
        values.len(),
        shown.join(", ")
    ))
}
