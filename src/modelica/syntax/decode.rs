//! Bytes of a file to text.

use super::errors::NOT_UTF8;
use crate::diag::Fault;
use crate::fault;

/// A byte-order mark, and how a code unit is read after it.
type Encoding = (&'static [u8], fn([u8; 2]) -> u16);

/// Those of UTF-16.
const UTF16: [Encoding; 2] = [(b"\xff\xfe", u16::from_le_bytes), (b"\xfe\xff", u16::from_be_bytes)];

/// The text of a file: UTF-8, or UTF-16 with a byte-order mark; the mark is taken away. Bytes that are not UTF-8 are read as
/// Latin-1, where every byte is a character, and the fault to warn with is returned beside.
pub fn decode(bytes: &[u8]) -> (String, Option<Fault>) {
    for (mark, unit) in UTF16 {
        if let Some(units) = bytes.strip_prefix(mark) {
            let (pairs, _) = units.as_chunks::<2>();
            let letters = char::decode_utf16(pairs.iter().map(|pair| unit(*pair)));
            let text = letters.map(|letter| letter.unwrap_or(char::REPLACEMENT_CHARACTER));
            return (text.collect(), None);
        }
    }
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

#[cfg(test)]
mod tests {
    use super::decode;

    #[test]
    fn utf16_is_read_after_its_mark() {
        let letters: Vec<u16> = "x = \"°C 😀\"".encode_utf16().collect();
        for (mark, bytes) in
            [(0xfeff_u16, u16::to_le_bytes as fn(u16) -> [u8; 2]), (0xfeff, u16::to_be_bytes)]
        {
            let all = std::iter::once(mark).chain(letters.iter().copied());
            let file: Vec<u8> = all.flat_map(bytes).collect();
            assert_eq!(decode(&file), ("x = \"°C 😀\"".to_owned(), None));
        }
    }
}
