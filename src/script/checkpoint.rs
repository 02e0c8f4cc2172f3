//! A journal being written: records are collected and appended from time to time.

use super::Session;
use std::path::{Path, PathBuf};

/// Seconds between two writes unless something else is wanted.
pub(super) const SECONDS: f64 = 2.0;

/// A journal with what is not yet in the file.
pub(super) struct Checkpoint {
    path: PathBuf,
    pending: Vec<u8>,
    records: u64,
    written: f64,
    /// Records and seconds after which it is written.
    every: (Option<u64>, f64),
    /// Why it could not be written.
    broken: Option<String>,
}

impl Checkpoint {
    /// A journal in the file `path`, which holds everything up to the time `now` in seconds.
    pub(super) fn new(path: PathBuf, every: (Option<u64>, f64), now: f64) -> Checkpoint {
        Checkpoint { path, pending: Vec::new(), records: 0, written: now, every, broken: None }
    }

    /// Puts this before the first record of a new file.
    pub(super) fn begin(&mut self, magic: &[u8]) {
        self.pending.extend_from_slice(magic);
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Why records are missing in the file, if they are.
    pub(super) fn broken(&self) -> Option<&str> {
        self.broken.as_deref()
    }

    /// Adds a record at the time `now`, and writes when it is time to.
    pub(super) fn note(&mut self, session: &mut Session, record: &[u8], now: f64) {
        self.pending.extend_from_slice(record);
        self.records += 1;
        let enough = self.every.0.is_some_and(|limit| self.records >= limit);
        if enough || now - self.written >= self.every.1 {
            self.flush(session, now);
        }
    }

    /// Writes what was collected.
    pub(super) fn flush(&mut self, session: &mut Session, now: f64) {
        self.written = now;
        self.records = 0;
        if self.pending.is_empty() || self.broken.is_some() {
            return;
        }
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let made = match session.world.exists(folder) {
            true => Ok(()),
            false => session.world.create_dirs(folder),
        };
        match made.and_then(|()| session.world.append(&self.path, &self.pending)) {
            Ok(()) => self.pending.clear(),
            Err(error) => {
                // A part may have been written; what stands before it is whole.
                self.broken = Some(format!("{error}; the run goes on without"));
                let text = format!(
                    "warning: `{}` cannot be written: {error}; the run goes on without checkpoints\n",
                    self.path.display()
                );
                session.world.eprint(&text);
            }
        }
    }
}
