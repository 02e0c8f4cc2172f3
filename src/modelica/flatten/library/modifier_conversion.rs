//! Modifiers of classes whose library is converted (MLS §18.8.3): `convertElement`,
//! `convertModifiers` and `convertClassIf`.

use super::conversion::Converter;
use super::conversion_rules::{ModifierRule, Rules, literal_text};
use super::old_names::Meaning;
use crate::fault;
use crate::flatten::errors::CONVERSION;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax;
use crate::syntax::ast::{
    Argument, Binding, ClassSpecifier, ComponentDeclaration, ComponentReference, Expression,
    ExpressionKind, Modification, RedeclaredElement, Subscript,
};
use crate::syntax::visit::{Rewrite, rewrite_arguments, rewrite_expression};
use std::sync::Arc;

/// The arguments of a modification.
pub(super) type Modifiers = Vec<Argument>;

impl Converter<'_> {
    pub(super) fn subscripts(&mut self, subscripts: &mut [Subscript]) {
        for subscript in subscripts {
            if let Subscript::Index(index) = subscript {
                self.expression(index);
            }
        }
    }

    /// A component, and the type that the value of one of its modifiers chooses.
    pub(super) fn component(
        &mut self,
        component: &mut ComponentDeclaration,
        meaning: Option<&Meaning>,
        span: Span,
    ) -> Option<Name> {
        self.subscripts(&mut component.subscripts);
        component.condition.iter_mut().for_each(|one| self.expression(one));
        let is_written = component.modification.is_some();
        let modification = component.modification.get_or_insert_with(|| empty(span));
        let chosen = self.modification(modification, meaning, span);
        if !is_written && modification.arguments.is_empty() {
            component.modification = None;
        }
        chosen
    }

    fn modification(
        &mut self,
        modification: &mut Modification,
        meaning: Option<&Meaning>,
        span: Span,
    ) -> Option<Name> {
        if let Some(Binding::Expression(value)) = &mut modification.binding {
            self.expression(value);
        }
        self.modifiers(meaning, &mut modification.arguments, span)
    }

    /// What modifies a class or component of a type; returns the class that stands for the type
    /// because of a modifier's value.
    pub(super) fn modifiers(
        &mut self,
        meaning: Option<&Meaning>,
        given: &mut Modifiers,
        span: Span,
    ) -> Option<Name> {
        // The values that a choice compares are those of the old version, the first choice's at
        // least; those of later steps are compared as they are converted.
        let is_type = matches!(meaning, Some(Meaning::Old(_)));
        let written = if is_type { given.clone() } else { Modifiers::new() };
        given.iter_mut().for_each(|argument| self.argument(meaning, argument));
        let mut chosen = None;
        for old in self.names.old_bases(meaning?) {
            let Some(conversion) = self.rules_of(&old) else { continue };
            let mut class = old;
            for (at, rules) in conversion.steps().iter().enumerate() {
                let by_value = match (is_type, at) {
                    (false, _) => None,
                    (true, 0) => chosen_by_value(rules, &class, &written, given),
                    (true, _) => chosen_by_value(rules, &class, &given.clone(), given),
                };
                self.step(rules, &class, is_type, given, span);
                let is_chosen = chosen.is_some() || by_value.is_some();
                class = by_value.or_else(|| rules.class(&class)).unwrap_or(class);
                chosen = is_chosen.then(|| class.clone());
            }
        }
        chosen
    }

    /// The modifiers of a class that is a type or, if not `is_type`, the base of one, converted by
    /// the rules of one step.
    fn step(
        &mut self,
        rules: &Rules,
        class: &Name,
        is_type: bool,
        given: &mut Modifiers,
        span: Span,
    ) {
        let mut added = Vec::new();
        for rule in rules.modifiers(class) {
            // Where the old class is a base, its own extends clause has got what is added.
            if !rule.old.is_empty() || is_type {
                self.replace(rule, given, &mut added, span);
            }
        }
        self.rename(class, rules, given);
        // What is written takes precedence.
        for argument in added {
            if name_of(&argument).is_none_or(|name| position(given, name).is_none()) {
                given.push(argument);
            }
        }
    }

    /// Gives modifiers of an old class the new names of its elements.
    fn rename(&mut self, old: &Name, rules: &Rules, given: &mut Modifiers) {
        for argument in given.iter_mut() {
            let Argument::Element(element) = argument else { continue };
            let path = &element.name.node.parts;
            if let Some(reason) = path.first().and_then(|p| rules.message_of_element(old, *p)) {
                self.impossible(&old.child(path[0]), reason, element.span);
            } else if let Some((new, count)) = rules.element(old, path) {
                let parts = new.parts.iter().chain(&path[count..]).copied();
                element.name.node = Name::new(parts);
            }
        }
    }

    fn argument(&mut self, meaning: Option<&Meaning>, argument: &mut Argument) {
        match argument {
            Argument::Element(element) => {
                let Some(modification) = &mut element.modification else { return };
                let inner = self.type_of_element(meaning, &element.name.node);
                // The type of the component is chosen where it is declared.
                let _chosen = self.modification(modification, inner.as_ref(), element.span);
            }
            Argument::Redeclaration(redeclaration) => match &mut redeclaration.element {
                RedeclaredElement::Component(clause) => {
                    if let Some(converted) = self.clauses((**clause).clone()).pop() {
                        **clause = converted;
                    }
                }
                RedeclaredElement::Class(nested) => {
                    if let ClassSpecifier::Short(short) =
                        &mut Arc::make_mut(&mut nested.class).specifier
                    {
                        self.typed(&mut short.target, &mut short.modification);
                    }
                    nested.constraint.iter_mut().for_each(|one| self.constraint(one));
                }
            },
        }
    }

    /// The type of the component that a modifier is about, in classes of the user.
    fn type_of_element(&self, meaning: Option<&Meaning>, name: &Name) -> Option<Meaning> {
        let mut found = meaning?.clone();
        for part in &name.parts {
            let Meaning::Own(id) = found else { return None };
            found = self.names.component(id, *part)?;
        }
        Some(found)
    }

    /// Removes the old modifiers of a rule and adds the new ones to a list.
    fn replace(
        &mut self,
        rule: &ModifierRule,
        given: &mut Modifiers,
        added: &mut Modifiers,
        span: Span,
    ) {
        let mut values = Vec::new();
        let mut is_met = rule.old.is_empty();
        for (name, default) in &rule.old {
            let value = match position(given, name) {
                Some(at) => {
                    is_met = true;
                    bound(&given[at]).cloned()
                }
                None => default.as_ref().and_then(|text| parsed(text, span)),
            };
            values.push((name.clone(), value));
        }
        if !is_met {
            return;
        }
        given.retain(|argument| {
            !rule
                .old
                .iter()
                .any(|(name, _)| position(std::slice::from_ref(argument), name).is_some())
        });
        for template in &rule.new {
            match filled(template, &values, span) {
                Some(arguments) => added.extend(arguments),
                None => self.problems.push(
                    fault!(CONVERSION, "the modifier `{template}` of a conversion script has no \
                                        value here";
                        help: "give the old modifiers a default in the script")
                    .at(span),
                ),
            }
        }
    }
}

fn empty(span: Span) -> Modification {
    Modification { arguments: Vec::new(), binding: None, span }
}

fn name_of(argument: &Argument) -> Option<&Name> {
    match argument {
        Argument::Element(element) => Some(&element.name.node),
        Argument::Redeclaration(_) => None,
    }
}

fn position(given: &[Argument], name: &Name) -> Option<usize> {
    given.iter().position(|one| name_of(one).is_some_and(|known| known.parts == name.parts))
}

/// The class that stands for an old one because of a modifier's value; the modifier is removed.
fn chosen_by_value(
    rules: &Rules,
    old: &Name,
    values: &Modifiers,
    given: &mut Modifiers,
) -> Option<Name> {
    rules.conditional(old).iter().find_map(|rule| {
        let value = bound(&values[position(values, &rule.element)?])?;
        let at = position(given, &rule.element)?;
        (literal_text(value) == rule.value).then(|| {
            given.remove(at);
            rule.new.clone()
        })
    })
}

fn bound(argument: &Argument) -> Option<&Expression> {
    match argument {
        Argument::Element(element) => match &element.modification.as_ref()?.binding {
            Some(Binding::Expression(value)) => Some(value),
            _ => None,
        },
        Argument::Redeclaration(_) => None,
    }
}

/// An expression of a script, as if it were written at a place.
fn parsed(text: &str, span: Span) -> Option<Expression> {
    let mut e = syntax::parse_expression(span.source, text).ok()?;
    Filling { values: &[], span, complete: true }.expression(&mut e);
    Some(e)
}

/// A new modifier, with the old values for `%name%`.
fn filled(template: &str, values: &[(Name, Option<Expression>)], span: Span) -> Option<Modifiers> {
    // `'%name%'` is an identifier, which no other name of the template can be.
    let mut text = template.to_owned();
    for (name, _) in values {
        text = text.replace(&format!("%{name}%"), &format!("'%{name}%'"));
    }
    let text = format!("M({text})");
    let (_, mut arguments) = syntax::parse_class_with_modification(span.source, &text).ok()?;
    let mut filling = Filling { values, span, complete: true };
    rewrite_arguments(&mut filling, &mut arguments);
    filling.complete.then_some(arguments)
}

/// Puts old values where a template names them.
struct Filling<'a> {
    values: &'a [(Name, Option<Expression>)],
    span: Span,
    complete: bool,
}

impl Filling<'_> {
    fn value_of(&self, reference: &ComponentReference) -> Option<&Option<Expression>> {
        let name: Ident = reference.as_ident()?;
        let stands_for = |old: &Name| format!("'%{old}%'") == name.as_str();
        self.values.iter().find(|(old, _)| stands_for(old)).map(|(_, value)| value)
    }
}

impl Rewrite for Filling<'_> {
    fn expression(&mut self, e: &mut Expression) {
        if let ExpressionKind::Reference(reference) = &e.kind
            && let Some(value) = self.value_of(reference)
        {
            match value {
                Some(value) => *e = value.clone(),
                None => self.complete = false,
            }
            return;
        }
        rewrite_expression(self, e);
    }

    fn span(&mut self, span: &mut Span) {
        *span = self.span;
    }
}
