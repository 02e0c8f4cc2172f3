//! The readers of results. Seeds: `tests/data/mat/result_*.mat`.
#![no_main]

#[path = "../targets.rs"]
#[allow(dead_code)]
mod targets;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| targets::read_results(bytes));
