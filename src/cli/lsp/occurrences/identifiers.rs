//! The identifiers of a written name, whose places the tree does not have one by one.

use std::ops::Range;

/// The identifiers in some bytes of a text, those in brackets and strings left out.
pub(crate) fn identifiers(text: &str, within: Range<usize>) -> Vec<Range<usize>> {
    let Some(part) = text.get(within.clone()) else { return Vec::new() };
    let bytes = part.as_bytes();
    let (mut found, mut depth, mut at) = (Vec::new(), 0_usize, 0);
    while at < bytes.len() {
        let start = at;
        at = end_of_token(part, at);
        match bytes[start] {
            b'(' | b'[' => depth += 1,
            b')' | b']' => depth = depth.saturating_sub(1),
            first if depth == 0 && (begins_word(first) || first == b'\'') => {
                found.push(within.start + start..within.start + at);
            }
            _ => {}
        }
    }
    found
}

/// Where what begins at a byte ends: a word, something quoted, a comment, or one character.
fn end_of_token(text: &str, start: usize) -> usize {
    let rest = &text[start..];
    let first = rest.as_bytes()[0];
    let length = match first {
        b'\'' | b'"' => quoted(rest),
        b'/' if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
        b'/' if rest.starts_with("/*") => rest.find("*/").map_or(rest.len(), |end| end + 2),
        _ if begins_word(first) || first.is_ascii_digit() => {
            rest.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(rest.len())
        }
        _ => rest.chars().next().map_or(1, char::len_utf8),
    };
    start + length
}

/// Bytes from one quotation mark to the next that is not escaped.
fn quoted(text: &str) -> usize {
    let quote = text.as_bytes()[0];
    let mut escaped = false;
    for (at, byte) in text.bytes().enumerate().skip(1) {
        match byte {
            b'\\' if !escaped => escaped = true,
            byte if byte == quote && !escaped => return at + 1,
            _ => escaped = false,
        }
    }
    text.len()
}

fn begins_word(byte: u8) -> bool {
    byte.is_ascii_alphabetic() || byte == b'_'
}

/// Whether a text is an identifier that can be declared.
pub(crate) fn is_identifier(text: &str) -> bool {
    let is_word = text.as_bytes().first().is_some_and(|first| begins_word(*first))
        && text.bytes().all(|byte| begins_word(byte) || byte.is_ascii_digit());
    let is_quoted = text.len() > 2
        && text.starts_with('\'')
        && quoted(text) == text.len()
        && text.ends_with('\'')
        && !text.contains(['\n', '\r']);
    is_quoted || is_word && !crate::syntax::is_keyword(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_of_a_name_are_found() {
        let text = "x = a.'b c'[i, \"]\"] /* d */ . e(f) + g;";
        let parts = identifiers(text, 4..text.len());
        let parts: Vec<&str> = parts.into_iter().map(|range| &text[range]).collect();
        assert_eq!(parts, ["a", "'b c'", "e", "g"]);
        assert!(identifiers("\u{e9}", 0..9).is_empty());
    }

    #[test]
    fn identifiers_are_words_or_quoted() {
        for good in ["x", "_1", "'a b'", "'it\\'s'"] {
            assert!(is_identifier(good), "{good}");
        }
        for bad in ["", "1x", "x y", "model", "\u{e9}", "'", "''", "'a", "'a'b'", "'a\nb'"] {
            assert!(!is_identifier(bad), "{bad}");
        }
    }
}
