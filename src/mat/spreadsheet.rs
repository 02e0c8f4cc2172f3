//! Spreadsheets (XLSX): the first sheet as a table. Its first row that is not empty names the
//! columns, each of which becomes a matrix with one column.

use super::errors::BAD_TABLE;
use super::matrix::{MatFile, Matrix, Version};
use crate::bail;
use crate::diag::Fault;
use crate::fault;
use calamine::{DataRef, Reader, Xlsx};
use std::collections::{BTreeMap, HashSet};
use std::io::Cursor;

/// Cells that a sheet may have.
const MOST_CELLS: usize = 10_000_000;

/// Names of columns by their place.
type Names = BTreeMap<u32, String>;

/// Whether the bytes are those of a zip archive, as XLSX files are.
pub(super) fn looks_like(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04")
}

/// Reads the first sheet. Empty cells are missing values, NaN; rows without any number are left
/// out. Faults name the cell: text that is no number, errors of formulas, columns without a name
/// or with the same one.
///
/// # Errors
///
/// `bad-table`.
pub(super) fn read(bytes: &[u8]) -> Result<MatFile, Fault> {
    let unreadable = |error: &dyn std::fmt::Display| {
        fault!(BAD_TABLE, "the spreadsheet cannot be read: {error}")
            .help("save it as .xlsx or .csv")
    };
    let mut workbook = Xlsx::new(Cursor::new(bytes)).map_err(|error| unreadable(&error))?;
    let Some(sheet) = workbook.sheet_names().first().cloned() else {
        bail!(BAD_TABLE, "the spreadsheet has no sheet");
    };
    let mut cells = workbook.worksheet_cells_reader(&sheet).map_err(|error| unreadable(&error))?;
    let mut names = Names::new();
    let mut heading = None;
    let mut rows: BTreeMap<u32, BTreeMap<u32, f64>> = BTreeMap::new();
    let mut count = 0;
    while let Some(cell) = cells.next_cell().map_err(|error| unreadable(&error))? {
        count += 1;
        if count > MOST_CELLS {
            bail!(BAD_TABLE, "the sheet `{sheet}` has more than {MOST_CELLS} cells");
        }
        let (row, column) = cell.get_position();
        if matches!(cell.get_value(), DataRef::Empty) {
            continue;
        }
        if *heading.get_or_insert(row) == row {
            names.insert(column, name(cell.get_value(), row, column)?);
        } else if let Some(value) = number(cell.get_value(), row, column)? {
            if !names.contains_key(&column) {
                bail!(BAD_TABLE, "cell {}: the column has no name", place(row, column));
            }
            rows.entry(row).or_default().insert(column, value);
        }
    }
    table(&sheet, &names, &rows)
}

fn table(
    sheet: &str,
    names: &Names,
    rows: &BTreeMap<u32, BTreeMap<u32, f64>>,
) -> Result<MatFile, Fault> {
    if names.is_empty() {
        bail!(BAD_TABLE, "the sheet `{sheet}` is empty"; help: "put the table on the first sheet");
    }
    let mut seen = HashSet::new();
    let mut file = MatFile::new(Version::Spreadsheet);
    for (column, name) in names {
        if !seen.insert(name) {
            bail!(BAD_TABLE, "column {}: a second column is named `{name}`", letters(*column));
        }
        let value = |row: &BTreeMap<u32, f64>| row.get(column).copied().unwrap_or(f64::NAN);
        file.insert(name.clone(), Matrix::column_vector(rows.values().map(value).collect()));
    }
    Ok(file)
}

fn name(value: &DataRef<'_>, row: u32, column: u32) -> Result<String, Fault> {
    let text = match value {
        DataRef::String(text) => text.trim(),
        DataRef::SharedString(text) => text.trim(),
        _ => bail!(
            BAD_TABLE,
            "cell {}: the first row must hold the names of the columns", place(row, column);
            help: "name the columns in the first row, such as `x` and `y`"
        ),
    };
    if text.is_empty() {
        bail!(BAD_TABLE, "cell {}: the column has no name", place(row, column));
    }
    Ok(text.to_owned())
}

/// The number of a cell; none for blanks.
fn number(value: &DataRef<'_>, row: u32, column: u32) -> Result<Option<f64>, Fault> {
    let text = match value {
        DataRef::Float(value) => return Ok(Some(*value)),
        DataRef::Int(value) => return Ok(Some(*value as f64)),
        DataRef::Bool(value) => return Ok(Some(f64::from(u8::from(*value)))),
        DataRef::DateTime(value) => return Ok(Some(value.as_f64())),
        DataRef::String(text) => text.trim(),
        DataRef::SharedString(text) => text.trim(),
        other => bail!(BAD_TABLE, "cell {}: {other:?} is no number", place(row, column)),
    };
    match text.parse() {
        Ok(value) => Ok(Some(value)),
        Err(_) if text.is_empty() => Ok(None),
        Err(_) => bail!(BAD_TABLE, "cell {}: `{text}` is no number", place(row, column)),
    }
}

/// `B7` for row 6 and column 1, both counted from 0.
fn place(row: u32, column: u32) -> String {
    format!("{}{}", letters(column), u64::from(row) + 1)
}

fn letters(column: u32) -> String {
    let (rest, last) = (column / 26, (column % 26) as u8);
    let front = if rest > 0 { letters(rest - 1) } else { String::new() };
    front + &char::from(b'A' + last).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Put together by hand: sheet `run`, from B2 on: t, V; 0, 1; 1, (empty); the text 2.5, 0.25; and
    /// a second sheet.
    const FILE: &[u8] = include_bytes!("../../tests/data/spreadsheet/table.xlsx");
    /// The same with `high` in C5.
    const TEXT: &[u8] = include_bytes!("../../tests/data/spreadsheet/text.xlsx");

    #[test]
    fn the_first_sheet_is_a_table() {
        let file = read(FILE).unwrap();
        assert_eq!(file.matrix("t").unwrap().values, [0.0, 1.0, 2.5]);
        let voltage = &file.matrix("V").unwrap().values;
        assert_eq!((voltage[0], voltage[2]), (1.0, 0.25));
        assert!(voltage[1].is_nan(), "an empty cell is a missing value");
        assert_eq!(
            crate::mat::read_named("table.XLSX", FILE).unwrap().matrix("t"),
            file.matrix("t")
        );
    }

    #[test]
    fn what_is_wrong_is_named_with_its_cell() {
        assert_eq!(read(TEXT).unwrap_err().message, "cell C5: `high` is no number");
        for end in [0, 4, 100, FILE.len() / 2, FILE.len() - 30] {
            assert!(read(&FILE[..end]).is_err(), "cut at {end}");
        }
        assert_eq!(place(6, 1), "B7");
        assert_eq!(
            ["A", "Z", "AA", "ZZ", "AAA"].map(str::to_owned),
            [0, 25, 26, 701, 702].map(letters)
        );
    }
}
