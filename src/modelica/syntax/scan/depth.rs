//! How deep the tree of an expression will be, from its tokens.
//!
//! The terms of a sum and the factors of a product are a list in the grammar (MLS §A.2.7,
//! `arithmetic_expression`), and generated code has long ones: the nesting counts such a list once. The
//! tree has a level for each of them, since it leans to the left; its levels are limited as well.

use super::tokens::{Token, TokenKind};

/// Nesting that is still read: later stages walk trees by recursion.
const MAX_NESTING: usize = 500;

/// Levels of the tree that are still read: measured in a debug build with stacks of 256 MB, as the
/// commands have them.
const MAX_LEVELS: usize = if cfg!(target_family = "wasm") { MAX_NESTING } else { 5_000 };

/// How deep a part is.
#[derive(Debug, Clone, Copy, Default)]
struct Height {
    /// With a list of terms or factors as one.
    nesting: usize,
    /// With every operator.
    levels: usize,
}

impl Height {
    fn max(self, other: Height) -> Height {
        Height { nesting: self.nesting.max(other.nesting), levels: self.levels.max(other.levels) }
    }

    /// Under a list of so many operators.
    fn under(self, operators: usize) -> Height {
        let nesting = self.nesting + usize::from(operators > 0);
        Height { nesting, levels: self.levels + operators }
    }
}

/// The tokens of one bracket, or of one statement outside brackets.
#[derive(Debug, Clone, Copy, Default)]
struct Level {
    /// Operators since the last separator that each make the tree one deeper.
    operators: usize,
    /// `+` and `-` since the last separator.
    sums: usize,
    /// `*` and `/` since the last `+`, `-` or separator.
    products: usize,
    /// The deepest term before the last `+` or `-`.
    term: Height,
    /// The deepest bracket since then.
    inner: Height,
    /// The deepest part before the last separator.
    before: Height,
}

impl Level {
    fn term(self) -> Height {
        self.term.max(self.inner.under(self.products))
    }

    fn height(self) -> Height {
        let Height { nesting, levels } = self.term().under(self.sums);
        let part = Height { nesting: nesting + self.operators, levels: levels + self.operators };
        self.before.max(part)
    }

    fn add(&mut self) {
        let term = self.term();
        *self = Level { sums: self.sums + 1, products: 0, term, inner: Height::default(), ..*self };
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
        match token.kind {
            TokenKind::Open => self.levels.push(Level::default()),
            TokenKind::Close if self.levels.len() > 1 => {
                let closed = self.levels.pop().map_or(Height::default(), Level::height);
                let closed = Height { nesting: closed.nesting + 1, levels: closed.levels + 1 };
                let level = self.innermost();
                level.inner = level.inner.max(closed);
            }
            TokenKind::Separator => {
                let level = self.innermost();
                *level = Level { before: level.height(), ..Level::default() };
            }
            TokenKind::Operator => match token.text {
                "." | ":" | "=" => {}
                "+" | "-" | ".+" | ".-" => self.innermost().add(),
                "*" | "/" | ".*" | "./" => self.innermost().products += 1,
                _ => self.innermost().operators += 1,
            },
            TokenKind::Word if matches!(token.text, "and" | "or" | "not" | "if") => {
                self.innermost().operators += 1;
            }
            _ => {}
        }
        let Height { nesting, levels } = self.innermost().height();
        nesting <= MAX_NESTING && levels <= MAX_LEVELS
    }

    fn innermost(&mut self) -> &mut Level {
        if self.levels.is_empty() {
            self.levels.push(Level::default());
        }
        let last = self.levels.len() - 1;
        &mut self.levels[last]
    }
}
