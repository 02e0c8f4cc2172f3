//! Spreadsheets (XLSX): the first sheet as a table, read as tables of text are.

use super::archive;
use super::errors::BAD_TABLE;
use super::matrix::MatFile;
use super::references;
use super::table;
use super::v5::MAX_INFLATED;
use crate::diag::Fault;
use crate::{bail, fault};
use calamine::{DataRef, ExcelDateTime, Reader, Xlsx};
use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;

/// Cells that a sheet may have.
const MOST_CELLS: usize = 10_000_000;
/// Days from the zero of the dates of spreadsheets to 1970-01-01.
const DAYS_TO_1970: f64 = 25_569.0;

/// Reads the first sheet. Empty cells are missing values, NaN; formulas without a stored value are
/// faults of their column.
///
/// # Errors
///
/// `bad-table`; faults name the cell.
pub(crate) fn read(bytes: &[u8]) -> Result<MatFile, Fault> {
    let unreadable = |error: &dyn std::fmt::Display| {
        fault!(BAD_TABLE, "the spreadsheet cannot be read: {error}")
            .help("save it as .xlsx or .csv")
    };
    check_archive(bytes)?;
    let mut workbook = Xlsx::new(Cursor::new(bytes)).map_err(|error| unreadable(&error))?;
    let sheets = workbook.sheet_names();
    let Some(sheet) = sheets.first() else {
        bail!(BAD_TABLE, "the spreadsheet has no sheet");
    };
    let mut rows: BTreeMap<u32, BTreeMap<u32, String>> = BTreeMap::new();
    let (mut count, mut string_bytes) = (0, 0);
    let mut cells = workbook.worksheet_cells_reader(sheet).map_err(|error| unreadable(&error))?;
    while let Some(cell) = cells.next_cell().map_err(|error| unreadable(&error))? {
        count += 1;
        if count > MOST_CELLS {
            bail!(BAD_TABLE, "the sheet `{sheet}` has more than {MOST_CELLS} cells");
        }
        let (row, column) = cell.get_position();
        let text = text(cell.get_value());
        // Any number of cells may share one text.
        string_bytes += text.len();
        if string_bytes as u64 > MAX_INFLATED {
            bail!(
                BAD_TABLE,
                "the cells of the sheet `{sheet}` contain more than {} MiB",
                MAX_INFLATED >> 20;
                help: "save it as .csv"
            );
        }
        if !text.is_empty() {
            rows.entry(row).or_default().insert(column, text);
        }
    }
    for (row, column) in formulas(bytes, sheet) {
        rows.entry(row).or_default().entry(column).or_insert_with(|| "=".to_owned());
    }
    if rows.is_empty() {
        bail!(BAD_TABLE, "the sheet `{sheet}` is empty"; help: "move the table to the first sheet");
    }
    let mut file = table::read_rows(filled(rows, sheet)?)?;
    if let [_, others @ ..] = &sheets[..]
        && !others.is_empty()
    {
        file.warnings
            .push(format!("only the first sheet `{sheet}` is read, not {}", others.join(", ")));
    }
    Ok(file)
}

/// A fault if the archive holds more than can be read, or cells that no sheet has.
fn check_archive(bytes: &[u8]) -> Result<(), Fault> {
    if archive::inflated(bytes, MAX_INFLATED).is_none() {
        bail!(
            BAD_TABLE,
            "the compressed data of the spreadsheet inflate to more than {} MiB",
            MAX_INFLATED >> 20;
            help: "save it as .csv"
        );
    }
    if let Some(reference) = references::impossible(bytes) {
        bail!(
            BAD_TABLE,
            "the spreadsheet has a cell reference that begins with `{reference}`, outside of every sheet";
            help: "columns end at XFD, rows at 1048576: save it again as .xlsx or .csv"
        );
    }
    Ok(())
}

/// The places of all formulas; none where they cannot be read.
fn formulas(bytes: &[u8], sheet: &str) -> BTreeSet<(u32, u32)> {
    let mut places = BTreeSet::new();
    let Ok(mut workbook) = Xlsx::new(Cursor::new(bytes)) else { return places };
    let Ok(mut cells) = workbook.worksheet_cells_reader(sheet) else { return places };
    while let Ok(Some(formula)) = cells.next_formula() {
        if !formula.get_value().is_empty() && places.len() < MOST_CELLS {
            places.insert(formula.get_position());
        }
    }
    places
}

/// Rows with all their cells, empty ones between them.
fn filled(
    rows: BTreeMap<u32, BTreeMap<u32, String>>,
    sheet: &str,
) -> Result<Vec<(usize, Vec<String>)>, Fault> {
    let width = rows
        .values()
        .filter_map(|row| row.keys().next_back())
        .max()
        .map_or(0, |last| last.saturating_add(1));
    if rows.len().saturating_mul(width as usize) > MOST_CELLS {
        bail!(BAD_TABLE, "the sheet `{sheet}` has more than {MOST_CELLS} cells");
    }
    let fill = |(row, mut cells): (u32, BTreeMap<u32, String>)| {
        let all = (0..width).map(|column| cells.remove(&column).unwrap_or_default());
        (row as usize + 1, all.collect())
    };
    Ok(rows.into_iter().map(fill).collect())
}

/// The content of a cell as a table of text would have it. The exponent of numbers leaves no doubt
/// about their decimal mark.
fn text(value: &DataRef<'_>) -> String {
    match value {
        DataRef::Empty => String::new(),
        DataRef::Float(value) => format!("{value:e}"),
        DataRef::Int(value) => value.to_string(),
        DataRef::Bool(value) => u8::from(*value).to_string(),
        DataRef::String(text) => text.trim().to_owned(),
        DataRef::SharedString(text) => text.trim().to_owned(),
        DataRef::DateTime(moment) => moment_text(moment),
        DataRef::DateTimeIso(text) | DataRef::DurationIso(text) => text.clone(),
        DataRef::Error(error) => error.to_string(),
    }
}

/// Durations and times of day are below one day or said to be so.
fn moment_text(moment: &ExcelDateTime) -> String {
    let days = moment.as_f64();
    if !days.is_finite() || days.abs() > 1e7 {
        return format!("{days:e}");
    }
    if days >= 0.0 && (moment.is_duration() || days < 1.0) {
        return table::duration(days);
    }
    table::iso(days - DAYS_TO_1970)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Put together by hand: sheet `run`, from B2 on: t, V; 0, 1; 1, (empty); the text 2.5, 0.25; and
    /// a second sheet.
    const FILE: &[u8] = include_bytes!("../../../tests/data/spreadsheet/table.xlsx");
    /// The same with `high` in C5.
    const TEXT: &[u8] = include_bytes!("../../../tests/data/spreadsheet/text.xlsx");

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
        let fault = read(TEXT).unwrap().matrix("V").unwrap_err();
        assert_eq!(fault.message, "cell C5: `high` in `V` is not a number");
        for end in [0, 4, 100, FILE.len() / 2, FILE.len() - 30] {
            assert!(read(&FILE[..end]).is_err(), "cut at {end}");
        }
    }
}
