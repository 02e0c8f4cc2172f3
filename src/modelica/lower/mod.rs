//! Lowering: a flat model becomes a system of differential-algebraic equations, a [`Dae`] — every
//! variable a scalar, every equation a pair of scalar expressions (MLS appendix B).
//!
//! Arrays, records and functions are expanded (`expressions`, `function`, `inline`);
//! algorithm sections and when-clauses become equations (`algorithm`, `when`); every relation
//! outside `noEvent` becomes a variable that changes at events only (`build`); operators with a
//! meaning in time become variables too (`temporal`, `transport`).
//!
//! Not supported yet, and refused with `not-supported`: statements whose loops depend on variables.

mod algorithm;
mod assigned_variables;
mod bound_strings;
mod build;
mod builder;
mod calls_of_statements;
mod clocks;
mod component_shape;
mod dae;
mod default_values;
mod discrete;
mod equation;
pub mod errors;
mod evaluated_parameters;
mod events;
mod execution;
mod expressions;
mod function;
mod guarded;
mod inline;
mod inputs;
mod loops;
mod message;
mod number_values;
mod outside_ranges;
mod record_values;
mod recordings;
mod scalar_types;
mod shape;
mod statement_function;
mod string_array;
mod string_part;
mod symbolic_target;
mod temporal;
mod transport;
mod used_variables;
mod varying_strings;
mod when;

#[cfg(test)]
mod tests;

pub(crate) use build::{derivative_of, scalar_of_nothing};
pub use dae::*;
pub use default_values::Attributes;
pub(crate) use default_values::fold_parameters;
pub(crate) use discrete::{WITHOUT_EVENTS, not_discrete};
pub use equation::*;
pub use events::*;
pub use function::CompiledFunctions;
pub(crate) use function::warning_of;
pub use outside_ranges::{Beyond, OutsideRanges};
pub(crate) use scalar_types::is_real;
pub use shape::Shape;
pub use string_array::StringArray;
pub use string_part::StringPart;
pub(crate) use used_variables::used_variables;

use crate::diag::Diagnostic;
use crate::flatten::FlatModel;

/// Lowers a flat model.
///
/// # Errors
/// What the language or this program does not allow in equations: see [`errors`].
pub fn lower(flat: &FlatModel) -> Result<Dae, Diagnostic> {
    let mut dae = build::build(flat)?;
    inputs::unbound_inputs(&mut dae, flat);
    Ok(dae)
}
