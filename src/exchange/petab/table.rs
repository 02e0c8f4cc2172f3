//! Tables of PEtab: tab-separated values with a heading.

use crate::Refusal;
use crate::diag::Fault;
use crate::registry::BAD_OPTION;
use std::collections::BTreeMap;
use std::ops::Range;
use std::rc::Rc;

/// A row of a table.
#[derive(Debug, Clone)]
pub(super) struct Row {
    file: Rc<str>,
    place: Range<usize>,
    line: usize,
    columns: Rc<BTreeMap<String, usize>>,
    cells: Vec<String>,
}

/// Columns that may be missing.
const OPTIONAL: &[&str] = &[
    "parameterName",
    "objectivePriorType",
    "objectivePriorParameters",
    "priorDistribution",
    "priorParameters",
    "observableName",
    "observableTransformation",
    "observableParameters",
    "observablePlaceholders",
    "noiseParameters",
    "noisePlaceholders",
    "noiseDistribution",
    "preequilibrationConditionId",
    "experimentId",
    "conditionName",
    "nominalValue",
    "lowerBound",
    "upperBound",
];

/// The rows of a table.
///
/// # Errors
///
/// Required columns that are missing, columns of one name, known names in other letters, and cells without
/// a column.
pub(super) fn rows(file: &str, text: &str, required: &[&str]) -> Result<Vec<Row>, Refusal> {
    let name: Rc<str> = file.into();
    let mut heading: Option<(Rc<BTreeMap<String, usize>>, usize)> = None;
    let (mut rows, mut start) = (Vec::new(), 0);
    for (number, line) in text.split_inclusive('\n').enumerate() {
        let place = start..start + line.trim_end().len();
        start += line.len();
        let line = line.trim_end_matches(['\n', '\r']);
        let line = line.strip_prefix('\u{feff}').unwrap_or(line);
        if line.trim().is_empty() {
            continue;
        }
        let cells: Vec<String> = line.split('\t').map(cell).collect();
        let Some((columns, width)) = &heading else {
            if let Some(twice) = repeated(&cells) {
                let fault = Fault::new(BAD_OPTION, format!("there are two columns `{twice}`"));
                return Err(Refusal::new(place, fault).in_file(file));
            }
            if let Some(missing) =
                required.iter().find(|name| !cells.iter().any(|own| own == *name))
            {
                let fault = Fault::new(BAD_OPTION, format!("there is no column `{missing}`"));
                return Err(Refusal::new(place, fault).in_file(file));
            }
            if let Some((own, known)) = in_other_letters(&cells) {
                let fault = Fault::new(BAD_OPTION, format!("`{own}` is not a column of PEtab"))
                    .help(format!("write `{known}`"));
                return Err(Refusal::new(place, fault).in_file(file));
            }
            let width = cells.iter().rposition(|name| !name.is_empty()).map_or(0, |last| last + 1);
            let columns = cells.into_iter().take(width).enumerate().map(|(k, name)| (name, k));
            heading = Some((Rc::new(columns.collect()), width));
            continue;
        };
        let row =
            Row { file: name.clone(), place, line: number + 1, columns: columns.clone(), cells };
        if let Some(extra) = row.cells.iter().skip(*width).find(|cell| !cell.is_empty()) {
            return Err(row.wrong(format!(
                "the cell `{extra}` has no column: the heading has {width} of them"
            )));
        }
        rows.push(row);
    }
    Ok(rows)
}

/// A column whose name differs from a known one in its letters alone, and that.
fn in_other_letters(names: &[String]) -> Option<(&str, &'static str)> {
    names.iter().find_map(|own| {
        let is_alike = |known: &&&str| own.eq_ignore_ascii_case(known) && *own != ***known;
        Some((own.as_str(), *OPTIONAL.iter().find(is_alike)?))
    })
}

/// Refuses columns that only another version of PEtab has, where they say something.
///
/// # Errors
///
/// The first such cell.
pub(super) fn refuse_columns(rows: &[Row], of_other: &[&str], version: u8) -> Result<(), Refusal> {
    for row in rows {
        if let Some(name) = of_other.iter().find(|name| row.get(name).is_some()) {
            let fault = Fault::new(
                BAD_OPTION,
                format!("version {version} of PEtab has no column `{name}`"),
            )
            .help("remove it, or correct `format_version` in the YAML file");
            return Err(row.refusal(fault));
        }
    }
    Ok(())
}

/// A name that several columns have.
fn repeated(names: &[String]) -> Option<&String> {
    let mut named = names.iter().enumerate().filter(|(_, name)| !name.is_empty());
    named.find(|(at, name)| names[..*at].contains(name)).map(|(_, name)| name)
}

/// The content of a cell, which may be in quotation marks.
fn cell(text: &str) -> String {
    let text = text.trim();
    let inner = text.strip_prefix('"').and_then(|text| text.strip_suffix('"'));
    inner.map_or_else(|| text.to_owned(), |inner| inner.replace("\"\"", "\""))
}

impl Row {
    /// The cell of a column; `None` where it is empty, or the column is not there.
    pub(super) fn get(&self, column: &str) -> Option<&str> {
        let cell = self.cells.get(*self.columns.get(column)?)?.as_str();
        (!["", "nan", "NaN", "NA"].contains(&cell)).then_some(cell)
    }

    pub(super) fn required(&self, column: &str) -> Result<&str, Refusal> {
        self.get(column).ok_or_else(|| self.wrong(format!("`{column}` is empty")))
    }

    pub(super) fn number(&self, column: &str) -> Result<Option<f64>, Refusal> {
        let Some(text) = self.get(column) else { return Ok(None) };
        text.parse()
            .map(Some)
            .map_err(|_| self.wrong(format!("`{column}` is `{text}`, which is not a number")))
    }

    /// The columns with content and their cells.
    pub(super) fn pairs(row: &Row) -> Vec<(String, String)> {
        let own = |(name, cell): (&str, &str)| (name.to_owned(), cell.to_owned());
        row.filled().into_iter().map(own).collect()
    }

    /// A row with these columns in the place of this one.
    pub(super) fn made(&self, pairs: Vec<(String, String)>) -> Row {
        let (names, cells): (Vec<String>, Vec<String>) = pairs.into_iter().unzip();
        let columns = names.into_iter().enumerate().map(|(k, name)| (name, k)).collect();
        Row { columns: Rc::new(columns), cells, ..self.clone() }
    }

    /// The columns with content, in the order of the file.
    pub(super) fn filled(&self) -> Vec<(&str, &str)> {
        let mut all: Vec<(&str, usize)> =
            self.columns.iter().map(|(name, place)| (name.as_str(), *place)).collect();
        all.sort_by_key(|(_, place)| *place);
        all.into_iter().filter_map(|(name, _)| Some((name, self.get(name)?))).collect()
    }

    /// Its line, as `file:line`.
    pub(super) fn number_of_line(&self) -> String {
        format!("{}:{}", self.file, self.line)
    }

    /// A fault in this row.
    pub(super) fn wrong(&self, message: impl Into<String>) -> Refusal {
        self.refusal(Fault::new(BAD_OPTION, message))
    }

    pub(super) fn refusal(&self, fault: Fault) -> Refusal {
        Refusal::new(self.place.clone(), fault).in_file(&self.file)
    }
}
