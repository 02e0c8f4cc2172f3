//! What a modification is about, as far as declarations show.

use super::certainty::is_certain;
use crate::flatten::checks::scope::{Component, Scope};
use crate::flatten::declared::Declared;
use crate::flatten::library::Library;
use crate::flatten::lookup::types::Predefined;
use crate::name::Ident;

/// What a modification is about.
#[derive(Clone, Copy)]
pub(crate) enum Modified<'a> {
    /// A class, whose elements are all known or not.
    Class { class: Scope<'a>, is_certain: bool },
    /// A variable, or a type, with the attributes of the predefined types.
    Variable(Ident),
    /// Nothing is known of it.
    Unknown,
}

impl<'a> Modified<'a> {
    /// A class by itself.
    pub(crate) fn class(class: Scope<'a>) -> Modified<'a> {
        Modified::of_class(class, !class.is_open())
    }

    /// What the parts of a name lead to.
    pub(crate) fn by_parts(library: &'a Library, parts: &[Option<Declared>]) -> Modified<'a> {
        let is_certain = is_certain(library, parts);
        match parts.last().copied().flatten() {
            Some(Declared::Class(class)) => {
                Modified::of_class(Scope { library, class }, is_certain)
            }
            Some(Declared::Component(owner, name)) => {
                let component = Scope { library, class: owner }.own_component(name);
                component.map_or(Modified::Unknown, |one| Modified::of_component(&one, is_certain))
            }
            Some(Declared::Predefined(name)) => {
                let predefined = Predefined::named(name);
                predefined.map_or(Modified::Unknown, |one| Modified::of_predefined(one, name))
            }
            Some(Declared::Literal(..)) | None => Modified::Unknown,
        }
    }

    fn of_class(class: Scope<'a>, is_certain: bool) -> Modified<'a> {
        let name = class.definition().name.node;
        match class.predefined() {
            Some(predefined) => Modified::of_predefined(predefined, name),
            None if class.is_enumeration() => Modified::Variable(name),
            None => Modified::Class { class, is_certain },
        }
    }

    fn of_component(component: &Component<'a>, is_certain: bool) -> Modified<'a> {
        let modified = match component.predefined() {
            Some(predefined) => Modified::of_predefined(predefined, component.name()),
            None => component
                .class()
                .map_or(Modified::Unknown, |class| Modified::of_class(class, is_certain)),
        };
        modified.of(component.name())
    }

    fn of_predefined(predefined: Predefined, name: Ident) -> Modified<'a> {
        match predefined {
            Predefined::ExternalObject | Predefined::Clock => Modified::Unknown,
            _ => Modified::Variable(name),
        }
    }

    /// The same of a component of this name.
    pub(crate) fn of(self, name: Ident) -> Modified<'a> {
        match self {
            Modified::Variable(_) => Modified::Variable(name),
            other => other,
        }
    }

    /// The same where another type may replace it.
    pub(crate) fn replaceable_if(self, is_replaceable: bool) -> Modified<'a> {
        match self {
            Modified::Class { class, is_certain } => {
                Modified::Class { class, is_certain: is_certain && !is_replaceable }
            }
            other => other,
        }
    }
}
