//! How much a ZIP archive holds, without trusting what it says of itself: a spreadsheet of 1 MB may
//! inflate to gigabytes.
//!
//! Every place with the signature of a local header is inflated into nothing, whatever the directory
//! of the archive says of sizes and places: readers find no other entries than those.

use flate2::read::DeflateDecoder;
use std::io::{self, Read};

/// With what the header of an entry begins.
const LOCAL: &[u8] = b"PK\x03\x04";
/// Bytes of a header before the name.
const HEADER: usize = 30;

/// The bytes that all entries have when they are inflated; `None` if they have more than `limit`.
pub(crate) fn inflated(bytes: &[u8], limit: u64) -> Option<u64> {
    let mut total = 0;
    for entry in entries(bytes) {
        let mut counted = Counted(0);
        // What is not compressed or damaged is no longer than the file; its reader finds out.
        let _ = io::copy(&mut entry.take(limit - total + 1), &mut counted);
        total += counted.0;
        if total > limit {
            return None;
        }
    }
    Some(total)
}

/// What follows each local header, inflated while it is read.
pub(crate) fn entries(bytes: &[u8]) -> impl Iterator<Item = DeflateDecoder<&[u8]>> {
    let mut rest = bytes;
    std::iter::from_fn(move || {
        let at = rest.windows(LOCAL.len()).position(|window| window == LOCAL)?;
        let header = &rest[at..];
        rest = &header[LOCAL.len()..];
        Some(DeflateDecoder::new(data(header)))
    })
}

/// The bytes after a header.
fn data(header: &[u8]) -> &[u8] {
    let length = |place: usize| match header.get(place..place + 2) {
        Some(bytes) => usize::from(u16::from_le_bytes([bytes[0], bytes[1]])),
        None => 0,
    };
    header.get(HEADER + length(26) + length(28)..).unwrap_or_default()
}

/// Counts what is written.
struct Counted(u64);

impl io::Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_an_archive_holds_is_counted() {
        let file = include_bytes!("../../../tests/data/spreadsheet/table.xlsx");
        let size = inflated(file, 1 << 20).expect("a small file");
        assert!(size > 1000, "{size}");
        assert_eq!(inflated(file, size), Some(size));
        assert_eq!(inflated(file, size - 1), None);
        for end in 0..file.len() {
            assert!(inflated(&file[..end], 1 << 20).is_some(), "cut at {end}");
        }
        assert_eq!(inflated(b"", 0), Some(0));
        // Another place than the one that a directory would name.
        let moved = [b"MZ", &file[..]].concat();
        assert_eq!(inflated(&moved, size - 1), None);
    }
}
