//! How deep expressions are nested, from their tokens.
//!
//! The operands of `or` and `and`, the terms of a sum and the factors of a product are lists in the
//! grammar (MLS §A.2.7), and generated code has long ones: such a list is one level, however long
//! ([`Expression::chain`](crate::syntax::ast::Expression::chain)).

use super::tokens::{Token, TokenKind};

/// Nesting that is still read: later stages walk trees by recursion.
const MAX_NESTING: usize = 500;

const OR: u8 = 1;
const AND: u8 = 2;
const RELATION: u8 = 4;
const PRODUCT: u8 = 8;
const POWER: u8 = 16;

/// The tokens of one bracket, or of one statement outside brackets.
#[derive(Debug, Clone, Copy, Default)]
struct Level {
    /// Operators since the last separator that each make the tree one deeper.
    operators: usize,
    /// A bit for each precedence of operators since the last separator: lists of operands are within
    /// lists of operators that bind less tightly, and so the tree is at most one deeper for each.
    lists: u8,
    /// `+`, `-` and `not` in a row, until now and at most: all but the first are signs of signs.
    signs: usize,
    most_signs: usize,
    /// The deepest bracket since then.
    inner: usize,
    /// The deepest part before the last separator.
    before: usize,
}

impl Level {
    fn nesting(self) -> usize {
        let lists = self.lists.count_ones() as usize;
        self.before.max(self.inner + self.operators + lists + self.most_signs)
    }

    fn sign(&mut self) {
        self.signs += 1;
        self.most_signs = self.most_signs.max(self.signs);
    }
}

/// The levels that are open; the first is that outside brackets.
#[derive(Debug)]
pub(super) struct Depth {
    levels: Vec<Level>,
}

impl Depth {
    pub(super) fn new() -> Depth {
        Depth { levels: vec![Level::default()] }
    }

    /// A statement ends, whatever brackets are open.
    pub(super) fn end_statement(&mut self) {
        self.levels.clear();
        self.levels.push(Level::default());
    }

    /// Takes a token into account; whether the tree so far is shallow enough.
    pub(super) fn take(&mut self, token: &Token<'_>) -> bool {
        let is_sign = matches!(token.text, "+" | "-" | ".+" | ".-" | "not");
        if is_sign {
            self.innermost().sign();
        } else {
            self.innermost().signs = 0;
        }
        match token.kind {
            TokenKind::Open => self.levels.push(Level::default()),
            TokenKind::Close if self.levels.len() > 1 => {
                let closed = 1 + self.levels.pop().map_or(0, Level::nesting);
                let level = self.innermost();
                level.inner = level.inner.max(closed);
            }
            TokenKind::Separator => {
                let level = self.innermost();
                *level = Level { before: level.nesting(), ..Level::default() };
            }
            TokenKind::Operator => match token.text {
                "." | ":" | "=" => {}
                _ if is_sign => {}
                "*" | "/" | ".*" | "./" => self.list(PRODUCT),
                "^" | ".^" => self.list(POWER),
                "<" | "<=" | ">" | ">=" | "==" | "<>" => self.list(RELATION),
                _ => self.innermost().operators += 1,
            },
            TokenKind::Word => match token.text {
                "or" => self.list(OR),
                "and" => self.list(AND),
                "if" => self.innermost().operators += 1,
                _ => {}
            },
            _ => {}
        }
        self.innermost().nesting() <= MAX_NESTING
    }

    fn list(&mut self, precedence: u8) {
        self.innermost().lists |= precedence;
    }

    fn innermost(&mut self) -> &mut Level {
        if self.levels.is_empty() {
            self.levels.push(Level::default());
        }
        let last = self.levels.len() - 1;
        &mut self.levels[last]
    }
}
