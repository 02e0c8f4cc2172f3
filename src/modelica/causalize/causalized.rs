//! The sorted system: what is computed from what, in order. Data only.

use crate::lower::{Dae, Equation};
use crate::symbolic::{Expr, VarId};

/// A system in solving order.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub struct CausalizedDae {
    /// Variables, assertions, relations; equations as they were read.
    pub dae: Dae,
    /// For every variable, the one that it is equal to, with the opposite sign if negated.
    pub aliases: Vec<Option<Alias>>,
    /// The states, in order of declaration.
    pub states: Vec<VarId>,
    /// States that are chosen at run time.
    pub(crate) selections: Vec<Selection>,
    /// Solves for derivatives and algebraic variables, the states given.
    pub blocks: Vec<Block>,
    /// Solves for discrete variables as well, at events; empty if there are none.
    pub(crate) event_blocks: Vec<Block>,
    /// Solves for everything at the start.
    pub(crate) initial_blocks: Vec<Block>,
    /// Discrete variables of loops: blocks read them before they write them, so the blocks are
    /// solved until these do not change.
    pub iterated: Vec<VarId>,
    /// What the solution of these must fulfil besides.
    pub(crate) initial_checks: Vec<Equation>,
    /// Parameters with bindings, each after those it depends on.
    pub parameters: Vec<VarId>,
}

/// States of which each is one of several candidates, chosen again when the constraints between the
/// candidates do not determine the others well.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Selection {
    /// The Jacobian of the constraints in the candidates, by rows; fewer rows than columns.
    pub jacobian: Vec<Vec<Expr>>,
    /// The candidates.
    pub candidates: Vec<VarId>,
    /// The states, as many as candidates are free.
    pub states: Vec<VarId>,
    /// Frozen variables by states and candidates: 1 for the candidate that a state is equal to.
    pub weights: Vec<Vec<VarId>>,
    /// The candidates that are states at first, by their places.
    pub chosen: Vec<usize>,
}

/// Another name for a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Alias {
    /// The variable whose value it is.
    pub of: VarId,
    /// Whether it has the opposite sign.
    pub negated: bool,
}

/// A part of the system that is solved at once.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum Block {
    /// A variable and its value.
    Assignment(Assignment),
    /// A linear algebraic loop, solved in closed form.
    Linear(LinearLoop),
    /// An algebraic loop, torn.
    Loop(Loop),
}

/// `variable := value`, from the equation of this number.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Assignment {
    /// The variable.
    pub variable: VarId,
    /// Its value.
    pub value: Expr,
    /// Number of the equation in the list that was sorted.
    pub equation: usize,
}

/// A linear loop in closed form.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct LinearLoop {
    /// What its equations are solved for at once.
    pub unknowns: Vec<VarId>,
    /// These, then what follows from them, in order.
    pub assignments: Vec<Assignment>,
    /// What must be zero by the other assignments, with the number of the equation: it determines the
    /// unknowns, too.
    pub residuals: Vec<(Expr, usize)>,
}

/// A torn algebraic loop.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Loop {
    /// The iteration variables.
    pub iteration: Vec<VarId>,
    /// What follows from them, in order.
    pub assignments: Vec<Assignment>,
    /// What must be zero, with the number of the equation.
    pub residuals: Vec<(Expr, usize)>,
}

impl Block {
    /// Its assignments: inner ones for a loop.
    pub fn assignments(&self) -> &[Assignment] {
        match self {
            Block::Assignment(assignment) => std::slice::from_ref(assignment),
            Block::Linear(solved) => &solved.assignments,
            Block::Loop(torn) => &torn.assignments,
        }
    }

    /// What must be zero besides.
    pub fn residuals(&self) -> impl Iterator<Item = Expr> {
        let residuals: &[(Expr, usize)] = match self {
            Block::Assignment(_) | Block::Linear(_) => &[],
            Block::Loop(torn) => &torn.residuals,
        };
        residuals.iter().map(|(residual, _)| *residual)
    }
}
