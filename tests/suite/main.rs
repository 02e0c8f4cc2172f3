//! The integration tests; one module per suite.

mod architecture;
mod flattening;
mod grammar;
mod syntax_properties;
