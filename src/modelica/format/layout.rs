//! Lines of lexemes with their indentation.

use super::spacing::blanks;
use super::structure::{Role, roles};
use super::{INDENT, Language, Lexed};
use crate::syntax::LexemeKind;
use std::ops::Range;

/// Columns from one tab stop to the next.
const TAB: usize = 4;

/// A line of the formatted text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Line {
    /// The lexemes, by number.
    pub(super) lexemes: Range<usize>,
    /// Columns before the first.
    pub(super) indent: usize,
    /// Columns before the first lexeme of the statement.
    pub(super) base: usize,
    /// Whether a blank line precedes it.
    pub(super) blank: bool,
}

/// Lexemes with all that decides on their places.
pub(super) struct Layout<'t> {
    pub(super) lexed: &'t Lexed<'t>,
    pub(super) roles: Vec<Role>,
    /// Blanks before each, if it does not begin a line.
    pub(super) blanks: Vec<usize>,
    /// The bodies of outermost packages whose elements are at the column of the package, as in the
    /// files `package.mo` of the standard library.
    flat: Vec<Range<usize>>,
}

/// The statement that is being laid out.
#[derive(Default)]
struct Statement {
    /// Columns of its first line in the original.
    written: usize,
    /// Columns of its first line.
    base: usize,
    /// Columns by which its further lines are moved so that all are deeper than the first.
    further: usize,
}

/// The comment at the end of a line, which comments on the following lines may continue.
#[derive(Clone, Copy)]
struct Trailing {
    written: usize,
    column: usize,
}

impl Layout<'_> {
    /// The roles of lexemes, and the blanks between them.
    pub(super) fn of<'t>(lexed: &'t Lexed<'t>, language: Language) -> Layout<'t> {
        let roles = roles(lexed, language);
        let blanks = blanks(lexed, &roles);
        let mut layout = Layout { lexed, roles, blanks, flat: Vec::new() };
        layout.flat = layout.flat_packages();
        layout
    }

    /// The lines, not broken yet.
    pub(super) fn lines(&self) -> Vec<Line> {
        let count = self.lexed.lexemes.len();
        let mut lines: Vec<Line> = Vec::new();
        let mut statement = Statement::default();
        let mut trailing = None;
        for at in 0..count {
            if !self.begins_line(at, lines.last()) {
                continue;
            }
            self.end_line(&mut lines, at, &mut trailing);
            let blank = !lines.is_empty() && self.lexed.line_ends_before(at) > 1;
            let indent = match self.roles[at].begins {
                Some(level) => {
                    let written = self.written_indent(at);
                    statement = Statement {
                        written,
                        base: level.saturating_sub(self.flat(at)) * INDENT,
                        further: self.shortfall(at, written),
                    };
                    statement.base
                }
                None => self.indent(at, &statement, if blank { None } else { trailing }),
            };
            lines.push(Line { lexemes: at..at, indent, base: statement.base, blank });
        }
        self.end_line(&mut lines, count, &mut trailing);
        lines
    }

    /// Completes the last line, which ends before a lexeme.
    fn end_line(&self, lines: &mut [Line], end: usize, trailing: &mut Option<Trailing>) {
        let Some(line) = lines.last_mut() else { return };
        line.lexemes.end = end;
        let last = end - 1;
        if self.lexed.lexemes[last].kind != LexemeKind::LineComment {
            *trailing = None;
        } else if last > line.lexemes.start {
            let column = self.width(line) - self.lexed.str(last).chars().count();
            *trailing = Some(Trailing { written: self.column(last), column });
        } else if trailing.is_some_and(|trailing| trailing.column != line.indent) {
            *trailing = None;
        }
    }

    fn begins_line(&self, at: usize, line: Option<&Line>) -> bool {
        if at == 0 || self.lexed.line_ends_before(at) > 0 {
            return true;
        }
        let follows_leading_comment = line.is_some_and(|line| {
            (line.lexemes.start..at)
                .all(|before| self.lexed.lexemes[before].kind == LexemeKind::BlockComment)
        });
        self.roles[at].begins.is_some() && !follows_leading_comment
    }

    /// The indentation of a comment, or of a line that continues a statement.
    fn indent(&self, at: usize, statement: &Statement, trailing: Option<Trailing>) -> usize {
        let column = self.column(at);
        let lexeme = self.lexed.lexemes[at];
        if let Some(trailing) = trailing.filter(|trailing| trailing.written == column)
            && lexeme.is_comment()
        {
            return trailing.column;
        }
        if lexeme.is_comment()
            && let Some(indent) = self.between_statements(at, column)
        {
            return indent;
        }
        if lexeme.is_comment() && column == 0 {
            return 0;
        }
        let least = if self.closes(at) { 0 } else { 1 };
        let deeper = (column + statement.further).saturating_sub(statement.written);
        if deeper >= least { statement.base + deeper } else { statement.base + INDENT }
    }

    /// Whether a lexeme at the beginning of a line closes what the statement has opened.
    fn closes(&self, at: usize) -> bool {
        let lexeme = self.lexed.lexemes[at];
        lexeme.kind == LexemeKind::Close
            || matches!(self.lexed.str(at), "then" | "loop") && !lexeme.in_expression
    }

    /// The columns that the further lines of a statement lack to be deeper than the first.
    fn shortfall(&self, first: usize, written: usize) -> usize {
        let lexemes = &self.lexed.lexemes;
        let rest = (first + 1..lexemes.len()).take_while(|at| self.roles[*at].begins.is_none());
        let columns = rest
            .filter(|at| self.lexed.line_ends_before(*at) > 0)
            .filter(|at| !lexemes[*at].is_comment() && !self.closes(*at))
            .map(|at| self.column(at));
        match columns.min() {
            Some(least) if least <= written => written - least + INDENT,
            _ => 0,
        }
    }

    /// The indentation of a comment after which a statement begins, or nothing.
    fn between_statements(&self, at: usize, column: usize) -> Option<usize> {
        let lexemes = &self.lexed.lexemes;
        let next = (at..lexemes.len()).find(|next| !lexemes[*next].is_comment());
        let flat = self.flat(at);
        let inner = self.roles[at].level.saturating_sub(flat) * INDENT;
        let next = match next {
            None => None,
            Some(next) => Some((next, self.roles[next].begins?)),
        };
        Some(match next {
            Some((next, level)) if self.written_indent(next) == column => {
                level.saturating_sub(flat) * INDENT
            }
            _ if column == 0 => 0,
            _ => inner,
        })
    }

    /// The bodies of outermost packages most of whose elements begin in the first column.
    fn flat_packages(&self) -> Vec<Range<usize>> {
        let mut found = Vec::new();
        let begins = |level: usize| move |at: &usize| self.roles[*at].begins == Some(level);
        let all = 0..self.lexed.lexemes.len();
        let outer: Vec<usize> = all.clone().filter(begins(0)).chain([all.end]).collect();
        for pair in outer.windows(2) {
            let body = pair[0] + 1..pair[1];
            let head = pair[0]..body.clone().find(begins(1)).unwrap_or(pair[0]);
            let is_package = head.clone().any(|at| self.lexed.str(at) == "package");
            let elements =
                body.clone().filter(begins(1)).filter(|at| self.begins_written_line(*at));
            let (first, others): (Vec<usize>, Vec<usize>) =
                elements.partition(|at| self.column(*at) == 0);
            if is_package && first.len() > others.len() {
                found.push(body);
            }
        }
        found
    }

    /// Whether a lexeme is the first of its line in the original.
    fn begins_written_line(&self, at: usize) -> bool {
        at == 0 || self.lexed.line_ends_before(at) > 0
    }

    /// The levels that do not indent: that of the outermost package, if its author did not.
    fn flat(&self, at: usize) -> usize {
        usize::from(self.flat.iter().any(|package| package.contains(&at)))
    }

    /// The column of a lexeme in the original.
    fn column(&self, at: usize) -> usize {
        let start = self.lexed.lexemes[at].start;
        let line = self.lexed.text[..start].rfind('\n').map_or(0, |end| end + 1);
        columns(&self.lexed.text[line..start])
    }

    /// The indentation of the line of a lexeme in the original.
    fn written_indent(&self, at: usize) -> usize {
        let start = self.lexed.lexemes[at].start;
        let line = self.lexed.text[..start].rfind('\n').map_or(0, |end| end + 1);
        let line = &self.lexed.text[line..start];
        columns(&line[..line.len() - line.trim_start().len()])
    }

    /// The columns of a line without a comment at its end.
    pub(super) fn code_width(&self, line: &Line) -> usize {
        let last = line.lexemes.end - 1;
        let has_comment = self.lexed.lexemes[last].kind == LexemeKind::LineComment;
        let end = if has_comment { last } else { last + 1 };
        self.width(&Line { lexemes: line.lexemes.start..end, ..line.clone() })
    }

    /// The columns of a line, to the first line end in it.
    pub(super) fn width(&self, line: &Line) -> usize {
        let mut width = line.indent;
        for at in line.lexemes.clone() {
            if at > line.lexemes.start {
                width += self.blanks[at];
            }
            width += self.lexed.str(at).chars().count();
        }
        width
    }
}

fn columns(text: &str) -> usize {
    text.chars().fold(0, |column, character| match character {
        '\t' => (column / TAB + 1) * TAB,
        '\r' | '\u{feff}' => column,
        _ => column + 1,
    })
}
