//! Classes: found by name, with the modifiers and redeclarations that reach them, their base classes
//! and their elements (MLS §5.3, ch. 7).

pub(crate) mod classes;
pub(crate) mod declarations;
pub(crate) mod elements;
pub(crate) mod inheritance;
pub(crate) mod modification;
pub(crate) mod names;
pub(crate) mod scope;
pub(crate) mod selective_extension;
pub(crate) mod type_expansion;
pub(crate) mod types;
