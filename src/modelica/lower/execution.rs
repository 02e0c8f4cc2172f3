//! Symbolic evaluation of the statements of algorithms.

use crate::symbolic::{Expr, Pool, VarId};
use indexmap::IndexMap;
use rustc_hash::FxHashSet;

/// The variables of the loops around a statement, innermost last.
pub(super) type Loops = super::loops::Loops<Expr>;

/// Values of the variables that an algorithm assigns, during symbolic evaluation.
#[derive(Debug, Default)]
pub(super) struct Execution {
    /// In the order of the first assignment.
    pub(super) values: IndexMap<VarId, Expr>,
    /// Conditions of the branches around the statement.
    pub(super) guards: Vec<Expr>,
    /// Conditions of the branches of the expression.
    pub(super) branches: Vec<Expr>,
    /// What when-statements assign.
    pub(super) in_when: FxHashSet<VarId>,
    /// What when-clauses and algorithms of the model assign.
    pub(super) assigned: FxHashSet<VarId>,
    /// More than zero where a reference means the variable, not the value it has in an algorithm.
    pub(super) raw: usize,
}

impl Execution {
    /// The value that a variable has where the algorithm stands.
    pub(super) fn value_now(&self, pool: &mut Pool, variable: VarId) -> Expr {
        match self.values.get(&variable) {
            Some(value) => *value,
            None => pool.variable(variable),
        }
    }
}
