//! What is done to a text before the grammar reads it.
//!
//! One pass over the characters blanks comments (so that the grammar has none and a place never
//! includes one), replaces the line ends that close a statement of a script by [`LINE_END`],
//! matches brackets and `end`s, and bounds the nesting, because the grammar is read by recursion.
//! Every replacement keeps the number of bytes: a place in the scanned text is a place in the
//! original.

mod blocks;
mod depth;
mod lexemes;
mod tokens;

use crate::diag::Diagnostic;
use crate::fault;
use crate::source::{SourceId, Span};
use crate::syntax::errors::{NESTING_TOO_DEEP, NOT_A_SCRIPT, TEXT_TOO_LARGE, UNCLOSED_BRACKET};
use blocks::Blocks;
use depth::Depth;
use lexemes::Follows;
pub use lexemes::{Lexeme, LexemeKind};
use std::ops::Range;
use tokens::{CommandPlace, Token, TokenKind, Tokens};

/// Stands for a line end that closes a statement of a script.
const LINE_END: u8 = 0x1e;

/// Brackets and blocks inside each other that are still read.
const MAX_NESTING: usize = 200;

/// Whether line ends count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Dialect {
    /// Classes: they do not.
    Modelica,
    /// Scripts: they do, outside classes.
    Script,
    /// A piece of Modelica that is not a statement: `if` is a conditional expression.
    Fragment,
}

/// Bytes of a piece of a script that is read by itself. The grammar's answer takes a hundred times
/// as much; pieces of this size stay in the processor's cache.
const PIECE: usize = 1 << 16;

/// A text made ready for the grammar.
#[derive(Debug)]
pub(super) struct Scanned {
    /// As long as the original.
    pub(super) text: String,
    /// A bracket or `end` without its partner: an error wherever the grammar stops.
    pub(super) problem: Option<Problem>,
    /// Where statements of a script end, outside everything, at least [`PIECE`] bytes apart.
    ends: Vec<usize>,
}

impl Scanned {
    /// A part of a scanned text.
    pub(super) fn part(text: String) -> Scanned {
        Scanned { text, problem: None, ends: Vec::new() }
    }

    /// The parts of the text that can be read one by one; the whole of one with a problem.
    pub(super) fn pieces(&self) -> Vec<Range<usize>> {
        let ends = if self.problem.is_some() { &[][..] } else { &self.ends };
        let starts = std::iter::once(0).chain(ends.iter().copied());
        let ends = ends.iter().copied().chain([self.text.len()]);
        starts.zip(ends).map(|(start, end)| start..end).collect()
    }
}

/// A structural error. If the grammar stops before `from`, that is another error, and the first.
#[derive(Debug)]
pub(super) struct Problem {
    pub(super) from: usize,
    pub(super) diagnostic: Diagnostic,
}

/// Makes a text ready for the grammar; an error where the grammar would have nothing to read.
pub(super) fn scan(source: SourceId, text: &str, dialect: Dialect) -> Result<Scanned, Diagnostic> {
    if text.len() >= u32::MAX as usize {
        return Err(fault!(TEXT_TOO_LARGE, "the text has {} bytes", text.len())
            .help("check the file name, or split the text")
            .at(Span::new(source, 0, 0)));
    }
    if dialect == Dialect::Script {
        refuse_table(source, text)?;
    }
    Scanner::new(source, text, dialect).run()
}

/// The tokens and comments of a text.
///
/// # Errors
/// A string or comment without end, a bracket or `end` without its partner, a foreign character.
pub(super) fn lexemes(
    source: SourceId,
    text: &str,
    dialect: Dialect,
) -> Result<Vec<Lexeme>, Diagnostic> {
    let mut scanner = Scanner::new(source, text, dialect);
    scanner.kept = Some(Vec::new());
    scanner.read()?;
    match scanner.problem {
        Some(problem) => Err(problem.diagnostic),
        None => Ok(lexemes::with_comments(text, scanner.kept.unwrap_or_default())),
    }
}

/// Refuses table data that carries the ending `.mos`.
fn refuse_table(source: SourceId, text: &str) -> Result<(), Diagnostic> {
    let start = text.len() - text.trim_start_matches(['\u{feff}', ' ', '\t', '\r', '\n']).len();
    let line = text[start..].lines().next().unwrap_or("");
    if line.starts_with("#1") || is_table_header(line) {
        return Err(fault!(NOT_A_SCRIPT, "this is table data, not a script")
            .help("read it as data, for instance with `readMatrix`, and run another file")
            .at(Span::new(source, start, start + line.trim_end().len())));
    }
    Ok(())
}

/// Whether the line reads `double name(rows,columns)`.
fn is_table_header(line: &str) -> bool {
    let Some(rest) = ["double ", "float ", "char "].iter().find_map(|word| line.strip_prefix(word))
    else {
        return false;
    };
    let Some((_, rest)) = rest.split_once('(') else { return false };
    let Some((sizes, _)) = rest.split_once(')') else { return false };
    sizes.chars().all(|c| c.is_ascii_digit() || c == ',' || c == ' ') && sizes.contains(',')
}

struct Bracket {
    at: usize,
    open: u8,
}

struct Scanner<'t> {
    source: SourceId,
    dialect: Dialect,
    tokens: Tokens<'t>,
    out: Vec<u8>,
    brackets: Vec<Bracket>,
    blocks: Blocks<'t>,
    depth: Depth,
    /// `if` of conditional expressions at bracket depth zero whose `else` is to come.
    awaiting_else: usize,
    /// The same for their `then`.
    awaiting_then: usize,
    previous: Option<Token<'t>>,
    problem: Option<Problem>,
    ends: Vec<usize>,
    /// The tokens, if they are to be kept.
    kept: Option<Vec<Lexeme>>,
}

impl<'t> Scanner<'t> {
    fn new(source: SourceId, text: &'t str, dialect: Dialect) -> Scanner<'t> {
        Scanner {
            source,
            dialect,
            tokens: Tokens::new(source, text),
            out: text.as_bytes().to_vec(),
            brackets: Vec::new(),
            blocks: Blocks::new(source, dialect != Dialect::Fragment),
            depth: Depth::new(),
            awaiting_else: 0,
            awaiting_then: 0,
            previous: None,
            problem: None,
            ends: Vec::new(),
            kept: None,
        }
    }

    fn run(mut self) -> Result<Scanned, Diagnostic> {
        self.read()?;
        let text = String::from_utf8(self.out)
            .unwrap_or_else(|_| unreachable!("only whole characters are replaced, by ASCII"));
        Ok(Scanned { text, problem: self.problem, ends: self.ends })
    }

    fn read(&mut self) -> Result<(), Diagnostic> {
        while let Some(token) = self.next_token()? {
            self.step(token)?;
        }
        self.finish();
        Ok(())
    }

    fn next_token(&mut self) -> Result<Option<Token<'t>>, Diagnostic> {
        self.tokens.next(self.command_place(), &mut self.out)
    }

    fn command_place(&self) -> CommandPlace {
        if self.dialect == Dialect::Modelica || !self.brackets.is_empty() || !self.blocks.is_empty()
        {
            CommandPlace::Nowhere
        } else if self.blocks.at_start() {
            CommandPlace::Here
        } else if self.previous.is_some_and(|previous| previous.can_end_statement()) {
            CommandPlace::AfterLineEnd
        } else {
            CommandPlace::Nowhere
        }
    }

    fn step(&mut self, token: Token<'t>) -> Result<(), Diagnostic> {
        let mut follows = Follows::Token;
        if self.brackets.is_empty() {
            self.blocks.name_class(&token);
            if self.begins_with_sign(&token) {
                follows = Follows::Line;
            }
            if self.ends_line(&token) {
                follows = Follows::Statement;
                let end = token.line_end.unwrap_or(token.start);
                self.out[end] = LINE_END;
                self.end_statement();
                self.end_piece(end + 1);
            }
        }
        let mut in_condition = false;
        match token.kind {
            TokenKind::Open => self.open(&token),
            TokenKind::Close => self.close(&token),
            TokenKind::Separator if token.text == ";" => self.semicolon(&token),
            TokenKind::Word | TokenKind::Quoted => in_condition = self.word(&token),
            _ => self.blocks.leave_start(),
        }
        if let Some(kept) = &mut self.kept {
            kept.push(Lexeme::of(&token, follows, in_condition));
        }
        self.previous = Some(token);
        self.check_depth(&token)
    }

    /// Whether a line end before the token closes a statement.
    fn ends_line(&self, token: &Token<'t>) -> bool {
        self.follows_line(token)
            && !(self.awaiting_else > 0 && matches!(token.text, "else" | "elseif"))
            && token.can_begin_statement()
    }

    /// Whether the token is a sign that begins a line and could have begun a statement.
    fn begins_with_sign(&self, token: &Token<'t>) -> bool {
        self.follows_line(token) && matches!(token.text, "+" | "-")
    }

    /// Whether a line end of a script before the token could close a statement.
    fn follows_line(&self, token: &Token<'t>) -> bool {
        self.dialect == Dialect::Script
            && token.line_end.is_some()
            && !self.blocks.in_class()
            && !self.blocks.in_header()
            && self.previous.is_some_and(|previous| previous.can_end_statement())
    }

    fn end_statement(&mut self) {
        self.blocks.end_statement();
        self.awaiting_else = 0;
        self.awaiting_then = 0;
        self.depth.end_statement();
    }

    /// Takes a word into account; whether it belongs to a conditional expression.
    fn word(&mut self, token: &Token<'t>) -> bool {
        if !self.brackets.is_empty() {
            return true;
        }
        if self.in_condition(token) {
            return true;
        }
        let after_end = self.after_end();
        if let Err(problem) = self.blocks.word(token, after_end) {
            self.report(problem.from, problem.diagnostic);
        }
        false
    }

    /// Whether the word belongs to a conditional expression, which is then followed.
    fn in_condition(&mut self, token: &Token<'t>) -> bool {
        match token.text {
            "if" if !self.after_end()
                && (!self.blocks.at_start() || self.is_conditional_expression(token)) =>
            {
                self.blocks.leave_start();
                self.awaiting_else += 1;
                self.awaiting_then += 1;
            }
            "elseif" if self.awaiting_else > 0 => self.awaiting_then += 1,
            "then" if self.awaiting_then > 0 => self.awaiting_then -= 1,
            "else" if self.awaiting_else > 0 => self.awaiting_else -= 1,
            _ => return false,
        }
        true
    }

    /// Whether the `if` that begins a statement of a script is an expression, `if a then b else c`:
    /// its line has the `else` of this `if` before anything that ends a statement.
    fn is_conditional_expression(&self, token: &Token<'t>) -> bool {
        if self.dialect != Dialect::Script || self.blocks.in_class() {
            return false;
        }
        let line = self.tokens.line_from(token.start);
        let mut tokens = Tokens::new(self.source, line);
        let (mut scratch, mut open) = (line.as_bytes().to_vec(), 0usize);
        let mut awaiting_else = 0usize;
        while let Ok(Some(next)) = tokens.next(CommandPlace::Nowhere, &mut scratch) {
            match (next.kind, next.text) {
                (TokenKind::Open, _) => open += 1,
                (TokenKind::Close, _) => open = open.saturating_sub(1),
                (TokenKind::Separator, ";") if open == 0 => return false,
                (TokenKind::Word, "end") if open == 0 => return false,
                (TokenKind::Word, "if") if open == 0 => awaiting_else += 1,
                (TokenKind::Word, "else") if open == 0 && awaiting_else > 1 => awaiting_else -= 1,
                (TokenKind::Word, "else") if open == 0 => {
                    let value = tokens.next(CommandPlace::Nowhere, &mut scratch);
                    return matches!(value, Ok(Some(_)));
                }
                _ => {}
            }
        }
        false
    }

    fn after_end(&self) -> bool {
        self.previous.is_some_and(|previous| previous.text == "end")
    }

    fn open(&mut self, token: &Token<'t>) {
        self.blocks.leave_start();
        self.brackets.push(Bracket { at: token.start, open: token.text.as_bytes()[0] });
    }

    fn close(&mut self, token: &Token<'t>) {
        self.blocks.leave_start();
        let Some(bracket) = self.brackets.pop() else {
            let message =
                fault!(UNCLOSED_BRACKET, "`{}` closes a bracket that was never opened", token.text)
                    .help(format!("remove `{}`, or open it first", token.text));
            return self.report(
                token.start,
                message.labelled(self.span(token.start, token.end), "no bracket is open here"),
            );
        };
        if closing(bracket.open) != token.text {
            self.unclosed(
                &bracket,
                token.start,
                token.end,
                &format!("`{}` found here", token.text),
            );
        }
    }

    fn semicolon(&mut self, token: &Token<'t>) {
        match self.brackets.last() {
            Some(bracket) if bracket.open == b'[' => {}
            Some(_) => {
                if let Some(bracket) = self.brackets.pop() {
                    let ends_here = self.tokens.line_from(token.end).contains('}');
                    match bracket.open == b'{' && ends_here {
                        true => self.separated_by_semicolons(token),
                        false => {
                            self.unclosed(
                                &bracket,
                                token.start,
                                token.end,
                                "the statement ends here",
                            );
                        }
                    }
                }
                self.brackets.clear();
                self.end_statement();
            }
            None => {
                self.end_statement();
                self.end_piece(token.end);
            }
        }
    }

    fn end_piece(&mut self, at: usize) {
        let before = self.ends.last().copied().unwrap_or(0);
        if at >= before + PIECE && self.dialect == Dialect::Script && self.blocks.is_empty() {
            self.ends.push(at);
        }
    }

    fn unclosed(&mut self, bracket: &Bracket, start: usize, end: usize, here: &str) {
        let open = char::from(bracket.open);
        let diagnostic = fault!(UNCLOSED_BRACKET, "`{open}` is not closed")
            .help(format!("write `{}` at the end of the bracket", closing(bracket.open)))
            .labelled(self.span(bracket.at, bracket.at + 1), "opened here")
            .related(self.span(start, end), here);
        self.report(bracket.at, diagnostic);
    }

    /// `{1; 2}`
    fn separated_by_semicolons(&mut self, token: &Token<'t>) {
        let diagnostic = fault!(UNCLOSED_BRACKET, "`;` does not separate elements in braces")
            .help("write `,` between them; rows of a matrix are in square brackets: `[1; 2; 3]`")
            .at(self.span(token.start, token.end));
        self.report(token.start, diagnostic);
    }

    fn finish(&mut self) {
        if let Some(bracket) = self.brackets.pop() {
            let end = self.out.len();
            self.unclosed(&bracket, end, end, "the text ends here");
        }
        if let Some(problem) = self.blocks.unclosed(self.out.len()) {
            self.report(problem.from, problem.diagnostic);
        }
    }

    fn report(&mut self, from: usize, diagnostic: Diagnostic) {
        self.problem.get_or_insert(Problem { from, diagnostic });
    }

    fn check_depth(&mut self, token: &Token<'t>) -> Result<(), Diagnostic> {
        let shallow = self.depth.take(token);
        if shallow && self.brackets.len() + self.blocks.len() <= MAX_NESTING {
            return Ok(());
        }
        Err(too_deep(self.span(token.start, token.end)))
    }

    fn span(&self, start: usize, end: usize) -> Span {
        Span::new(self.source, start, end)
    }
}

/// The error of a text nested too deeply.
fn too_deep(span: Span) -> Diagnostic {
    fault!(NESTING_TOO_DEEP, "this is nested too deeply")
        .help("split it: assign parts of the expression to variables")
        .at(span)
}

fn closing(open: u8) -> &'static str {
    match open {
        b'(' => ")",
        b'[' => "]",
        _ => "}",
    }
}
