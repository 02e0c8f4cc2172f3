//! Which rows of a file are what: preamble, head, units, data.
//!
//! The data are the longest run of equally long rows with numbers; the head is the row of names above
//! them. What precedes the header is not read; everything after it must fit.

use super::Places;
use super::moment::moment;
use super::number::{form, missing};
use super::records::{Record, Separator, is_comment, lines, split};
use super::unit::{is_unit, without_brackets};
use crate::bail;
use crate::diag::Fault;
use crate::mat::errors::BAD_TABLE;
use std::borrow::Cow;
use std::ops::Range;

/// Lines looked at from the beginning and from the end to find the separator.
const SAMPLE: usize = 200;
/// Rows with numbers before the head that are another table and not a preamble.
const OTHER_TABLE: usize = 3;

/// The rows of a table by what they are.
pub(crate) struct Layout<'a> {
    pub head: Record<'a>,
    pub units: Option<Record<'a>>,
    pub rows: Vec<Record<'a>>,
    /// What is not read, one sentence each.
    pub warnings: Vec<String>,
}

/// The separator with which the most rows fall into numbers.
pub(crate) fn separator(text: &str) -> Separator {
    let count = lines(text).count();
    let sample = || {
        let near = |(number, _): &(usize, _)| *number < SAMPLE || *number + SAMPLE >= count;
        lines(text).enumerate().filter(near).map(|(_, (_, line))| line)
    };
    let (mut best, mut most) = (None, 0.0);
    for separator in Separator::ALL {
        let score = score(sample(), separator);
        // A little more is chance: lines of a preamble that happen to fit.
        if score > 1.1 * most {
            (best, most) = (Some(separator), score);
        }
    }
    let first = || {
        let used = |separator: &Separator| match separator {
            Separator::Mark(mark) => sample().any(|line| line.contains(*mark)),
            Separator::Blanks => true,
        };
        Separator::ALL.into_iter().find(used).unwrap_or(Separator::Blanks)
    };
    best.unwrap_or_else(first)
}

/// How many rows with numbers are equally long, each counting with its share of numbers; a little
/// more where a row of names is as long.
fn score<'a>(sample: impl Iterator<Item = &'a str>, separator: Separator) -> f64 {
    const MOST_COLUMNS: usize = 4096;
    let mut shares: Vec<(f64, bool)> = Vec::new();
    for line in sample {
        let (cells, _) = split(line, separator);
        if !(2..MOST_COLUMNS).contains(&cells.len()) {
            continue;
        }
        if shares.len() <= cells.len() {
            shares.resize(cells.len() + 1, (0.0, false));
        }
        let filled = cells.iter().filter(|cell| !cell.is_empty()).count().max(1);
        let numbers = cells.iter().filter(|cell| is_value(cell)).count();
        let entry = &mut shares[cells.len()];
        entry.0 += numbers as f64 / filled as f64;
        entry.1 |= has_no_number(&cells);
    }
    let total = |(share, named): (f64, bool)| share + if named && share > 0.0 { 0.5 } else { 0.0 };
    shares.into_iter().map(total).fold(0.0, f64::max)
}

fn is_value(cell: &str) -> bool {
    form(cell).is_some() || moment(cell).is_some()
}

/// Whether a cell or more is text and none is a number.
fn has_no_number(cells: &[Cow<'_, str>]) -> bool {
    let mut text = false;
    for cell in cells {
        if is_value(cell) {
            return false;
        }
        text |= missing(cell).is_none();
    }
    text
}

fn has_value(record: &Record<'_>) -> bool {
    record.cells.iter().any(|cell| is_value(cell))
}

/// Finds out which rows are what; `text` is the comment that may contain the names.
pub(crate) fn layout<'a>(
    mut records: Vec<Record<'a>>,
    source: Option<(&'a str, Separator)>,
    places: Places,
) -> Result<Layout<'a>, Fault> {
    let mut warnings = Vec::new();
    let block = block(&records);
    let found = head_above(&records, &block).or_else(|| head_in(&records, &block));
    let (head, data) = match found {
        Some(head) => (records[head].clone(), head + 1),
        None => {
            let Some(head) = source.and_then(|source| commented_head(source, &records, &block))
            else {
                let first = records.get(block.start).or(records.first());
                let place = places.of(first.map_or(1, |record| record.line), 0);
                bail!(
                    BAD_TABLE,
                    "{place}: the first line contains numbers instead of column names";
                    help: "write the column names in the first line, such as `x,y`"
                );
            };
            let line = head.line;
            warnings.push(format!(
                "the column names are taken from the comment in {}",
                places.row(line)
            ));
            (head, block.start)
        }
    };
    refuse_other_table(&records[..data.saturating_sub(1)], places)?;
    if data > 1 && found.is_some() {
        let last = records[data - 2].line;
        warnings.push(match places {
            Places::Lines { .. } if last == 1 => {
                "line 1 precedes the header and is ignored".to_owned()
            }
            Places::Lines { .. } => {
                format!("lines 1 to {last} precede the header and are ignored")
            }
            Places::Cells => format!("rows above row {} are ignored", head.line),
        });
    }
    let mut rows = records.split_off(data);
    let units = units_row(&mut rows, &head, places, &mut warnings);
    let separator = source.map(|(_, separator)| separator);
    let rows = checked(rows, &head, (units.as_ref(), separator), places, &mut warnings)?;
    if rows.is_empty() {
        let place = places.row(head.line);
        bail!(
            BAD_TABLE, "there are no rows below the header in {place}";
            help: "export the measurement again, including its data"
        );
    }
    Ok(Layout { head, units, rows, warnings })
}

/// The longest run of equally long rows with numbers; the first of several.
fn block(records: &[Record<'_>]) -> Range<usize> {
    let (mut best, mut run) = (0..0, 0..0);
    for (at, record) in records.iter().enumerate() {
        if !has_value(record) {
            run = at + 1..at + 1;
            continue;
        }
        let same = run.end > run.start && records[run.start].cells.len() == record.cells.len();
        run = if same { run.start..at + 1 } else { at..at + 1 };
        if run.len() > best.len() {
            best = run.clone();
        }
    }
    best
}

/// The row of names above the block, the row of units skipped.
fn head_above(records: &[Record<'_>], block: &Range<usize>) -> Option<usize> {
    if block.is_empty() {
        return (!records.is_empty()).then_some(0);
    }
    let first = &records[block.start];
    let names_all = |head: &Record<'_>| {
        let named = |column: usize| head.cells.get(column).is_some_and(|name| !name.is_empty());
        let needs = |(column, cell): (usize, &Cow<'_, str>)| {
            column == 0 || cell.is_empty() || named(column)
        };
        first.cells.iter().enumerate().all(needs)
    };
    let above = || (0..block.start).rev().filter(|&at| has_no_number(&records[at].cells));
    let nearest = above().find(|&at| names_all(&records[at])).or_else(|| above().next())?;
    let nearest = fuller_head(records, nearest, block.start).unwrap_or(nearest);
    // The same header precedes an earlier part where a file was continued.
    let nearest =
        records.iter().position(|record| record.cells == records[nearest].cells).unwrap_or(nearest);
    let Some(before) = nearest.checked_sub(1) else { return Some(nearest) };
    let (names, units) = (&records[before], &records[nearest]);
    let adjacent = names.line + 1 == units.line && has_no_number(&names.cells) && names_all(names);
    let is_units = adjacent && is_units_row(units, names, Some(first));
    Some(if is_units { before } else { nearest })
}

/// Above a row of names that leaves columns without one, such as channels below signals, a row directly
/// before it that names more, and the first column as well.
fn fuller_head(records: &[Record<'_>], nearest: usize, data: usize) -> Option<usize> {
    /// Rows of a head at most.
    const MOST: usize = 4;
    let named = |at: usize| records[at].cells.iter().filter(|cell| !cell.is_empty()).count();
    let has_first = |at: usize| records[at].cells.first().is_some_and(|cell| !cell.is_empty());
    if has_first(nearest) || nearest + 1 != data {
        return None;
    }
    let head = (nearest.saturating_sub(MOST - 1)..nearest).rev();
    let mut together = head.take_while(|&at| {
        records[at].line + 1 == records[at + 1].line && has_no_number(&records[at].cells)
    });
    let width = |at: usize| records[at].width() >= records[nearest].width();
    together.find(|&at| has_first(at) && named(at) > named(nearest) && width(at))
}

/// A head with numbers among its names, such as `time,300,350`: the first row, if it has a text where
/// the next has a number.
fn head_in(records: &[Record<'_>], block: &Range<usize>) -> Option<usize> {
    let (first, second) = (records.get(block.start)?, records.get(block.start + 1)?);
    let is_name = |(cell, below): (&Cow<'_, str>, &Cow<'_, str>)| {
        let text = !is_value(cell) && missing(cell).is_none();
        text && cell.starts_with(|c: char| c.is_alphabetic()) && is_value(below)
    };
    let named = first.cells.iter().zip(&second.cells).any(is_name);
    (block.start == 0 && named && first.cells.len() == second.cells.len()).then_some(block.start)
}

/// The names in the comment directly above the data, as some programs write them.
fn commented_head<'a>(
    (text, separator): (&'a str, Separator),
    records: &[Record<'a>],
    block: &Range<usize>,
) -> Option<Record<'a>> {
    let first = records.get(block.start).filter(|_| block.start == 0)?;
    let above = text.split('\n').enumerate().take(first.line - 1);
    let (number, line) = above.filter(|(_, line)| is_comment(line)).last()?;
    let (mut cells, _) =
        split(line.trim_start().trim_start_matches(['#', '%', '/', ' ']), separator);
    while cells.last().is_some_and(|cell| cell.is_empty()) {
        cells.pop();
    }
    let fits = cells.len() == first.cells.len() && has_no_number(&cells);
    fits.then_some(Record { line: number + 1, cells })
}

/// A second table above the one that was found would be left out.
fn refuse_other_table(skipped: &[Record<'_>], places: Places) -> Result<(), Fault> {
    let other = block(skipped);
    let named = head_above(skipped, &other).filter(|_| other.len() >= OTHER_TABLE);
    let Some(named) = named else { return Ok(()) };
    bail!(
        BAD_TABLE,
        "the file contains several tables; the first one starts in \
         {}", places.row(skipped[named].line);
        help: "write each table to a separate file"
    )
}

/// Takes the row of units from the rows below the head, and what else stands above the data.
fn units_row<'a>(
    rows: &mut Vec<Record<'a>>,
    head: &Record<'a>,
    places: Places,
    warnings: &mut Vec<String>,
) -> Option<Record<'a>> {
    let first_data = rows.iter().position(has_value);
    let below = first_data.and_then(|at| rows.get(at)).cloned();
    let has_units = rows.first().is_some_and(|first| is_units_row(first, head, below.as_ref()));
    let units = has_units.then(|| rows.remove(0));
    let between = rows.iter().take_while(|row| has_no_number(&row.cells)).count();
    for row in rows.drain(..between) {
        warnings.push(format!("{} between header and data is ignored", places.row(row.line)));
    }
    units
}

/// Whether the row below the head holds units: at least half of its cells are known ones, and none
/// is a number but 1.
fn is_units_row(row: &Record<'_>, head: &Record<'_>, below: Option<&Record<'_>>) -> bool {
    let (mut filled, mut known, mut words) = (0, 0, 0);
    for (column, cell) in row.cells.iter().enumerate().filter(|(_, cell)| !cell.is_empty()) {
        if is_value(cell) && **cell != *"1" {
            return false;
        }
        let below = below.and_then(|below| below.cells.get(column));
        let above_number = below.is_some_and(|below| is_value(below) || missing(below).is_some());
        filled += 1;
        known += usize::from(is_unit(cell));
        words +=
            usize::from(is_unit(cell) && above_number && missing(cell).is_none() && **cell != *"1");
    }
    row.width() <= head.width() && words > 0 && 2 * known >= filled
}

/// The rows of data: none shorter or longer than the head; heads that are repeated and rows without
/// any content are left out.
fn checked<'a>(
    rows: Vec<Record<'a>>,
    head: &Record<'a>,
    (units, separator): (Option<&Record<'a>>, Option<Separator>),
    places: Places,
    warnings: &mut Vec<String>,
) -> Result<Vec<Record<'a>>, Fault> {
    let expected = head.width();
    let mut kept = Vec::with_capacity(rows.len());
    for row in rows {
        let repeated = row.cells[..row.width()] == head.cells[..expected];
        if repeated || units.is_some_and(|units| units.cells == row.cells) {
            warnings.push(format!("{} repeats the header and is skipped", places.row(row.line)));
            continue;
        }
        let width = row.width();
        if width == 0 {
            continue;
        }
        let found = if width > expected { width } else { row.cells.len().min(expected) };
        if found != expected {
            let place = places.of(row.line, found.min(expected));
            // A blank before a unit separates cells where nothing else separates them alike in all rows.
            let how = match separator {
                Some(Separator::Blanks) => ", separated by blanks,",
                _ => "",
            };
            bail!(
                BAD_TABLE, "{place}: {found} cells{how} where the header has {expected}";
                help: "give every row one cell per column; put text that contains a separator in \
                       double quotes, and remarks after a `#`"
            );
        }
        kept.push(row);
    }
    Ok(kept)
}

/// The name of a column of the head, without a comma that precedes blanks.
pub(crate) fn name(cell: &str) -> &str {
    without_brackets(cell.trim().trim_end_matches([',', ';']).trim())
}
