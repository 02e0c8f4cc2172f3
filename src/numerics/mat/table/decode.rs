//! From bytes to text: byte-order marks, UTF-16, Latin-1, and the three ways to end a line.

use crate::bail;
use crate::diag::Fault;
use crate::mat::errors::BAD_TABLE;
use std::borrow::Cow;

/// The text of a file: UTF-8, UTF-16 with a byte-order mark, Latin-1 if it is neither.
pub(in crate::mat) fn decode(bytes: &[u8]) -> Cow<'_, str> {
    if let Some(rest) = bytes.strip_prefix(b"\xff\xfe") {
        return Cow::Owned(utf16(rest, u16::from_le_bytes));
    }
    if let Some(rest) = bytes.strip_prefix(b"\xfe\xff") {
        return Cow::Owned(utf16(rest, u16::from_be_bytes));
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(bytes.iter().copied().map(char::from).collect()),
    }
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> String {
    let (pairs, _) = bytes.as_chunks::<2>();
    char::decode_utf16(pairs.iter().map(|pair| unit(*pair)))
        .map(|letter| letter.unwrap_or(char::REPLACEMENT_CHARACTER))
        .collect()
}

/// The text with `\n` at the ends of lines; an empty file, a page of the web and binary data are
/// not tables.
pub(crate) fn lines_of(bytes: &[u8]) -> Result<Cow<'_, str>, Fault> {
    let text = decode(bytes);
    if text.trim().is_empty() {
        bail!(BAD_TABLE, "the file is empty"; help: "write the column names in the first line");
    }
    let start: String = text.trim_start().chars().take(15).collect::<String>().to_lowercase();
    if start.starts_with("<!doctype html") || start.starts_with("<html") {
        bail!(
            BAD_TABLE,
            "the file is a web page (HTML), not a table";
            help: "download the data again; the page may require a login"
        );
    }
    if let Some(at) = text.find('\0') {
        let line = text[..at].matches('\n').count() + 1;
        bail!(
            BAD_TABLE,
            "line {line}: the file contains binary data, not a table";
            help: "save it as CSV in UTF-8"
        );
    }
    match text.contains('\r') {
        true => Ok(Cow::Owned(text.replace("\r\n", "\n").replace('\r', "\n"))),
        false => Ok(text),
    }
}
