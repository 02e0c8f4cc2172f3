//! The reader of tables of text. Seeds: `tests/fuzz/seeds/csv`.
#![no_main]

#[path = "../targets.rs"]
#[allow(dead_code)]
mod targets;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| targets::read_csv(bytes));
