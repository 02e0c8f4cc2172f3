//! Problem files, solved with a few simulations. Seeds: `tests/fuzz/seeds/problems`.
#![no_main]

#[path = "../targets.rs"]
#[allow(dead_code)]
mod targets;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| targets::solve_problem(bytes));
