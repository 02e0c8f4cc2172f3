//! What calls came to, kept for when they are made again.

use crate::eval::Function;
use crate::lower::equation::Assertion;
use crate::lower::expressions::Lowered;
use crate::symbolic::Expr;
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Calls with what they came to, by the function's address, which stays as the function is kept.
pub(in crate::lower) type CallResults = FxHashMap<(usize, Vec<Lowered<Expr>>), Outcome>;

/// What a call came to.
pub(in crate::lower) struct Outcome {
    pub(super) _function: Arc<Function>,
    pub(super) results: Vec<Lowered<Expr>>,
    pub(super) assertions: Vec<Assertion>,
    /// Statements that it needs to come to this within another call; `None` if it does not.
    pub(super) statements: Option<usize>,
    /// Whether it comes to this where it is in no other call.
    pub(super) outermost: bool,
}
