//! Equations (MLS §A.2.6, ch. 8).

use super::{Comment, ComponentReference, Expression, ForIndex};
use crate::source::Span;

/// An equation with its comment.
#[derive(Debug, Clone, PartialEq)]
pub struct Equation {
    /// What it says.
    pub kind: EquationKind,
    /// String and annotation.
    pub comment: Comment,
    /// The equation without its semicolon.
    pub span: Span,
}

/// The forms of equations.
#[derive(Debug, Clone, PartialEq)]
pub enum EquationKind {
    /// `a = b`
    Equal {
        /// Left side.
        left: Expression,
        /// Right side.
        right: Expression,
    },
    /// `if c then … elseif … else … end if`
    If {
        /// Conditions with their equations.
        branches: Vec<(Expression, Vec<Equation>)>,
        /// Equations behind `else`; empty without it.
        otherwise: Vec<Equation>,
    },
    /// `for i in 1:n loop … end for`
    For {
        /// Loop variables.
        indices: Vec<ForIndex>,
        /// The equations.
        body: Vec<Equation>,
    },
    /// `connect(a, b)`
    Connect {
        /// First connector.
        left: ComponentReference,
        /// Second connector.
        right: ComponentReference,
    },
    /// `when c then … elsewhen … end when`
    When {
        /// Conditions with their equations.
        branches: Vec<(Expression, Vec<Equation>)>,
    },
    /// A call without a value: `assert(…)`, `terminate(…)`, `reinit(…)`, `Connections.root(…)`;
    /// always an [`ExpressionKind::Call`](super::ExpressionKind::Call).
    Call(Expression),
}
