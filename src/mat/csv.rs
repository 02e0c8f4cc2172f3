//! Tables with a header line: each column becomes a matrix with one column, named by the header.
//!
//! Cells are separated by commas, or by semicolons or tabs if the header holds one. Lines that
//! start with `#` are comments. Between semicolons a comma is a decimal sign, unless a point
//! occurs as one in the same file.

use super::errors::BAD_TABLE;
use super::matrix::{MatFile, Matrix, Version};
use crate::bail;
use crate::diag::Fault;
use std::borrow::Cow;
use std::collections::HashSet;

/// Reads a table of numbers. Faults name line and column: cells that are empty or no numbers,
/// lines with more or fewer cells than the header, columns without a name or with the same one.
/// `NaN` and `inf` are numbers here.
///
/// ```
/// let table = gapilib::mat::read_csv(b"i,V\n0.1,0.95\n0.2,0.91\n")?;
/// assert_eq!(table.matrix("V")?.values, [0.95, 0.91]);
/// # Ok::<(), gapilib::diag::Fault>(())
/// ```
pub fn read_csv(bytes: &[u8]) -> Result<MatFile, Fault> {
    let text = decode(bytes);
    let delimiter = delimiter(&text);
    let decimal_comma = delimiter == b';' && has_decimal_comma(&text);
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .comment(Some(b'#'))
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let names = header(&mut reader)?;
    let mut columns = vec![Vec::new(); names.len()];
    let mut record = csv::StringRecord::new();
    while read_record(&mut reader, &mut record)? {
        let line = record.position().map_or(0, csv::Position::line);
        if record.len() != names.len() {
            let (found, expected) = (record.len(), names.len());
            let column = found.min(expected) + 1;
            bail!(
                BAD_TABLE,
                "line {line}, column {column}: {found} cells where the header has {expected}"
            );
        }
        for (j, cell) in record.iter().enumerate() {
            columns[j].push(number(cell, decimal_comma, line, j + 1, &names[j])?);
        }
    }
    let mut file = MatFile::new(Version::Csv);
    for (name, values) in names.into_iter().zip(columns) {
        file.insert(name, Matrix::column_vector(values));
    }
    Ok(file)
}

/// Text without a byte-order mark; Latin-1 if it is no UTF-8.
pub(super) fn decode(bytes: &[u8]) -> Cow<'_, str> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().copied().map(char::from).collect()),
    }
}

fn delimiter(text: &str) -> u8 {
    let header = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#'));
    let header = header.unwrap_or_default();
    [b';', b'\t'].into_iter().find(|mark| header.contains(char::from(*mark))).unwrap_or(b',')
}

fn has_decimal_comma(text: &str) -> bool {
    let data = || text.lines().filter(|line| !line.starts_with('#')).skip(1);
    data().any(|line| line.contains(',')) && !data().any(|line| line.contains('.'))
}

fn header(reader: &mut csv::Reader<&[u8]>) -> Result<Vec<String>, Fault> {
    let Ok(header) = reader.headers() else {
        bail!(BAD_TABLE, "the header line cannot be read");
    };
    if header.is_empty() {
        bail!(BAD_TABLE, "the file is empty"; help: "name the columns in the first line");
    }
    let mut names: Vec<String> = Vec::with_capacity(header.len());
    let mut seen = HashSet::new();
    let line = header.position().map_or(1, csv::Position::line);
    for (j, name) in header.iter().enumerate() {
        let column = j + 1;
        if name.is_empty() {
            bail!(BAD_TABLE, "line {line}, column {column}: the column has no name");
        }
        if !seen.insert(name) {
            bail!(BAD_TABLE, "line {line}, column {column}: a second column is named `{name}`");
        }
        names.push(name.to_owned());
    }
    if names.iter().all(|name| name.parse::<f64>().is_ok()) {
        bail!(
            BAD_TABLE,
            "line {line}, column 1: the first line holds numbers, not the names of the columns";
            help: "name the columns in the first line, such as `x,y`"
        );
    }
    Ok(names)
}

fn read_record(
    reader: &mut csv::Reader<&[u8]>,
    record: &mut csv::StringRecord,
) -> Result<bool, Fault> {
    match reader.read_record(record) {
        Ok(more) => Ok(more),
        Err(error) => {
            let line = error.position().map_or(0, csv::Position::line);
            bail!(BAD_TABLE, "line {line}: the line cannot be read");
        }
    }
}

fn number(
    cell: &str,
    decimal_comma: bool,
    line: u64,
    column: usize,
    name: &str,
) -> Result<f64, Fault> {
    let text = if decimal_comma { cell.replace(',', ".") } else { cell.to_owned() };
    match text.parse() {
        Ok(value) => Ok(value),
        Err(_) if cell.is_empty() => {
            bail!(BAD_TABLE, "line {line}, column {column}: `{name}` has an empty cell")
        }
        Err(_) => {
            let cell: String = cell.chars().take(40).collect();
            bail!(BAD_TABLE, "line {line}, column {column}: `{cell}` in `{name}` is not a number")
        }
    }
}
