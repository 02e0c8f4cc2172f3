//! The characters of a text as tokens, comments blanked on the way.

use crate::diag::Diagnostic;
use crate::fault;
use crate::source::{SourceId, Span};
use crate::syntax::errors::{BAD_CHARACTER, UNCLOSED_STRING};
use crate::syntax::keywords;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TokenKind {
    /// Identifier or keyword.
    Word,
    Quoted,
    Number,
    String,
    Open,
    Close,
    /// `,` or `;`
    Separator,
    Operator,
    /// A bare command with the rest of its line.
    Command,
}

/// Where a bare command is allowed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CommandPlace {
    /// The next token begins a statement.
    Here,
    /// It does if a line end precedes it.
    AfterLineEnd,
    /// It does not.
    Nowhere,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Token<'t> {
    pub(super) kind: TokenKind,
    pub(super) text: &'t str,
    pub(super) start: usize,
    pub(super) end: usize,
    /// The first line end between the previous token and this one.
    pub(super) line_end: Option<usize>,
}

impl Token<'_> {
    pub(super) fn is(&self, word: &str) -> bool {
        self.kind == TokenKind::Word && self.text == word
    }

    pub(super) fn can_begin_statement(&self) -> bool {
        match self.kind {
            TokenKind::Word => !keywords::has(self.text, keywords::CONTINUES),
            TokenKind::Quoted | TokenKind::Number | TokenKind::String | TokenKind::Open => true,
            TokenKind::Command => true,
            TokenKind::Close | TokenKind::Separator | TokenKind::Operator => false,
        }
    }

    pub(super) fn can_end_statement(&self) -> bool {
        match self.kind {
            TokenKind::Word => !keywords::has(self.text, keywords::LEAVES_OPEN),
            TokenKind::Quoted | TokenKind::Number | TokenKind::String | TokenKind::Close => true,
            TokenKind::Command => true,
            TokenKind::Open | TokenKind::Separator | TokenKind::Operator => false,
        }
    }
}

pub(super) struct Tokens<'t> {
    source: SourceId,
    text: &'t str,
    at: usize,
}

impl<'t> Tokens<'t> {
    pub(super) fn new(source: SourceId, text: &'t str) -> Tokens<'t> {
        Tokens { source, text, at: 0 }
    }

    /// The next token. Comments before it are blanked in `out`.
    pub(super) fn next(
        &mut self,
        place: CommandPlace,
        out: &mut [u8],
    ) -> Result<Option<Token<'t>>, Diagnostic> {
        let line_end = self.skip_blanks(out)?;
        let command = match place {
            CommandPlace::Here => true,
            CommandPlace::AfterLineEnd => line_end.is_some(),
            CommandPlace::Nowhere => false,
        };
        let start = self.at;
        let Some(&first) = self.text.as_bytes().get(start) else { return Ok(None) };
        let kind = match first {
            b'a'..=b'z' | b'A'..=b'Z' | b'_' => self.word(command),
            b'@' if command => self.run_command(),
            b'$' if self.quotes() => self.single(TokenKind::Operator),
            b'0'..=b'9' => self.number(),
            b'.' if self.peek(1).is_some_and(|byte| byte.is_ascii_digit()) => self.number(),
            b'"' => self.delimited(b'"', TokenKind::String)?,
            b'\'' => self.delimited(b'\'', TokenKind::Quoted)?,
            b'(' | b'[' | b'{' => self.single(TokenKind::Open),
            b')' | b']' | b'}' => self.single(TokenKind::Close),
            b',' | b';' => self.single(TokenKind::Separator),
            b'+' | b'-' | b'*' | b'/' | b'^' | b'<' | b'>' | b'=' | b':' | b'.' => {
                self.single(TokenKind::Operator)
            }
            _ => return Err(self.bad_character()),
        };
        let text = &self.text[start..self.at];
        Ok(Some(Token { kind, text, start, end: self.at, line_end }))
    }

    fn peek(&self, ahead: usize) -> Option<u8> {
        self.text.as_bytes().get(self.at + ahead).copied()
    }

    /// The rest of a line.
    pub(super) fn line_from(&self, start: usize) -> &'t str {
        self.text[start..].lines().next().unwrap_or("")
    }

    /// Whether `$TypeName`, `$Code` or `$annotation` is here.
    fn quotes(&self) -> bool {
        let rest = &self.text[self.at + 1..];
        ["TypeName(", "Code(", "annotation("].iter().any(|word| rest.starts_with(word))
    }

    fn single(&mut self, kind: TokenKind) -> TokenKind {
        self.at += 1;
        kind
    }

    /// Skips white space and comments; returns the first line end met.
    fn skip_blanks(&mut self, out: &mut [u8]) -> Result<Option<usize>, Diagnostic> {
        let mut line_end = None;
        while let Some(byte) = self.peek(0) {
            match byte {
                b'\n' => {
                    line_end.get_or_insert(self.at);
                    self.at += 1;
                }
                b' ' | b'\t' | b'\r' | 0x0b | 0x0c => self.at += 1,
                b'/' if self.peek(1) == Some(b'/') => self.line_comment(out),
                b'/' if self.peek(1) == Some(b'*') => self.block_comment(out)?,
                0x80.. => match self.text[self.at..].chars().next() {
                    Some(blank @ ('\u{feff}' | '\u{a0}')) => self.blank(blank.len_utf8(), out),
                    _ => break,
                },
                _ => break,
            }
        }
        Ok(line_end)
    }

    fn blank(&mut self, length: usize, out: &mut [u8]) {
        out[self.at..self.at + length].fill(b' ');
        self.at += length;
    }

    fn line_comment(&mut self, out: &mut [u8]) {
        let rest = &self.text[self.at..];
        self.blank(rest.find('\n').unwrap_or(rest.len()), out);
    }

    fn block_comment(&mut self, out: &mut [u8]) -> Result<(), Diagnostic> {
        let Some(length) = self.text[self.at + 2..].find("*/") else {
            return Err(self.unclosed("comment", "*/", 2));
        };
        self.blank(length + 4, out);
        Ok(())
    }

    fn word(&mut self, command: bool) -> TokenKind {
        let rest = &self.text.as_bytes()[self.at..];
        let length = rest
            .iter()
            .position(|byte| !byte.is_ascii_alphanumeric() && *byte != b'_')
            .unwrap_or(rest.len());
        let word = &self.text[self.at..self.at + length];
        self.at += length;
        if command && matches!(word, "cd" | "clear" | "clearlog" | "exit" | "experiment") {
            return self.command(word);
        }
        TokenKind::Word
    }

    /// Reads the argument of a bare command, if it is one: only `cd` and `experiment` have any.
    fn command(&mut self, word: &str) -> TokenKind {
        let line = &self.text[self.at..];
        let line = &line[..line.find(['\n', ';']).unwrap_or(line.len())];
        let argument = line.trim_start_matches([' ', '\t', '\r']);
        let blanks = line.len() - argument.len();
        let comment = argument.starts_with("//") || argument.starts_with("/*");
        let empty = argument.is_empty() || comment;
        let is_path = matches!(word, "cd" | "experiment")
            && blanks > 0
            && !argument.starts_with(['(', '=', '['])
            && !argument.starts_with(":=");
        if !empty && !is_path || empty && word == "experiment" {
            return TokenKind::Word;
        }
        if !empty {
            let length = [" //", "\t//", " /*"].iter().filter_map(|mark| line[blanks..].find(mark));
            self.at += blanks + length.min().unwrap_or(argument.trim_end().len());
        }
        TokenKind::Command
    }

    /// `@script.mos` runs a script: the rest of the line is its name.
    fn run_command(&mut self) -> TokenKind {
        let line = &self.text[self.at..];
        let line = &line[..line.find(['\n', ';']).unwrap_or(line.len())];
        let comment = ["//", "/*"].iter().filter_map(|mark| line.find(mark)).min();
        self.at += line[..comment.unwrap_or(line.len())].trim_end().len();
        TokenKind::Command
    }

    fn number(&mut self) -> TokenKind {
        self.digits();
        if self.peek(0) == Some(b'.') {
            self.at += 1;
            self.digits();
        }
        if matches!(self.peek(0), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(self.peek(1), Some(b'+' | b'-')));
            if self.peek(1 + sign).is_some_and(|byte| byte.is_ascii_digit()) {
                self.at += 1 + sign;
                self.digits();
            }
        }
        TokenKind::Number
    }

    fn digits(&mut self) {
        while self.peek(0).is_some_and(|byte| byte.is_ascii_digit()) {
            self.at += 1;
        }
    }

    fn delimited(&mut self, quote: u8, kind: TokenKind) -> Result<TokenKind, Diagnostic> {
        let bytes = self.text.as_bytes();
        let mut at = self.at + 1;
        while let Some(&byte) = bytes.get(at) {
            match byte {
                b'\\' => at += 2,
                b'\n' if quote == b'\'' => break,
                _ if byte == quote => {
                    self.at = at + 1;
                    return Ok(kind);
                }
                _ => at += 1,
            }
        }
        let word = self.word_before();
        if quote == b'\'' && !word.is_empty() {
            return Err(fault!(UNCLOSED_STRING, "`'` after a name is not a derivative")
                .help(format!("write `der({word})` for the derivative of `{word}`"))
                .at(Span::new(self.source, self.at, self.at + 1)));
        }
        let what = if quote == b'"' { "string" } else { "quoted identifier" };
        Err(self.unclosed(what, &char::from(quote).to_string(), 1))
    }

    /// The name that ends directly before this place.
    fn word_before(&self) -> &'t str {
        let head = &self.text[..self.at];
        &head[head.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_').len()..]
    }

    fn unclosed(&self, what: &str, close: &str, length: usize) -> Diagnostic {
        fault!(UNCLOSED_STRING, "this {what} has no end")
            .help(format!("write `{close}` at the end of the {what}"))
            .labelled(Span::new(self.source, self.at, self.at + length), "it starts here")
    }

    fn bad_character(&self) -> Diagnostic {
        let rest = &self.text[self.at..];
        let character = rest.chars().next().unwrap_or(' ');
        let known = REMEDIES.iter().find(|(wrong, _)| rest.starts_with(wrong));
        let length = known.map_or(character.len_utf8(), |(wrong, _)| wrong.len());
        let shown = &rest[..length];
        let fault = if character.is_control() {
            fault!(
                BAD_CHARACTER,
                "the control character {} is not allowed here",
                character.escape_unicode()
            )
        } else {
            fault!(BAD_CHARACTER, "the character `{shown}` is not allowed here")
        };
        let line = rest.lines().next().unwrap_or_default();
        let help = match known {
            Some(("|", _)) if line.matches('|').count() == 2 => {
                let inner = line.split('|').nth(1).unwrap_or_default();
                format!("write `abs({inner})` for an absolute value, `or` between conditions")
            }
            Some((_, remedy)) => format!("write `{remedy}`"),
            None if character.is_alphabetic() => {
                "identifiers contain only the letters `a` to `z`; quote it: `'...'`".to_owned()
            }
            None => "it is allowed only in strings, comments and quoted identifiers".to_owned(),
        };
        fault.help(help).at(Span::new(self.source, self.at, self.at + length))
    }
}

/// What others write, and what Modelica writes.
const REMEDIES: &[(&str, &str)] = &[
    ("!=", "<>"),
    ("~=", "<>"),
    ("!", "not"),
    ("~", "not"),
    ("&&", "and"),
    ("&", "and"),
    ("||", "or"),
    ("|", "or"),
    ("%", "//"),
    ("#", "//"),
    ("\u{201c}", "\""),
    ("\u{201d}", "\""),
    ("\u{2018}", "'"),
    ("\u{2019}", "'"),
    ("\u{2013}", "-"),
    ("\u{2212}", "-"),
    ("\u{d7}", "*"),
    ("\u{b7}", "*"),
];
