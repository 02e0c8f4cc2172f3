//! Classes in their enclosing scopes (MLS §5.6.1): the text of a class with the modifiers and
//! redeclarations that reach it and the scope in which it stands. The same text in two
//! scopes, such as `Medium` in two tanks, is two scopes.

use super::elements::Elements;
use super::modification::Modifier;
use crate::diag::Diagnostic;
use crate::flatten::ids::NodeId;
use crate::flatten::ids::ScopeId;
use crate::flatten::library::ClassId;
use crate::flatten::lookup::types::Type;
use crate::name::Name;
use crate::source::Span;
use crate::syntax::ast::{
    ClassDefinition, ClassSpecifier, Element, Exclusion, Restriction, Section, Visibility,
};
use std::rc::Rc;
use std::sync::Arc;

/// The text of a class.
#[derive(Debug, Clone)]
pub(crate) struct Text {
    /// Full name, for messages and as the name of functions and records.
    pub name: Name,
    pub definition: Arc<ClassDefinition>,
    /// The class of the library; `None` for one in a modification.
    pub id: Option<ClassId>,
    /// For `extends M(…)` (MLS §7.3.1): the class that it extends and replaces.
    pub extended: Option<Rc<Nested>>,
}

impl Text {
    pub(crate) fn restriction(&self) -> Restriction {
        self.definition.restriction
    }

    pub(crate) fn span(&self) -> Span {
        self.definition.name.span
    }

    /// The sections of a long class; none for a short one.
    pub(crate) fn sections(&self) -> &[Section] {
        match &self.definition.specifier {
            ClassSpecifier::Long(long) => &long.sections,
            _ => &[],
        }
    }

    /// The elements with whether they are protected, in order.
    pub(crate) fn elements(&self) -> impl Iterator<Item = (bool, &Element)> {
        self.sections().iter().flat_map(|section| {
            let (protected, elements) = match section {
                Section::Elements { visibility, elements } => {
                    (*visibility == Some(Visibility::Protected), elements.as_slice())
                }
                _ => (false, [].as_slice()),
            };
            elements.iter().map(move |element| (protected, element))
        })
    }
}

/// A class declared in another, with all that replaces or modifies it there.
#[derive(Debug)]
pub(crate) struct Nested {
    pub text: Text,
    /// The scope in which its text stands.
    pub parent: ScopeId,
    /// Modifiers over its own.
    pub modifier: Modifier,
    /// Modifiers under its own: those of a constraining clause (MLS §7.3.2).
    pub defaults: Modifier,
    pub outer: bool,
    pub inner: bool,
    pub instance: std::cell::Cell<Option<Type>>,
}

/// A class in its enclosing scope.
#[derive(Debug)]
pub(crate) struct Scope {
    pub text: Option<Text>,
    /// The scope in which the text stands; `None` for the top.
    pub parent: Option<ScopeId>,
    /// The instance whose components the names in the text mean; that of the derived class for a
    /// base class.
    pub node: NodeId,
    pub modifier: Modifier,
    pub defaults: Modifier,
    /// The class that extends this one here.
    pub derived: Option<ScopeId>,
    /// What the extends clause of that class leaves out of this one.
    pub excluded: Vec<Exclusion>,
    pub bases: Stage<Rc<[ScopeId]>>,
    pub elements: Stage<Rc<Elements>>,
}

/// What is found out at most once.
#[derive(Debug, Clone, Default)]
pub(crate) enum Stage<T> {
    #[default]
    Pending,
    Busy,
    Done(T),
    Failed(Box<Diagnostic>),
}
