//! The integration tests; one module per suite.

mod mat;
mod plot;
mod results;
