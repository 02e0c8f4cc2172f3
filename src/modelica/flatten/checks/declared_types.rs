//! Types of expressions as far as a class tells by itself: what its components and literals are
//! declared as.

use super::scope::{Component, Scope};
use crate::flatten::declared::classes::Type;
use crate::flatten::library::ClassId;
use crate::flatten::lookup::types::Predefined;
use crate::inference::{self, ElementType, Elementary, TypesOfNames};
use crate::name::{Ident, Name};
use crate::syntax::ast::{Arguments, ClassSpecifier, ComponentReference, Expression};

/// The type of an expression.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CheckedType {
    /// Real or Integer.
    Number,
    /// `Boolean`
    Boolean,
    /// `String`
    String,
    /// The enumeration that a class is.
    Enumeration(ClassId),
}

/// Whether an expression in a class is a number, as far as the class tells.
pub(super) fn is_number(class: Scope<'_>, e: &Expression) -> bool {
    DeclaredTypes { class, loops: Vec::new() }.type_of(e) == Some(CheckedType::Number)
}

/// What a class tells of the types of names.
pub(super) struct DeclaredTypes<'a> {
    pub(super) class: Scope<'a>,
    /// The loop variables met; what they are is not looked at.
    pub(super) loops: Vec<Ident>,
}

impl DeclaredTypes<'_> {
    /// The type of an expression, where the class tells.
    pub(super) fn type_of(&self, expression: &Expression) -> Option<CheckedType> {
        inference::type_of(&mut &*self, expression)
    }

    pub(super) fn kind_of_reference(&self, reference: &ComponentReference) -> Option<CheckedType> {
        let first = reference.parts[0].name;
        if !reference.global && self.loops.contains(&first) {
            return None;
        }
        if !reference.global && super::names::is_component(self.class, first) {
            return self.class.path(reference)?.last().and_then(kind_of);
        }
        self.literal(reference)
    }

    /// The enumeration of a literal `E.a`.
    fn literal(&self, reference: &ComponentReference) -> Option<CheckedType> {
        let parts: Vec<Ident> = reference.parts.iter().map(|part| part.name).collect();
        let (last, path) = parts.split_last()?;
        let name = Name { global: reference.global, parts: path.to_vec() };
        let enumeration = self.class.class_named(&name)?.enumeration()?;
        let ClassSpecifier::Enumeration(literals) = &enumeration.definition().specifier else {
            return None;
        };
        let is_literal = literals.literals.iter().flatten().any(|one| one.name.node == *last);
        is_literal.then_some(CheckedType::Enumeration(enumeration.class))
    }
}

impl ElementType for CheckedType {
    fn elementary(which: Elementary) -> Option<CheckedType> {
        match which {
            Elementary::Real | Elementary::Integer => Some(CheckedType::Number),
            Elementary::Boolean => Some(CheckedType::Boolean),
            Elementary::String => Some(CheckedType::String),
            Elementary::Clock => None,
        }
    }
}

impl TypesOfNames for &DeclaredTypes<'_> {
    type Type = CheckedType;

    fn of_reference(&mut self, reference: &ComponentReference) -> Option<CheckedType> {
        self.kind_of_reference(reference)
    }

    /// Those of the class are not looked at, nor is a function that hides one of the language.
    fn of_function(
        &mut self,
        function: &ComponentReference,
        _: &Arguments,
    ) -> Option<Option<CheckedType>> {
        let is_of_language = !function.global
            && function
                .as_ident()
                .is_some_and(|name| self.class.class_named(&name.into()).is_none());
        (!is_of_language).then_some(None)
    }
}

/// The type that a component, or its elements, is declared of; none if it can be redeclared.
pub(super) fn kind_of(component: &Component<'_>) -> Option<CheckedType> {
    let prefixes = component.clause.prefixes;
    if prefixes.replaceable || prefixes.outer {
        return None;
    }
    let (predefined, class) = match component.meaning()? {
        Type::Predefined(predefined) => (Some(predefined), None),
        Type::Class(class) => {
            let class = component.owner.of(class);
            if class.is_replaceable() {
                return None;
            }
            (class.predefined(), class.enumeration())
        }
    };
    match (predefined, class) {
        (Some(Predefined::Real | Predefined::Integer), _) => Some(CheckedType::Number),
        (Some(Predefined::Boolean), _) => Some(CheckedType::Boolean),
        (Some(Predefined::String), _) => Some(CheckedType::String),
        (None, Some(enumeration)) => Some(CheckedType::Enumeration(enumeration.class)),
        _ => None,
    }
}
