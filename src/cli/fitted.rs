//! Text laid out for the width of a terminal: sentences wrap at spaces, below where their value
//! begins; a table that is too wide has two or more lines per row. What is not printed to a terminal
//! is not laid out.

use regex::Regex;
use std::ops::Range;
use std::sync::LazyLock;
use textwrap::core::display_width;
use textwrap::{Options, WordSeparator, WordSplitter};

/// Spaces between two columns of a table, at least.
const GAP: usize = 2;
/// In front of the further lines of a row.
const INDENT: usize = 4;
/// Stands for a space at which no line ends.
const NO_BREAK: &str = "\u{a0}";
/// Where no line ends: within intervals, assignments and products.
static WHOLE: LazyLock<Regex> =
    LazyLock::new(|| Regex::new(r"(\d) (to|×|±) ([-+\d])| (=) ").expect("it is an expression"));
/// What begins a quoted line of a file, which keeps its columns.
const QUOTED: [char; 2] = ['│', '┌'];
/// What points to a place in a quoted line, before the words about it.
const MARKS: &str = " ^-│╭╰─";
/// Columns that words beside such marks have at least; else they begin in the next line.
const BESIDE: usize = 30;
/// Follows the sign that begins an action.
const HELP: &str = " help: ";
/// Begins a colour. Diagnostics have colours, and no tables.
const COLOUR: char = '\u{1b}';
/// Ends a colour.
const PLAIN: &str = "\u{1b}[0m";

/// The text with lines of at most `width` columns, as far as its words allow.
pub(super) fn fitted(text: &str, width: usize) -> String {
    let lines: Vec<&str> = text.split_inclusive('\n').collect();
    if lines.iter().all(|line| display_width(line.trim_end()) <= width) {
        return text.to_owned();
    }
    let rows = lines.chunk_by(|a, b| is_row(a) && is_row(b));
    rows.map(|rows| if is_row(rows[0]) { table(rows, width) } else { sentence(rows[0], width) })
        .collect()
}

/// Whether the line has columns.
fn is_row(line: &str) -> bool {
    line.trim().contains("  ") && !line.contains(QUOTED) && !line.contains(COLOUR)
}

/// A line of words. What follows a label such as `= help:` begins below itself.
fn sentence(line: &str, width: usize) -> String {
    let (content, end) = match line.strip_suffix('\n') {
        Some(content) => (content, "\n"),
        None => (line, ""),
    };
    if display_width(content) <= width {
        return line.to_owned();
    }
    if content.contains(QUOTED) {
        return labelled(content, width).unwrap_or_else(|| content.to_owned()) + end;
    }
    let own = content.len() - content.trim_start().len();
    // The sign before it may be coloured.
    let is_label =
        |at: &usize| content[..*at].contains('=') && display_width(&content[own..*at]) == "=".len();
    let label = content.find(HELP).filter(is_label);
    let label = label.map(|at| display_width(&content[..at]) + HELP.len());
    wrapped(content.trim_start(), own, label.unwrap_or(own), width) + end
}

/// A line below a quoted one, whose words wrap below themselves; `None` where there are none.
fn labelled(line: &str, width: usize) -> Option<String> {
    let visible = visible(line);
    let mut signs = visible.iter().skip_while(|(_, sign)| *sign == ' ');
    let (bar, _) = signs.next().filter(|(_, sign)| *sign == QUOTED[0])?;
    let (start, _) = signs.find(|(_, sign)| !MARKS.contains(*sign))?;
    let gutter = &line[..bar + QUOTED[0].len_utf8()];
    let (before, words) = line.split_at(*start);
    let colour = before.rfind(COLOUR).map_or("", |at| &before[at..]);
    let (is_coloured, colour) = (!colour.is_empty(), colour.trim_end_matches(' '));
    let (column, least) = (display_width(before), display_width(gutter) + 1);
    let length = display_width(words);
    let is_beside = width.saturating_sub(column) >= BESIDE.min(length);
    let first = if is_beside { column } else { width.saturating_sub(length).max(least) };
    let wrapped = wrapped(words, 0, 0, width.saturating_sub(first));
    let plain = if is_coloured { PLAIN } else { "" };
    let lines = wrapped.lines().enumerate().map(|(number, words)| match number {
        0 if is_beside => format!("{before}{words}{plain}"),
        _ => {
            let indent = " ".repeat(first - display_width(gutter));
            format!("{gutter}{plain}{indent}{colour}{words}{plain}")
        }
    });
    let marks = before.strip_suffix(colour).unwrap_or(before).trim_end();
    let marks = (!is_beside).then(|| format!("{marks}{plain}"));
    Some(marks.into_iter().chain(lines).collect::<Vec<_>>().join("\n"))
}

/// The characters that are no part of a colour, with their places.
fn visible(line: &str) -> Vec<(usize, char)> {
    let mut is_colour = false;
    let shown = line.char_indices().filter(|(_, sign)| {
        is_colour |= *sign == COLOUR;
        let is_shown = !is_colour;
        is_colour &= *sign != 'm';
        is_shown
    });
    shown.collect()
}

/// Words from column `first` on, in further lines from column `next` on.
fn wrapped(words: &str, first: usize, next: usize, width: usize) -> String {
    let kept = WHOLE.replace_all(words, format!("${{1}}{NO_BREAK}${{2}}${{4}}{NO_BREAK}${{3}}"));
    let [first, next] = [first, next].map(|columns| " ".repeat(columns));
    let options = Options::new(width)
        .initial_indent(&first)
        .subsequent_indent(&next)
        .break_words(false)
        .word_separator(WordSeparator::AsciiSpace)
        .word_splitter(WordSplitter::NoHyphenation);
    textwrap::fill(&kept, options).replace(NO_BREAK, " ")
}

/// Lines whose columns stand below each other.
fn table(lines: &[&str], width: usize) -> String {
    if lines.iter().all(|line| display_width(line.trim_end()) <= width) {
        return lines.concat();
    }
    let cells: Vec<Vec<char>> =
        lines.iter().map(|line| line.trim_end().chars().collect()).collect();
    let columns = columns(&cells);
    let Some(last) = columns.last() else { return lines.concat() };
    // Labels and sentences: the sentences wrap in their column.
    if last.start <= width / 2 && columns.len() > 1 {
        let rows = cells.iter().map(|row| {
            let text: String = row[last.start.min(row.len())..].iter().collect();
            let before: String = row[..last.start.min(row.len())].iter().collect();
            match text.trim() {
                "" => before.trim_end().to_owned() + "\n",
                text => before + wrapped(text, last.start, last.start, width).trim_start() + "\n",
            }
        });
        return rows.collect();
    }
    cells.iter().map(|row| folded(row, &columns, width)).collect()
}

/// The columns of a table: between them all lines have spaces.
fn columns(rows: &[Vec<char>]) -> Vec<Range<usize>> {
    let end = rows.iter().map(Vec::len).max().unwrap_or(0);
    let is_blank = |at: usize| rows.iter().all(|row| row.get(at).is_none_or(|c| *c == ' '));
    let mut columns: Vec<Range<usize>> = Vec::new();
    for at in (0..end).filter(|at| !is_blank(*at)) {
        match columns.last_mut() {
            Some(last) if at < last.end + GAP => last.end = at + 1,
            _ => columns.push(at..at + 1),
        }
    }
    columns
}

/// A row in as many lines as its columns need.
fn folded(row: &[char], columns: &[Range<usize>], width: usize) -> String {
    let mut text = String::new();
    let mut line = String::new();
    let below = columns[0].start + INDENT;
    // The columns of the table move by this much to the left.
    let mut moved = 0;
    for (k, column) in columns.iter().enumerate() {
        if k > 0 && column.end - moved > width {
            text += &ended(&line);
            line = String::new();
            moved = column.start - below;
        }
        let cell = row.iter().take(column.end).skip(column.start).collect::<String>();
        let place = column.start - moved;
        line += &" ".repeat(place.saturating_sub(line.chars().count()));
        line += &match place + cell.trim_end().chars().count() > width {
            true => wrapped(cell.trim(), place, place, width).trim_start().to_owned(),
            false => cell,
        };
    }
    text + &ended(&line)
}

/// A line, unless it is empty.
fn ended(line: &str) -> String {
    match line.trim_end() {
        "" => String::new(),
        line => format!("{line}\n"),
    }
}

#[cfg(test)]
mod tests {
    use super::fitted;

    #[test]
    fn what_fits_stays() {
        let text = "a  b\n  a sentence\n\nc";
        assert_eq!(fitted(text, 20), text);
    }

    #[test]
    fn sentences_wrap_between_words_and_numbers_stay_whole() {
        let text = "  k is determined: its interval 1.5e-3 to 2.5e-3 is narrow\n = help: give more data here\n";
        let expected = "  k is determined: its\n  interval\n  1.5e-3 to 2.5e-3 is\n  narrow\n\
                         = help: give more data\n         here\n";
        assert_eq!(fitted(text, 24), expected.replace("\n= help", "\n = help"));
    }

    #[test]
    fn coloured_actions_wrap_below_themselves() {
        let text = "   \u{1b}[36m=\u{1b}[0m help: give more data here\n";
        let expected = "   \u{1b}[36m=\u{1b}[0m help: give more\n           data here\n";
        assert_eq!(fitted(text, 20), expected);
    }

    #[test]
    fn values_wrap_below_themselves() {
        let text = "  model    Decay\n  ending   Minimum found, reached by 5 of 5 descents.\n";
        let expected = "  model    Decay\n  ending   Minimum found,\n           reached by 5 of 5\n           \
                        descents.\n";
        assert_eq!(fitted(text, 28), expected);
    }

    #[test]
    fn rows_that_are_too_wide_have_two_lines() {
        let text = "  parameter  value     interval        range\n  \
                      k          1.234e-5  1e-6 to 1e-4    0 to 1   practically non-identifiable\n";
        let expected = "  parameter  value\n      interval        range\n  \
                          k          1.234e-5\n      1e-6 to 1e-4    0 to 1\n      practically \
                          non-identifiable\n";
        assert_eq!(fitted(text, 34), expected);
    }

    #[test]
    fn words_about_a_place_wrap_below_themselves() {
        let text = " 1 │ x = a + b\n   │     ^ there is no variable `a` in the script\n";
        let expected =
            " 1 │ x = a + b\n   │     ^ there is no variable `a` in the\n   │       script\n";
        assert_eq!(fitted(text, 48), expected);
        let [bar, red, plain] = ["   \u{1b}[34m│\u{1b}[0m ", "\u{1b}[31m", "\u{1b}[0m"];
        let coloured = format!("{bar}    {red}^{plain} {red}there is no variable{plain}\n");
        let expected = format!(
            "{bar}    {red}^{plain}\n{bar}{red}there is no{plain}\n{bar}{red}variable{plain}\n"
        );
        let fitted = fitted(&coloured, 20).replace(&plain.repeat(2), plain);
        assert_eq!(fitted, expected);
    }

    #[test]
    fn quoted_lines_keep_their_columns() {
        let text = "   ┌─ a.mos:1:1\n 1 │ x := {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};\n";
        assert_eq!(fitted(text, 20), text);
    }
}
