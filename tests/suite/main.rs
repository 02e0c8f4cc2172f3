//! The integration tests; one module per suite.

mod architecture;
mod grammar;
mod mat;
mod results;
mod transcripts;
