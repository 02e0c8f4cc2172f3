//! Symbolic evaluation of the statements of algorithms.

use crate::source::Span;
use crate::symbolic::{Expr, Pool, VarId};
use indexmap::IndexMap;
use rustc_hash::{FxHashMap, FxHashSet};

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
    /// Where each variable was assigned last.
    pub(super) written: FxHashMap<VarId, Written>,
    /// What when-clauses and algorithms of the model assign.
    pub(super) assigned: FxHashSet<VarId>,
    /// More than zero where a reference means the variable, not the value it has in an algorithm.
    pub(super) raw: usize,
}

/// Where a variable of an algorithm is assigned.
#[derive(Debug, Clone, Copy)]
pub(super) enum Written {
    /// The target of a statement.
    Assignment(Span),
    /// The condition or the iterators of a loop that is executed as a function.
    Loop(Span),
}

impl Execution {
    /// A variable is assigned; of several places a loop is remembered.
    pub(super) fn assigned_by(&mut self, variable: VarId, place: Written) {
        match self.written.get(&variable) {
            Some(Written::Loop(_)) => {}
            _ => drop(self.written.insert(variable, place)),
        }
    }

    /// The value that a variable has where the algorithm stands.
    pub(super) fn value_now(&self, pool: &mut Pool, variable: VarId) -> Expr {
        match self.values.get(&variable) {
            Some(value) => *value,
            None => pool.variable(variable),
        }
    }
}
