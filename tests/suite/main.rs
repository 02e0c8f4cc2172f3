//! The integration tests; one module per suite.
mod grammar;
mod syntax_properties;
