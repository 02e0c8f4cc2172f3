//! The integration tests; one module per suite.

mod architecture;
mod mat;
mod models;
mod scripts;
mod shipped;
