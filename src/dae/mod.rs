//! Sorting: a flat model becomes a sequence of assignments and torn algebraic loops.
//!
//! ```text
//! build              every variable a scalar, every relation outside noEvent frozen
//! order_parameters   bindings in order of dependence
//! fold_parameters    parameters that cannot be set become numbers
//! eliminate_aliases  a = b and a = -b become names
//! drop_vanishing     derivatives with coefficients of zero
//! separate_discrete  equations of discrete variables become assignments at events
//! reduce_index       constraints between states differentiated, states chosen
//! sort_blocks        matching, strongly connected components, tearing
//! sort_events        the same for the system at events, discrete equations included
//! sort_initial       the same for the system at the start
//! ```
//!
//! Between events the blocks give derivatives and algebraic variables; discrete variables and
//! relations keep their values. At events the whole system is solved, with `pre(v)` known, until
//! `pre(v) = v` (MLS §8.5).
//!
//! Not handled yet, and refused with `not-supported`: `delay` by a time that varies,
//! `spatialDistribution`, statements whose loops depend on variables.

mod algorithm;
mod alias_elimination;
mod assigned;
mod blt;
mod build;
mod component_shape;
mod default_values;
mod discrete;
mod dummy_derivatives;
mod dump;
mod dynamic_states;
pub mod errors;
mod events;
mod function;
mod homotopy;
mod index_reduction;
mod initial;
mod inline;
mod linear_loops;
mod lowering;
mod message;
mod mixed;
mod model;
mod parameters;
mod report;
mod settled;
mod sorted;
mod statement_function;
mod symbolic_target;
mod temporal;
mod used;
mod vanishing_coefficients;
mod vanishing_derivatives;
mod varying_texts;
mod when;

pub use default_values::DefaultValues;
pub use dump::{dump, sizes};
pub use events::*;
pub use model::*;
pub use report::report;
pub use sorted::*;

use crate::diag::{Diagnostic, Label};
use crate::fault;
use crate::flatten::FlatModel;
use crate::symbolic::VarId;
use errors::{SINGULAR_SYSTEM, UNBALANCED_MODEL};
use vanishing_coefficients::Settled;

/// The passes, in order: the name for `--dump` and what it does.
pub const PASSES: &[(&str, &str)] = &[
    ("build", "every variable a scalar, relations outside `noEvent` frozen"),
    ("order_parameters", "bindings of parameters in order of dependence"),
    ("fold_parameters", "parameters that cannot be set become numbers"),
    ("eliminate_aliases", "`a = b` and `a = -b` become names"),
    ("drop_vanishing", "derivatives with coefficients of zero are dropped"),
    ("separate_discrete", "equations of discrete variables become assignments at events"),
    ("reduce_index", "constraints between states differentiated, states chosen"),
    ("sort_blocks", "matching, strongly connected components, tearing"),
    ("sort_events", "the same for the system at events, discrete equations included"),
    ("sort_initial", "the same for the system at the start"),
];

/// Sorts a flat model.
pub fn sort(flat: &FlatModel) -> Result<SortedDae, Diagnostic> {
    sort_settled(flat).map(|(sorted, _)| sorted)
}

/// The sorted system, and the parameters that its structure takes as numbers.
fn sort_settled(flat: &FlatModel) -> Result<(SortedDae, Settled), Diagnostic> {
    let mut settled = Settled::default();
    let mut sorted = sort_with(flat, &settled, &mut |_, _, _| {})?;
    loop {
        let found = vanishing_coefficients::vanishing(&mut sorted);
        let all: Settled = settled.union(&found).copied().collect();
        if all.len() == settled.len() {
            return Ok((sorted, settled));
        }
        // A loop without a unique solution may still have one that is used.
        match sort_with(flat, &all, &mut |_, _, _| {}) {
            Ok(again) => (sorted, settled) = (again, all),
            Err(_) => return Ok((sorted, settled)),
        }
    }
}

/// Is shown the name of a pass, the system after it, and the aliases known so far.
type Show<'a> = dyn FnMut(&str, &Dae, &[Option<Alias>]) + 'a;

/// The same; the passes that change the system show it, with the aliases known so far.
fn sort_and_show(flat: &FlatModel, show: &mut Show<'_>) -> Result<SortedDae, Diagnostic> {
    let settled = sort_settled(flat).map(|(_, settled)| settled).unwrap_or_default();
    sort_with(flat, &settled, show)
}

fn sort_with(
    flat: &FlatModel,
    settled: &Settled,
    show: &mut Show<'_>,
) -> Result<SortedDae, Diagnostic> {
    let mut dae = build::build(flat)?;
    zero_inputs(&mut dae, flat);
    vanishing_coefficients::settle(&mut dae, settled);
    show("build", &dae, &[]);
    let parameters = parameters::order_parameters(&mut dae)?;
    show("order_parameters", &dae, &[]);
    let parameters = default_values::fold_parameters(&mut dae, parameters);
    show("fold_parameters", &dae, &[]);
    dae.defaults = DefaultValues::of_parameters(&dae, &parameters);
    let mut aliases = alias_elimination::eliminate_aliases(&mut dae);
    show("eliminate_aliases", &dae, &aliases);
    vanishing_derivatives::drop_vanishing_derivatives(&mut dae, &aliases);
    show("drop_vanishing", &dae, &aliases);
    discrete::separate_discrete(&mut dae, &aliases)?;
    show("separate_discrete", &dae, &aliases);
    let chosen = index_reduction::reduce_index(&mut dae, &mut aliases)?;
    show("reduce_index", &dae, &aliases);
    let dummy_derivatives::ChosenStates { states, selections } = chosen;
    when::check_reinits(&dae, &aliases, &states, &selections)?;
    let unknowns = index_reduction::unknowns(&dae, &aliases, &states);
    let equations = homotopy::actual_equations(&mut dae);
    let blocks = blt::sort_blocks(&mut dae, &equations, &unknowns)?;
    let events = mixed::sort_events(&mut dae, &equations, &unknowns)?;
    let initial = initial::sort_initial(&mut dae, &states, &selections, &unknowns, &aliases)?;
    let mut lagged = events.lagged;
    lagged.extend(initial.lagged);
    lagged.sort_unstable();
    lagged.dedup();
    Ok(SortedDae {
        dae,
        aliases,
        states,
        selections,
        blocks,
        event_blocks: events.blocks,
        initial_blocks: initial.blocks,
        initial_checks: initial.checks,
        lagged,
        parameters,
    })
}

/// The error that a model is not balanced, with the variables and equations concerned, if they can
/// be told.
pub fn explain_imbalance(flat: &FlatModel, error: Diagnostic) -> Diagnostic {
    let found = match sort(flat) {
        Err(found) if [SINGULAR_SYSTEM, UNBALANCED_MODEL].contains(&found.code) => found,
        _ => return error,
    };
    let related = |error: Diagnostic, label: &Label| error.related(label.span, &*label.text);
    let error = found.labels.iter().fold(error, related);
    found.helps.iter().cloned().fold(error, Diagnostic::help)
}

/// An input at the top level without a binding has its start value, which is zero by default.
fn zero_inputs(dae: &mut Dae, flat: &FlatModel) {
    let is_bound = |name: &str| {
        let whole = name.strip_suffix(']').and_then(|name| name.rsplit_once('['));
        let declared = flat.variables.get(name);
        let declared = declared.or_else(|| flat.variables.get(whole?.0));
        declared.is_some_and(|variable| variable.binding.is_some())
    };
    for position in 0..dae.variables.len() {
        let variable = &dae.variables[position];
        if variable.causality == Some(crate::syntax::ast::CausalityPrefix::Input)
            && matches!(variable.kind, Kind::Unknown | Kind::Discrete)
            && !is_bound(&variable.name)
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
            dae.equations.push(Equation::new(left, right, span));
        }
    }
}
