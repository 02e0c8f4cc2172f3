//! Which relations belong together: those of one algebraic loop, and those from which nothing but
//! functions of the relations follows at events. Mode search and sliding need it.

use super::code::CompiledRelation;
use crate::causalize::{Block, CausalizedDae};
use crate::lower::VariableKind;
use crate::symbolic::{Containing, Expr, Pool, RelationOperator, VarId};
use indexmap::IndexSet;
use rustc_hash::{FxHashMap, FxHashSet};

/// For every block that is solved at once, the relations in it.
pub(super) fn relations_of_blocks(pool: &Pool, sorted: &CausalizedDae) -> Vec<Vec<usize>> {
    let blocks = sorted.blocks.iter().chain(&sorted.event_blocks).chain(&sorted.initial_blocks);
    groups_of(blocks, pool, sorted)
}

/// The relations in the torn loops that are solved between events, ascending.
pub(super) fn relations_of_loops(pool: &Pool, sorted: &CausalizedDae) -> Vec<usize> {
    let loops = sorted.blocks.iter().filter(|block| matches!(block, Block::Loop(_)));
    let mut all = groups_of(loops, pool, sorted).concat();
    all.sort_unstable();
    all.dedup();
    all
}

/// For every block, the relations in it.
fn groups_of<'a>(
    blocks: impl Iterator<Item = &'a Block>,
    pool: &Pool,
    sorted: &CausalizedDae,
) -> Vec<Vec<usize>> {
    let numbers: FxHashMap<_, _> =
        sorted.dae.relations.iter().enumerate().map(|(at, r)| (r.variable, at)).collect();
    let mut containing = Containing::new(|pool, e| {
        pool.as_variable(e).is_some_and(|variable| numbers.contains_key(&variable))
    });
    let mut groups = IndexSet::new();
    for block in blocks {
        let values = block.assignments().iter().map(|a| a.value).chain(block.residuals());
        let values: Vec<Expr> = values.filter(|e| containing.contains(pool, *e)).collect();
        let mut group: Vec<usize> = Vec::new();
        pool.visit_variables(&values, |v| group.extend(numbers.get(&v).copied()));
        group.sort_unstable();
        if !group.is_empty() {
            groups.insert(group);
        }
    }
    groups.into_iter().collect()
}

/// For every relation, whether nothing follows from it at events but values that are functions of
/// the relations at hand.
pub(super) fn memoryless(
    pool: &Pool,
    sorted: &CausalizedDae,
    compiled: &[CompiledRelation],
) -> Vec<bool> {
    let dae = &sorted.dae;
    let events = &dae.events;
    let mut remembered: FxHashSet<VarId> = FxHashSet::default();
    let remember = |set: &mut FxHashSet<VarId>, e: Expr| {
        let before = set.len();
        pool.visit_variables(&[e], |v| {
            set.insert(v);
        });
        set.len() > before
    };
    let conditions = events.reinits.iter().flat_map(|r| [r.condition, r.value]);
    let assertions = events.assertions.iter().map(|a| a.condition);
    let ends = events.terminations.iter().map(|t| t.condition);
    for e in conditions.chain(assertions).chain(ends) {
        remember(&mut remembered, e);
    }
    // Between events nothing tells that another time has become the next.
    let pairs = dae.relations.iter().zip(compiled);
    for (relation, _) in pairs.filter(|(_, compiled)| compiled.is_rescheduled) {
        remember(&mut remembered, relation.left);
        remember(&mut remembered, relation.right);
    }
    let has_memory =
        |v: VarId| matches!(dae.variable(v).kind, VariableKind::Previous(_) | VariableKind::Signal);
    for equation in &events.equations {
        if [equation.left, equation.right].iter().any(|side| pool.any_variable(*side, has_memory)) {
            remember(&mut remembered, equation.right);
        }
    }
    loop {
        let mut grown = false;
        for equation in &events.equations {
            if pool.any_variable(equation.left, |v| remembered.contains(&v)) {
                grown |= remember(&mut remembered, equation.right);
            }
        }
        if !grown {
            break;
        }
    }
    let is_plain =
        |operator| !matches!(operator, RelationOperator::Equal | RelationOperator::NotEqual);
    let relations = dae.relations.iter();
    relations.map(|r| is_plain(r.operator) && !remembered.contains(&r.variable)).collect()
}
