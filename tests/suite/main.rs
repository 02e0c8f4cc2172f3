//! The integration tests; one module per suite.

mod architecture;
mod diagnostics;
mod grammar;
mod mat;
mod results;
mod transcripts;
