//! An equation of a clocked partition. Data only.

use crate::lower::equation::Equation;
use crate::symbolic::{Expr, VarId};

/// A clocked equation.
#[derive(Debug, Clone, Copy)]
pub(super) struct ClockedEquation {
    pub(super) equation: Equation,
    /// Its sub-partition.
    pub(super) sub: usize,
    /// Of a discretized state: its derivative, and what that is where constraints determine the
    /// state.
    pub(super) rate: Option<(VarId, Expr)>,
}
