//! The integration tests; one module per suite.

mod grammar;
mod mat;
mod plot;
mod results;
mod syntax_properties;
