//! Trees of files and links with a script. Seeds: none.
#![no_main]

#[path = "../targets.rs"]
#[allow(dead_code)]
mod targets;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| targets::visit_stranger(bytes));
