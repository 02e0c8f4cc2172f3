//! The integration tests; one module per suite.

mod architecture;
mod models;
mod scripts;
mod shipped;
