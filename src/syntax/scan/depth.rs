//! How deep the tree of an expression will be, from its tokens.

use super::tokens::{Token, TokenKind};

/// Depth that is still read: later stages walk trees by recursion.
const MAX_DEPTH: usize = 500;

/// The tokens of one bracket, or of one statement outside brackets.
#[derive(Debug, Clone, Copy, Default)]
struct Level {
    /// Operators since the last separator: each makes the tree one deeper.
    operators: usize,
    /// Depth of the deepest bracket since the last separator.
    inner: usize,
    /// Depth of the deepest part before the last separator.
    before: usize,
}

impl Level {
    fn depth(self) -> usize {
        self.before.max(self.operators + self.inner)
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
                let depth = self.levels.pop().map_or(0, Level::depth) + 1;
                let level = self.innermost();
                level.inner = level.inner.max(depth);
            }
            TokenKind::Separator => {
                let level = self.innermost();
                *level = Level { before: level.depth(), ..Level::default() };
            }
            TokenKind::Operator if !matches!(token.text, "." | ":" | "=") => {
                self.innermost().operators += 1;
            }
            TokenKind::Word if matches!(token.text, "and" | "or" | "not" | "if") => {
                self.innermost().operators += 1;
            }
            _ => {}
        }
        self.innermost().depth() <= MAX_DEPTH
    }

    fn innermost(&mut self) -> &mut Level {
        if self.levels.is_empty() {
            self.levels.push(Level::default());
        }
        let last = self.levels.len() - 1;
        &mut self.levels[last]
    }
}
