//! No bytes make the reader of `.mo` files panic. Seeds: `tests/grammar/{valid,invalid}`.
#![no_main]

use gapilib::source::SourceId;
use gapilib::syntax::{decode, parse_stored_definition};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let (text, _) = decode(bytes);
    let _ = parse_stored_definition(SourceId::NONE, &text);
});
