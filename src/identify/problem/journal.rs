//! The journal of a run: the answers to every request, one record after the other, each with its
//! length and a checksum. A run that ended in the middle of a record has lost that record alone.
//!
//! ```text
//! file   = "GAPIRUN3", frame of the origins of the problem, record, record, …
//! record = length of the payload (8 bytes), CRC-32 of it (4 bytes), payload
//! ```
//!
//! All numbers are little-endian.

use super::evaluation::Answered;
use super::frame::{first_frame, frame};
use super::{Failed, FailureKind, Origins};

const MAGIC: &[u8; 8] = b"GAPIRUN3";

/// One question of the method with its answers.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Record {
    /// Seconds of work up to here.
    pub seconds: f64,
    /// Settings changed before this question: name and value.
    pub changes: Vec<(String, f64)>,
    /// A number made of the genes that were asked: a run that asks others is another run.
    pub asked: u64,
    /// What came out.
    pub answered: Answered,
}

/// A journal that was read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Journal {
    /// What the run depends on.
    pub origins: Origins,
    /// The records that are whole.
    pub records: Vec<Record>,
    /// How many bytes they take; what follows is damaged or was not finished.
    pub whole: usize,
    /// Bytes after them.
    pub lost: usize,
}

/// The beginning of a journal.
pub fn header(origins: &Origins) -> Vec<u8> {
    let mut bytes = MAGIC.to_vec();
    // Names and numbers only.
    bytes.extend(frame(&postcard::to_allocvec(origins).unwrap_or_default()));
    bytes
}

/// A record as bytes.
pub fn encode(record: &Record) -> Vec<u8> {
    let mut payload = Vec::new();
    payload.extend(record.seconds.to_le_bytes());
    payload.extend(record.asked.to_le_bytes());
    payload.extend(record.answered.simulations.to_le_bytes());
    put_count(&mut payload, record.changes.len());
    for (name, value) in &record.changes {
        put_text(&mut payload, name);
        payload.extend(value.to_le_bytes());
    }
    let Answered { objectives, residuals, jacobians, .. } = &record.answered;
    for numbers in [objectives, residuals, jacobians] {
        put_count(&mut payload, numbers.len());
        numbers.iter().for_each(|value| payload.extend(value.to_le_bytes()));
    }
    put_count(&mut payload, record.answered.failures.len());
    for (k, failed) in &record.answered.failures {
        put_count(&mut payload, *k);
        payload
            .push(FailureKind::ALL.iter().position(|kind| *kind == failed.kind).unwrap_or(0) as u8);
        payload.extend(failed.progress.to_le_bytes());
        put_text(&mut payload, &failed.cause);
    }
    frame(&payload)
}

/// A journal without the times that its run took; what is none stays as it is.
pub fn without_times(bytes: &[u8]) -> Vec<u8> {
    let Some(journal) = decode(bytes) else { return bytes.to_vec() };
    let mut timeless = header(&journal.origins);
    for record in journal.records {
        timeless.extend(encode(&Record { seconds: 0.0, ..record }));
    }
    timeless
}

/// Reads a journal as far as it is whole; `None` when it is none at all.
pub fn decode(bytes: &[u8]) -> Option<Journal> {
    let mut reader = Reader { bytes };
    if reader.take(MAGIC.len())? != MAGIC {
        return None;
    }
    let (origins, rest) = first_frame(reader.bytes)?;
    let origins = postcard::from_bytes(origins).ok()?;
    reader.bytes = rest;
    let mut journal = Journal { origins, ..Journal::default() };
    journal.whole = bytes.len() - reader.bytes.len();
    while let Some(record) = whole_record(&mut reader) {
        journal.records.push(record);
        journal.whole = bytes.len() - reader.bytes.len();
    }
    journal.lost = bytes.len() - journal.whole;
    Some(journal)
}

fn whole_record(reader: &mut Reader<'_>) -> Option<Record> {
    let (payload, rest) = first_frame(reader.bytes)?;
    let record = record(&mut Reader { bytes: payload })?;
    reader.bytes = rest;
    Some(record)
}

fn record(reader: &mut Reader<'_>) -> Option<Record> {
    let mut record =
        Record { seconds: reader.number()?, asked: reader.integer()?, ..Record::default() };
    record.answered.simulations = reader.integer()?;
    for _ in 0..reader.count()? {
        record.changes.push((reader.text()?, reader.number()?));
    }
    record.answered.objectives = reader.numbers()?;
    record.answered.residuals = reader.numbers()?;
    record.answered.jacobians = reader.numbers()?;
    for _ in 0..reader.count()? {
        let k = reader.count()?;
        let kind = *FailureKind::ALL.get(usize::from(reader.take(1)?[0]))?;
        let (progress, cause) = (reader.number()?, reader.text()?);
        record.answered.failures.push((k, Failed { kind, cause, progress }));
    }
    reader.bytes.is_empty().then_some(record)
}

fn put_count(bytes: &mut Vec<u8>, count: usize) {
    bytes.extend((count as u64).to_le_bytes());
}

fn put_text(bytes: &mut Vec<u8>, text: &str) {
    put_count(bytes, text.len());
    bytes.extend(text.as_bytes());
}

/// The bytes not read yet.
struct Reader<'a> {
    bytes: &'a [u8],
}

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.bytes.split_at_checked(count)?;
        self.bytes = rest;
        Some(taken)
    }

    fn integer(&mut self) -> Option<u64> {
        Some(u64::from_le_bytes(self.take(8)?.try_into().ok()?))
    }

    /// A number of things, each of which takes a byte or more.
    fn count(&mut self) -> Option<usize> {
        usize::try_from(self.integer()?).ok()
    }

    fn number(&mut self) -> Option<f64> {
        Some(f64::from_bits(self.integer()?))
    }

    fn numbers(&mut self) -> Option<Vec<f64>> {
        let count = self.count()?;
        if count > self.bytes.len() / 8 {
            return None;
        }
        (0..count).map(|_| self.number()).collect()
    }

    fn text(&mut self) -> Option<String> {
        let count = self.count()?;
        String::from_utf8(self.take(count)?.to_vec()).ok()
    }
}

#[cfg(test)]
mod tests {
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
                failures: vec![(
                    1,
                    Failed { kind: FailureKind::Solver, cause: "log ≤ 0".into(), progress: 0.25 },
                )],
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
        assert_eq!((journal.origins, journal.records), (origins, vec![record(), record()]));
    }

    #[test]
    fn every_cut_and_every_damage_leaves_the_whole_records() {
        let mut bytes = header(&Origins::new());
        let begin = bytes.len();
        let single = encode(&record());
        bytes.extend(&single);
        bytes.extend(&single);
        for end in begin..bytes.len() {
            let records = decode(&bytes[..end]).unwrap().records.len();
            assert_eq!(records, usize::from(end >= begin + single.len()), "cut at {end}");
        }
        for place in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[place] ^= 0x40;
            let Some(journal) = decode(&damaged) else {
                assert!(place < begin, "{place}");
                continue;
            };
            let whole = usize::from(place >= begin + single.len());
            assert_eq!(journal.records.len(), whole, "{place}");
            assert_eq!(journal.whole + journal.lost, bytes.len());
        }
        assert!(decode(b"something else").is_none());
        assert!(decode(b"").is_none());
    }
}
