//! The integration tests; one module per suite.

mod architecture;
mod grammar;
