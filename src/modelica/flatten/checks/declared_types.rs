//! Types of expressions as far as a class tells by itself: what its components and literals are
//! declared as.

use super::compatibility::dimensions;
use super::inputs::outputs;
use super::scope::{Component, Scope};
use crate::flatten::declared::classes::Type;
use crate::flatten::library::ClassId;
use crate::flatten::lookup::types::Predefined;
use crate::inference::{self, ElementType, Elementary, TypesOfNames};
use crate::name::{Ident, Name};
use crate::syntax::ast::{
    Arguments, ClassSpecifier, ComponentReference, Expression, ExpressionKind, Restriction,
};

/// The type of an expression.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CheckedType {
    /// `Real`
    Real,
    /// `Integer`
    Integer,
    /// `Boolean`
    Boolean,
    /// `String`
    String,
    /// The enumeration that a class is.
    Enumeration(ClassId),
    /// The record that a class is, without operators of its own.
    Record(ClassId),
}

impl CheckedType {
    pub(super) fn is_number(self) -> bool {
        matches!(self, CheckedType::Real | CheckedType::Integer)
    }

    /// The type in words, as the class `of` sees it.
    pub(super) fn described(self, of: Scope<'_>) -> String {
        match self {
            CheckedType::Real => "a Real".to_owned(),
            CheckedType::Integer => "an Integer".to_owned(),
            CheckedType::Boolean => "a Boolean".to_owned(),
            CheckedType::String => "a String".to_owned(),
            CheckedType::Enumeration(class) => {
                format!("of the enumeration `{}`", of.of(class).name())
            }
            CheckedType::Record(class) => format!("a record `{}`", of.of(class).name()),
        }
    }

    /// What to write where this type is expected and another one is found.
    pub(super) fn remedy(self, found: CheckedType) -> Option<&'static str> {
        match (self, found) {
            (CheckedType::Integer, CheckedType::Real) => {
                Some("round it with `integer(x)`; `div(a, b)` divides Integers")
            }
            (CheckedType::Real | CheckedType::Integer, CheckedType::Boolean) => {
                Some("write `if b then 1 else 0`")
            }
            (CheckedType::Real | CheckedType::Integer, CheckedType::Enumeration(_)) => {
                Some("write `Integer(e)`, the number of the literal")
            }
            (CheckedType::Enumeration(_), CheckedType::Integer) => {
                Some("write a literal, such as `E.a`; `E(i)` is the literal with the number `i`")
            }
            (CheckedType::Boolean, CheckedType::Real | CheckedType::Integer) => {
                Some("compare it, as in `x > 0`")
            }
            (CheckedType::String, found) if !matches!(found, CheckedType::Record(_)) => {
                Some("write `String(x)`")
            }
            _ => None,
        }
    }
}

/// Whether an expression in a class is a number, as far as the class tells.
pub(super) fn is_number(class: Scope<'_>, e: &Expression) -> bool {
    DeclaredTypes { class, loops: Vec::new() }.type_of(e).is_some_and(CheckedType::is_number)
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

    /// Whether an expression is certainly a scalar: a literal, or variables declared without sizes.
    fn is_scalar(&self, e: &Expression) -> bool {
        let has_sizes = |component: &Component<'_>| {
            !component.clause.subscripts.is_empty()
                || !component.declaration.subscripts.is_empty()
                || component.class().is_some_and(|class| dimensions(class) > 0)
        };
        match &e.kind {
            ExpressionKind::Integer(_) | ExpressionKind::Real(_) => true,
            ExpressionKind::Reference(reference) => {
                let path = self.class.path(reference);
                path.is_some_and(|path| !path.iter().any(has_sizes))
            }
            _ => false,
        }
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
            Elementary::Real => Some(CheckedType::Real),
            Elementary::Integer => Some(CheckedType::Integer),
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

    /// The first output of a function that nothing can replace; a function that hides one of the
    /// language is not that one.
    fn of_function(
        &mut self,
        function: &ComponentReference,
        _: &Arguments,
    ) -> Option<Option<CheckedType>> {
        if let Some(called) = self.class.certain_class(&function.name()) {
            return Some(result_of(called));
        }
        let is_of_language = !function.global
            && function
                .as_ident()
                .is_some_and(|name| self.class.class_named(&name.into()).is_none());
        (!is_of_language).then_some(None)
    }

    /// What is not certainly a scalar may be a matrix.
    fn rank(&mut self, e: &Expression) -> Option<usize> {
        Some(if self.is_scalar(e) { 0 } else { 2 })
    }
}

/// The type of what a call of a function or a constructor gives.
fn result_of(called: Scope<'_>) -> Option<CheckedType> {
    record(called).or_else(|| outputs(called)?.first().and_then(kind_of))
}

/// The record that a class is, if its components are known and no operators are defined for it.
fn record(class: Scope<'_>) -> Option<CheckedType> {
    let is_plain = class.restriction() == Restriction::Record
        && class.lineage().all(|class| class.restriction() != Restriction::OperatorRecord)
        && !class.is_open();
    is_plain.then_some(CheckedType::Record(class.class))
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
        (Some(Predefined::Real), _) => Some(CheckedType::Real),
        (Some(Predefined::Integer), _) => Some(CheckedType::Integer),
        (Some(Predefined::Boolean), _) => Some(CheckedType::Boolean),
        (Some(Predefined::String), _) => Some(CheckedType::String),
        (None, Some(enumeration)) => Some(CheckedType::Enumeration(enumeration.class)),
        (None, None) => record(component.class()?),
        _ => None,
    }
}
