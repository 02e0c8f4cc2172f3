//! What modifications may reach, and which classes may be replaced (MLS §4.1, §7.3.1).

use super::compatibility::{Lack, dimensions, lack};
use super::scope::Scope;
use super::visible_elements::{element, protected};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::declared::classes::Type;
use crate::flatten::errors::ILLEGAL_REDECLARATION;
use crate::name::Ident;
use crate::source::{Span, Spanned};
use crate::syntax::ast::{
    Argument, ClassDefinition, ClassSpecifier, ComponentClause, Constraint, Element,
    ElementPrefixes, RedeclaredElement, Restriction, VariabilityPrefix, Visibility,
};

/// The most base classes in a row that are followed.
const MAX_DEPTH: usize = 100;

/// Checks the modifications of the own components and base classes of a class, the elements that
/// it redeclares, and its `extends M(…)` classes.
pub(crate) fn check(class: Scope<'_>, errors: &mut Vec<Diagnostic>) {
    if let ClassSpecifier::Short(short) = &class.definition().specifier
        && let Some(base) = class.parent().and_then(|p| p.class_named(&short.target.name))
    {
        redeclarations(class.parent().unwrap_or(class), base, &short.modification, errors);
    }
    for (visibility, element) in class.elements() {
        errors.extend(unfit_declaration(class, element));
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
    /// What replaces it must be compatible with this class.
    constraint: Option<Scope<'a>>,
}

/// The element of a class as it can be redeclared from outside.
fn inherited(class: Scope<'_>, name: Ident, depth: usize) -> Option<Inherited<'_>> {
    if depth > MAX_DEPTH {
        return None;
    }
    for (visibility, element) in class.elements() {
        let (prefixes, variability, kind, constraint) = match element {
            Element::Component(clause) if clause.components.iter().any(|c| c.name.node == name) => {
                let kind = class.meaning(&clause.type_specifier.name);
                let constraint = clause.constraint.as_ref().map(|constraint| &constraint.target);
                let constraint = constraint.unwrap_or(&clause.type_specifier);
                let variability = clause.type_prefixes.variability;
                (clause.prefixes, variability, kind, class.class_named(&constraint.name))
            }
            Element::Class(nested) if nested.class.name.node == name => {
                let constraint = nested.constraint.as_ref().map(|one| one.target.name.clone());
                let constraint = constraint.unwrap_or_else(|| name.into());
                (nested.prefixes, None, None, class.class_named(&constraint))
            }
            _ => continue,
        };
        let constant = variability == Some(VariabilityPrefix::Constant);
        let replaceable = prefixes.replaceable;
        return Some(Inherited {
            holder: class,
            kind,
            replaceable,
            constant,
            visibility,
            constraint,
        });
    }
    if let ClassSpecifier::Short(short) = &class.definition().specifier {
        let outside = class.parent()?;
        let base = outside.class_named(&short.target.name)?;
        return modified(outside, inherited(base, name, depth + 1)?, &short.modification, name);
    }
    class.elements().find_map(|(_, element)| {
        let Element::Extends(extends) = element else { return None };
        let base = class.class_named(&extends.base.name).filter(|b| b.class != class.class)?;
        modified(class, inherited(base, name, depth + 1)?, &extends.modification, name)
    })
}

/// An element after the modification of a base class, written in a class: a redeclaration redefines
/// whether it is replaceable, and may constrain it further.
fn modified<'a>(
    writer: Scope<'a>,
    mut element: Inherited<'a>,
    arguments: &[Argument],
    name: Ident,
) -> Option<Inherited<'a>> {
    for argument in arguments {
        let Argument::Redeclaration(redeclaration) = argument else { continue };
        let (own, _, prefixes) = declared(&redeclaration.element)?;
        if own == name {
            element.replaceable = prefixes.replaceable;
            if let Some(constraint) = constraint(&redeclaration.element) {
                element.constraint = writer.class_named(&constraint.target.name);
            }
        }
    }
    Some(element)
}

fn constraint(element: &RedeclaredElement) -> Option<&Constraint> {
    match element {
        RedeclaredElement::Class(nested) => nested.constraint.as_ref(),
        RedeclaredElement::Component(clause) => clause.constraint.as_ref(),
    }
}

/// The class that a redeclaration, written in a class, puts in the place of another.
fn replacement<'a>(writer: Scope<'a>, element: &RedeclaredElement) -> Option<Scope<'a>> {
    match element {
        RedeclaredElement::Component(clause) => writer.class_named(&clause.type_specifier.name),
        RedeclaredElement::Class(nested) => match &nested.class.specifier {
            ClassSpecifier::Short(short) => writer.class_named(&short.target.name),
            _ => None,
        },
    }
}

/// A replacement, and its own constraint, are compatible with the constraint of what is replaced
/// (MLS §7.3.2).
fn incompatible(
    writer: Scope<'_>,
    element: &RedeclaredElement,
    expected: Option<Scope<'_>>,
    name: Ident,
    span: Span,
) -> Option<Diagnostic> {
    let expected = expected?;
    let own = constraint(element).and_then(|one| writer.class_named(&one.target.name));
    // What is replaceable itself is judged where it is used, by the class that it stands for then.
    let given = replacement(writer, element).filter(|class| !class.is_replaceable());
    let candidates = [given, own];
    candidates.into_iter().flatten().find_map(|candidate| {
        let Lack(reason) = lack(candidate, expected)?;
        Some(unfit(name, expected, &reason, span))
    })
}

/// Media are exchanged for others that have not all of the constants and functions of the first one,
/// or of their own constraint: what is used is looked for where it is used.
fn unfit(name: Ident, expected: Scope<'_>, reason: &str, span: Span) -> Diagnostic {
    let error = fault!(ILLEGAL_REDECLARATION, "`{name}` does not satisfy its constraining type \
                                               `{}`: {reason}", expected.name();
        help: "use a class with the public components of the constraining type")
    .at(span);
    match expected.restriction() {
        Restriction::Package => error.warning(),
        _ => error,
    }
}

/// What a replaceable element is declared as fits its own constraint.
fn unfit_declaration(class: Scope<'_>, element: &Element) -> Option<Diagnostic> {
    let (written, constraint, name) = match element {
        Element::Component(clause) => {
            let written = class.class_named(&clause.type_specifier.name)?;
            (written, clause.constraint.as_ref()?, clause.components.first()?.name)
        }
        Element::Class(nested) => {
            let name = nested.class.name;
            let written = class.own_class(name.node)?;
            let base = match &written.definition().specifier {
                ClassSpecifier::Short(short) => class.class_named(&short.target.name)?,
                _ => written,
            };
            (base, nested.constraint.as_ref()?, name)
        }
        _ => return None,
    };
    let expected = class.class_named(&constraint.target.name)?;
    if written.predefined().is_some() && dimensions(written) != dimensions(expected) {
        return Some(unfit(name.node, expected, "the numbers of dimensions differ", name.span));
    }
    let Lack(reason) = lack(written, expected)?;
    Some(unfit(name.node, expected, &reason, name.span))
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
/// that are not constants (MLS §7.3.3).
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
            let wrong = not_replaceable(&element, name, kind, span);
            errors.extend(wrong.or_else(|| {
                incompatible(writer, &redeclaration.element, element.constraint, name, span)
            }));
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
        modified(class, inherited(base, name.node, 0)?, &extends.modification, name.node)
    })?;
    not_replaceable(&element, name.node, kind, name.span).or_else(|| {
        let (now, then) = match (visibility, element.visibility) {
            (Visibility::Public, Visibility::Protected) => ("public", "protected"),
            (Visibility::Protected, Visibility::Public) => ("protected", "public"),
            _ => return None,
        };
        Some(
            fault!(ILLEGAL_REDECLARATION, "`{}` is redeclared {now}, but it is {then} in `{}`",
                name.node, element.holder.name();
                help: "redeclare it in a {then} section")
            .at(name.span)
            // Libraries for older versions of the language do it.
            .warning(),
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
            .at(span)
            .warning(),
        );
    }
    let keeps_type = kind.is_some() && kind == element.kind;
    (!element.replaceable && !keeps_type).then(|| {
        fault!(ILLEGAL_REDECLARATION, "`{name}` is not replaceable in `{holder}`";
            help: "declare it `replaceable` there, or modify it without redeclaring it")
        .at(span)
        // Libraries do it, where the tools that they were written with allow it.
        .warning()
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
            errors.push(protected(name, modified, span));
        }
    }
}
