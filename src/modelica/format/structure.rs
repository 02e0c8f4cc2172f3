//! Which lexemes begin a line, and how deep.
//!
//! The levels are those of classes and of the clauses of `if`, `for`, `while` and `when`; the
//! keywords of sections are as deep as the class. Words in brackets and in conditional expressions
//! are no such keywords, which the scanner has found out.

use super::{Language, Lexed};
use crate::syntax::LexemeKind;

/// What a lexeme is for the layout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Role {
    /// The level of a token that begins a line.
    pub(super) begins: Option<usize>,
    /// The level of a statement that would begin here.
    pub(super) level: usize,
    /// Brackets around it.
    pub(super) depth: usize,
    /// Whether a token `=` here belongs to an equation or an assignment.
    pub(super) in_equations: bool,
    /// Whether it is in an annotation.
    pub(super) in_annotation: bool,
}

/// The role of every lexeme.
pub(super) fn roles(lexed: &Lexed<'_>, language: Language) -> Vec<Role> {
    let mut walk = TokenCursor {
        lexed,
        language,
        blocks: Vec::new(),
        head: Head::None,
        at_start: true,
        after_end: false,
        depth: 0,
        annotation: false,
    };
    (0..lexed.lexemes.len()).map(|at| walk.role(at)).collect()
}

/// What is closed by `end`.
enum Block {
    /// A class; whether it is in a section of equations or statements.
    Class(bool),
    /// `if`, `for`, `while` or `when`.
    Clause,
}

/// How much of the head of a class was read.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Head {
    None,
    /// `model`
    Keyword,
    /// `model extends`
    Extends,
    /// `model M`: a long class unless `=` follows.
    Name,
    /// After the name of a long class, where its description may follow.
    Description,
}

const CLASS_WORDS: &[&str] =
    &["class", "model", "block", "record", "connector", "type", "package", "function", "operator"];

struct TokenCursor<'w> {
    lexed: &'w Lexed<'w>,
    language: Language,
    blocks: Vec<Block>,
    head: Head,
    /// Whether the next token begins a statement or an element.
    at_start: bool,
    after_end: bool,
    depth: usize,
    annotation: bool,
}

impl TokenCursor<'_> {
    fn role(&mut self, at: usize) -> Role {
        let lexeme = self.lexed.lexemes[at];
        if !lexeme.is_comment() {
            self.follow_head(at);
        }
        let begins =
            (!lexeme.is_comment() && self.depth == 0 && (self.at_start || lexeme.ends_line))
                .then(|| self.level_of(at));
        let role = Role {
            begins,
            level: self.blocks.len(),
            depth: self.depth,
            in_equations: self.in_equations(),
            in_annotation: self.annotation,
        };
        if !lexeme.is_comment() {
            self.take(at);
        }
        role
    }

    /// Sees whether the head of a class ends before this token.
    fn follow_head(&mut self, at: usize) {
        let (kind, text) = (self.lexed.lexemes[at].kind, self.lexed.str(at));
        let is_name = matches!(kind, LexemeKind::Word | LexemeKind::Quoted);
        if self.depth > 0 {
            return;
        }
        self.head = match self.head {
            Head::Keyword if text == "extends" => Head::Extends,
            Head::Keyword if CLASS_WORDS.contains(&text) => Head::None,
            Head::Keyword if is_name => Head::Name,
            Head::Keyword => Head::None,
            Head::Extends => {
                self.blocks.push(Block::Class(false));
                return self.head = Head::Description;
            }
            Head::Name if text == "=" => Head::None,
            Head::Name => {
                self.blocks.push(Block::Class(false));
                self.described(at)
            }
            Head::Description => self.described(at),
            Head::None => Head::None,
        };
    }

    /// After the name of a long class: a description, a modification, or the first element.
    fn described(&mut self, at: usize) -> Head {
        let kind = self.lexed.lexemes[at].kind;
        let continues = match kind {
            LexemeKind::String => true,
            LexemeKind::Open | LexemeKind::Close => true,
            LexemeKind::Operator => self.lexed.str(at) == "+",
            _ => false,
        };
        if continues {
            return Head::Description;
        }
        self.at_start = true;
        Head::None
    }

    fn in_equations(&self) -> bool {
        let classes = |block: &&Block| matches!(block, Block::Class(_));
        match self.blocks.iter().rev().find(classes) {
            Some(Block::Class(equations)) => *equations && self.depth == 0,
            _ => self.language == Language::Script && self.depth == 0,
        }
    }

    /// The level of a token that begins a line.
    fn level_of(&self, at: usize) -> usize {
        let level = self.blocks.len();
        let outer = match self.lexed.str(at) {
            _ if self.lexed.lexemes[at].kind != LexemeKind::Word => false,
            "end" | "else" | "elseif" | "elsewhen" => true,
            "initial" => self.is_section(at),
            word => is_section_word(word) && level > 0,
        };
        level - usize::from(outer && level > 0)
    }

    /// Whether `initial` begins a section.
    fn is_section(&self, at: usize) -> bool {
        let next =
            (at + 1..self.lexed.lexemes.len()).find(|next| !self.lexed.lexemes[*next].is_comment());
        next.is_some_and(|next| matches!(self.lexed.str(next), "equation" | "algorithm"))
    }

    fn take(&mut self, at: usize) {
        let lexeme = self.lexed.lexemes[at];
        let was_start = std::mem::replace(&mut self.at_start, false) || lexeme.ends_line;
        let after_end = std::mem::replace(&mut self.after_end, false);
        match lexeme.kind {
            LexemeKind::Open => self.depth += 1,
            LexemeKind::Close => self.depth = self.depth.saturating_sub(1),
            LexemeKind::Semicolon if self.depth == 0 => {
                self.at_start = true;
                self.annotation = false;
            }
            LexemeKind::Word | LexemeKind::Quoted if after_end => _ = self.blocks.pop(),
            LexemeKind::Word if self.depth == 0 && !lexeme.in_expression => {
                self.word(self.lexed.str(at), was_start);
            }
            _ => {}
        }
        // A statement of a script that a line end closes.
        if lexeme.ends_line && self.lexed.str(at) != "annotation" {
            self.annotation = false;
        }
    }

    fn word(&mut self, word: &str, was_start: bool) {
        match word {
            "end" => self.after_end = true,
            "annotation" => self.annotation = true,
            "for" | "if" | "while" | "when" if was_start => self.blocks.push(Block::Clause),
            "then" | "loop" | "else" => self.at_start = true,
            "equation" | "algorithm" | "public" | "protected" => {
                self.at_start = true;
                if let Some(Block::Class(equations)) = self.blocks.last_mut() {
                    *equations = matches!(word, "equation" | "algorithm");
                }
            }
            _ if CLASS_WORDS.contains(&word) => self.head = Head::Keyword,
            _ => {}
        }
    }
}

fn is_section_word(word: &str) -> bool {
    matches!(word, "equation" | "algorithm" | "public" | "protected")
}
