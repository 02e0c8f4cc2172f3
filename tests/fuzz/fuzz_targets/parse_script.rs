//! No bytes make the reader of `.mos` files panic. Seeds: `tests/grammar/{valid,invalid}`.
#![no_main]

use gapilib::source::SourceId;
use gapilib::syntax::{decode, parse_script};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let (text, _) = decode(bytes);
    let _ = parse_script(SourceId::NONE, &text);
});
