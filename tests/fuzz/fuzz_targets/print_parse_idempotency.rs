//! What is read and printed reads back as the same. Seeds: `tests/grammar/valid`.
#![no_main]

#[path = "../targets.rs"]
#[allow(dead_code)]
mod targets;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| targets::print_and_parse(bytes));
