//! What OpenModelica's scripting prints of its own: flat models.

pub(in crate::script) mod flat_model;
