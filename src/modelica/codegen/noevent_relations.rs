//! Relations inside `noEvent`, with events after all.
//!
//! A relation inside `noEvent` is taken literally (MLS §3.7.5): the integrator steps across it. Where
//! the fields on both sides point at it, steps become as short as the tolerance allows and the
//! solution does not get on. A [`System`] can give events to these relations then, at the time that
//! it has reached: its program is replaced by one in which they are relations as all others, so that
//! the solution slides along them.
//!
//! Only relations of Reals in equations that hold between events take part, not those in functions,
//! assertions and when-clauses.

use super::program::Program;
use super::sequence::compile_outputs;
use crate::causalize::{Assignment, Block, CausalizedDae};
use crate::codegen::program::Differences;
use crate::flatten::{BaseType, Variability};
use crate::lower::{Dae, Relation, Variable, VariableKind};
use crate::symbolic::{Expr, Node, Pool, RelationOperator, VarId};
use rustc_hash::{FxHashMap, FxHashSet};
use std::sync::Arc;

/// A relation, and the number of the equation it was found in first.
type Found = (Expr, usize);

/// The relations in equations between events that are taken literally and vary there.
fn literal_relations(sorted: &CausalizedDae) -> Vec<Found> {
    let (dae, pool) = (&sorted.dae, &sorted.dae.pool);
    let mut known: FxHashSet<Expr> = FxHashSet::default();
    let mut found = Vec::new();
    for (value, equation) in sorted.blocks.iter().flat_map(continuous) {
        for e in pool.reachable(&[value]) {
            if is_candidate(dae, e) && known.insert(e) {
                found.push((e, equation));
            }
        }
    }
    found
}

/// The values and residuals of a block, with the numbers of their equations.
fn continuous(block: &Block) -> Vec<Found> {
    let residuals: &[(Expr, usize)] = match block {
        Block::Assignment(_) => &[],
        Block::Linear(linear) => &linear.residuals,
        Block::Loop(torn) => &torn.residuals,
    };
    let values = block.assignments().iter().map(|a| (a.value, a.equation));
    values.chain(residuals.iter().copied()).collect()
}

fn is_candidate(dae: &Dae, e: Expr) -> bool {
    match dae.pool.node(e) {
        Node::Relation(RelationOperator::Equal | RelationOperator::NotEqual, ..) => false,
        Node::Relation(..) => dae.pool.any_variable(e, |v| {
            let variable = dae.variable(v);
            variable.base == BaseType::Real && dae.is_unknown(v)
        }),
        _ => false,
    }
}

/// The system with relations that switch at events instead of these.
fn with_events(sorted: &CausalizedDae, literal: &[Found]) -> CausalizedDae {
    let mut sorted = sorted.clone();
    let mut replaced: FxHashMap<Expr, Expr> = FxHashMap::default();
    for (e, equation) in literal {
        let Node::Relation(operator, left, right) = *sorted.dae.pool.node(*e) else { continue };
        let dae = &mut sorted.dae;
        let equations = dae.equations.iter().chain(&dae.initial_equations);
        let span = equations.chain(&dae.events.equations).nth(*equation).map(|e| e.span);
        let span = span.unwrap_or(crate::source::Span::NONE);
        let variable = VarId(dae.variables.len() as u32);
        let frozen = Variable {
            name: format!("$relation[{}]", dae.relations.len() + 1).into(),
            kind: VariableKind::Frozen,
            base: BaseType::Boolean,
            variability: Variability::Discrete,
            span,
            ..dae.variables[0].clone()
        };
        dae.variables.push(frozen);
        dae.relations.push(Relation { variable, operator, left, right, span });
        replaced.insert(*e, dae.pool.variable(variable));
        sorted.aliases.push(None);
    }
    let CausalizedDae { dae, blocks, event_blocks, .. } = &mut sorted;
    let (pool, variables) = (&mut dae.pool, &dae.variables);
    let mut successors = replaced;
    for block in blocks.iter_mut().chain(event_blocks) {
        // Values of events are computed at events only, where relations are what their sides say.
        let is_between =
            |a: &Assignment| variables[a.variable.0 as usize].kind != VariableKind::Discrete;
        let (assignments, residuals) = parts(block);
        for assignment in assignments.iter_mut().filter(|a| is_between(a)) {
            assignment.value = replace(pool, &mut successors, assignment.value);
        }
        for (residual, _) in residuals {
            *residual = replace(pool, &mut successors, *residual);
        }
    }
    sorted
}

fn parts(block: &mut Block) -> (&mut [Assignment], &mut [(Expr, usize)]) {
    match block {
        Block::Assignment(assignment) => (std::slice::from_mut(assignment), &mut []),
        Block::Linear(linear) => (&mut linear.assignments, &mut linear.residuals),
        Block::Loop(torn) => (&mut torn.assignments, &mut torn.residuals),
    }
}

/// The expression with all that has a successor replaced.
fn replace(pool: &mut Pool, successors: &mut FxHashMap<Expr, Expr>, expr: Expr) -> Expr {
    for old in pool.reachable(&[expr]) {
        if successors.contains_key(&old) {
            continue;
        }
        let node = pool.node(old).clone();
        let mut changed = false;
        node.for_each_operand(|operand| changed |= successors[&operand] != operand);
        let new = match changed {
            true => pool.rebuild(&node, |operand| successors[&operand]),
            false => old,
        };
        successors.insert(old, new);
    }
    successors[&expr]
}

impl Program {
    /// The code for the sides of relations inside `noEvent`; `None` if there are none.
    pub(crate) fn differences(&self) -> Option<&Differences> {
        let made = self.literal.differences.get_or_init(|| {
            let literal = literal_relations(&self.sorted);
            if literal.is_empty() {
                return None;
            }
            let mut pool = self.sorted.dae.pool.clone();
            let sides = literal.iter().filter_map(|(e, _)| match *pool.node(*e) {
                Node::Relation(_, left, right) => Some((left, right)),
                _ => None,
            });
            let sides: Vec<(Expr, Expr)> = sides.collect();
            let outputs: Vec<Expr> = sides.into_iter().map(|(a, b)| pool.sub(a, b)).collect();
            let mut registers = self.registers.clone();
            let code = compile_outputs(&pool, &mut registers, &self.sequence, &outputs);
            Some(Differences { registers, code })
        });
        made.as_ref()
    }

    /// The program in which relations inside `noEvent` have events, with the same unknowns; `None`
    /// if there is none.
    pub(crate) fn with_events(&self) -> Option<&Arc<Program>> {
        let made = self.literal.program.get_or_init(|| {
            let literal = literal_relations(&self.sorted);
            if literal.is_empty() {
                return None;
            }
            let program = Program::compile(with_events(&self.sorted, &literal)).ok()?;
            let is_alike = program.continuous.unknowns == self.continuous.unknowns
                && program.continuous.n_auxiliary == self.continuous.n_auxiliary
                && program.observed == self.observed;
            is_alike.then_some(program)
        });
        made.as_ref()
    }
}
