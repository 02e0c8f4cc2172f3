//! Equations and assertions: scalar, with their places. Data only.

use super::string_part::StringPart;
use crate::source::Span;
use crate::symbolic::Expr;
use std::sync::Arc;

/// `left = right`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Equation {
    /// Left side.
    pub left: Expr,
    /// Right side.
    pub right: Expr,
    /// Where it is written.
    pub span: Span,
    /// Whose equation it is, if of one instance.
    pub instance: Option<Instance>,
}

impl Equation {
    /// `left = right`, written at `span`; whose it is, is not known.
    pub fn new(left: Expr, right: Expr, span: Span) -> Equation {
        Equation { left, right, span, instance: None }
    }
}

/// Position of a path in [`Dae::instances`](super::Dae::instances).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub struct Instance(pub u32);

/// What it means that a condition does not hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Level {
    /// The simulation ends (`AssertionLevel.error`).
    Error,
    /// The user is warned (`AssertionLevel.warning`).
    Warning,
    /// A function prints the text.
    Message,
    /// Functions write; the parts are their calls.
    Effect,
}

/// `assert(condition, message, level)`, or a text that is printed.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Assertion {
    /// Must hold; its relations are evaluated as they are.
    pub condition: Expr,
    /// The text for people as far as it is known when compiling.
    pub message: Arc<str>,
    /// The same in parts.
    pub parts: Vec<StringPart<Expr>>,
    /// What a violation means.
    pub level: Level,
    /// Where it is written.
    pub span: Span,
}
