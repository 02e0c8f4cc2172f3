//! Which elements of a class are known from its declaration. Those of a replaceable class may be more
//! where it is used, and those of a class with an unknown base are not known at all: what cannot be
//! found there is not called wrong.

use crate::flatten::checks::scope::Scope;
use crate::flatten::declared::Declared;
use crate::flatten::library::{BaseProperty, ClassId, Library};
use crate::name::Name;
use crate::syntax::ast::{ClassSpecifier, Restriction};

impl<'a> Scope<'a> {
    /// Whether it may have elements that no declaration shows: it is replaceable, or
    /// [inherits](Scope::inherits_open) such.
    pub(crate) fn is_open(self) -> bool {
        self.library.is_replaceable(self.class) || self.inherits_open()
    }

    /// The class that the name of a function means in it, if no redeclaration can replace it and all
    /// that it inherits is known.
    pub(crate) fn certain_class(self, name: &Name) -> Option<Scope<'a>> {
        let parts = self.library.parts_of_reference(Some(self.class), name);
        match parts.last().copied().flatten()? {
            Declared::Class(class) if is_certain(self.library, &parts) => Some(self.of(class)),
            _ => None,
        }
    }

    /// Whether it, or a class that it extends, is an expandable connector, or extends an unknown or a
    /// replaceable class. What `redeclare model extends M` replaces (MLS §7.3.1) is replaceable, but
    /// there it is the inherited one.
    fn inherits_open(self) -> bool {
        self.first(BaseProperty::Open, |class| {
            class.restriction() == Restriction::ExpandableConnector || class.has_open_base()
        })
        .is_some()
    }

    /// Whether names in its text may mean elements that no declaration shows.
    pub(crate) fn has_open_names(self) -> bool {
        let mut around = std::iter::successors(Some(self), |scope| scope.around());
        let has_open = |class: Scope<'a>| {
            let bases = class.library.declared_bases(class.class);
            class.has_open_base() || bases.iter().any(|base| class.of(*base).inherits_open())
        };
        around.any(has_open)
    }

    /// Whether it extends, or is short for, a class that is unknown or found in a replaceable one.
    fn has_open_base(self) -> bool {
        let is_open = |parts: Vec<Option<Declared>>| {
            parts.iter().any(|part| part.is_none_or(|part| is_replaceable(self.library, part)))
        };
        match &self.definition().specifier {
            ClassSpecifier::Short(short) => {
                let around = self.library.enclosing(self.class);
                is_open(self.library.parts_of_type(around, &short.target.name))
            }
            ClassSpecifier::Long(long) => {
                let mut bases = self.library.class(self.class).extends.iter();
                let is_open_base = bases
                    .any(|one| is_open(self.library.parts_of_base(self.class, &one.base.name)));
                let replaced = || self.library.replaced_class(self.class);
                is_open_base || long.class_extends.is_some() && replaced().is_none()
            }
            _ => false,
        }
    }
}

/// Whether an element, or the type of a component, can be replaced by another one.
fn is_replaceable(library: &Library, declared: Declared) -> bool {
    match declared {
        Declared::Class(class) => library.is_replaceable(class),
        Declared::Component(owner, name) => {
            library.component(owner, name).is_none_or(|(clause, _)| {
                let parts = library.parts_of_type(Some(owner), &clause.type_specifier.name);
                let is_open =
                    |part: Option<Declared>| part.is_none_or(|part| is_replaceable(library, part));
                clause.prefixes.replaceable || parts.into_iter().any(is_open)
            })
        }
        Declared::Literal(..) | Declared::Predefined(_) => false,
    }
}

/// Whether the elements of what the parts of a name mean are known.
pub(crate) fn is_certain(library: &Library, parts: &[Option<Declared>]) -> bool {
    let is_closed = |class: ClassId| !Scope { library, class }.is_open();
    parts.iter().all(|part| {
        part.is_some_and(|part| {
            !is_replaceable(library, part) && library.class_of_declared(part).is_none_or(is_closed)
        })
    })
}
