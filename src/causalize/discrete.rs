//! Which equations determine discrete variables (MLS §3.8.4, §4.5): these become assignments that
//! are executed at events.

use super::causalized::Alias;
use super::used_variables::used_variables;
use crate::diag::Diagnostic;
use crate::fault;
use crate::graph::{Bipartite, match_equations};
use crate::lower::errors::{NOT_SUPPORTED, UNBALANCED_MODEL};
use crate::lower::{Dae, Equation, Kind, is_real};
use crate::symbolic::{Expr, Node, VarId};
use rustc_hash::FxHashMap;

/// Moves the equations that determine discrete variables to those of events, and drops previous
/// values that nothing uses.
pub(super) fn separate_discrete(
    dae: &mut Dae,
    aliases: &[Option<Alias>],
) -> Result<(), Diagnostic> {
    drop_unused_previous(dae);
    let given: std::collections::BTreeSet<VarId> =
        dae.events.equations.iter().filter_map(|e| dae.pool.as_variable(e.left)).collect();
    let open: Vec<VarId> = (0..dae.variables.len() as u32)
        .map(VarId)
        .filter(|v| dae.variable(*v).kind == Kind::Discrete && aliases[v.0 as usize].is_none())
        .filter(|v| !given.contains(v))
        .collect();
    if open.is_empty() {
        return Ok(());
    }
    let column: FxHashMap<VarId, usize> = open.iter().enumerate().map(|(at, v)| (*v, at)).collect();
    let rows: Vec<Vec<usize>> = dae
        .equations
        .iter()
        .map(|equation| {
            let sides = [(equation.left, equation.right), (equation.right, equation.left)];
            let target = |(side, other): &(Expr, Expr)| {
                let variable = dae.pool.as_variable(*side)?;
                let at = column.get(&variable).copied()?;
                let fits = !is_real(dae, *other) && !dae.pool.depends_on(*other, variable);
                fits.then_some(at)
            };
            sides.iter().filter_map(target).collect()
        })
        .collect();
    let matching = match_equations(&Bipartite::new(open.len(), rows));
    if let Some(missing) = matching.unknown_to_equation.iter().position(Option::is_none) {
        let variable = dae.variable(open[missing]);
        return Err(fault!(UNBALANCED_MODEL, "no equation determines the discrete `{}`",
            variable.name; help: "write an equation `{} = …` for it", variable.name)
        .labelled(variable.span, "no equation determines this"));
    }
    let equations = std::mem::take(&mut dae.equations);
    let pairs = || equations.iter().copied().zip(&matching.equation_to_unknown);
    for (equation, unknown) in pairs() {
        if let Some(unknown) = unknown
            && is_call_that_varies(dae, open[*unknown], equation)
        {
            dae.variables[open[*unknown].0 as usize].kind = Kind::Unknown;
        }
    }
    for (equation, unknown) in pairs() {
        let unknown = unknown.filter(|at| dae.variable(open[*at]).kind == Kind::Discrete);
        let Some(unknown) = unknown.as_ref() else {
            dae.equations.push(equation);
            continue;
        };
        let left = dae.pool.variable(open[*unknown]);
        let right = if equation.left == left { equation.right } else { equation.left };
        check_constant_between_events(dae, open[*unknown], right, equation)?;
        dae.events.equations.push(Equation { left, right, ..equation });
    }
    Ok(())
}

fn drop_unused_previous(dae: &mut Dae) {
    let used = used_variables(dae);
    for (variable, used) in dae.variables.iter_mut().zip(used) {
        if matches!(variable.kind, Kind::Previous(_)) && !used {
            variable.kind = Kind::Signal;
        }
    }
}

/// Whether a function gives an Integer or Boolean that follows continuous inputs, such as the number
/// of phases in the records of media: it varies between events, where nothing else could be meant,
/// and without events, as everything in functions. Not if something asks for `pre` of it.
fn is_call_that_varies(dae: &Dae, variable: VarId, equation: Equation) -> bool {
    let is_left = dae.pool.as_variable(equation.left) == Some(variable);
    let right = if is_left { equation.right } else { equation.left };
    matches!(dae.pool.node(right), Node::Call { .. })
        && dae.pool.any_variable(right, |v| varies(dae, v))
        && !dae.variables.iter().any(|other| other.kind == Kind::Previous(variable))
}

fn varies(dae: &Dae, v: VarId) -> bool {
    dae.is_unknown(v) || matches!(dae.variable(v).kind, Kind::Time | Kind::Delayed)
}

fn check_constant_between_events(
    dae: &Dae,
    variable: VarId,
    value: Expr,
    equation: Equation,
) -> Result<(), Diagnostic> {
    match dae.pool.any_variable(value, |v| varies(dae, v)) {
        false => Ok(()),
        true => Err(fault!(NOT_SUPPORTED,
            "`{}` is discrete, but its equation may change between events",
            dae.variable(variable).name;
            help: "do not use relations inside `noEvent` or inside functions")
        .at(equation.span)),
    }
}
