//! Types, sizes and variability of values, as far as the text of an expression shows them (MLS §3.8,
//! §6.7, §10.1): the rules of operators, and one walk of expressions for each question.
//!
//! A caller knows what names stand for, [`TypesOfNames`], [`SizesOfNames`], [`VariabilityOfNames`]:
//! variables of a flat model, declarations of a class, local variables of a function.

mod operators;
mod sizes;
mod subscripts;
mod types;
mod variability;

pub(crate) use operators::{Sizes, is_arithmetic, is_relation};
pub(crate) use sizes::{DeclaredSizes, SizesOfNames, all_known, at_end, element_sizes, sizes_of};
pub(crate) use subscripts::{SubscriptUse, subscript_uses};
pub(crate) use types::{ElementType, Elementary, TypesOfNames, chain_types, type_of};
pub use variability::Variability;
pub(crate) use variability::{VariabilityOfNames, most_variable};
