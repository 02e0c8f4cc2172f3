//! Expressions of records that refer to `outer` components: only an instance has their values.

use crate::name::Ident;
use crate::syntax::ast::{ComponentReference, Expression};
use crate::syntax::visit::{Visit, walk_reference};

/// Whether an expression refers to one of these components.
pub(super) fn names_any(e: &Expression, names: &[Ident]) -> bool {
    let mut search = NameSearch { names, found: false };
    search.expression(e);
    search.found
}

struct NameSearch<'a> {
    names: &'a [Ident],
    found: bool,
}

impl Visit for NameSearch<'_> {
    fn reference(&mut self, reference: &ComponentReference) {
        walk_reference(self, reference);
        let first = reference.parts.first().map(|part| part.name);
        self.found |= first.is_some_and(|name| self.names.contains(&name));
    }
}
