//! How the loaded classes came to be what they are.

use super::reads::{Digest, digest};
use crate::name::Ident;

/// How the loaded classes came to be what they are, and which names were searched for.
#[derive(Debug, Default)]
pub struct History {
    /// Of all that changed them, in order.
    digest: Digest,
    /// Names of top-level classes, and whether a file was loaded, since the last
    /// [`History::forget_searches`].
    searches: Vec<(Ident, bool)>,
}

impl History {
    /// Something changed the classes.
    pub fn note(&mut self, what: &str, subject: &str) {
        let mut bytes = self.digest.to_vec();
        bytes.extend_from_slice(what.as_bytes());
        bytes.push(0);
        bytes.extend_from_slice(subject.as_bytes());
        self.digest = digest(&bytes);
    }

    /// A name was searched for, and a file was loaded or not.
    pub(crate) fn note_search(&mut self, name: Ident, is_loaded: bool) {
        self.searches.push((name, is_loaded));
    }

    pub(super) fn forget_searches(&mut self) {
        self.searches.clear();
    }

    pub(super) fn digest(&self) -> Digest {
        self.digest
    }

    pub(super) fn searches(&self) -> &[(Ident, bool)] {
        &self.searches
    }
}
