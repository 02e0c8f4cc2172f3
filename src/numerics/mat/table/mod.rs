//! Tables as instruments and laboratories write them: each column becomes a matrix with one column.
//!
//! Separators are semicolons, tabs, commas or blanks; numbers have decimal points or commas; a row of
//! units may follow the names; empty cells and words such as `n/a` are missing values, NaN; dates and
//! times of day become seconds; lines with `#`, `%` or `//` are comments, and what an instrument
//! writes before the head is passed over. A column that cannot be read is a fault only when it is
//! requested. Nothing is guessed: what may be read in two ways is refused.

mod column;
mod decode;
mod instruments;
mod layout;
mod moment;
mod number;
mod records;
mod unit;

pub(super) use decode::decode;
pub(super) use moment::{duration, iso};

use super::errors::BAD_TABLE;
use super::matrix::{About, MatFile, Matrix, Version};
use super::words::Words;
use crate::diag::Fault;
use crate::{bail, fault};
use column::{Cells, Content, Parsed};
use layout::Layout;
use moment::{Moment, MomentKind};
use records::{Record, Separator};
use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

/// How places in a table are named.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Places {
    /// `line 3, column 2`; the flag says whether commas separate cells.
    Lines { commas: bool },
    /// `cell B3`.
    Cells,
}

impl Places {
    /// The cell in column `column`, counted from 0.
    fn of(self, line: usize, column: usize) -> String {
        match self {
            Places::Lines { .. } => format!("line {line}, column {}", column + 1),
            Places::Cells => format!("cell {}", cell_name(line, column)),
        }
    }

    fn row(self, line: usize) -> String {
        match self {
            Places::Lines { .. } => format!("line {line}"),
            Places::Cells => format!("row {line}"),
        }
    }

    /// Whether a comma in a number can only be a decimal one unless it groups thousands.
    fn comma_is_free(self) -> bool {
        self != Places::Lines { commas: true }
    }
}

/// Reads a table of text; `strict` where empty cells are faults.
///
/// # Errors
///
/// `bad-table`: no table, no names, rows that are shorter or longer than the head. Faults name line
/// and column.
pub(crate) fn read_text(bytes: &[u8], strict: bool) -> Result<MatFile, Fault> {
    let text = instruments::table_of(decode::lines_of(bytes)?);
    let separator = layout::separator(&text);
    let records = records::records(&text, separator);
    let places = Places::Lines { commas: separator == Separator::Mark(',') };
    let layout = layout::layout(records, Some((&text, separator)), places)?;
    Ok(file(&layout, places, Version::Csv, strict))
}

/// Reads the rows of a spreadsheet: number of the row counted from 1, and its cells as text.
///
/// # Errors
///
/// As [`read_text`]; faults name the cell.
pub(crate) fn read_rows(rows: Vec<(usize, Vec<String>)>) -> Result<MatFile, Fault> {
    let record = |(line, cells): (usize, Vec<String>)| Record {
        line,
        cells: cells.into_iter().map(Cow::Owned).collect(),
    };
    let records = rows.into_iter().map(record).filter(|record| record.width() > 0).collect();
    let layout = layout::layout(records, None, Places::Cells)?;
    Ok(file(&layout, Places::Cells, Version::Spreadsheet, false))
}

/// `B7` for line 7 and column 1 counted from 0.
fn cell_name(line: usize, column: usize) -> String {
    format!("{}{line}", letters(column))
}

fn letters(column: usize) -> String {
    let (rest, last) = (column / 26, (column % 26) as u8);
    let front = if rest > 0 { letters(rest - 1) } else { String::new() };
    front + &char::from(b'A' + last).to_string()
}

/// A column of the head.
struct Heading<'a> {
    column: usize,
    /// As written.
    name: &'a str,
    /// Without the unit.
    bare: Option<&'a str>,
    unit: Option<String>,
    /// What is there instead of one that is known.
    unknown_unit: Option<String>,
}

fn headings<'a>(layout: &'a Layout<'_>) -> Vec<Heading<'a>> {
    let units = layout.units.as_ref().map_or(&[][..], |units| &units.cells[..]);
    let heading = |(column, cell): (usize, &'a Cow<'_, str>)| {
        let name = layout::name(cell);
        let (bare, unit) = unit::split(name);
        let cell = units.get(column).map(|cell| &**cell);
        let unit = cell.and_then(unit::of_cell).or(unit);
        let unknown_unit = unit::unknown(name, cell).filter(|_| unit.is_none());
        Heading { column, name, bare, unit, unknown_unit }
    };
    layout.head.cells.iter().enumerate().map(heading).collect()
}

fn file(layout: &Layout<'_>, places: Places, version: Version, strict: bool) -> MatFile {
    let mut file = MatFile::new(version);
    file.warnings.clone_from(&layout.warnings);
    let lines: Arc<[usize]> = layout.rows.iter().map(|row| row.line).collect();
    let headings = headings(layout);
    let usual = column::usual_mark(&layout.rows, layout.head.width());
    let parsed: Vec<Option<Result<Parsed, Fault>>> = headings
        .iter()
        .map(|heading| {
            (!heading.name.is_empty()).then(|| cells(layout, heading, places, strict).parse(usual))
        })
        .collect();
    let dates = only_dates(&headings, &parsed);
    let dates = dates.map(|(own, dates)| (cells(layout, own, places, strict), dates));
    let mut named: HashMap<&str, Vec<usize>> = HashMap::new();
    for heading in &headings {
        named.entry(heading.name).or_default().push(heading.column);
    }
    for (heading, parsed) in headings.iter().zip(&parsed) {
        let Some(parsed) = parsed else {
            if !cells(layout, heading, places, strict).is_empty() {
                file.warnings
                    .push(format!("column {} has no name and is ignored", heading.column + 1));
            }
            continue;
        };
        let name = heading.name.to_owned();
        if let Some([first, second, ..]) = named.get(heading.name).map(Vec::as_slice) {
            let (first, second) = (*first, *second);
            file.fail(name, two_columns(heading.name, layout.head.line, [first, second], places));
            continue;
        }
        if let Some(cells) = cells(layout, heading, places, strict).words(parsed.is_err()) {
            file.words.insert(name.clone(), Words { cells, lines: lines.clone() });
        }
        let mut about = About {
            unit: heading.unit.clone(),
            unknown_unit: heading.unknown_unit.clone(),
            lines: lines.clone(),
            ..About::default()
        };
        match numbers(cells(layout, heading, places, strict), parsed, dates, &mut about) {
            Ok(values) => file.insert_column(name, Matrix::column_vector(values), about),
            Err(fault) => file.fail(name, fault),
        }
    }
    for heading in &headings {
        if let Some(bare) = heading.bare {
            file.alias(bare, heading.name);
        }
    }
    file
}

fn cells<'r, 'a>(
    layout: &'r Layout<'a>,
    heading: &'r Heading<'r>,
    places: Places,
    strict: bool,
) -> Cells<'r, 'a> {
    Cells { rows: &layout.rows, column: heading.column, name: heading.name, places, strict }
}

fn two_columns(name: &str, line: usize, columns: [usize; 2], places: Places) -> Fault {
    let [first, second] = columns.map(|column| match places {
        Places::Lines { .. } => (column + 1).to_string(),
        Places::Cells => cell_name(line, column),
    });
    let what = if places == Places::Cells { "cells" } else { "columns" };
    fault!(BAD_TABLE, "two columns are named `{name}`: {what} {first} and {second}")
        .help("give each column a unique name")
}

/// The only column with dates and without times of day.
fn only_dates<'p, 'h>(
    headings: &'p [Heading<'h>],
    parsed: &'p [Option<Result<Parsed, Fault>>],
) -> Option<(&'p Heading<'h>, &'p [Option<Moment>])> {
    let dates = headings.iter().zip(parsed).filter_map(|(heading, parsed)| match parsed {
        Some(Ok(Parsed { content: Content::Moments(moments), .. })) => {
            let kind = moments.iter().flatten().next()?.kind();
            (kind == MomentKind::Date).then_some((heading, moments.as_slice()))
        }
        _ => None,
    });
    let found: Vec<_> = dates.collect();
    if let [only] = found[..] { Some(only) } else { None }
}

/// The numbers of a column; moments become seconds.
fn numbers(
    own: Cells<'_, '_>,
    parsed: &Result<Parsed, Fault>,
    dates: Option<(Cells<'_, '_>, &[Option<Moment>])>,
    about: &mut About,
) -> Result<Vec<f64>, Fault> {
    let parsed = parsed.as_ref().map_err(Clone::clone)?;
    about.notes.clone_from(&parsed.notes);
    match &parsed.content {
        Content::Numbers(values) => Ok(values.clone()),
        Content::Moments(moments) => {
            let kind = moments.iter().flatten().next().map(|moment| moment.kind());
            let dates = dates.filter(|_| kind == Some(MomentKind::Clock));
            let (values, note) = column::in_seconds(own, moments, dates)?;
            about.notes.push(note);
            about.unit = Some("s".to_owned());
            Ok(values)
        }
    }
}

/// Reads a table of numbers of which every column is needed: columns that cannot be read, have no
/// name or the same one, and empty cells are faults. `NaN` and `inf` are numbers here.
///
/// ```
/// let table = gapilib_numerics::mat::read_csv(b"i,V\n0.1,0.95\n0.2,0.91\n")?;
/// assert_eq!(table.matrix("V")?.values, [0.95, 0.91]);
/// # Ok::<(), gapilib_base::diag::Fault>(())
/// ```
///
/// # Errors
///
/// `bad-table`; faults name line and column.
pub fn read_csv(bytes: &[u8]) -> Result<MatFile, Fault> {
    let file = read_text(bytes, true)?;
    if let Some((_, fault)) = file.unreadable().next() {
        return Err(fault.clone());
    }
    if let Some(warning) = file.warnings.first() {
        bail!(BAD_TABLE, "{warning}"; help: "write a table that contains only a header and \
            numbers");
    }
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_named_as_in_spreadsheets() {
        assert_eq!(cell_name(7, 1), "B7");
        assert_eq!([0, 25, 26, 701, 702].map(letters), ["A", "Z", "AA", "ZZ", "AAA"]);
    }

    #[test]
    fn the_fullest_row_above_the_data_names_the_columns() {
        let text = "Protocol,,,2024-05-01\n\nZeit,Signal,Remark,Valve\ns,mV,,\n,Channel 1,,Digital\n\
                    0,1.5,ok,TRUE\n1,2.5,,FALSE\n";
        let file = read_text(text.as_bytes(), false).unwrap();
        let column = |name: &str| file.column(name).unwrap();
        assert_eq!(column("Zeit").values, [0.0, 1.0]);
        assert_eq!(column("Zeit").about.unit.as_deref(), Some("s"));
        assert_eq!(column("Signal").values, [1.5, 2.5]);
        assert_eq!(column("Signal").about.unit.as_deref(), Some("mV"));
        assert_eq!(column("Valve").values, [1.0, 0.0]);
        assert!(file.warnings.iter().any(|w| w.contains("line 5 between header and data")));
        // An index without a name above it is not a remark.
        let file = read_text(b",time,y\n0,0.0,1\n1,0.5,2\n", false).unwrap();
        assert_eq!(file.column("time").unwrap().values, [0.0, 0.5]);
    }

    #[test]
    fn words_of_switches_are_one_and_zero() {
        let read = |text: &str| read_text(text.as_bytes(), false).unwrap();
        let file = read("t,a,b\n0,True,off\n1,,1\n2,False,ON\n");
        let a = file.column("a").unwrap();
        assert!(a.values[0] == 1.0 && a.values[1].is_nan() && a.values[2] == 0.0);
        assert_eq!(a.about.notes, ["`a` contains truth values: `True` as 1 and `False` as 0"]);
        assert_eq!(file.column("b").unwrap().values, [0.0, 1.0, 1.0]);
        let wrong = read("t,a\n0,TRUE\n1,maybe\n").column("a").unwrap_err();
        assert!(wrong.message.contains("line 3") && wrong.message.contains("truth value"));
        let late = read("t,a\n0,1\n1,TRUE\n").column("a").unwrap_err();
        assert!(late.helps[0].contains("1 for true and 0 for false"), "{:?}", late.helps);
    }
}
