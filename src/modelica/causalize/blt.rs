//! Block lower triangular form: which equation determines which unknown, in solving order.

use super::causalized::{Assignment, Block, Loop};
use super::linear_loops::{is_safe, solve_linear};
use super::singularity::report;
use super::tearing_growth::limit_growth;
use crate::diag::Diagnostic;
use crate::fault;
use crate::graph::{Bipartite, blocks, match_equations, tear};
use crate::lower::errors::NOT_SUPPORTED;
use crate::lower::{Dae, Equation, VariableKind};
use crate::symbolic::{Expr, Solution, VarId, solve};
use rustc_hash::FxHashMap;

/// Sorts equations for unknowns, and solves the blocks that are needed: `is_needed` is given the numbers
/// of their equations and their unknowns.
pub(super) fn sort_blocks(
    dae: &mut Dae,
    equations: &[Equation],
    unknowns: &[VarId],
    is_needed: impl Fn(&Dae, &[usize], &[VarId]) -> bool,
) -> Result<Vec<Block>, Diagnostic> {
    let graph = incidence(dae, equations, unknowns);
    let matching = match_equations(&graph);
    if equations.len() != unknowns.len() || !matching.is_perfect() {
        let system = format!("`{}`", dae.name);
        return Err(report(dae, &system, equations, unknowns, &graph, &matching));
    }
    let mut sorted = Vec::new();
    for block in blocks(&graph, &matching) {
        let members: Vec<VarId> = block
            .iter()
            .filter_map(|equation| matching.equation_to_unknown[*equation])
            .map(|unknown| unknowns[unknown])
            .collect();
        if is_needed(dae, &block, &members) {
            sorted.push(solve_block(dae, equations, &block, &members)?);
        }
    }
    Ok(sorted)
}

/// Which unknowns every equation contains.
pub(super) fn incidence(dae: &Dae, equations: &[Equation], unknowns: &[VarId]) -> Bipartite {
    let column: FxHashMap<VarId, usize> =
        unknowns.iter().enumerate().map(|(at, v)| (*v, at)).collect();
    let rows = equations.iter().map(|equation| {
        let mut row = Vec::new();
        let sides = [equation.left, equation.right];
        dae.pool.visit_variables(&sides, |v| row.extend(column.get(&v).copied()));
        row.sort_unstable();
        row
    });
    Bipartite::new(unknowns.len(), rows.collect::<Vec<_>>())
}

pub(super) fn solve_block(
    dae: &mut Dae,
    equations: &[Equation],
    block: &[usize],
    members: &[VarId],
) -> Result<Block, Diagnostic> {
    if let (&[equation], &[variable]) = (block, members)
        && let Some(value) = explicit_alone(dae, equations[equation], variable)
    {
        return Ok(Block::Assignment(Assignment { variable, value, equation }));
    }
    let is_discrete = |v: &&VarId| dae.variable(**v).base != crate::flatten::BaseType::Real;
    if let Some(discrete) = members.iter().find(is_discrete) {
        return Err(fault!(
            NOT_SUPPORTED,
            "`{}` is discrete and belongs to an algebraic loop",
            dae.variable(*discrete).name
        )
        .at(equations[block[0]].span));
    }
    let local: Vec<Equation> = block.iter().map(|equation| equations[*equation]).collect();
    let graph = incidence(dae, &local, members);
    let mut solutions: FxHashMap<(usize, usize), Expr> = FxHashMap::default();
    for (row, equation) in local.iter().enumerate() {
        for unknown in graph.unknowns(row) {
            if !may_determine(dae, *equation, members[*unknown], members) {
                continue;
            }
            if let Some(value) = explicit(dae, *equation, members[*unknown]) {
                solutions.insert((row, *unknown), value);
            }
        }
    }
    let torn = tear(&graph, |row, unknown| solutions.contains_key(&(row, unknown)));
    let assignments = torn
        .assignments
        .iter()
        .map(|(row, unknown)| Assignment {
            variable: members[*unknown],
            value: solutions[&(*row, *unknown)],
            equation: block[*row],
        })
        .collect();
    let residuals = torn
        .residual_equations
        .iter()
        .map(|row| (dae.pool.sub(local[*row].left, local[*row].right), block[*row]))
        .collect();
    let iteration = torn.iteration_unknowns.iter().map(|u| members[*u]).collect();
    let torn = limit_growth(dae, Loop { iteration, assignments, residuals });
    Ok(match solve_linear(dae, &torn) {
        Some(solved) => Block::Linear(solved),
        None => Block::Loop(torn),
    })
}

/// Within a loop a discrete variable has the value of its own equation, so that it keeps its value
/// exactly where no when-clause acts.
fn may_determine(dae: &Dae, equation: Equation, variable: VarId, members: &[VarId]) -> bool {
    let is_discrete = |v: VarId| dae.variable(v).kind == VariableKind::Discrete;
    match dae.pool.as_variable(equation.left) {
        Some(own) if is_discrete(own) && members.contains(&own) => own == variable,
        _ => !is_discrete(variable),
    }
}

/// The value of a variable by one equation, if it can be had without dividing by what may be zero:
/// within a loop also by what is zero at an iterate only. What solves the loop solves its equations:
/// a declared inverse that is none everywhere is not used.
pub(super) fn explicit(dae: &mut Dae, equation: Equation, variable: VarId) -> Option<Expr> {
    explicit_where(dae, equation, variable, |dae, solution| {
        solution.is_exact && is_safe(dae, solution.divisor) && is_safe(dae, solution.inverted)
    })
}

/// The same where all else in the equation is known: `a / v = b` has no solution where b is zero,
/// and Newton's method would divide by v, which begins at zero. The inverse that the function
/// declares is used as its author intends: the pressure drops of IBPSA and their inverses differ
/// where both are made smooth, and the reference results of its dampers have the values of the
/// inverses.
fn explicit_alone(dae: &mut Dae, equation: Equation, variable: VarId) -> Option<Expr> {
    explicit_where(dae, equation, variable, |dae, solution| is_safe(dae, solution.divisor))
}

fn explicit_where(
    dae: &mut Dae,
    equation: Equation,
    variable: VarId,
    is_allowed: impl Fn(&Dae, &Solution) -> bool,
) -> Option<Expr> {
    let pool = &mut dae.pool;
    if pool.as_variable(equation.left) == Some(variable)
        && !pool.depends_on(equation.right, variable)
    {
        return Some(equation.right);
    }
    if pool.as_variable(equation.right) == Some(variable)
        && !pool.depends_on(equation.left, variable)
    {
        return Some(equation.left);
    }
    let solution = solve(pool, equation.left, equation.right, variable)?;
    is_allowed(dae, &solution).then_some(solution.value)
}
