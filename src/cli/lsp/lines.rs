//! Positions of the protocol: lines, and UTF-16 code units in them.

use lsp_types::{Position, Range};
use std::ops;

/// Where the lines of a text begin. Lines end with `\n`, `\r\n` or `\r`, as the protocol says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Lines {
    starts: Vec<usize>,
}

impl Lines {
    /// The lines of a text.
    pub fn of(text: &str) -> Lines {
        let bytes = text.as_bytes();
        let ends = |at: &usize| match bytes[*at] {
            b'\n' => true,
            b'\r' => bytes.get(at + 1) != Some(&b'\n'),
            _ => false,
        };
        let starts = (0..bytes.len()).filter(ends).map(|at| at + 1);
        Lines { starts: std::iter::once(0).chain(starts).collect() }
    }

    /// The bytes of a line without its end; for a line that does not exist, those after the text.
    pub fn content(&self, text: &str, line: usize) -> ops::Range<usize> {
        let Some(start) = self.starts.get(line).copied() else { return text.len()..text.len() };
        let end = self.starts.get(line + 1).copied().unwrap_or(text.len());
        let line = text[start..end].trim_end_matches(['\r', '\n']);
        start..start + line.len()
    }

    /// The line of a byte.
    pub fn line_of(&self, offset: usize) -> usize {
        self.starts.partition_point(|start| *start <= offset).saturating_sub(1)
    }

    /// The byte of a position. After the end of a line it is the end, within a character its
    /// beginning.
    pub fn offset(&self, text: &str, position: Position) -> usize {
        let line = self.content(text, position.line as usize);
        let mut units = position.character as usize;
        for (at, character) in text[line.clone()].char_indices() {
            match units.checked_sub(character.len_utf16()) {
                Some(rest) if units > 0 => units = rest,
                _ => return line.start + at,
            }
        }
        line.end
    }

    /// The position of a byte; of one within a character that of the character.
    pub fn position(&self, text: &str, offset: usize) -> Position {
        let mut offset = offset.min(text.len());
        while !text.is_char_boundary(offset) {
            offset -= 1;
        }
        let line = self.line_of(offset);
        let units: usize = text[self.starts[line]..offset].chars().map(char::len_utf16).sum();
        Position { line: line as u32, character: units as u32 }
    }

    /// The range of some bytes.
    pub fn range(&self, text: &str, bytes: ops::Range<usize>) -> Range {
        Range { start: self.position(text, bytes.start), end: self.position(text, bytes.end) }
    }

    /// The bytes of a range; empty if its end precedes its start.
    pub fn bytes(&self, text: &str, range: Range) -> ops::Range<usize> {
        let start = self.offset(text, range.start);
        start..self.offset(text, range.end).max(start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The positions between the characters of a text, one after the other.
    fn positions(text: &str) -> Vec<(usize, Position)> {
        let mut found = Vec::new();
        let (mut line, mut character) = (0, 0);
        let mut characters = text.char_indices().peekable();
        while let Some((at, one)) = characters.next() {
            found.push((at, Position { line, character }));
            let is_end = one == '\n' || one == '\r' && characters.peek().map(|c| c.1) != Some('\n');
            (line, character) = match is_end {
                true => (line + 1, 0),
                false => (line, character + one.len_utf16() as u32),
            };
        }
        found.push((text.len(), Position { line, character }));
        found
    }

    proptest! {
        #[test]
        fn positions_count_utf16_units(
            text in "([a-z;\n]|\r\n|\r|\u{e9}|e\u{301}|\u{1f600}|\u{1f468}\u{200d}\u{1f4bb}){0,40}"
        ) {
            let lines = Lines::of(&text);
            for (offset, position) in positions(&text) {
                prop_assert_eq!(lines.position(&text, offset), position);
                // Between `\r` and `\n` there is no position of its own.
                let is_inside = text[..offset].ends_with('\r') && text[offset..].starts_with('\n');
                let expected = if is_inside { offset - 1 } else { offset };
                prop_assert_eq!(lines.offset(&text, position), expected);
            }
        }

        #[test]
        fn no_position_is_outside_the_text(
            text in "([a-z\n]|\r\n|\u{1f600}){0,20}", line in 0u32..30, character in 0u32..30
        ) {
            let offset = Lines::of(&text).offset(&text, Position { line, character });
            prop_assert!(text.is_char_boundary(offset));
        }
    }

    #[test]
    fn a_position_within_a_character_is_its_beginning() {
        let text = "a\u{1f600}b";
        let lines = Lines::of(text);
        let offset = |character| lines.offset(text, Position { line: 0, character });
        assert_eq!([0, 1, 2, 3, 4, 9].map(offset), [0, 1, 1, 5, 6, 6]);
        assert_eq!(lines.position(text, 3), Position { line: 0, character: 1 });
    }
}
