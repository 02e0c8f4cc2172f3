//! From the cells of a column to numbers.

use super::Places;
use super::moment::{Moment, MomentKind, moment, seconds};
use super::number::{Form, Missing, form, missing, value};
use super::records::Record;
use crate::diag::Fault;
use crate::fault;
use crate::mat::errors::BAD_TABLE;

/// What a column holds.
pub(crate) enum Content {
    /// Numbers; NaN where there is none.
    Numbers(Vec<f64>),
    /// Dates and times of day.
    Moments(Vec<Option<Moment>>),
}

/// A column as it was read, and what is to be said of it.
pub(crate) struct Parsed {
    pub content: Content,
    pub notes: Vec<String>,
}

/// Where the cells of a column are.
#[derive(Clone, Copy)]
pub(crate) struct Cells<'r, 'a> {
    pub rows: &'r [Record<'a>],
    pub column: usize,
    pub name: &'r str,
    pub places: Places,
    /// Empty cells are faults.
    pub strict: bool,
}

impl<'r> Cells<'r, '_> {
    /// Lines and cells.
    fn all(self) -> impl Iterator<Item = (usize, &'r str)> {
        self.rows
            .iter()
            .map(move |row| (row.line, row.cells.get(self.column).map_or("", |cell| cell.as_ref())))
    }

    fn place(self, line: usize) -> String {
        self.places.of(line, self.column)
    }

    fn not_a_number(self, line: usize, cell: &str) -> Fault {
        let (place, name) = (self.place(line), self.name);
        if cell.starts_with('=') {
            return fault!(BAD_TABLE, "{place}: the formula in `{name}` has no stored value")
                .help("open the file in a spreadsheet program, calculate and save it");
        }
        let is_truth = truth(cell).is_some();
        let cell: String = cell.chars().take(40).collect();
        let fault = fault!(BAD_TABLE, "{place}: `{cell}` in `{name}` is not a number");
        if is_truth {
            return fault.help("write 1 for true and 0 for false");
        }
        fault.help("correct the cell, or leave it empty if the value is missing")
    }

    /// A cell by its row, with its place.
    pub(crate) fn cell(self, row: usize) -> String {
        let (line, cell) = self.all().nth(row).unwrap_or_default();
        format!("{}: `{}` in `{}`", self.place(line), short(cell), self.name)
    }

    /// Whether all cells are empty.
    pub(crate) fn is_empty(self) -> bool {
        self.all().all(|(_, cell)| cell.is_empty())
    }

    /// The cells where some are words: those of a column that `is_unreadable`, or of truth values.
    pub(crate) fn words(self, is_unreadable: bool) -> Option<Vec<Option<String>>> {
        let mut present = self.all().map(|(_, cell)| cell).filter(|cell| missing(cell).is_none());
        let is_truth = present.next().is_some_and(|cell| truth(cell).is_some());
        let known = |cell: &str| missing(cell).is_none().then(|| cell.to_owned());
        (is_unreadable || is_truth).then(|| self.all().map(|(_, cell)| known(cell)).collect())
    }

    /// The column as numbers or moments; `usual` is the decimal mark of the file.
    pub(crate) fn parse(self, usual: Option<char>) -> Result<Parsed, Fault> {
        let first = self.all().find(|(_, cell)| missing(cell).is_none());
        match first {
            Some((_, cell)) if form(cell).is_none() && moment(cell).is_some() => self.moments(),
            Some((_, cell)) if truth(cell).is_some() => self.truths(),
            _ => self.numbers(usual),
        }
    }

    /// A column of truth values: 1 and 0.
    fn truths(self) -> Result<Parsed, Fault> {
        let mut values = Vec::with_capacity(self.rows.len());
        let mut words: Vec<&str> = Vec::new();
        for (line, cell) in self.all() {
            let read = match cell {
                "0" => Some(0.0),
                "1" => Some(1.0),
                _ if missing(cell).is_some() => Some(f64::NAN),
                _ => {
                    if !words.contains(&cell) {
                        words.push(cell);
                    }
                    truth(cell).map(f64::from)
                }
            };
            let wrong = || {
                let (place, name) = (self.place(line), self.name);
                fault!(BAD_TABLE, "{place}: `{}` in `{name}` is not a truth value as in the cells above", short(cell))
                    .help("write 1 for true and 0 for false, or leave the cell empty if the value is missing")
            };
            values.push(read.ok_or_else(wrong)?);
        }
        words.sort_by_key(|word| truth(word) != Some(true));
        let meanings: Vec<String> = words
            .iter()
            .map(|word| format!("`{word}` as {}", u8::from(truth(word) == Some(true))))
            .collect();
        let note = format!("`{}` contains truth values: {}", self.name, meanings.join(" and "));
        Ok(Parsed { content: Content::Numbers(values), notes: vec![note] })
    }

    fn moments(self) -> Result<Parsed, Fault> {
        let mut moments = Vec::with_capacity(self.rows.len());
        let mut kind: Option<MomentKind> = None;
        for (line, cell) in self.all() {
            if missing(cell).is_some() {
                moments.push(None);
                continue;
            }
            let found = moment(cell).filter(|m| *kind.get_or_insert(m.kind()) == m.kind());
            let Some(found) = found else {
                let (place, name) = (self.place(line), self.name);
                return Err(fault!(
                    BAD_TABLE,
                    "{place}: `{}` in `{name}` is not in the time format of the cells above",
                    short(cell)
                ));
            };
            moments.push(Some(found));
        }
        Ok(Parsed { content: Content::Moments(moments), notes: Vec::new() })
    }

    fn numbers(self, usual: Option<char>) -> Result<Parsed, Fault> {
        let decimal = self.decimal(usual)?;
        let mut values = Vec::with_capacity(self.rows.len());
        let (mut notes, mut words, mut grouped) = (Vec::new(), Vec::new(), None);
        notes.extend(self.marks_of_thousands(usual));
        for (line, cell) in self.all() {
            match missing(cell) {
                Some(_) if self.strict && cell.is_empty() => {
                    let (place, name) = (self.place(line), self.name);
                    return Err(fault!(BAD_TABLE, "{place}: `{name}` has an empty cell"));
                }
                Some(reason) => {
                    if reason == Missing::Reason {
                        words.push((line, cell));
                    }
                    values.push(f64::NAN);
                    continue;
                }
                None => {
                    let found = form(cell);
                    if let Some(Form::Grouped { group, .. }) = found {
                        grouped.get_or_insert((group, line));
                    }
                    let read = match found {
                        Some(_) => value(cell, decimal),
                        // `inf`; no other word is a number.
                        None => cell.parse().ok().filter(|value: &f64| value.is_infinite()),
                    };
                    values.push(read.ok_or_else(|| self.not_a_number(line, cell))?);
                }
            }
        }
        if let Some((line, word)) = words.first() {
            let more = if words.len() > 1 {
                format!(", and {} more like it", words.len() - 1)
            } else {
                String::new()
            };
            notes.push(format!(
                "`{word}` in `{}`, {}{more}, is read as missing",
                self.name,
                self.place(*line)
            ));
        }
        if let Some((group, line)) = grouped.filter(|(group, _)| matches!(group, '.' | ',')) {
            notes.push(format!(
                "in `{}` the character `{group}` is read as thousands separator, as in {}",
                self.name,
                self.place(line)
            ));
        }
        Ok(Parsed { content: Content::Numbers(values), notes })
    }

    /// The decimal mark of the column, from cells that leave no doubt; what contradicts it or
    /// cannot be decided is a fault.
    fn decimal(self, usual: Option<char>) -> Result<char, Fault> {
        let mut certain: Option<(char, usize, &str)> = None;
        let mut doubtful: [Option<(usize, &str)>; 2] = [None; 2];
        for (line, cell) in self.all() {
            let Some(form) = form(cell) else { continue };
            if let Form::Ambiguous(mark) = form {
                doubtful[usize::from(mark == ',')].get_or_insert((line, cell));
            }
            let Some(mark) = form.decimal() else { continue };
            match certain {
                Some((known, at, evidence)) if known != mark => {
                    return Err(fault!(
                        BAD_TABLE,
                        "{}: `{cell}` in `{}` has a different decimal separator from \
                         `{evidence}` in {}",
                        self.place(line),
                        self.name,
                        self.places.row(at)
                    )
                    .help("write all numbers with the same decimal separator"));
                }
                _ => _ = certain.get_or_insert((mark, line, cell)),
            }
        }
        let known = certain.map(|(mark, ..)| mark).or(usual);
        let alone = || match doubtful {
            [Some(_), None] => Some('.'),
            [None, Some(_)] if self.places.comma_is_free() => Some(','),
            [None, None] => Some('.'),
            _ => None,
        };
        let decimal = known.or_else(alone);
        let doubt = match decimal {
            Some('.') => doubtful[1],
            Some(_) => doubtful[0],
            None => doubtful[1].or(doubtful[0]),
        };
        if known.is_none()
            && let [_, Some((line, cell))] = doubtful
            && let Some((at, integer)) = self.hundreds()
        {
            return Err(self.ambiguous(line, cell, Some((at, integer))));
        }
        match (decimal, doubt) {
            (Some(decimal), None) => Ok(decimal),
            (_, Some((line, cell))) => {
                let evidence = certain.map(|(_, at, evidence)| (at, evidence));
                Err(self.ambiguous(line, cell, evidence))
            }
            (None, None) => Ok('.'),
        }
    }

    /// A whole number of three digits: beside it `1,101` comes after 999 as likely as it is a decimal.
    fn hundreds(self) -> Option<(usize, &'r str)> {
        let is_one = |cell: &str| {
            let digits = cell.strip_prefix(['+', '-', '−']).unwrap_or(cell);
            form(cell) == Some(Form::Integer) && digits.len() == 3 && !digits.starts_with('0')
        };
        self.all().find(|(_, cell)| is_one(cell))
    }

    /// A sentence about numbers such as `1.000` or `1,000` where nothing in the file shows whether the
    /// mark is the decimal one: between semicolons or tabs it may as well separate thousands.
    fn marks_of_thousands(self, usual: Option<char>) -> Option<String> {
        if usual.is_some() || self.places != (Places::Lines { commas: false }) {
            return None;
        }
        let doubtful = |(line, cell)| match form(cell) {
            Some(Form::Ambiguous(mark)) => Some((line, cell, mark)),
            _ => None,
        };
        let (line, cell, mark): (usize, &str, char) = self.all().find_map(doubtful)?;
        let name = if mark == ',' { "comma" } else { "point" };
        let joined: String = cell.chars().filter(|c| *c != mark).collect();
        Some(format!(
            "`{cell}` in `{}`, {}, is read with a decimal {name}; if it means {joined}, remove the \
             {name}s that separate thousands from the file",
            self.name,
            self.place(line)
        ))
    }

    fn ambiguous(self, line: usize, cell: &str, evidence: Option<(usize, &str)>) -> Fault {
        let joined: String = cell.chars().filter(|c| !matches!(c, '.' | ',')).collect();
        let point = cell.replace(',', ".");
        let why = match evidence {
            Some((at, evidence)) => format!(", beside `{evidence}` in {}", self.places.row(at)),
            None => String::new(),
        };
        fault!(
            BAD_TABLE,
            "{}: `{cell}` in `{}` is ambiguous: {point} or {joined}{why}",
            self.place(line),
            self.name
        )
        .help("write numbers without thousands separators")
    }
}

/// The decimal mark of which the columns leave no doubt, if they agree.
pub(crate) fn usual_mark(rows: &[Record<'_>], columns: usize) -> Option<char> {
    let mut usual = None;
    for row in rows {
        for cell in row.cells.iter().take(columns) {
            let Some(mark) = form(cell).and_then(Form::decimal) else { continue };
            if usual.is_some_and(|usual| usual != mark) {
                return None;
            }
            usual = Some(mark);
        }
    }
    usual
}

/// Moments of one column as seconds, with the dates of another.
pub(super) fn in_seconds(
    own: Cells<'_, '_>,
    moments: &[Option<Moment>],
    dates: Option<(Cells<'_, '_>, &[Option<Moment>])>,
) -> Result<(Vec<f64>, String), Fault> {
    let dated = dates.map_or(own, |(cells, _)| cells);
    let cell = |row| dated.cell(row);
    let found = seconds(moments, dates.map(|(_, dates)| dates), own.name, &cell)?;
    let with = dates.map_or(String::new(), |(own, _)| format!(" with the dates of `{}`", own.name));
    Ok((found.values, format!("`{}` holds {}{with}", own.name, found.meaning)))
}

/// What a word says about a switch: spreadsheets and programs write truth values so.
fn truth(cell: &str) -> Option<bool> {
    let is = |word: &str| cell.eq_ignore_ascii_case(word);
    match () {
        () if is("true") || is("on") => Some(true),
        () if is("false") || is("off") => Some(false),
        () => None,
    }
}

fn short(cell: &str) -> String {
    cell.chars().take(40).collect()
}

#[cfg(test)]
mod tests {
    use crate::mat::read_csv;

    #[test]
    fn points_that_may_separate_thousands_are_named_where_no_number_decides() {
        let notes = |text: &str| {
            let table = read_csv(text.as_bytes()).unwrap();
            table.column("P").unwrap().about.notes
        };
        let found = notes("t;P\n0;1.000\n1;4.000\n2;4.000\n");
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].starts_with("`1.000` in `P`, line 2, column 2, is read with a decimal"));
        for clear in
            ["t;P\n0;1.000\n1;4.05\n", "t;P\n0.5;1.000\n1;4.000\n", "t,P\n0,1.000\n1,4.000\n"]
        {
            assert_eq!(notes(clear), [""; 0], "{clear}");
        }
        let found = notes("t\tP\n0\t1,501\n1\t1,599\n");
        let expected = "`1,501` in `P`, line 2, column 2, is read with a decimal comma; if it means 1501, \
                        remove the commas that separate thousands from the file";
        assert_eq!(found, [expected]);
        for clear in ["t;P\n0;1,501\n1;1,5\n", "t;P\n0,5;1,501\n1;999\n", "t;P\n0;0,501\n1;999\n"] {
            assert_eq!(notes(clear), [""; 0], "{clear}");
        }
    }

    #[test]
    fn commas_beside_whole_numbers_of_three_digits_are_ambiguous() {
        for text in ["t\tP\n0\t899\n1\t999\n2\t1,101\n", "t;P\n0;-999\n1;-1,101\n"] {
            let fault = read_csv(text.as_bytes()).map(|_| ()).unwrap_err();
            assert!(fault.message.contains("1,101` in `P` is ambiguous: "), "{}", fault.message);
            assert!(fault.message.contains(", beside `"), "{}", fault.message);
        }
        let small = read_csv(b"t;P\n0;0\n1;1,101\n").unwrap();
        assert_eq!(small.column("P").unwrap().values, [0.0, 1.101]);
    }
}
