//! How fast crossing functions oscillate in time by themselves: the rates at which the arguments of
//! sin, cos and tan in them change. Steps, which are as long as the states allow, do not tell.

use crate::causalize::{Assignment, Block, CausalizedDae};
use crate::codegen::event_code::changes_at_events_only;
use crate::symbolic::{Expr, Node, Pool, Substitution, VarId, derivative};
use indexmap::IndexSet;
use rustc_hash::{FxHashMap, FxHashSet};

pub(crate) const TIME: VarId = VarId(0);
/// More arguments are not looked at: sources of one model share a few frequencies.
const MOST_ARGUMENTS: usize = 200;

/// The rates, in radians per second, of time and of what changes at events only; also those that the
/// functions follow as unknowns of loops do.
pub(super) fn oscillations(
    pool: &mut Pool,
    causalized: &CausalizedDae,
    functions: &[Expr],
) -> Vec<Expr> {
    let (needed, residuals) = with_loops(pool, causalized, functions);
    let values = needed.iter().map(|a| a.value).chain(functions.iter().copied()).chain(residuals);
    let arguments = arguments(pool, &values.collect::<Vec<Expr>>());
    let mut by_time: FxHashMap<VarId, Expr> = FxHashMap::default();
    for assignment in dependencies(pool, &needed, &arguments) {
        if let Some(value) = in_time(pool, causalized, &by_time, assignment.value) {
            by_time.insert(assignment.variable, value);
        }
    }
    let mut rates = IndexSet::new();
    for argument in arguments {
        let Some(argument) = in_time(pool, causalized, &by_time, argument) else { continue };
        let rate = derivative(pool, argument, TIME);
        if pool.as_constant(rate) != Some(0.0) {
            rates.insert(rate);
        }
    }
    rates.into_iter().collect()
}

/// The assignments that functions need, in order, and the residuals of the loops among them.
fn with_loops(
    pool: &Pool,
    causalized: &CausalizedDae,
    functions: &[Expr],
) -> (Vec<Assignment>, Vec<Expr>) {
    let mut read: FxHashSet<VarId> = FxHashSet::default();
    pool.visit_variables(functions, |v| read.extend([v]));
    let (mut needed, mut residuals) = (Vec::new(), Vec::new());
    for block in causalized.blocks.iter().rev() {
        let iteration: &[VarId] = match block {
            Block::Loop(torn) => &torn.iteration,
            Block::Assignment(_) | Block::Linear(_) => &[],
        };
        let mut solved = iteration.iter().chain(block.assignments().iter().map(|a| &a.variable));
        if solved.any(|v| read.contains(v)) {
            let values = block.assignments().iter().map(|a| a.value).chain(block.residuals());
            pool.visit_variables(&values.collect::<Vec<Expr>>(), |v| read.extend([v]));
            needed.extend(block.assignments().iter().rev());
            residuals.extend(block.residuals());
        }
    }
    needed.reverse();
    (needed, residuals)
}

/// The arguments of trigonometric functions.
fn arguments(pool: &Pool, values: &[Expr]) -> IndexSet<Expr> {
    let argument = |e: &Expr| match pool.node(*e) {
        Node::Apply(id, arguments) if ["sin", "cos", "tan"].contains(&id.get().name) => {
            Some(arguments.first())
        }
        _ => None,
    };
    pool.reachable(values).iter().filter_map(argument).take(MOST_ARGUMENTS).collect()
}

/// The assignments that the arguments need, in order.
fn dependencies(pool: &Pool, needed: &[Assignment], arguments: &IndexSet<Expr>) -> Vec<Assignment> {
    let mut needed_variables: FxHashSet<VarId> = FxHashSet::default();
    let arguments: Vec<Expr> = arguments.iter().copied().collect();
    pool.visit_variables(&arguments, |v| needed_variables.extend([v]));
    let mut found = Vec::new();
    for assignment in needed.iter().rev() {
        if needed_variables.contains(&assignment.variable) {
            found.push(*assignment);
            pool.visit_variables(&[assignment.value], |v| needed_variables.extend([v]));
        }
    }
    found.reverse();
    found
}

/// An expression in terms of time and of what changes at events only; `None` if it is not made of these.
fn in_time(
    pool: &mut Pool,
    causalized: &CausalizedDae,
    by_time: &FxHashMap<VarId, Expr>,
    e: Expr,
) -> Option<Expr> {
    let is_kept = |v: VarId| v == TIME || changes_at_events_only(causalized, v);
    if pool.any_variable(e, |v| !is_kept(v) && !by_time.contains_key(&v)) {
        return None;
    }
    Some(Substitution::new(&|v| by_time.get(&v).copied()).apply(pool, e))
}
