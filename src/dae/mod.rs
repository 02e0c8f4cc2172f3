//! Sorting: a flat model becomes a sequence of assignments and torn algebraic loops.
//!
//! ```text
//! build                every variable a scalar, every relation outside noEvent frozen
//! order_parameters     bindings in order of dependence
//! eliminate_aliases    a = b and a = -b become names
//! separate_discrete    equations of discrete variables become assignments at events
//! sort_blocks          matching, strongly connected components, tearing
//! sort_events          the same for the system at events, discrete equations included
//! sort_initial         the same for the system at the start
//! ```
//!
//! Between events the blocks give derivatives and algebraic variables; discrete variables and
//! relations keep their values. At events the whole system is solved, with `pre(v)` known, until
//! `pre(v) = v` (MLS §8.5).
//!
//! Not handled yet, and refused with `not-supported`: `delay` by a time that varies, `spatialDistribution`,
//! statements whose loops depend on variables, systems of an index above one, parameters with `fixed = false`.

mod algorithm;
mod alias_elimination;
mod blt;
mod build;
mod discrete;
pub mod errors;
mod events;
mod function;
mod initial;
mod inline;
mod lowering;
mod mixed;
mod model;
mod parameters;
mod report;
mod sorted;
mod symbolic_target;
mod temporal;
mod when;

pub use events::*;
pub use model::*;
pub use report::report;
pub use sorted::*;

use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::FlatModel;
use crate::symbolic::VarId;

/// The passes, in order: the name for `--dump` and what it does.
pub const PASSES: &[(&str, &str)] = &[
    ("build", "every variable a scalar, relations outside `noEvent` frozen"),
    ("order_parameters", "bindings of parameters in order of dependence"),
    ("eliminate_aliases", "`a = b` and `a = -b` become names"),
    ("separate_discrete", "equations of discrete variables become assignments at events"),
    ("sort_blocks", "matching, strongly connected components, tearing"),
    ("sort_events", "the same for the system at events, discrete equations included"),
    ("sort_initial", "the same for the system at the start"),
];

/// Sorts a flat model.
pub fn sort(flat: &FlatModel) -> Result<SortedDae, Diagnostic> {
    let mut dae = build::build(flat)?;
    zero_inputs(&mut dae);
    let parameters = parameters::order_parameters(&mut dae)?;
    let aliases = alias_elimination::eliminate_aliases(&mut dae);
    discrete::separate_discrete(&mut dae, &aliases)?;
    let states: Vec<VarId> = dae
        .variables
        .iter()
        .filter_map(|v| match v.kind {
            Kind::Derivative(of) => Some(of),
            _ => None,
        })
        .collect::<std::collections::BTreeSet<_>>()
        .into_iter()
        .collect();
    let unknowns: Vec<VarId> = (0..dae.variables.len() as u32)
        .map(VarId)
        .filter(|v| dae.is_unknown(*v) && aliases[v.0 as usize].is_none())
        .filter(|v| states.binary_search(v).is_err())
        .collect();
    let equations = dae.equations.clone();
    high_index(&dae, &states, &unknowns)?;
    let blocks = blt::sort_blocks(&mut dae, &equations, &unknowns)?;
    let events = mixed::sort_events(&mut dae, &unknowns)?;
    let (initial_blocks, initial_lagged) =
        initial::sort_initial(&mut dae, &states, &unknowns, &aliases)?;
    let mut lagged = events.lagged;
    lagged.extend(initial_lagged);
    lagged.sort_unstable();
    lagged.dedup();
    let event_blocks = events.blocks;
    Ok(SortedDae { dae, aliases, states, blocks, event_blocks, initial_blocks, lagged, parameters })
}

/// An input at the top level without a binding has its start value, which is zero by default.
fn zero_inputs(dae: &mut Dae) {
    let bound: std::collections::BTreeSet<VarId> =
        dae.equations.iter().filter_map(|e| dae.pool.as_variable(e.left)).collect();
    for position in 0..dae.variables.len() {
        let variable = &dae.variables[position];
        if variable.causality == Some(crate::syntax::ast::CausalityPrefix::Input)
            && matches!(variable.kind, Kind::Unknown | Kind::Discrete)
            && !bound.contains(&VarId(position as u32))
        {
            let zero = dae.pool.constant(0.0);
            let right = variable.start.unwrap_or(zero);
            let span = variable.span;
            let warning = fault!(
                errors::NOT_SUPPORTED,
                "the input `{}` is not connected; it keeps its start value",
                variable.name
            );
            dae.warnings.push(warning.at(span).warning());
            let left = dae.pool.variable(VarId(position as u32));
            dae.equations.push(Equation { left, right, span });
        }
    }
}

/// An equation between states alone constrains them: the index is above one.
fn high_index(dae: &Dae, states: &[VarId], unknowns: &[VarId]) -> Result<(), Diagnostic> {
    if dae.equations.len() != unknowns.len() {
        return Ok(());
    }
    for equation in &dae.equations {
        let mut variables = dae.pool.variables(equation.left);
        variables.extend(dae.pool.variables(equation.right));
        let constrains = variables.iter().any(|v| states.binary_search(v).is_ok())
            && !variables.iter().any(|v| unknowns.binary_search(v).is_ok());
        if constrains {
            return Err(fault!(errors::NOT_SUPPORTED,
                "high-index: this equation constrains states and would have to be differentiated";
                help: "choose fewer states, or differentiate the constraint by hand")
            .at(equation.span));
        }
    }
    Ok(())
}
