//! The integration tests; one module per suite.
#![allow(
    clippy::disallowed_methods,
    reason = "expected values need not have the same last digit on every machine"
)]

mod architecture;
mod identification;
mod language;
#[path = "../nist/mod.rs"]
mod nist;
mod simulation;
mod support;
mod tools;
mod words;
