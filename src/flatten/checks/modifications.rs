//! What modifications may reach, and which classes may be replaced (MLS §4.1, §7.3.1).

use super::access::{self, element};
use super::lookup::Type;
use super::scope::Scope;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::ILLEGAL_REDECLARATION;
use crate::name::Ident;
use crate::source::{Span, Spanned};
use crate::syntax::ast::{
    Argument, ClassDefinition, ClassSpecifier, ComponentClause, Element, ElementPrefixes,
    RedeclaredElement, VariabilityPrefix, Visibility,
};

/// The most base classes in a row that are followed.
const MAX_DEPTH: usize = 100;

/// Checks the modifications of the own components and base classes of a class, the elements that
/// it redeclares, and its `extends M(…)` classes.
pub(super) fn check(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    if let ClassSpecifier::Short(short) = &class.definition().specifier
        && let Some(base) = class.parent().and_then(|p| p.class_named(&short.target.name))
    {
        redeclarations(class.parent().unwrap_or(class), base, &short.modification, errors);
    }
    for (visibility, element) in class.elements() {
        match element {
            Element::Extends(extends) => {
                let Some(base) = class.class_named(&extends.base.name) else { continue };
                redeclarations(class, base, &extends.modification, errors);
            }
            Element::Component(clause) => {
                components(class, clause, errors);
                if let (true, [component, ..]) = (clause.prefixes.redeclare, &clause.components[..])
                {
                    let kind = class.meaning(&clause.type_specifier.name);
                    errors.extend(redeclared(class, component.name, kind, visibility));
                }
            }
            Element::Class(nested) => {
                let name = nested.class.name;
                if nested.prefixes.redeclare || is_class_extends(&nested.class) {
                    errors.extend(redeclared(class, name, None, visibility));
                }
            }
            Element::Import(_) => {}
        }
    }
}

fn is_class_extends(class: &ClassDefinition) -> bool {
    matches!(&class.specifier, ClassSpecifier::Long(long) if long.class_extends.is_some())
}

/// What a redeclaration finds: an element as the base classes, with their modifications, leave it.
struct Inherited<'a> {
    holder: Scope<'a>,
    /// The type of a component.
    kind: Option<Type>,
    replaceable: bool,
    constant: bool,
    visibility: Visibility,
}

/// The element of a class as it can be redeclared from outside.
fn inherited(class: Scope<'_>, name: Ident, depth: usize) -> Option<Inherited<'_>> {
    if depth > MAX_DEPTH {
        return None;
    }
    for (visibility, element) in class.elements() {
        let (prefixes, variability, kind) = match element {
            Element::Component(clause) if clause.components.iter().any(|c| c.name.node == name) => {
                let kind = class.meaning(&clause.type_specifier.name);
                (clause.prefixes, clause.type_prefixes.variability, kind)
            }
            Element::Class(nested) if nested.class.name.node == name => {
                (nested.prefixes, None, None)
            }
            _ => continue,
        };
        let constant = variability == Some(VariabilityPrefix::Constant);
        let replaceable = prefixes.replaceable;
        return Some(Inherited { holder: class, kind, replaceable, constant, visibility });
    }
    if let ClassSpecifier::Short(short) = &class.definition().specifier {
        let base = class.parent()?.class_named(&short.target.name)?;
        return modified(inherited(base, name, depth + 1)?, &short.modification, name);
    }
    class.elements().find_map(|(_, element)| {
        let Element::Extends(extends) = element else { return None };
        let base = class.class_named(&extends.base.name).filter(|b| b.class != class.class)?;
        modified(inherited(base, name, depth + 1)?, &extends.modification, name)
    })
}

/// An element behind the modification of a base class: a redeclaration decides anew whether it is
/// replaceable.
fn modified<'a>(
    element: Inherited<'a>,
    arguments: &[Argument],
    name: Ident,
) -> Option<Inherited<'a>> {
    let redeclared = arguments.iter().find_map(|argument| {
        let Argument::Redeclaration(redeclaration) = argument else { return None };
        let (own, _, prefixes) = declared(&redeclaration.element)?;
        (own == name).then_some(prefixes.replaceable)
    });
    Some(Inherited { replaceable: redeclared.unwrap_or(element.replaceable), ..element })
}

/// Name, place and prefixes of what a redeclaration declares.
fn declared(element: &RedeclaredElement) -> Option<(Ident, Span, ElementPrefixes)> {
    match element {
        RedeclaredElement::Class(nested) => {
            let name = nested.class.name;
            Some((name.node, name.span, nested.prefixes))
        }
        RedeclaredElement::Component(clause) => {
            let name = clause.components.first()?.name;
            Some((name.node, name.span, clause.prefixes))
        }
    }
}

/// Redeclarations in modifications, written in one class about another, are of replaceable elements
/// that are no constants (MLS §7.3.3).
fn redeclarations(
    writer: Scope<'_>,
    class: Scope<'_>,
    arguments: &[Argument],
    errors: &mut Vec<Diagnostic>,
) {
    for argument in arguments {
        let Argument::Redeclaration(redeclaration) = argument else { continue };
        let Some((name, span, _)) = declared(&redeclaration.element) else { continue };
        let kind = match &redeclaration.element {
            RedeclaredElement::Component(clause) => writer.meaning(&clause.type_specifier.name),
            RedeclaredElement::Class(_) => None,
        };
        if let Some(element) = inherited(class, name, 0) {
            errors.extend(not_replaceable(&element, name, kind, span));
        }
    }
}

/// An element that redeclares an inherited one keeps its visibility.
fn redeclared(
    class: Scope<'_>,
    name: Spanned<Ident>,
    kind: Option<Type>,
    visibility: Visibility,
) -> Option<Diagnostic> {
    let element = class.elements().find_map(|(_, element)| {
        let Element::Extends(extends) = element else { return None };
        let base = class.class_named(&extends.base.name).filter(|b| b.class != class.class)?;
        modified(inherited(base, name.node, 0)?, &extends.modification, name.node)
    })?;
    not_replaceable(&element, name.node, kind, name.span).or_else(|| {
        let (now, then) = match (visibility, element.visibility) {
            (Visibility::Public, Visibility::Protected) => ("public", "protected"),
            (Visibility::Protected, Visibility::Public) => ("protected", "public"),
            _ => return None,
        };
        Some(
            fault!(ILLEGAL_REDECLARATION, "`{}` is redeclared {now}, and it is {then} in `{}`",
                name.node, element.holder.name();
                help: "redeclare it in a {then} section")
            .at(name.span),
        )
    })
}

/// A redeclaration to the same type may still restrict variability and sizes.
fn not_replaceable(
    element: &Inherited<'_>,
    name: Ident,
    kind: Option<Type>,
    span: Span,
) -> Option<Diagnostic> {
    let holder = element.holder.name();
    if element.constant {
        return Some(
            fault!(ILLEGAL_REDECLARATION, "`{name}` is a constant of `{holder}` and cannot be redeclared";
                help: "modify its value instead")
            .at(span),
        );
    }
    let keeps_type = kind.is_some() && kind == element.kind;
    (!element.replaceable && !keeps_type).then(|| {
        fault!(ILLEGAL_REDECLARATION, "`{name}` is not replaceable in `{holder}`";
            help: "declare it `replaceable` there, or modify it without redeclaring it")
        .at(span)
    })
}

fn components(class: Scope<'_>, clause: &ComponentClause, errors: &mut Vec<Diagnostic>) {
    let Some(modified) = class.class_named(&clause.type_specifier.name) else { return };
    for component in &clause.components {
        if let Some(modification) = &component.modification {
            arguments(modified, &modification.arguments, errors);
            redeclarations(class, modified, &modification.arguments, errors);
        }
    }
}

/// Protected elements are not modified from outside.
fn arguments(modified: Scope<'_>, arguments: &[Argument], errors: &mut Vec<Diagnostic>) {
    for argument in arguments {
        let (name, span) = match argument {
            Argument::Element(one) => match one.name.node.first() {
                Some(first) => (first, one.name.span),
                None => continue,
            },
            Argument::Redeclaration(one) => match declared(&one.element) {
                Some((name, span, _)) => (name, span),
                None => continue,
            },
        };
        if element(modified, name).is_some_and(|one| one.visibility == Visibility::Protected) {
            errors.push(access::protected(name, modified, span));
        }
    }
}
