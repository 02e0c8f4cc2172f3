//! References of cells that lie outside of all spreadsheets: the reader of cells computes with 32 bits
//! and takes `AAAAAAAA1` for another cell.
//!
//! The attributes `r` are found in the bytes of the entries that hold a sheet, as the reader finds them:
//! in UTF-8, between quotes, with ASCII white space around the equals sign, without entities.

use super::archive;
use std::io::{BufReader, Read};

/// Columns and rows of a sheet (ECMA-376, 18.3.1.73 and 18.3.1.13, as Excel and LibreOffice have them).
const MOST_COLUMNS: u64 = 16_384;
const MOST_ROWS: u64 = 1_048_576;
/// The name of the element with the cells.
const SHEET: &[u8] = b"sheetData";
/// Characters of a reference that a message shows.
const SHOWN: usize = 40;

/// The first reference of a cell or row outside of all spreadsheets, if the archive has one.
pub(crate) fn impossible(bytes: &[u8]) -> Option<String> {
    // Entries that are not compressed are found in the file itself.
    in_sheet(bytes).or_else(|| archive::entries(bytes).find_map(in_sheet))
}

/// The same for one entry: only in sheets, other parts have attributes of this name as well.
fn in_sheet(content: impl Read) -> Option<String> {
    let (mut scan, mut found, mut matched, mut is_sheet) = (Scan::Other, None, 0, false);
    // A damaged entry ends where it is damaged, for its reader as well.
    for byte in BufReader::new(content).bytes().map_while(Result::ok) {
        matched = match () {
            () if SHEET.get(matched) == Some(&byte) => matched + 1,
            () => usize::from(SHEET[0] == byte),
        };
        is_sheet |= matched == SHEET.len();
        if found.is_none() {
            let (next, impossible) = scan.after(byte);
            (scan, found) = (next, impossible);
        }
        if is_sheet && found.is_some() {
            return found;
        }
    }
    None
}

/// What was read last.
enum Scan {
    Other,
    /// White space, or a quote, which may end the attribute before.
    Gap,
    /// The name of the attribute, and white space.
    Name,
    /// The equals sign, and white space.
    Equals,
    /// The reference so far.
    Reference(Reference),
}

impl Scan {
    /// The state after this byte, and the reference that has become impossible.
    fn after(self, byte: u8) -> (Scan, Option<String>) {
        let is_quote = byte == b'"' || byte == b'\'';
        let next = match (self, byte) {
            (Scan::Gap, b'r') => Scan::Name,
            (Scan::Name, b'=') => Scan::Equals,
            (Scan::Name, _) if byte.is_ascii_whitespace() => Scan::Name,
            (Scan::Equals, _) if byte.is_ascii_whitespace() => Scan::Equals,
            (Scan::Equals, _) if is_quote => Scan::Reference(Reference::default()),
            (Scan::Reference(mut reference), _) if byte.is_ascii_alphanumeric() => {
                reference.push(byte);
                match reference.is_possible() {
                    true => Scan::Reference(reference),
                    false => return (Scan::Other, Some(reference.text)),
                }
            }
            _ if is_quote || byte.is_ascii_whitespace() => Scan::Gap,
            _ => Scan::Other,
        };
        (next, None)
    }
}

/// A column and a row, counted from 1; 0 where the letters or digits are missing.
#[derive(Default)]
struct Reference {
    text: String,
    column: u64,
    row: u64,
}

impl Reference {
    fn push(&mut self, byte: u8) {
        if self.text.len() < SHOWN {
            self.text.push(char::from(byte));
        }
        match byte {
            b'0'..=b'9' => self.row = 10 * self.row + u64::from(byte - b'0'),
            _ => {
                self.column = 26 * self.column + u64::from(byte.to_ascii_uppercase() - b'A') + 1;
            }
        }
    }

    fn is_possible(&self) -> bool {
        self.column <= MOST_COLUMNS && self.row <= MOST_ROWS
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(attributes: &str) -> Option<String> {
        in_sheet(format!("<sheetData><c {attributes}/></sheetData>").as_bytes())
    }

    #[test]
    fn references_end_where_spreadsheets_end() {
        for good in ["r=\"XFD1048576\"", "r='a1'", "s=\"1\" r=\"A0000000000001\"", "r=\"7\"", ""] {
            assert_eq!(found(good), None, "{good}");
        }
        for (bad, shown) in [
            ("r=\"XFE1\"", "XFE"),
            ("r=\"A1048577\"", "A1048577"),
            ("s='1'r=\"MWLQKWW1\"", "MWLQ"),
            ("r\n=\t'4294967297'", "4294967"),
            ("r = \"aaaa1\"", "aaaa"),
        ] {
            assert_eq!(found(bad).as_deref(), Some(shown), "{bad}");
        }
    }

    #[test]
    fn attributes_of_other_names_and_parts_are_no_references() {
        for other in
            ["xr=\"AAAA1\"", "r:id=\"AAAA1\"", "ref=\"AAAA1\"", "t=\"r\"", "a r b=\"AAAA1\""]
        {
            assert_eq!(found(other), None, "{other}");
        }
        let drawing = "<a:rect l=\"textLeft\" r=\"textRight\"/>";
        assert_eq!(in_sheet(drawing.as_bytes()), None);
        // The sheet may be named after the reference, and cut.
        let late = format!("{drawing}<ssheetData");
        assert_eq!(in_sheet(late.as_bytes()).as_deref(), Some("text"));
    }
}
