//! What OpenModelica's scripting prints of its own: flat models.

pub(crate) mod flat_model;
