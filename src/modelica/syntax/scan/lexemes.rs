//! Tokens with the comments between them, for those who work on the text rather than on the tree.

use super::tokens::{Token, TokenKind};
use std::ops::Range;

/// What a lexeme is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LexemeKind {
    /// Identifier or keyword.
    Word,
    /// Quoted identifier.
    Quoted,
    /// Unsigned number.
    Number,
    /// String with its quotes.
    String,
    /// `(`, `[`, `{`
    Open,
    /// `)`, `]`, `}`
    Close,
    /// `,`
    Comma,
    /// `;`
    Semicolon,
    /// Operator, `.`, `:`, `=`, `:=`, or `$` before a quoted expression.
    Operator,
    /// A bare command with the rest of its line.
    Command,
    /// From `//` to the end of the line, which is excluded.
    LineComment,
    /// From `/*` to `*/`.
    BlockComment,
}

/// A token or a comment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lexeme {
    /// What it is.
    pub kind: LexemeKind,
    /// First byte.
    pub start: usize,
    /// The byte after the last.
    pub end: usize,
    /// Whether a line end before it closes a statement of a script.
    pub ends_line: bool,
    /// Whether it is a sign that begins a line of a script and continues the statement of the line
    /// before, which could have ended there.
    pub continues: bool,
    /// Whether it is in brackets, or a word of a conditional expression: no keyword of a statement.
    pub(crate) in_expression: bool,
}

/// What a token of a script follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Follows {
    /// A statement that the line end before it closes.
    Statement,
    /// A line that could be a whole statement, which it continues by a sign.
    Line,
    /// The token before it.
    Token,
}

/// Operators of two characters, which the scanner reads one by one.
const LONG_OPERATORS: &[&str] = &[":=", "==", "<=", ">=", "<>", ".+", ".-", ".*", "./", ".^"];

impl Lexeme {
    /// The bytes.
    pub fn range(&self) -> Range<usize> {
        self.start..self.end
    }

    /// Whether it is a comment.
    pub fn is_comment(&self) -> bool {
        matches!(self.kind, LexemeKind::LineComment | LexemeKind::BlockComment)
    }

    pub(super) fn of(token: &Token<'_>, follows: Follows, in_expression: bool) -> Lexeme {
        let kind = match token.kind {
            TokenKind::Word => LexemeKind::Word,
            TokenKind::Quoted => LexemeKind::Quoted,
            TokenKind::Number => LexemeKind::Number,
            TokenKind::String => LexemeKind::String,
            TokenKind::Open => LexemeKind::Open,
            TokenKind::Close => LexemeKind::Close,
            TokenKind::Separator if token.text == "," => LexemeKind::Comma,
            TokenKind::Separator => LexemeKind::Semicolon,
            TokenKind::Operator => LexemeKind::Operator,
            TokenKind::Command => LexemeKind::Command,
        };
        Lexeme {
            kind,
            start: token.start,
            end: token.end,
            ends_line: follows == Follows::Statement,
            continues: follows == Follows::Line,
            in_expression,
        }
    }
}

/// Tokens as the scanner reads them with operators put together, and the comments between them.
pub(super) fn with_comments(text: &str, tokens: Vec<Lexeme>) -> Vec<Lexeme> {
    let mut found: Vec<Lexeme> = Vec::new();
    let mut at = 0;
    for token in tokens {
        comments(text, at..token.start, &mut found);
        at = token.end;
        match found.last_mut() {
            Some(last)
                if last.end == token.start
                    && last.kind == LexemeKind::Operator
                    && LONG_OPERATORS.contains(&&text[last.start..token.end]) =>
            {
                last.end = token.end;
            }
            _ => found.push(token),
        }
    }
    comments(text, at..text.len(), &mut found);
    found
}

/// The comments in the gap between two tokens.
fn comments(text: &str, gap: Range<usize>, found: &mut Vec<Lexeme>) {
    let mut at = gap.start;
    while let Some(begin) = text[at..gap.end].find('/') {
        let start = at + begin;
        let rest = &text[start..gap.end];
        let (kind, length) = match rest.strip_prefix("/*").and_then(|inside| inside.find("*/")) {
            Some(length) => (LexemeKind::BlockComment, length + 4),
            None => {
                let line = rest.find('\n').map_or(rest, |end| &rest[..end]);
                (LexemeKind::LineComment, line.trim_end().len().max(1))
            }
        };
        let end = start + length;
        let (ends_line, continues, in_expression) = (false, false, false);
        found.push(Lexeme { kind, start, end, ends_line, continues, in_expression });
        at = end;
        if kind == LexemeKind::LineComment {
            at = start + rest.find('\n').unwrap_or(rest.len());
        }
    }
}
