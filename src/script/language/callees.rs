//! What called names stand for, remembered until a class or an import changes.

use crate::Dialect;
use crate::eval::{Callee, Function};
use crate::name::{Ident, Name};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Names looked up before.
#[derive(Default)]
pub(crate) struct Callees {
    state: (u64, Dialect),
    known: FxHashMap<Name, Option<Known>>,
    /// Those of one identifier, found without making a name of it.
    simple: FxHashMap<Ident, Option<Known>>,
}

#[derive(Clone)]
enum Known {
    Function(Arc<Function>),
    Builtin(Arc<Function>),
}

impl Known {
    fn of(callee: &Callee) -> Known {
        match callee {
            Callee::Function(function) => Known::Function(function.clone()),
            Callee::Builtin(header) => Known::Builtin(header.clone()),
        }
    }

    fn callee(&self) -> Callee {
        match self {
            Known::Function(function) => Callee::Function(function.clone()),
            Known::Builtin(header) => Callee::Builtin(header.clone()),
        }
    }
}

impl Callees {
    /// What the name stood for at this revision of the classes; `None` if that is not known.
    pub(crate) fn get(
        &mut self,
        name: &Name,
        revision: u64,
        dialect: Dialect,
    ) -> Option<Option<Callee>> {
        self.keep_up(revision, dialect);
        Some(self.known.get(name)?.as_ref().map(Known::callee))
    }

    /// As [`Callees::get`], of a name of one identifier.
    pub(crate) fn get_simple(
        &mut self,
        name: Ident,
        revision: u64,
        dialect: Dialect,
    ) -> Option<Option<Callee>> {
        self.keep_up(revision, dialect);
        Some(self.simple.get(&name)?.as_ref().map(Known::callee))
    }

    fn keep_up(&mut self, revision: u64, dialect: Dialect) {
        if self.state != (revision, dialect) {
            self.clear();
            self.state = (revision, dialect);
        }
    }

    /// Remembers an answer.
    pub(crate) fn put(&mut self, name: &Name, callee: Option<&Callee>) {
        self.known.insert(name.clone(), callee.map(Known::of));
    }

    /// Remembers the answer to a name of one identifier.
    pub(crate) fn put_simple(&mut self, name: Ident, callee: Option<&Callee>) {
        self.simple.insert(name, callee.map(Known::of));
    }

    /// Forgets everything.
    pub(crate) fn clear(&mut self) {
        self.known.clear();
        self.simple.clear();
    }
}
