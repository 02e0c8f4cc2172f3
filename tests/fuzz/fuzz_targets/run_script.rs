//! Scripts in a world in memory. Seeds: `tests/fuzz/seeds/scripts`.
#![no_main]

#[path = "../targets.rs"]
#[allow(dead_code)]
mod targets;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| targets::run_script(bytes));
