//! Checks and flattens the classes of a file. Seeds: `tests/fuzz/seeds/models`.
#![no_main]

#[path = "../targets.rs"]
#[allow(dead_code)]
mod targets;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| targets::flatten_model(bytes));
