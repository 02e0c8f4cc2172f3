//! The reader of MAT files. Seeds: `tests/data/mat`.
#![no_main]

#[path = "../targets.rs"]
#[allow(dead_code)]
mod targets;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| targets::read_mat(bytes));
