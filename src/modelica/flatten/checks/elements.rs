//! Names of elements, enumeration literals, and what may be extended (MLS §4.2, §4.8.5, §4.6.2,
//! §7.1).

use super::scope::Scope;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::{DUPLICATE_ELEMENT, ILLEGAL_EXTENDS, RESERVED_NAME};
use crate::flatten::library::BaseProperty;
use crate::name::Ident;
use crate::source::{Span, Spanned};
use crate::syntax::ast::{
    ClassSpecifier, Element, EnumerationClass, Extends, Restriction, Section, ShortClass,
    Visibility,
};
use rustc_hash::{FxHashMap, FxHashSet};

/// Names that a class cannot give to its elements (MLS §4.9).
const PREDEFINED: &[&str] = &["Real", "Integer", "Boolean", "String"];

/// Attributes of enumerations, which cannot be literals (MLS §4.9.5.1).
const ENUMERATION_ATTRIBUTES: &[&str] = &["quantity", "min", "max", "start", "fixed"];

/// Checks the names that a class declares, its literals and its extends clauses.
pub(crate) fn check(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    let definition = class.definition();
    reserved(definition.name, errors);
    match &definition.specifier {
        ClassSpecifier::Enumeration(enumeration) => literals(class, enumeration, errors),
        ClassSpecifier::Long(_) => {
            names(class, errors);
            extends(class, errors);
        }
        _ => {}
    }
}

fn reserved(name: Spanned<Ident>, errors: &mut Vec<Diagnostic>) {
    if PREDEFINED.contains(&name.node.as_str()) {
        errors.push(
            fault!(RESERVED_NAME, "`{}` is the name of a predefined type", name.node;
                help: "choose another name")
            .at(name.span),
        );
    }
}

/// A class and a component of one name, and components named like their type.
fn names(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    let mut classes: FxHashMap<Ident, Span> = FxHashMap::default();
    for (_, nested) in class.class_elements() {
        reserved(nested.class.name, errors);
        classes.insert(nested.class.name.node, nested.class.name.span);
    }
    for component in class.components() {
        let name = component.declaration.name;
        if PREDEFINED.contains(&name.node.as_str()) {
            reserved(name, errors);
        } else if let Some(other) = classes.get(&name.node) {
            errors.push(
                fault!(DUPLICATE_ELEMENT, "`{}` declares a class and a component named `{}`",
                    class.name(), name.node;
                    help: "rename one of them")
                .at(name.span)
                .related(*other, "the class"),
            );
        } else if component.clause.type_specifier.name.is_simple()
            && component.clause.type_specifier.name.first() == Some(name.node)
        {
            errors.push(
                fault!(DUPLICATE_ELEMENT, "the component `{}` is named like its type", name.node;
                    help: "rename the component")
                .at(name.span),
            );
        }
    }
}

fn literals(class: Scope<'_>, enumeration: &EnumerationClass, errors: &mut Vec<Diagnostic>) {
    let mut seen = FxHashSet::default();
    for literal in enumeration.literals.iter().flatten() {
        let name = literal.name;
        if ENUMERATION_ATTRIBUTES.contains(&name.node.as_str()) {
            errors.push(
                fault!(RESERVED_NAME, "the literal `{}` of `{}` is named like an attribute of enumerations",
                    name.node, class.name();
                    help: "choose another name")
                .at(name.span),
            );
        } else if !seen.insert(name.node) {
            errors.push(
                fault!(DUPLICATE_ELEMENT, "`{}` has two literals `{}`", class.name(), name.node;
                    help: "rename one of them")
                .at(name.span),
            );
        }
    }
}

fn extends(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    for (_, element) in class.elements() {
        let Element::Extends(extends) = element else { continue };
        errors.extend(replaceable_base(class, extends));
        let Some(base) = class.class_named(&extends.base.name) else { continue };
        errors.extend(operator_record_base(class, base, extends));
        errors.extend(base_that_stands_alone(class, base, extends));
    }
}

/// A base class must not be replaceable: neither it nor a package that its name leads through may
/// be one that the class declares as such (MLS §7.1.4).
fn replaceable_base(class: Scope<'_>, extends: &Extends) -> Option<Diagnostic> {
    let name = &extends.base.name;
    let first = name.first().filter(|_| name.is_simple())?;
    let (_, nested) = class.class_element(first)?;
    nested.prefixes.replaceable.then(|| {
        fault!(ILLEGAL_EXTENDS, "`{}` extends `{name}`, which is replaceable", class.name();
            help: "extend a class that is not replaceable")
        .at(extends.base.span)
        .related(nested.class.name.span, "declared replaceable")
    })
}

/// An operator record is not extended by long classes, nor are the classes around it
/// (MLS §4.7, §14.1).
fn operator_record_base(
    class: Scope<'_>,
    base: Scope<'_>,
    extends: &Extends,
) -> Option<Diagnostic> {
    let reason = match base.restriction() {
        Restriction::OperatorRecord => "is an operator record",
        _ if declares_operator_record(base) => "contains an operator record",
        _ => return None,
    };
    Some(
        fault!(ILLEGAL_EXTENDS, "`{}` extends `{}`, which {reason}", class.name(), base.name();
            help: "write a short class, `operator record A = B;`, or use it without extending it")
        .at(extends.span),
    )
}

fn declares_operator_record(class: Scope<'_>) -> bool {
    class
        .class_elements()
        .any(|(_, nested)| nested.class.restriction == Restriction::OperatorRecord)
}

/// What extends an array class, a class with a prefix, or a predefined type has nothing else
/// (MLS §4.6.2).
fn base_that_stands_alone(
    class: Scope<'_>,
    base: Scope<'_>,
    extends: &Extends,
) -> Option<Diagnostic> {
    let what = alone(base)?;
    let other = class.elements().find_map(|(visibility, element)| match element {
        Element::Component(clause) => Some(("components", clause.span)),
        _ if visibility == Visibility::Protected => {
            Some(("protected elements", super::restrictions::place(element)))
        }
        Element::Extends(other) if !std::ptr::eq(other, extends) => {
            let other_base = class.class_named(&other.base.name)?;
            (!is_empty(other_base)).then_some(("other base classes", other.span))
        }
        _ => None,
    });
    let other = other.or_else(|| {
        class.sections().iter().find_map(|section| match section {
            Section::Equations { span, .. } => Some(("equations", *span)),
            Section::Algorithm { span, .. } => Some(("algorithms", *span)),
            _ => None,
        })
    });
    let (kind, span) = other?;
    Some(
        fault!(ILLEGAL_EXTENDS, "`{}` extends {what} and has {kind}", class.name();
            help: "give the class a component of that type instead of extending it")
        .at(extends.span)
        .related(span, ""),
    )
}

/// What kind of class it is that cannot be extended together with anything else.
fn alone(base: Scope<'_>) -> Option<&'static str> {
    let array_or_prefix = base.first(BaseProperty::Alone, |class| special(class).is_some());
    let is_type = || base.predefined().is_some() || base.is_enumeration();
    array_or_prefix.and_then(special).or_else(|| is_type().then_some("a predefined type"))
}

fn special(class: Scope<'_>) -> Option<&'static str> {
    match &class.definition().specifier {
        ClassSpecifier::Short(short) if !short.subscripts.is_empty() => Some("an array class"),
        ClassSpecifier::Short(short) if has_prefix(short) => Some("a class with a prefix"),
        _ => None,
    }
}

fn has_prefix(short: &ShortClass) -> bool {
    let prefixes = short.prefixes;
    prefixes.connection.is_some() || prefixes.causality.is_some() || prefixes.variability.is_some()
}

fn is_empty(class: Scope<'_>) -> bool {
    let has_content = |class: Scope<'_>| {
        let behaves = class.sections().iter().any(super::restrictions::is_behaviour);
        class.components().next().is_some() || behaves
    };
    class.first(BaseProperty::Content, has_content).is_none()
}
