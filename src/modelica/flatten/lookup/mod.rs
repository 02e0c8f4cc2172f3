//! Classes: found by name, with the modifiers and redeclarations that reach them, their base classes
//! and their elements (MLS §5.3, ch. 7).

pub mod classes;
pub mod declarations;
pub mod elements;
pub(crate) mod inheritance;
pub mod modification;
pub mod names;
pub mod scope;
pub mod selective_extension;
pub(crate) mod type_expansion;
pub mod types;
