//! The integration tests; one module per suite.

mod architecture;
mod bad_input;
mod cli;
mod compat;
mod diagnostics;
mod flat_class;
mod flattening;
mod flattening_properties;
mod functions;
mod gapilib;
mod grammar;
mod identification;
mod identified_models;
mod mat;
mod models;
mod plot;
mod results;
mod scripts;
mod session;
mod shipped;
mod simulation;
mod structural_parameters;
mod structure;
mod syntax_properties;
mod transcripts;
