//! What runs have made outside of their output folder, so that the next run of the same problem
//! replaces its own files and no others.
//!
//! The record lies in the output folder. A line names a file by its number in the file system and
//! the time of its birth, which cannot be known before: a record that came with a download
//! describes no file of this machine.

use std::collections::BTreeMap;
use std::fs::{File, Metadata};
use std::io;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

/// Lines beyond twice the number of files that are written before the record is rewritten.
const SLACK: usize = 1000;

/// The files made, by their real paths.
#[derive(Debug, Default)]
pub(super) struct Record {
    files: BTreeMap<PathBuf, Identity>,
    lines: usize,
}

/// A file as the file system knows it: number and nanoseconds from 1970 to its birth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Identity(u64, u128);

impl Identity {
    /// `None` where the file system keeps no time of birth.
    fn of(found: &Metadata) -> Option<Identity> {
        let birth = found.created().ok()?.duration_since(UNIX_EPOCH).ok()?;
        Some(Identity(number(found), birth.as_nanos()))
    }
}

#[cfg(unix)]
fn number(found: &Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::ino(found)
}

#[cfg(not(unix))]
fn number(_: &Metadata) -> u64 {
    0
}

impl Record {
    /// Reads lines; the last one of a file counts.
    pub(super) fn read(text: &str) -> Record {
        let mut record = Record::default();
        for line in text.lines() {
            let mut parts = line.splitn(3, ' ');
            let identity = (|| {
                let (number, birth) = (parts.next()?.parse().ok()?, parts.next()?.parse().ok()?);
                Some(Identity(number, birth))
            })();
            if let (Some(identity), Some(path)) = (identity, parts.next()) {
                record.files.insert(PathBuf::from(path), identity);
                record.lines += 1;
            }
        }
        record
    }

    /// The files that are still the ones that were made.
    pub(super) fn unchanged(&self) -> impl Iterator<Item = &Path> {
        let is_same = |(path, identity): &(&PathBuf, &Identity)| {
            std::fs::symlink_metadata(path)
                .is_ok_and(|found| Identity::of(&found).as_ref() == Some(*identity))
        };
        self.files.iter().filter(is_same).map(|(path, _)| path.as_path())
    }

    /// Notes a file that is going to have this path; the line to be written, or all of them.
    pub(super) fn note(&mut self, real: &Path, file: &File) -> io::Result<Option<Lines>> {
        let Some(identity) = Identity::of(&file.metadata()?) else { return Ok(None) };
        self.files.insert(real.to_owned(), identity);
        self.lines += 1;
        if self.lines <= 2 * self.files.len() + SLACK {
            return Ok(line(real, identity).map(Lines::Further));
        }
        self.lines = self.files.len();
        Ok(Some(Lines::All(self.files.iter().filter_map(|(path, id)| line(path, *id)).collect())))
    }
}

/// What is to be written.
pub(super) enum Lines {
    /// After the existing lines.
    Further(String),
    /// In place of what is there.
    All(String),
}

fn line(real: &Path, Identity(number, birth): Identity) -> Option<String> {
    let path = real.to_str().filter(|path| !path.contains(['\n', '\r']))?;
    Some(format!("{number} {birth} {path}\n"))
}
