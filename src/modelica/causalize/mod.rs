//! Causalization, the structural analysis of a [`Dae`](crate::lower::Dae): it becomes a sequence of
//! assignments and torn algebraic loops, a [`CausalizedDae`].
//!
//! ```text
//! build              every variable a scalar, every relation outside noEvent frozen
//! order_parameters   bindings in order of dependence
//! fold_parameters    parameters that cannot be set become numbers
//! eliminate_aliases  alias elimination: a = b and a = -b become names
//! drop_vanishing     derivatives with coefficients of zero
//! separate_discrete  equations of discrete variables become assignments at events
//! reduce_index       index reduction (Pantelides), states chosen (dummy derivatives)
//! sort_blocks        matching, block lower triangular form (BLT), tearing
//! sort_events        the same for the system at events, discrete equations included
//! sort_initial       the same for the system at the start
//! ```
//!
//! Between events the blocks give derivatives and algebraic variables; discrete variables and
//! relations keep their values. At events the whole system is solved, with `pre(v)` known, until
//! `pre(v) = v` (MLS §8.5). The passes are the table [`PASSES`].

mod alias_elimination;
mod blt;
mod causalized;
mod constant_conditions;
mod declared_ranges;
mod discrete;
mod dummy_derivatives;
mod dump;
mod dynamic_states;
mod event_system;
mod hidden_constraints;
mod homotopy;
mod index_reduction;
mod initial_system;
mod linear_loops;
mod numbers;
mod parameter_order;
mod passes;
mod preferred_states;
mod reinit;
mod report;
mod singularity;
mod state_select;
mod tearing_growth;
mod zero_coefficients;
mod zero_derivatives;

pub use causalized::*;
pub use dump::{dump, sizes};
pub use passes::{PASSES, Pass};
pub use report::report;

use crate::diag::{Diagnostic, Label};
use crate::flatten::FlatModel;
use crate::lower::errors::{SINGULAR_SYSTEM, UNBALANCED_MODEL};
use passes::{Show, run_passes};
use zero_coefficients::ZeroCoefficients;

/// Causalizes a flat model.
///
/// # Errors
/// Those of the passes: a model that is not balanced, structurally singular, or not supported.
pub fn causalize(flat: &FlatModel) -> Result<CausalizedDae, Diagnostic> {
    with_zeros(flat).map(|(causalized, _)| causalized)
}

/// Finds out what is wrong with a flat model. What only the solution needs is not computed: blocks of
/// Real variables are not solved, unless they may hide constraints, and parameters of zero do not lead
/// to a second structure.
///
/// # Errors
/// Those of [`causalize`].
pub fn check(flat: &FlatModel) -> Result<(), Diagnostic> {
    passes::check(flat).map(drop)
}

/// The causalized system, and the parameters of zero that its structure takes as numbers.
fn with_zeros(flat: &FlatModel) -> Result<(CausalizedDae, ZeroCoefficients), Diagnostic> {
    let mut zeros = ZeroCoefficients::default();
    let mut causalized = run_passes(flat, &zeros, &mut |_, _, _| {})?;
    loop {
        let found = zero_coefficients::zero_coefficients(&mut causalized);
        let all: ZeroCoefficients = zeros.union(&found).copied().collect();
        if all.len() == zeros.len() {
            return Ok((causalized, zeros));
        }
        // A loop without a unique solution may still have one that is used.
        match run_passes(flat, &all, &mut |_, _, _| {}) {
            Ok(again) => (causalized, zeros) = (again, all),
            Err(_) => return Ok((causalized, zeros)),
        }
    }
}

/// The same; the passes that change the system show it, with the aliases known so far.
fn causalize_and_show(flat: &FlatModel, show: &mut Show<'_>) -> Result<CausalizedDae, Diagnostic> {
    let zeros = with_zeros(flat).map(|(_, zeros)| zeros).unwrap_or_default();
    run_passes(flat, &zeros, show)
}

/// The error that a model is not balanced, with the variables and equations concerned, if they can
/// be identified.
pub fn explain_imbalance(flat: &FlatModel, error: Diagnostic) -> Diagnostic {
    let found = match check(flat) {
        Err(found) if [SINGULAR_SYSTEM, UNBALANCED_MODEL].contains(&found.code) => found,
        _ => return error,
    };
    let related = |error: Diagnostic, label: &Label| error.related(label.span, &*label.text);
    let error = found.labels.iter().fold(error, related);
    found.helps.iter().cloned().fold(error, Diagnostic::help)
}
