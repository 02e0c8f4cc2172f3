//! What the resolution of an expression knows besides its scope: local names, and what may be read.

use crate::eval::ValueType;
use crate::name::Ident;
use crate::syntax::ast::{ComponentReference, Expression, Subscript};
use crate::syntax::visit::{Visit, walk_reference};
use std::rc::Rc;

/// What the resolution of an expression knows besides its scope.
#[derive(Clone, Default)]
pub(crate) struct Local {
    /// Loop variables and variables of a function, innermost last; those of an unrolled loop with
    /// their value.
    pub names: Vec<(Ident, Option<Expression>)>,
    /// Inputs of a function.
    pub(crate) read_only: Vec<Ident>,
    /// Types of the variables of a function.
    pub types: Rc<Vec<(Ident, ValueType)>>,
    /// Whether variables are replaced by their values, which must be constant.
    pub values: bool,
    /// Whether impure functions may be called: in parameters, initial sections and when-clauses
    /// (MLS §12.3).
    pub impure: bool,
    /// Whether the call at hand is an equation: an impure function without outputs may then be called.
    pub(crate) is_equation: bool,
    /// Whether names are flat paths, to which protected components are visible.
    pub flat: bool,
}

impl Local {
    /// What a local name stands for, if there is one: its value where it has one.
    pub(crate) fn get(&self, name: Ident) -> Option<&Option<Expression>> {
        self.names.iter().rev().find(|(known, _)| *known == name).map(|(_, value)| value)
    }

    /// Whether a subscript needs a local name that has no value yet.
    pub(crate) fn is_open(&self, subscript: &Subscript) -> bool {
        match subscript {
            Subscript::Index(e) => self.is_open_in(e),
            Subscript::All(_) => false,
        }
    }

    /// Whether an expression needs a local name that has no value yet.
    pub(crate) fn is_open_in(&self, e: &Expression) -> bool {
        let mut names = OpenNames { local: self, found: false };
        names.expression(e);
        names.found
    }

    /// This with more names that stay as they are.
    pub(crate) fn with(&self, names: impl IntoIterator<Item = Ident>) -> Local {
        let mut local = self.clone();
        local.names.extend(names.into_iter().map(|name| (name, None)));
        local
    }
}

/// Looks for local names without a value.
struct OpenNames<'a> {
    local: &'a Local,
    found: bool,
}

impl Visit for OpenNames<'_> {
    fn reference(&mut self, reference: &ComponentReference) {
        walk_reference(self, reference);
        let first = reference.parts.first().and_then(|part| self.local.get(part.name));
        self.found |= first.is_some_and(Option::is_none);
    }
}
