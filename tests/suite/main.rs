//! The integration tests; one module per suite.

mod architecture;
mod compat;
mod diagnostics;
mod flat_class;
mod flattening;
mod grammar;
mod mat;
mod plot;
mod results;
mod simulation;
mod structure;
mod syntax_properties;
mod transcripts;
