//! Files that are older than a script believes.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Files that commands of this run were to write and did not.
#[derive(Debug, Default)]
pub(super) struct Outdated {
    /// Each with the reason.
    files: BTreeMap<PathBuf, String>,
    /// Files that the commands being executed are going to write. They can be read until then: a model may
    /// read what the simulation before has written.
    expected: BTreeSet<PathBuf>,
    /// Files that hold what their simulations had computed when they failed.
    unfinished: BTreeSet<PathBuf>,
}

impl Outdated {
    /// Why a file is older than a script believes, if it is.
    pub(super) fn reason(&self, file: &Path) -> Option<&str> {
        self.files.get(file).map(String::as_str)
    }

    /// Whether a file holds what a simulation had computed when it failed.
    pub(super) fn is_unfinished(&self, file: &Path) -> bool {
        self.unfinished.contains(file)
    }

    /// A command is going to write this file.
    pub(super) fn expect(&mut self, file: PathBuf) {
        self.expected.insert(file);
    }

    /// The file was written.
    pub(super) fn note_written(&mut self, file: &Path) {
        self.expected.remove(file);
        self.files.remove(file);
        self.unfinished.remove(file);
    }

    /// The file was written as far as its simulation came; what was to be written is still missing.
    pub(super) fn note_unfinished(&mut self, file: &Path) {
        self.unfinished.insert(file.to_path_buf());
        self.expected.insert(file.to_path_buf());
    }

    /// The file could not be written.
    pub(super) fn note_failed(&mut self, file: PathBuf, reason: String) {
        self.files.insert(file, reason);
    }

    /// The command that was going to write this file has ended: whether it has not written it.
    pub(super) fn end(&mut self, file: &Path, reason: &str) -> bool {
        let is_missing = self.expected.remove(file);
        if is_missing {
            self.files.entry(file.to_path_buf()).or_insert_with(|| reason.to_owned());
        }
        is_missing
    }
}
