//! The integration tests; one module per suite.

mod architecture;
mod diagnostics;
mod flattening;
mod gapilib;
mod grammar;
mod identification;
mod identified_models;
mod mat;
mod models;
mod results;
mod scripts;
mod shipped;
mod syntax_properties;
mod transcripts;
