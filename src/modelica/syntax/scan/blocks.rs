//! Which classes, loops and clauses are open, and whether a statement begins here.

use super::Problem;
use super::tokens::{Token, TokenKind};
use crate::diag::Diagnostic;
use crate::fault;
use crate::source::{SourceId, Span};
use crate::syntax::errors::MISMATCHED_END;

const CLASS_WORDS: &[&str] =
    &["class", "model", "block", "record", "connector", "type", "package", "function", "operator"];

const SECTION_WORDS: &[&str] = &["equation", "algorithm", "public", "protected"];

/// A class, loop or clause that waits for its `end`.
struct Block<'t> {
    /// The keyword, or `""` for a class.
    keyword: &'t str,
    /// Keyword or class name: what follows `end`.
    name: &'t str,
    start: usize,
    end: usize,
    /// Whether `then` or `loop` ended its head.
    has_body: bool,
    /// An `if` directly after the `else` of this one.
    else_if: Option<Span>,
}

/// How much of a class's head was read.
enum Head<'t> {
    None,
    /// `model`
    Keyword,
    /// `model extends`
    Extends,
    /// `model M`
    Name(Token<'t>),
}

pub(super) struct Blocks<'t> {
    source: SourceId,
    stack: Vec<Block<'t>>,
    classes: usize,
    head: Head<'t>,
    /// Whether the next token begins a statement.
    start: bool,
    /// Between `for`, `if`, … and `loop` or `then`.
    header: bool,
    /// Directly after the `else` of a clause.
    after_else: bool,
}

impl<'t> Blocks<'t> {
    /// `start`: the text begins with a statement or element.
    pub(super) fn new(source: SourceId, start: bool) -> Blocks<'t> {
        Blocks {
            source,
            stack: Vec::new(),
            classes: 0,
            head: Head::None,
            start,
            header: false,
            after_else: false,
        }
    }

    pub(super) fn len(&self) -> usize {
        self.stack.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.stack.is_empty()
    }

    pub(super) fn in_class(&self) -> bool {
        self.classes > 0
    }

    pub(super) fn in_header(&self) -> bool {
        self.header
    }

    /// Whether a statement begins here, line ends aside.
    pub(super) fn at_start(&self) -> bool {
        self.start
    }

    pub(super) fn leave_start(&mut self) {
        self.start = false;
    }

    pub(super) fn end_statement(&mut self) {
        self.start = true;
        self.header = false;
        self.head = Head::None;
    }

    /// Follows the head of a class up to the token after its name, which distinguishes a long class
    /// from a short one.
    pub(super) fn name_class(&mut self, token: &Token<'t>) {
        let word = matches!(token.kind, TokenKind::Word | TokenKind::Quoted);
        self.head = match std::mem::replace(&mut self.head, Head::None) {
            Head::None => Head::None,
            Head::Keyword if token.is("extends") => Head::Extends,
            Head::Keyword if CLASS_WORDS.contains(&token.text) => Head::None,
            Head::Keyword if word => Head::Name(*token),
            Head::Keyword => Head::None,
            Head::Extends => {
                if word {
                    self.push_class(token);
                }
                Head::None
            }
            Head::Name(name) => {
                if token.text != "=" {
                    self.push_class(&name);
                }
                Head::None
            }
        };
    }

    fn push_class(&mut self, name: &Token<'t>) {
        self.classes += 1;
        self.stack.push(Block {
            keyword: "",
            name: name.text,
            start: name.start,
            end: name.end,
            has_body: true,
            else_if: None,
        });
        self.start = true;
        self.header = false;
    }

    /// Takes a word outside brackets into account.
    pub(super) fn word(&mut self, token: &Token<'t>, after_end: bool) -> Result<(), Problem> {
        let at_start = std::mem::replace(&mut self.start, false);
        let after_else = std::mem::replace(&mut self.after_else, false);
        match token.text {
            _ if after_end => return self.close(token),
            "for" | "if" | "while" | "when" if at_start => {
                let block = Block {
                    keyword: token.text,
                    name: token.text,
                    start: token.start,
                    end: token.end,
                    has_body: false,
                    else_if: None,
                };
                if let Some(outer) = self.stack.last_mut()
                    && after_else
                    && token.text == "if"
                {
                    outer.else_if = Some(Span::new(self.source, token.start, token.end));
                }
                self.stack.push(block);
                self.header = true;
            }
            "elseif" | "elsewhen" if at_start => self.header = true,
            "else" if at_start => {
                self.start = true;
                self.after_else = true;
            }
            "then" | "loop" if self.header => {
                self.header = false;
                self.start = true;
                if let Some(block) = self.stack.last_mut() {
                    block.has_body = true;
                }
            }
            word if SECTION_WORDS.contains(&word) => self.start = true,
            word if CLASS_WORDS.contains(&word) => self.head = Head::Keyword,
            _ => {}
        }
        Ok(())
    }

    fn close(&mut self, token: &Token<'t>) -> Result<(), Problem> {
        let span = Span::new(self.source, token.start, token.end);
        let Some(block) = self.stack.pop() else {
            let diagnostic = fault!(MISMATCHED_END, "`end {}` does not close anything", token.text)
                .help("remove it, or write the construct that it closes before it")
                .labelled(span, "no construct of this name is open here");
            return Err(Problem { from: token.start, diagnostic });
        };
        self.classes -= usize::from(block.keyword.is_empty());
        if block.name == token.text {
            return Ok(());
        }
        if let Some(inner) = block.else_if {
            return Err(Problem { from: token.start, diagnostic: else_if(inner) });
        }
        let diagnostic =
            fault!(MISMATCHED_END, "{} is closed by `end {}`", described(&block), token.text)
                .help(format!(
                    "write `end {}`, or close the constructs opened in between",
                    block.name
                ))
                .labelled(span, format!("expected `{}`", block.name))
                .related(Span::new(self.source, block.start, block.end), "opened here");
        Err(Problem { from: token.start, diagnostic })
    }

    /// The innermost block that the text leaves open.
    pub(super) fn unclosed(&self, end: usize) -> Option<Problem> {
        let block = self.stack.last()?;
        if let Some(inner) = block.else_if {
            return Some(Problem { from: end, diagnostic: else_if(inner) });
        }
        let diagnostic = fault!(MISMATCHED_END, "{} has no `end {}`", described(block), block.name)
            .help_if(headless(block))
            .help(format!("write `end {};` at its end", block.name))
            .labelled(Span::new(self.source, block.start, block.end), "opened here");
        Some(Problem { from: end, diagnostic })
    }
}

/// What ends the head of a loop or clause, where nothing does.
fn headless(block: &Block<'_>) -> Option<String> {
    let (word, example) = match block.keyword {
        "for" => ("loop", "for k in 1:3 loop"),
        "while" => ("loop", "while x < 2 loop"),
        "if" => ("then", "if x == 2 then"),
        "when" => ("then", "when x > 2 then"),
        _ => return None,
    };
    (!block.has_body).then(|| format!("write `{word}` at the end of its first line: `{example}`"))
}

/// The usual cause of an `if` that stays open.
fn else_if(inner: Span) -> Diagnostic {
    fault!(MISMATCHED_END, "the nested `if` of `else if` has no `end if`")
        .help("write `elseif`, which does not need one")
        .at(inner)
}

fn described(block: &Block<'_>) -> String {
    match block.keyword {
        "" => format!("class `{}`", block.name),
        keyword => format!("this `{keyword}`"),
    }
}
