//! What called names stand for, remembered until a class or an import changes.

use super::Dialect;
use crate::eval::{Callee, Function};
use crate::name::Name;
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Names looked up before.
#[derive(Default)]
pub(super) struct Callees {
    state: (u64, Dialect),
    known: FxHashMap<Name, Option<Known>>,
}

#[derive(Clone)]
enum Known {
    Function(Arc<Function>),
    Builtin(Arc<Function>),
}

impl Callees {
    /// What the name stood for at this revision of the classes; `None` if that is not known.
    pub(super) fn get(
        &mut self,
        name: &Name,
        revision: u64,
        dialect: Dialect,
    ) -> Option<Option<Callee>> {
        if self.state != (revision, dialect) {
            self.known.clear();
            self.state = (revision, dialect);
        }
        let known = self.known.get(name)?.clone();
        Some(known.map(|known| match known {
            Known::Function(function) => Callee::Function(function),
            Known::Builtin(header) => Callee::Builtin(header),
        }))
    }

    /// Remembers an answer.
    pub(super) fn put(&mut self, name: &Name, callee: Option<&Callee>) {
        let known = callee.map(|callee| match callee {
            Callee::Function(function) => Known::Function(function.clone()),
            Callee::Builtin(header) => Known::Builtin(header.clone()),
        });
        self.known.insert(name.clone(), known);
    }

    /// Forgets everything.
    pub(super) fn clear(&mut self) {
        self.known.clear();
    }
}
