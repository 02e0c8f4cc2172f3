//! The reader of `.mos` files. Seeds: `tests/grammar/{valid,invalid}`.
#![no_main]

#[path = "../targets.rs"]
#[allow(dead_code)]
mod targets;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| targets::run_parser_of_scripts(bytes));
