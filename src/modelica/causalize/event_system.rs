//! The system at events: continuous and discrete equations sorted together (MLS §8.5, appendix B).
//!
//! A loop that runs through Booleans, Integers or enumerations is cut at these: what it solves for
//! takes their values from the pass before, and the passes are repeated until nothing changes.

use super::blt::{explicit, incidence, solve_block};
use super::causalized::{Assignment, Block};
use super::singularity::report;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::BaseType;
use crate::graph::{Bipartite, Matching, blocks, match_equations};
use crate::lower::errors::NOT_SUPPORTED;
use crate::lower::{Dae, Equation, VariableKind};
use crate::symbolic::{Expr, Substitution, VarId};

/// What a system is sorted for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Purpose {
    /// To solve it.
    #[default]
    Solution,
    /// To find out what is wrong with it: blocks of Real variables, which can always be solved by
    /// iteration, are left out.
    Check,
}

impl Purpose {
    /// Whether a block has to be solved.
    pub(super) fn needs(self, dae: &Dae, members: &[VarId]) -> bool {
        let is_real = |v: &VarId| dae.variable(*v).base == BaseType::Real;
        self == Purpose::Solution || !members.iter().all(is_real)
    }
}

/// Blocks, and the variables that are read before they are written.
#[derive(Debug, Default)]
pub(super) struct EventSystem {
    pub(super) blocks: Vec<Block>,
    pub(super) iterated: Vec<VarId>,
}

/// Sorts the whole system as it is at events, the equations between events given; empty if nothing
/// is discrete.
pub(super) fn sort_events(
    dae: &mut Dae,
    continuous: &[Equation],
    unknowns: &[VarId],
    purpose: Purpose,
) -> Result<EventSystem, Diagnostic> {
    if dae.events.equations.is_empty() {
        return Ok(EventSystem::default());
    }
    let mut equations = continuous.to_vec();
    equations.extend(&dae.events.equations);
    with_initial(dae, &mut equations, 0.0);
    let mut all = unknowns.to_vec();
    let discrete = dae.events.equations.iter().filter_map(|e| dae.pool.as_variable(e.left));
    all.extend(discrete);
    let (n, n_initial) = (dae.equations.len(), dae.initial_equations.len());
    let origins: Vec<usize> =
        (0..equations.len()).map(|at| if at < n { at } else { at + n_initial }).collect();
    let system = format!("`{}`", dae.name);
    sort_mixed(dae, &system, Numbered { equations, origins }, &all, purpose)
}

/// Replaces `initial()` by its value.
pub(super) fn with_initial(dae: &mut Dae, equations: &mut [Equation], value: f64) {
    let Some(initial) = dae.events.initial else { return };
    let pool = &mut dae.pool;
    let value = pool.constant(value);
    let replacement = |v: VarId| (v == initial).then_some(value);
    let mut substitution = Substitution::new(&replacement);
    for equation in equations {
        equation.left = substitution.apply(pool, equation.left);
        equation.right = substitution.apply(pool, equation.right);
    }
}

/// Equations with the numbers of what they come from.
#[derive(Default)]
pub(super) struct Numbered {
    pub(super) equations: Vec<Equation>,
    pub(super) origins: Vec<usize>,
}

/// Sorts equations for unknowns some of which are discrete.
pub(super) fn sort_mixed(
    dae: &mut Dae,
    system: &str,
    Numbered { equations, origins }: Numbered,
    unknowns: &[VarId],
    purpose: Purpose,
) -> Result<EventSystem, Diagnostic> {
    let equations = equations.as_slice();
    let graph = incidence(dae, equations, unknowns);
    let matching = match_mixed(dae, equations, unknowns, &graph, equations.len());
    if equations.len() != unknowns.len() || !matching.is_perfect() {
        return Err(report(dae, system, equations, unknowns, &graph, &matching));
    }
    let mut sorted = EventSystem::default();
    for block in blocks(&graph, &matching) {
        let members: Vec<VarId> = block
            .iter()
            .filter_map(|equation| matching.equation_to_unknown[*equation])
            .map(|unknown| unknowns[unknown])
            .collect();
        if !purpose.needs(dae, &members) {
            continue;
        }
        let is_real = members.iter().all(|v| dae.variable(*v).base == BaseType::Real);
        if is_real || block.len() == 1 {
            sorted.blocks.push(solve_block(dae, equations, &block, &members)?);
        } else {
            cut(dae, system, equations, (&block, &members), (&mut sorted, purpose))?;
        }
    }
    sorted.blocks.iter_mut().for_each(|block| renumber(block, &origins));
    Ok(sorted)
}

/// Matches discrete variables with equations that give them a value, if the first `required`
/// equations can be matched so.
pub(super) fn match_mixed(
    dae: &Dae,
    equations: &[Equation],
    unknowns: &[VarId],
    graph: &Bipartite,
    required: usize,
) -> Matching {
    let pool = &dae.pool;
    let gives = |side: Expr, other: Expr, v: VarId| {
        pool.as_variable(side) == Some(v) && !pool.depends_on(other, v)
    };
    let rows = equations.iter().enumerate().map(|(row, e)| {
        let determines = |unknown: &usize| {
            let v = unknowns[*unknown];
            let is_real = dae.variable(v).base == BaseType::Real;
            is_real || gives(e.left, e.right, v) || gives(e.right, e.left, v)
        };
        graph.unknowns(row).iter().copied().filter(determines).collect::<Vec<_>>()
    });
    let given = Bipartite::new(unknowns.len(), rows.collect::<Vec<_>>());
    let matching = match_equations(&given);
    let mut found =
        matching.equation_to_unknown.iter().take(required).chain(&matching.unknown_to_equation);
    match found.all(Option::is_some) {
        true => matching,
        false => match_equations(graph),
    }
}

/// Takes the discrete members of a loop as known for the others, and assigns them after these.
fn cut(
    dae: &mut Dae,
    system: &str,
    equations: &[Equation],
    (block, members): (&[usize], &[VarId]),
    (sorted, purpose): (&mut EventSystem, Purpose),
) -> Result<(), Diagnostic> {
    let local: Vec<Equation> = block.iter().map(|equation| equations[*equation]).collect();
    let graph = incidence(dae, &local, members);
    let mut values: Vec<Vec<(usize, Option<Expr>)>> = Vec::with_capacity(local.len());
    for (row, equation) in local.iter().enumerate() {
        let mut choices = Vec::new();
        for unknown in graph.unknowns(row) {
            let variable = members[*unknown];
            if dae.variable(variable).base == BaseType::Real {
                choices.push((*unknown, None));
            } else if let Some(value) = explicit(dae, *equation, variable) {
                choices.push((*unknown, Some(value)));
            }
        }
        values.push(choices);
    }
    let rows = values.iter().map(|row| row.iter().map(|(unknown, _)| *unknown).collect::<Vec<_>>());
    let matching = match_equations(&Bipartite::new(members.len(), rows.collect::<Vec<_>>()));
    let (mut rest, mut unknowns) = (Numbered::default(), Vec::new());
    let mut assignments = Vec::new();
    for (row, choices) in values.iter().enumerate() {
        let Some(unknown) = matching.equation_to_unknown[row] else {
            return Err(fault!(NOT_SUPPORTED,
                "this equation belongs to a loop of discrete variables but determines none of them";
                help: "write it as `variable = expression`")
            .at(local[row].span));
        };
        let chosen = choices.iter().find(|(at, _)| *at == unknown).and_then(|(_, value)| *value);
        match chosen {
            Some(value) => {
                let variable = members[unknown];
                assignments.push(Assignment { variable, value, equation: block[row] });
            }
            None => {
                rest.equations.push(local[row]);
                rest.origins.push(block[row]);
                unknowns.push(members[unknown]);
            }
        }
    }
    let inner = sort_mixed(dae, system, rest, &unknowns, purpose)?;
    sorted.blocks.extend(inner.blocks);
    sorted.iterated.extend(assignments.iter().map(|assignment| assignment.variable));
    sorted.blocks.extend(assignments.into_iter().map(Block::Assignment));
    Ok(())
}

fn renumber(block: &mut Block, origins: &[usize]) {
    match block {
        Block::Assignment(assignment) => assignment.equation = origins[assignment.equation],
        Block::Linear(solved) => {
            solved.assignments.iter_mut().for_each(|a| a.equation = origins[a.equation]);
            solved.residuals.iter_mut().for_each(|(_, equation)| *equation = origins[*equation]);
        }
        Block::Loop(torn) => {
            torn.assignments.iter_mut().for_each(|a| a.equation = origins[a.equation]);
            torn.residuals.iter_mut().for_each(|(_, equation)| *equation = origins[*equation]);
        }
    }
}

/// All variables of a kind, in order.
pub(super) fn of_kind(dae: &Dae, test: impl Fn(VariableKind) -> bool) -> Vec<VarId> {
    (0..dae.variables.len() as u32).map(VarId).filter(|v| test(dae.variable(*v).kind)).collect()
}
