//! Bytes of a file to text.

use super::errors::NOT_UTF8;
use crate::diag::Fault;
use crate::fault;

/// The text of a file: UTF-8, a byte-order mark taken away. Bytes that are not UTF-8 are read as
/// Latin-1, where every byte is a character, and the fault to warn with is returned beside.
pub fn decode(bytes: &[u8]) -> (String, Option<Fault>) {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match std::str::from_utf8(bytes) {
        Ok(text) => (text.to_owned(), None),
        Err(error) => {
            let line =
                bytes[..error.valid_up_to()].iter().filter(|byte| **byte == b'\n').count() + 1;
            let warning = fault!(NOT_UTF8, "the text is not UTF-8 (line {line}), read as Latin-1";
                help: "save it as UTF-8");
            (bytes.iter().map(|byte| char::from(*byte)).collect(), Some(warning))
        }
    }
}
