//! A journal being written: records are collected and appended from time to time.

use crate::Session;
use crate::diag::Fault;
use crate::fault;
use crate::identify::problem::is_of_another_version;
use crate::registry::BAD_OPTION;
use std::io;
use std::path::{Path, PathBuf};

/// Seconds between two writes by default.
pub(super) const SECONDS: f64 = 2.0;

/// A journal with what is not yet in the file.
pub(super) struct Checkpoint {
    path: PathBuf,
    pending: Vec<u8>,
    records: u64,
    written: f64,
    /// Records and seconds after which it is written.
    every: (Option<u64>, f64),
    /// All that the file holds, in case that it is removed; `None` when that is too much.
    whole: Option<Vec<u8>>,
    /// When the file was last safe on the disk.
    synced: f64,
    /// Why it could not be written.
    broken: Option<String>,
}

/// Bytes of a journal that are kept besides the file.
const KEPT: usize = 64 << 20;

/// How often it is made again where another process removes its folder at the same moment. One
/// attempt was too few while `rm -r` was at work.
const ATTEMPTS: usize = 20;

/// Seconds between two times that the file is made safe against a power cut.
const SAFE: f64 = 2.0;

/// The path with the next free number.
pub(super) fn numbered(session: &Session, path: &Path) -> PathBuf {
    let numbered = |number: u32| {
        let mut name = path.as_os_str().to_owned();
        name.push(format!(".{number}"));
        PathBuf::from(name)
    };
    let free = (1..=u32::MAX).map(numbered).find(|old| !session.world.exists(old));
    free.unwrap_or_else(|| numbered(0))
}

/// Gives a journal of an earlier run the next free number, and says where it is.
pub(super) fn keep_old(session: &mut Session, path: &Path) -> Result<PathBuf, Fault> {
    let old = numbered(session, path);
    let bytes = session.world.read_bytes(path)?;
    session.world.write_safely(&old, &bytes)?;
    // What cannot be removed is written over.
    let _ = session.world.remove(path);
    Ok(old)
}

/// Why these bytes of a file are not a checkpoint.
pub(super) fn refused(path: &Path, bytes: &[u8]) -> Fault {
    let path = path.display();
    match is_of_another_version(bytes) {
        true => fault!(
            BAD_OPTION,
            "`{path}` is not a checkpoint that this version of gapilib can read: another one wrote it"
        ),
        false => fault!(BAD_OPTION, "`{path}` is not a checkpoint"),
    }
}

impl Checkpoint {
    /// A journal in the file `path`, which holds everything up to the time `now` in seconds.
    pub(super) fn new(path: PathBuf, every: (Option<u64>, f64), now: f64) -> Checkpoint {
        Checkpoint {
            path,
            pending: Vec::new(),
            records: 0,
            written: now,
            every,
            whole: Some(Vec::new()),
            synced: f64::NEG_INFINITY,
            broken: None,
        }
    }

    /// The same, where the file holds these bytes.
    pub(super) fn after(mut self, bytes: Vec<u8>) -> Checkpoint {
        self.whole = Some(bytes);
        self
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
        let mut written = self.append(session, now);
        for _ in 0..ATTEMPTS {
            let has_gone = written.as_ref().is_err_and(|e| e.kind() == io::ErrorKind::NotFound);
            if !has_gone || self.whole.is_none() {
                break;
            }
            written = self.append(session, now);
        }
        match written {
            Ok(()) => self.keep_pending(),
            Err(error) => {
                // A part may have been written; what precedes it is complete.
                self.broken = Some(format!("{error}; the run continues without checkpoints"));
                let text = format!(
                    "warning: `{}` cannot be written: {error}; the run continues without \
                     checkpoints\n",
                    self.path.display()
                );
                session.world.eprint(&text);
            }
        }
    }

    /// Writes what was collected, and makes it safe on the disk: the run ends.
    pub(super) fn secure(&mut self, session: &mut Session, now: f64) {
        self.flush(session, now);
        if self.broken.is_none() && session.world.exists(&self.path) {
            // What cannot be made safe has been written all the same.
            let _ = session.world.sync(&self.path);
        }
    }

    /// Appends to what the file holds, all of it where the file has gone.
    fn append(&mut self, session: &mut Session, now: f64) -> io::Result<()> {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        if !session.world.exists(folder) {
            session.world.create_dirs(folder)?;
        }
        let holds_records = self.whole.as_ref().is_none_or(|whole| !whole.is_empty());
        if holds_records && !session.world.exists(&self.path) {
            let Some(whole) = &self.whole else {
                return Err(io::Error::new(io::ErrorKind::NotFound, "it was removed"));
            };
            let all = [whole.as_slice(), &self.pending].concat();
            return session.world.write(&self.path, &all);
        }
        session.world.append(&self.path, &self.pending)?;
        if now - self.synced >= SAFE || now < self.synced {
            self.synced = now;
            session.world.sync(&self.path)?;
        }
        Ok(())
    }

    fn keep_pending(&mut self) {
        match &mut self.whole {
            Some(whole) if whole.len() + self.pending.len() <= KEPT => {
                whole.append(&mut self.pending);
            }
            _ => self.whole = None,
        }
        self.pending.clear();
    }
}
