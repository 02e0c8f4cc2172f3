//! Blanks between the lexemes of a line.
//!
//! What all authors write alike is made alike; what they choose, such as blanks around an operator,
//! is kept as long as it is the same on both sides.

use super::Lexed;
use super::structure::Role;
use crate::syntax::LexemeKind;
use crate::syntax::keywords::{self, SET_OFF};

/// The number of blanks before every lexeme, if it does not begin a line.
pub(super) fn blanks(lexed: &Lexed<'_>, roles: &[Role]) -> Vec<usize> {
    (0..lexed.lexemes.len()).map(|at| Gap { lexed, roles, at }.blanks()).collect()
}

/// What is between a lexeme and the one before it.
struct Gap<'g> {
    lexed: &'g Lexed<'g>,
    roles: &'g [Role],
    at: usize,
}

impl Gap<'_> {
    fn kind(&self, at: usize) -> LexemeKind {
        self.lexed.lexemes[at].kind
    }

    /// Blanks as the author wrote them; none where the line ends.
    fn written(&self, at: usize) -> usize {
        let lexemes = &self.lexed.lexemes;
        if at == 0 || at >= lexemes.len() {
            return 0;
        }
        let gap = &self.lexed.text[lexemes[at - 1].end..lexemes[at].start];
        if gap.contains('\n') { 0 } else { gap.chars().count() }
    }

    fn blanks(&self) -> usize {
        if self.at == 0 {
            return 0;
        }
        let (before, here) = (self.kind(self.at - 1), self.kind(self.at));
        match (before, here) {
            (_, LexemeKind::LineComment) => self.written(self.at).max(1),
            (LexemeKind::BlockComment, _) | (_, LexemeKind::BlockComment) => {
                self.written(self.at).min(1)
            }
            (_, LexemeKind::Semicolon) if self.lexed.str(self.at - 1) == "within" => {
                self.written(self.at).min(1)
            }
            (_, LexemeKind::Comma | LexemeKind::Semicolon) => 0,
            (LexemeKind::Open, _) | (_, LexemeKind::Close) => 0,
            (LexemeKind::Comma, _) => self.after_comma(),
            (LexemeKind::Semicolon, _) => self.written(self.at).min(1),
            (_, LexemeKind::Operator) | (LexemeKind::Operator, _) => self.at_operator(),
            (_, LexemeKind::Open) => self.before_bracket(),
            _ => 1,
        }
    }

    fn after_comma(&self) -> usize {
        self.written(self.at).min(1)
    }

    fn before_bracket(&self) -> usize {
        let before = self.lexed.str(self.at - 1);
        match self.kind(self.at - 1) {
            // `$annotation(` is one word.
            LexemeKind::Word if self.at > 1 && self.lexed.str(self.at - 2) == "$" => 0,
            LexemeKind::Word => usize::from(keywords::has(before, SET_OFF)),
            LexemeKind::Quoted | LexemeKind::Close if self.lexed.str(self.at) != "{" => 0,
            _ => 1,
        }
    }

    fn at_operator(&self) -> usize {
        let operator = match self.kind(self.at) {
            LexemeKind::Operator if !self.is_unary(self.at) => self.at,
            // Before a sign: as if an operand was there.
            LexemeKind::Operator if self.kind(self.at - 1) != LexemeKind::Operator => {
                return usize::from(!matches!(self.kind(self.at - 1), LexemeKind::Open));
            }
            _ => self.at - 1,
        };
        if operator != self.at && self.is_unary(operator) {
            return 0;
        }
        match self.lexed.str(operator) {
            "." if operator == self.at => self.written(self.at).min(1),
            "." | "$" => 0,
            ":=" if self.roles[operator].depth == 0 => 1,
            "=" if self.roles[operator].in_equations => 1,
            _ => usize::from(self.written(operator) > 0 || self.written(operator + 1) > 0),
        }
    }

    /// Whether an operator is a sign: nothing precedes it that could be an operand.
    fn is_unary(&self, at: usize) -> bool {
        match self.lexed.str(at) {
            "-" | "+" | ".-" | ".+" => {}
            operator => return operator == "$",
        }
        match self.lexed.token_before(at) {
            None => true,
            Some(before) => match self.kind(before) {
                LexemeKind::Word => keywords::has(self.lexed.str(before), SET_OFF),
                LexemeKind::Operator => true,
                LexemeKind::Open | LexemeKind::Comma | LexemeKind::Semicolon => true,
                _ => false,
            },
        }
    }
}
