//! What a script is expected to print, and whether it did: line by line, integers exactly, other
//! numbers within a tolerance.

use crate::diag::visible;
use std::fmt::Write as _;

/// How numbers that are no integers may differ: |a − b| ≤ absolute + relative |b|.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// In units of the number itself.
    pub absolute: f64,
    /// As a part of the number expected.
    pub relative: f64,
}

impl Tolerance {
    /// For transcripts: the last of six digits may differ.
    pub const TRANSCRIPT: Tolerance = Tolerance { absolute: 1e-9, relative: 2e-6 };
    /// For results embedded in scripts, as the tests of OpenModelica are compared.
    pub const EMBEDDED: Tolerance = Tolerance { absolute: 5e-3, relative: 5e-3 };
}

/// The lines between `// Result:` and `// endResult` without their slashes; `None` if the script
/// has no such block.
pub fn embedded(script: &str) -> Option<String> {
    let mut lines = script.lines().skip_while(|line| line.trim() != "// Result:");
    lines.next()?;
    let mut expected = String::new();
    for line in lines {
        let line = line.trim_end();
        if line.trim() == "// endResult" {
            break;
        }
        let Some(rest) = line.strip_prefix("//") else { break };
        expected.push_str(rest.strip_prefix(' ').unwrap_or(rest));
        expected.push('\n');
    }
    Some(expected)
}

/// One line of a comparison.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Line {
    /// In both.
    Same(String),
    /// Expected and not there.
    Missing(String),
    /// There and not expected.
    Unexpected(String),
}

/// Lines compared at most; longer ones are compared in order without looking for insertions.
const MAX_LINES: usize = 4000;

/// The lines of both in order; `None` if they agree.
pub fn difference(expected: &str, actual: &str, tolerance: Tolerance) -> Option<Vec<Line>> {
    let expected: Vec<&str> = expected.trim_end().lines().map(str::trim_end).collect();
    let actual: Vec<&str> = actual.trim_end().lines().map(str::trim_end).collect();
    let agree = |(a, b): (&&str, &&str)| lines_agree(a, b, tolerance);
    if expected.len() == actual.len() && expected.iter().zip(&actual).all(agree) {
        return None;
    }
    if expected.len().max(actual.len()) > MAX_LINES {
        return Some(in_order(&expected, &actual, tolerance));
    }
    Some(aligned(&expected, &actual, tolerance))
}

fn in_order(expected: &[&str], actual: &[&str], tolerance: Tolerance) -> Vec<Line> {
    let mut lines = Vec::new();
    for at in 0..expected.len().max(actual.len()) {
        match (expected.get(at), actual.get(at)) {
            (Some(a), Some(b)) if lines_agree(a, b, tolerance) => {
                lines.push(Line::Same((*b).to_owned()));
            }
            (a, b) => {
                lines.extend(a.map(|a| Line::Missing((*a).to_owned())));
                lines.extend(b.map(|b| Line::Unexpected((*b).to_owned())));
            }
        }
    }
    lines
}

/// Along a longest common subsequence.
fn aligned(expected: &[&str], actual: &[&str], tolerance: Tolerance) -> Vec<Line> {
    let (rows, columns) = (expected.len(), actual.len());
    let mut common = vec![0u16; (rows + 1) * (columns + 1)];
    let at = |row: usize, column: usize| row * (columns + 1) + column;
    for row in (0..rows).rev() {
        for column in (0..columns).rev() {
            common[at(row, column)] = match lines_agree(expected[row], actual[column], tolerance) {
                true => common[at(row + 1, column + 1)] + 1,
                false => common[at(row + 1, column)].max(common[at(row, column + 1)]),
            };
        }
    }
    let (mut row, mut column, mut lines) = (0, 0, Vec::new());
    while row < rows || column < columns {
        if row < rows && column < columns && lines_agree(expected[row], actual[column], tolerance) {
            lines.push(Line::Same(actual[column].to_owned()));
            (row, column) = (row + 1, column + 1);
        } else if column == columns
            || row < rows && common[at(row + 1, column)] >= common[at(row, column + 1)]
        {
            lines.push(Line::Missing(expected[row].to_owned()));
            row += 1;
        } else {
            lines.push(Line::Unexpected(actual[column].to_owned()));
            column += 1;
        }
    }
    lines
}

/// A number as it is written.
#[derive(Debug, Clone, Copy)]
struct Number {
    value: f64,
    /// Digits alone: a count, a size, an index.
    is_integer: bool,
}

impl Number {
    fn agrees_with(self, actual: Number, tolerance: Tolerance) -> bool {
        let (a, b) = (self.value, actual.value);
        match self.is_integer && actual.is_integer {
            true => a == b,
            false => (a - b).abs() <= tolerance.absolute + tolerance.relative * a.abs(),
        }
    }
}

/// Whether two lines say the same: the same text between numbers that agree.
pub(crate) fn lines_agree(expected: &str, actual: &str, tolerance: Tolerance) -> bool {
    if expected == actual {
        return true;
    }
    let (mut a, mut b) = (expected, actual);
    loop {
        let (prefix_a, number_a, rest_a) = next_number(a);
        let (prefix_b, number_b, rest_b) = next_number(b);
        let numbers = match (number_a, number_b) {
            (None, None) => return prefix_a == prefix_b,
            (Some(a), Some(b)) => a.agrees_with(b, tolerance),
            _ => false,
        };
        if prefix_a != prefix_b || !numbers {
            return false;
        }
        (a, b) = (rest_a, rest_b);
    }
}

/// The text before the next number, the number, and what follows it. Digits within a word are text.
fn next_number(text: &str) -> (&str, Option<Number>, &str) {
    let bytes = text.as_bytes();
    let is_word = |at: usize| bytes[at].is_ascii_alphanumeric() || bytes[at] == b'_';
    let mut start = 0;
    while start < bytes.len() {
        let begins = bytes[start].is_ascii_digit() && (start == 0 || !is_word(start - 1));
        if !begins {
            start += 1;
            continue;
        }
        let end = end_of_number(bytes, start);
        let signed = start > 0 && bytes[start - 1] == b'-';
        let from = if signed { start - 1 } else { start };
        let is_integer = bytes[start..end].iter().all(u8::is_ascii_digit);
        return match text[from..end].parse() {
            Ok(value) => (&text[..from], Some(Number { value, is_integer }), &text[end..]),
            Err(_) => (text, None, ""),
        };
    }
    (text, None, "")
}

fn end_of_number(bytes: &[u8], start: usize) -> usize {
    let digits = |mut at: usize| {
        while bytes.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
        at
    };
    let mut end = digits(start);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits(end + 1 + sign);
        if exponent > end + 1 + sign {
            end = exponent;
        }
    }
    end
}

/// Which statements agree, given how many lines each printed: those whose lines are all expected
/// and none of whose is missing. A missing line belongs to the statement that printed another line
/// in its place, else to one between its neighbours that printed nothing, else to the one before.
pub fn agreeing(lines: &[Line], printed: &[usize]) -> Vec<bool> {
    let mut agree = vec![true; printed.len()];
    let owners: Vec<usize> =
        printed.iter().enumerate().flat_map(|(at, count)| vec![at; *count]).collect();
    let last = printed.len().saturating_sub(1);
    let owner = |line: usize| owners.get(line).copied().unwrap_or(last);
    let (mut line, mut missing, mut replaced) = (0, false, false);
    for at in 0..=lines.len() {
        match lines.get(at) {
            Some(Line::Missing(_)) => missing = true,
            Some(Line::Unexpected(_)) => {
                if let Some(agrees) = agree.get_mut(owner(line)) {
                    *agrees = false;
                }
                replaced = true;
                line += 1;
            }
            same => {
                if missing && !replaced {
                    let before = line.checked_sub(1).map(owner);
                    let next = same.map_or(printed.len(), |_| owner(line));
                    let first = before.map_or(0, |before| before + 1);
                    let silent = (first..next).find(|at| printed[*at] == 0);
                    if let Some(agrees) = silent.or(before).and_then(|at| agree.get_mut(at)) {
                        *agrees = false;
                    }
                }
                (missing, replaced) = (false, false);
                line += 1;
            }
        }
    }
    agree
}

/// A comparison as text: three lines of context around what differs; coloured if requested. Control
/// characters are shown as symbols.
pub fn shown(lines: &[Line], colour: bool) -> String {
    const CONTEXT: usize = 3;
    let differs = |at: usize| !matches!(lines[at], Line::Same(_));
    let near =
        |at: usize| (at.saturating_sub(CONTEXT)..(at + CONTEXT + 1).min(lines.len())).any(differs);
    let (mut text, mut skipped) = (String::new(), false);
    for (at, line) in lines.iter().enumerate() {
        if !near(at) {
            skipped = true;
            continue;
        }
        if std::mem::take(&mut skipped) {
            text.push_str("  ...\n");
        }
        let (mark, code, line) = match line {
            Line::Same(line) => ("  ", "", line),
            Line::Missing(line) => ("- ", "\x1b[31m", line),
            Line::Unexpected(line) => ("+ ", "\x1b[32m", line),
        };
        let line = visible(line);
        let _ = match colour && !code.is_empty() {
            true => writeln!(text, "{code}{mark}{line}\x1b[0m"),
            false => writeln!(text, "{mark}{line}"),
        };
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_agree_within_the_tolerance_and_words_exactly() {
        let near = Tolerance::EMBEDDED;
        for (a, b, expected) in [
            ("x = 1.0", "x = 1.004", true),
            ("x = 1.0", "x = 1.02", false),
            ("1e-07", "1e-7", true),
            ("{-2.0, 3}", "{-2.001, 3}", true),
            ("{2.0}", "{-2.0}", false),
            ("n = 1000", "n = 1001", false),
            ("n = 1000.0", "n = 1001", true),
            ("x1 = 2", "x2 = 2", false),
            ("a1.5", "a1.5001", false),
            ("v 1.", "v 1", true),
            ("", "0", false),
        ] {
            assert_eq!(lines_agree(a, b, near), expected, "{a} {b}");
        }
    }

    #[test]
    fn an_embedded_result_is_what_stands_behind_the_slashes() {
        let script = "x := 1;\n// Result:\n// 1\n//\n//   two\n// endResult\n// 3\n";
        assert_eq!(embedded(script).as_deref(), Some("1\n\n  two\n"));
        assert_eq!(embedded("x := 1;"), None);
    }

    #[test]
    fn a_missing_line_belongs_to_the_statement_that_should_have_printed_it() {
        let agreeing = |expected: &str, printed: [&str; 3]| {
            let lines = difference(expected, &printed.concat(), Tolerance::EMBEDDED);
            let counts = printed.map(|text| text.lines().count());
            super::agreeing(&lines.unwrap_or_default(), &counts)
        };
        assert_eq!(agreeing("a\nb\nc", ["a\n", "b\n", "c\n"]), [true, true, true]);
        assert_eq!(agreeing("a\nb\nc", ["a\n", "x\n", "c\n"]), [true, false, true]);
        assert_eq!(agreeing("a\nb\nc", ["a\n", "", "c\n"]), [true, false, true]);
        assert_eq!(agreeing("a\nb\nc\nd", ["a\n", "b\n", "d\n"]), [true, false, true]);
        assert_eq!(agreeing("a\nc", ["a\n", "b\n", "c\n"]), [true, false, true]);
        assert_eq!(agreeing("a\nb\nc", ["a\n", "b\n", ""]), [true, true, false]);
    }

    #[test]
    fn a_difference_shows_what_is_missing_and_what_is_new() {
        let tolerance = Tolerance::TRANSCRIPT;
        assert_eq!(difference("a\nb\n", "a\nb", tolerance), None);
        let lines = difference("a\nb\nc", "a\nx\nc", tolerance).expect("a difference");
        assert_eq!(shown(&lines, false), "  a\n- b\n+ x\n  c\n");
    }
}
