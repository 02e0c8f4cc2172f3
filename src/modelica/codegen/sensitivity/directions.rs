//! Which parameters the solution depends on: along the others, such as the scale of an observed
//! variable, the derivatives of all unknowns are zero and need not be carried.

use super::super::program::Program;
use super::super::sequence::{close, right_sides};
use super::blocks::needed_blocks;
use crate::causalize::Block;
use crate::lower::VariableKind;
use crate::symbolic::{Expr, Pool, VarId, VariableCollection};
use rustc_hash::{FxHashMap, FxHashSet};

/// The number among those of each of these parameters (positions in [`Program::parameters`]), if it is
/// one.
pub(super) fn directions(
    program: &Program,
    pool: &mut Pool,
    parameters: &[usize],
) -> Vec<Option<usize>> {
    let read = read_by_solution(program, pool);
    let mut columns: FxHashMap<VarId, FxHashSet<usize>> = FxHashMap::default();
    for (column, at) in parameters.iter().enumerate() {
        columns.entry(program.parameters()[*at].variable).or_default().insert(column);
    }
    for parameter in &program.sorted.parameters {
        let binding = program.sorted.dae.variable(*parameter).binding;
        // A parameter that is varied does not follow its binding.
        let Some(binding) = binding.filter(|_| !columns.contains_key(parameter)) else { continue };
        let of = pool.variables(binding);
        let found: FxHashSet<usize> =
            of.iter().filter_map(|v| columns.get(v)).flatten().copied().collect();
        columns.insert(*parameter, found);
    }
    let found: FxHashSet<usize> =
        read.iter().filter_map(|v| columns.get(v)).flatten().copied().collect();
    let mut numbers = 0..;
    let number = |column| if found.contains(&column) { numbers.next() } else { None };
    (0..parameters.len()).map(number).collect()
}

/// All variables that unknowns, discrete variables and the times of events are computed from.
fn read_by_solution(program: &Program, pool: &mut Pool) -> FxHashSet<VarId> {
    let sorted = &program.sorted;
    let between: Vec<Expr> = right_sides(sorted, pool)
        .into_iter()
        .chain(program.continuous.residuals.iter().copied())
        .chain(sorted.dae.relations.iter().flat_map(|relation| [relation.left, relation.right]))
        .chain(sorted.dae.events.roundings.iter().map(|rounding| rounding.argument))
        .collect();
    let is_kept = |v: &VarId| {
        let kind = sorted.dae.variable(*v).kind;
        matches!(kind, VariableKind::Solved | VariableKind::Discrete | VariableKind::Previous(_))
    };
    let kept = (0..sorted.dae.variables.len() as u32).map(VarId).filter(is_kept);
    let unknowns = program.continuous.unknowns.iter().copied().chain(kept);
    let unknowns: Vec<Expr> = unknowns.map(|v| pool.variable(v)).collect();
    let reinits = sorted.dae.events.reinits.iter().map(|reinit| reinit.value);
    let at_events: Vec<Expr> = unknowns.iter().copied().chain(reinits).collect();
    let event_blocks = match sorted.event_blocks.is_empty() {
        true => &sorted.blocks,
        false => &sorted.event_blocks,
    };
    let parts: [(&[Block], &[Expr]); 3] = [
        (&sorted.initial_blocks, &unknowns),
        (event_blocks, &at_events),
        (&sorted.blocks, &between),
    ];
    let mut read = FxHashSet::default();
    let mut collection = VariableCollection::new(pool);
    let mut add = |e: Expr| {
        collection.add(e, |v| {
            read.insert(v);
        });
    };
    for (blocks, results) in parts {
        results.iter().for_each(|e| add(*e));
        for block in needed_blocks(pool, blocks, results) {
            block.assignments().iter().for_each(|a| add(a.value));
            block.residuals().for_each(&mut add);
        }
    }
    close(pool, &program.continuous.integrated, read)
}
