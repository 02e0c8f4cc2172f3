//! The journal of a search, of a problem or of a script: what it depends on, the answers to every request
//! and what the user changed, one entry after the other, each with its length and a checksum. A run
//! that ended in the middle of an entry has lost that entry alone.
//!
//! ```text
//! file = "GAPIRUN4", frame, frame, …
//! ```

use super::evaluation::Answered;
use super::frame::{first_frame, frame};
use super::{Failed, Origins};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

const MAGIC: &[u8; 8] = b"GAPIRUN4";
/// What journals of other versions begin with.
const OTHERS: [&[u8]; 2] = [b"GAPIRUN", b"GAPISCR"];

/// A request of the method with its answers.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Seconds of work up to here.
    pub seconds: f64,
    /// Settings changed before this request: name and value.
    pub changes: Vec<(String, f64)>,
    /// A number made of the genes that were asked: a run that asks others is another run.
    pub asked: u64,
    /// What came out.
    pub answered: Answered,
}

/// An entry of a journal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Entry<'a> {
    /// What the next entries depend on.
    From(Cow<'a, Origins>),
    /// A request of the method of a problem.
    Answered(Cow<'a, Record>),
    /// A population that a script has simulated.
    Simulated {
        /// A number made of what was asked.
        asked: u64,
        /// The simulated points.
        rows: Cow<'a, [f64]>,
        /// Which individuals failed.
        failures: Vec<(u32, Failed)>,
    },
    /// A statement that the user typed between two populations of a script.
    Typed(Cow<'a, str>),
}

/// A journal that was read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Journal {
    /// The entries that are whole.
    pub entries: Vec<Entry<'static>>,
    /// How many bytes they take; what follows is damaged or was not finished.
    pub whole: usize,
    /// Bytes after them.
    pub lost: usize,
}

impl Journal {
    /// What the run of a problem depends on; `None` where that was lost.
    pub fn origins(&self) -> Option<&Origins> {
        match self.entries.first()? {
            Entry::From(origins) => Some(origins),
            _ => None,
        }
    }

    /// The requests of the method of a problem.
    pub fn records(self) -> Vec<Record> {
        let record = |entry| match entry {
            Entry::Answered(record) => Some(record.into_owned()),
            _ => None,
        };
        self.entries.into_iter().filter_map(record).collect()
    }
}

/// The beginning of a journal, before its first entry.
pub fn begin() -> Vec<u8> {
    MAGIC.to_vec()
}

/// The beginning of the journal of a problem.
pub fn header(origins: &Origins) -> Vec<u8> {
    [begin(), Entry::From(Cow::Borrowed(origins)).to_bytes()].concat()
}

impl Entry<'_> {
    /// The entry as it is written.
    pub fn to_bytes(&self) -> Vec<u8> {
        // Numbers and strings only.
        frame(&postcard::to_allocvec(self).unwrap_or_default())
    }
}

/// A record as an entry.
pub fn encode(record: &Record) -> Vec<u8> {
    Entry::Answered(Cow::Borrowed(record)).to_bytes()
}

/// The journal of a problem without the times that its run took; what is none stays as it is.
pub fn without_times(bytes: &[u8]) -> Vec<u8> {
    let Some(journal) = decode(bytes) else { return bytes.to_vec() };
    let Some(origins) = journal.origins() else { return bytes.to_vec() };
    let mut timeless = header(origins);
    for record in journal.records() {
        timeless.extend(encode(&Record { seconds: 0.0, ..record }));
    }
    timeless
}

/// Reads a journal as far as it is whole; `None` when it is none at all.
pub fn decode(bytes: &[u8]) -> Option<Journal> {
    let mut rest = bytes.strip_prefix(MAGIC)?;
    let mut journal = Journal::default();
    while let Some((payload, others)) = first_frame(rest) {
        let Ok(entry) = postcard::from_bytes(payload) else { break };
        journal.entries.push(entry);
        rest = others;
    }
    journal.lost = rest.len();
    journal.whole = bytes.len() - rest.len();
    Some(journal)
}

/// Whether these bytes are a journal that another version of this program has written.
pub fn is_of_another_version(bytes: &[u8]) -> bool {
    !bytes.starts_with(MAGIC) && OTHERS.iter().any(|other| bytes.starts_with(other))
}

#[cfg(test)]
mod tests {
    use super::super::FailureKind;
    use super::*;

    fn record() -> Record {
        Record {
            seconds: 1.5,
            changes: vec![("mutation".to_owned(), 0.1)],
            asked: 77,
            answered: Answered {
                objectives: vec![1.0, f64::INFINITY, -0.0],
                residuals: vec![0.1],
                jacobians: vec![0.5, -0.5],
                failures: vec![(1, Failed::new(FailureKind::Solver, "log ≤ 0", 0.25))],
                simulations: 2,
            },
        }
    }

    #[test]
    fn what_was_written_is_read() {
        let origins = Origins::new();
        let mut bytes = header(&origins);
        let single = encode(&record());
        bytes.extend(&single);
        bytes.extend(&single);
        let journal = decode(&bytes).unwrap();
        assert_eq!((journal.whole, journal.lost), (bytes.len(), 0));
        assert_eq!(journal.origins(), Some(&origins));
        assert_eq!(journal.records(), [record(), record()]);
    }

    #[test]
    fn every_cut_and_every_damage_leaves_the_whole_records() {
        let mut bytes = header(&Origins::new());
        let begin = bytes.len();
        let single = encode(&record());
        bytes.extend(&single);
        bytes.extend(&single);
        for end in begin..bytes.len() {
            let records = decode(&bytes[..end]).unwrap().records().len();
            assert_eq!(records, usize::from(end >= begin + single.len()), "cut at {end}");
        }
        for place in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[place] ^= 0x40;
            let journal = decode(&damaged).filter(|journal| journal.origins().is_some());
            let Some(journal) = journal else {
                assert!(place < begin, "{place}");
                continue;
            };
            let whole = usize::from(place >= begin + single.len());
            assert_eq!(journal.whole + journal.lost, bytes.len());
            assert_eq!(journal.records().len(), whole, "{place}");
        }
        assert!(decode(b"something else").is_none());
        for other in [&b"GAPIRUN3"[..], b"GAPISCR2"] {
            assert!(decode(other).is_none() && is_of_another_version(other));
        }
        assert!(!is_of_another_version(&bytes) && !is_of_another_version(b"something else"));
        assert!(decode(b"").is_none());
    }
}
