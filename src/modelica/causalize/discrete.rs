//! Which equations determine discrete variables (MLS §3.8.4, §4.5): these become assignments that
//! are executed at events.

use super::causalized::Alias;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::BaseType;
use crate::flatten::errors::TYPE_MISMATCH;
use crate::graph::{Bipartite, match_equations};
use crate::lower::errors::UNBALANCED_MODEL;
use crate::lower::{
    Dae, Equation, Variable, VariableKind, WITHOUT_EVENTS, is_real, not_discrete, used_variables,
};
use crate::symbolic::{Expr, VarId};
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
        .filter(|v| {
            dae.variable(*v).kind == VariableKind::Discrete && aliases[v.0 as usize].is_none()
        })
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
        return Err(undetermined(dae, open[missing]));
    }
    let mut determining: Vec<(VarId, Equation)> = Vec::new();
    for (equation, unknown) in
        std::mem::take(&mut dae.equations).into_iter().zip(&matching.equation_to_unknown)
    {
        let Some(unknown) = unknown else {
            dae.equations.push(equation);
            continue;
        };
        let left = dae.pool.variable(open[*unknown]);
        let right = if equation.left == left { equation.right } else { equation.left };
        determining.push((open[*unknown], Equation { left, right, ..equation }));
    }
    leave_varying(dae, aliases, &mut determining)?;
    dae.events.equations.extend(determining.into_iter().map(|(_, equation)| equation));
    Ok(())
}

/// Why a discrete variable has no equation: the one that is written for it has a Real, which is known
/// without it, or there is none.
fn undetermined(dae: &Dae, variable: VarId) -> Diagnostic {
    let Variable { name, span, base, .. } = dae.variable(variable);
    let real_of = |equation: &Equation| {
        let sides = [(equation.left, equation.right), (equation.right, equation.left)];
        let found = sides.into_iter().find(|(own, _)| dae.pool.as_variable(*own) == Some(variable));
        found.map(|(_, other)| other).filter(|other| is_real(dae, *other))
    };
    let has_unknowns = |e: Expr| dae.pool.any_variable(e, |v| dae.is_unknown(v));
    let mut help = format!("write an equation `{name} = …` for it");
    for equation in dae.equations.iter().filter(|_| *base == BaseType::Integer) {
        match real_of(equation) {
            Some(value) if !has_unknowns(value) => {
                return fault!(
                    TYPE_MISMATCH,
                    "`{name}` is an Integer, but the value of its equation is a Real";
                    help: "round it with `integer(x)`, or declare `{name}` as Real"
                )
                .at(equation.span);
            }
            // It may determine one of these.
            Some(value) if dae.pool.as_variable(value).is_none() => {
                help = format!(
                    "an equation with a Real does not determine the Integer `{name}`: round it \
                     with `integer(x)`"
                );
            }
            _ => {}
        }
    }
    fault!(UNBALANCED_MODEL, "no equation determines the discrete `{name}`"; help: "{help}")
        .labelled(*span, "no equation determines this")
}

/// Leaves to the continuous equations what follows from Integers that change between events: the
/// phase of a medium that another record passes on.
fn leave_varying(
    dae: &mut Dae,
    aliases: &[Option<Alias>],
    determining: &mut Vec<(VarId, Equation)>,
) -> Result<(), Diagnostic> {
    loop {
        let varying = determining.iter().position(|(_, equation)| varies(dae, equation.right));
        let Some(at) = varying else { return Ok(()) };
        let (variable, equation) = determining.remove(at);
        if !may_vary(dae, aliases, (variable, equation)) {
            return Err(not_constant(dae, variable, equation));
        }
        dae.variables[variable.0 as usize].kind = VariableKind::Unknown;
        dae.equations.push(equation);
    }
}

fn drop_unused_previous(dae: &mut Dae) {
    let used = used_variables(dae);
    for (variable, used) in dae.variables.iter_mut().zip(used) {
        if matches!(variable.kind, VariableKind::Previous(_)) && !used {
            variable.kind = VariableKind::Signal;
        }
    }
}

/// Whether a value may change between events.
fn varies(dae: &Dae, value: Expr) -> bool {
    dae.pool.any_variable(value, |v| is_varying(dae, v))
}

fn is_varying(dae: &Dae, v: VarId) -> bool {
    dae.is_unknown(v) || matches!(dae.variable(v).kind, VariableKind::Time | VariableKind::Delayed)
}

/// Whether a variable may change between events: it is another name of an Integer that may, or
/// follows from such; and nothing asks for its value before an event.
fn may_vary(dae: &Dae, aliases: &[Option<Alias>], (variable, equation): (VarId, Equation)) -> bool {
    let is_other_name = |(alias, own): (&Option<Alias>, &Variable)| {
        own.kind == VariableKind::Unknown && alias.is_some_and(|alias| alias.of == variable)
    };
    let is_real = |v: VarId| is_varying(dae, v) && dae.variable(v).base == BaseType::Real;
    let may_vary = aliases.iter().zip(&dae.variables).any(is_other_name)
        || !dae.pool.any_variable(equation.right, is_real);
    may_vary && !dae.variables.iter().any(|v| v.kind == VariableKind::Previous(variable))
}

fn not_constant(dae: &Dae, variable: VarId, equation: Equation) -> Diagnostic {
    let subject = format!("`{}` is discrete, but its value", dae.variable(variable).name);
    not_discrete(dae, &subject, equation.right, |v| is_varying(dae, v))
        .help(WITHOUT_EVENTS)
        .at(equation.span)
}
