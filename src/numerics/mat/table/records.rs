//! From text to rows of cells: separators, quotes, comments.

use std::borrow::Cow;

/// What stands between cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Separator {
    /// One character.
    Mark(char),
    /// Any number of blanks.
    Blanks,
}

impl Separator {
    /// Those that are tried, the first of equally good ones taken.
    pub(crate) const ALL: [Separator; 4] =
        [Separator::Mark(';'), Separator::Mark('\t'), Separator::Mark(','), Separator::Blanks];
}

/// A row of cells with the number of its line, counted from 1.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Record<'a> {
    pub line: usize,
    pub cells: Vec<Cow<'a, str>>,
}

impl Record<'_> {
    /// The number of cells without empty ones at the end.
    pub(crate) fn width(&self) -> usize {
        self.cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1)
    }
}

/// Lines that a quoted cell may span; a quotation mark without a partner is a letter.
const MOST_QUOTED_LINES: usize = 20;

/// The lines that hold cells: neither blank, nor comments, nor rules drawn under a head.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.split('\n')
        .enumerate()
        .map(|(number, line)| (number + 1, line))
        .filter(|(_, line)| !line.trim().is_empty() && !is_comment(line) && !is_rule(line))
}

/// Whether the line is a comment. A mark after a tab is a cell: some instruments write `#` as the
/// unit of a count.
pub(crate) fn is_comment(line: &str) -> bool {
    let line = line.trim_start_matches(' ');
    line.starts_with(['#', '%']) || line.starts_with("//")
}

/// `____  ____`, `----+----`: at least three of one mark, and nothing else.
fn is_rule(line: &str) -> bool {
    let line = line.trim();
    let drawn = |c: char| matches!(c, '_' | '-' | '=' | '+' | '|' | ' ' | '\t');
    line.chars().all(drawn) && ["___", "---", "==="].iter().any(|rule| line.contains(rule))
}

/// All rows of a text.
pub(crate) fn records(text: &str, separator: Separator) -> Vec<Record<'_>> {
    let mut found = Vec::new();
    let mut done = 0;
    for (line, content) in lines(text) {
        if line <= done {
            continue;
        }
        let start = content.as_ptr() as usize - text.as_ptr() as usize;
        let (cells, more) = split_quoted(&text[start..], content, separator);
        done = line + more;
        found.push(Record { line, cells });
    }
    found
}

/// The cells of the line at the start of `rest`, and how many more lines its quotes span.
fn split_quoted<'a>(
    rest: &'a str,
    line: &'a str,
    separator: Separator,
) -> (Vec<Cow<'a, str>>, usize) {
    if !line.contains('"') {
        return (split(line, separator).0, 0);
    }
    let mut end = line.len();
    for more in 0..MOST_QUOTED_LINES {
        let (cells, open) = split(&rest[..end], separator);
        if !open {
            return (cells, more);
        }
        if end == rest.len() {
            break;
        }
        end = rest[end + 1..].find('\n').map_or(rest.len(), |length| end + 1 + length);
    }
    (split(line, separator).0, 0)
}

/// The cells of a line, and whether a quotation mark lacks its partner.
pub(crate) fn split(line: &str, separator: Separator) -> (Vec<Cow<'_, str>>, bool) {
    let mut cells = Vec::new();
    let mut rest = match separator {
        Separator::Blanks => line.trim(),
        Separator::Mark(_) => line,
    };
    loop {
        let begin = trim(rest);
        if let Some(quoted) = begin.strip_prefix('"') {
            let Some((cell, after)) = unquoted(quoted) else {
                cells.push(Cow::Borrowed(begin));
                return (cells, true);
            };
            cells.push(cell);
            match next(after, separator) {
                Some((_, following)) => rest = following,
                None => return (cells, false),
            }
            continue;
        }
        match next(rest, separator) {
            Some((cell, following)) => {
                cells.push(Cow::Borrowed(cell.trim()));
                rest = following;
            }
            None => {
                cells.push(Cow::Borrowed(rest.trim()));
                return (cells, false);
            }
        }
    }
}

/// Blanks before a quotation mark do not count; a tab may be the separator.
fn trim(text: &str) -> &str {
    text.trim_start_matches(' ')
}

/// The text before the next separator and the text after it.
fn next(text: &str, separator: Separator) -> Option<(&str, &str)> {
    match separator {
        Separator::Mark(mark) => text.split_once(mark),
        Separator::Blanks => {
            let (cell, following) = text.split_once([' ', '\t', '\u{a0}'])?;
            Some((cell, following.trim_start()))
        }
    }
}

/// The content up to the closing quotation mark, and what follows; two marks stand for one.
fn unquoted(text: &str) -> Option<(Cow<'_, str>, &str)> {
    let mut from = 0;
    loop {
        let at = from + text[from..].find('"')?;
        if text[at + 1..].starts_with('"') {
            from = at + 2;
            continue;
        }
        let cell = text[..at].trim();
        let cell = match cell.contains("\"\"") {
            true => Cow::Owned(cell.replace("\"\"", "\"")),
            false => Cow::Borrowed(cell),
        };
        return Some((cell, &text[at + 1..]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(line: &str, separator: Separator) -> Vec<String> {
        split(line, separator).0.into_iter().map(Cow::into_owned).collect()
    }

    #[test]
    fn cells_are_split() {
        let comma = Separator::Mark(',');
        assert_eq!(cells("a, \"b, \"\"c\"\"\" ,,d", comma), ["a", "b, \"c\"", "", "d"]);
        assert_eq!(cells("1,2,", comma), ["1", "2", ""]);
        assert_eq!(cells("  1.0   2\t3 ", Separator::Blanks), ["1.0", "2", "3"]);
        assert_eq!(cells("\t#\ts", Separator::Mark('\t')), ["", "#", "s"]);
    }

    #[test]
    fn lines_are_counted_through_quotes_and_comments() {
        let text = "# c\nt,\"a\nb\"\n\n1,2\n-----\n3,5\" pipe\n";
        let found = records(text, Separator::Mark(','));
        let lines: Vec<usize> = found.iter().map(|record| record.line).collect();
        assert_eq!(lines, [2, 5, 7]);
        assert_eq!(found[0].cells[1], "a\nb");
        assert_eq!(found[2].cells[1], "5\" pipe");
    }
}
