//! Statements of algorithms and scripts (MLS §A.2.6, ch. 11).

use super::{Comment, ComponentReference, Expression, ForIndex};
use crate::source::Span;

/// A statement with its comment.
#[derive(Debug, Clone, PartialEq)]
pub struct Statement {
    /// What it does.
    pub kind: StatementKind,
    /// String and annotation.
    pub comment: Comment,
    /// The statement without its terminator.
    pub span: Span,
}

/// The forms of statements.
#[derive(Debug, Clone, PartialEq)]
pub enum StatementKind {
    /// `a := e`
    Assign {
        /// Left side.
        target: ComponentReference,
        /// Right side.
        value: Expression,
    },
    /// `(a, , b) := f(x)`
    MultiAssign {
        /// Left sides; `None` where an output is not wanted.
        targets: Vec<Option<ComponentReference>>,
        /// The call; in a script any expression, so that `(a, b) := (1, 2)` can be refused by name.
        value: Expression,
    },
    /// A call whose value is not used.
    Call(Expression),
    /// `if c then … end if`
    If {
        /// Conditions with their statements.
        branches: Vec<(Expression, Vec<Statement>)>,
        /// Statements behind `else`; empty without it.
        otherwise: Vec<Statement>,
    },
    /// `for i in 1:n loop … end for`
    For {
        /// Loop variables.
        indices: Vec<ForIndex>,
        /// The statements.
        body: Vec<Statement>,
    },
    /// `while c loop … end while`
    While {
        /// Condition.
        condition: Expression,
        /// The statements.
        body: Vec<Statement>,
    },
    /// `when c then … elsewhen … end when`
    When {
        /// Conditions with their statements.
        branches: Vec<(Expression, Vec<Statement>)>,
    },
    /// `break`
    Break,
    /// `return`
    Return,
}
