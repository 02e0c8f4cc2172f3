//! The integration tests; one module per suite.

mod architecture;
mod gapilib;
mod identification;
mod mat;
mod models;
mod scripts;
mod shipped;
