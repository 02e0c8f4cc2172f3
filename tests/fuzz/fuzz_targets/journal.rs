//! Journals of identifications. Seeds: `tests/fuzz/corpus/journals`.
#![no_main]

#[path = "../targets.rs"]
#[allow(dead_code)]
mod targets;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| targets::read_journal(bytes));
