//! Which versions of other libraries a library was written for (MLS §18.8.2), and the rules that
//! convert it to those that are loaded.

use super::conversion_rules::{Conversions, Rules};
use super::{ClassId, Library, Origin, locked};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::CONVERSION;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax;
use crate::syntax::ast::{
    Annotation, Argument, Binding, ClassDefinition, ClassSpecifier, ElementModification,
    Expression, ExpressionKind, Section,
};
use std::sync::Arc;

impl Library {
    /// The conversions of the classes of a library.
    ///
    /// # Errors
    /// A conversion script cannot be read.
    pub(super) fn conversions(&self, user: Ident) -> Result<Conversions, Diagnostic> {
        let Some(id) = self.roots.get(&user).copied() else { return Ok(Arc::new([])) };
        if let Some(known) = locked(&self.conversions.rules).get(&id) {
            return known.clone();
        }
        let found = self.find_conversions(id);
        locked(&self.conversions.rules).insert(id, found.clone());
        found
    }

    /// Whether a library has a script that converts what was written for another version of it.
    pub fn converts_from(&self, library: &Name, version: &str) -> bool {
        let rules = self.find(library).map(|id| self.rules_from(id, version, Span::NONE));
        matches!(rules, Some(Ok(Some(_))))
    }

    /// Whether the classes of any library are converted.
    pub(super) fn is_any_converted(&self) -> bool {
        *self.conversions.is_any.get_or_init(|| {
            let known = |root: Ident| self.conversions(root).is_ok_and(|found| found.is_empty());
            !self.roots.keys().all(|root| known(*root))
        })
    }

    fn find_conversions(&self, user: ClassId) -> Result<Conversions, Diagnostic> {
        let mut found = Vec::new();
        let written = self.read(user).definition.clone();
        let annotation = annotation_of(&written);
        for used in inside(annotation, "uses") {
            let Some(library) = used.name.node.first() else { continue };
            let Some(version) =
                used.modification.as_ref().and_then(|m| text(&m.arguments, "version"))
            else {
                continue;
            };
            let Some(other) = self.roots.get(&library).copied().filter(|other| *other != user)
            else {
                continue;
            };
            if let Some(rules) = self.rules_from(other, &version, used.span)? {
                found.push((library, rules));
            }
        }
        Ok(found.into())
    }

    /// The rules that convert users of a version of a library to the one that is loaded.
    fn rules_from(
        &self,
        library: ClassId,
        version: &str,
        span: Span,
    ) -> Result<Option<Arc<Rules>>, Diagnostic> {
        let definition = self.read(library).definition.clone();
        let annotation = annotation_of(&definition);
        let own = annotation.and_then(|annotation| text(&annotation.arguments, "version"));
        if own.as_deref() == Some(version) {
            return Ok(None);
        }
        let from = inside(annotation, "conversion").find(|one| {
            let versions = one.modification.iter().flat_map(|m| texts(&m.arguments, "version"));
            one.name.node.to_string() == "from" && versions.into_iter().any(|v| &*v == version)
        });
        let Some(arguments) = from.and_then(|one| one.modification.as_ref()) else {
            return Ok(None);
        };
        let arguments = &arguments.arguments;
        if let Some(to) = text(arguments, "to").filter(|to| Some(&**to) != own.as_deref()) {
            return Err(
                fault!(CONVERSION, "`{}` is converted from version {version} to {to} only, \
                                           not to the loaded version {}",
                definition.name.node, own.as_deref().unwrap_or("without a number");
                help: "convert the library that uses it, or load version {to}")
                .at(span),
            );
        }
        let Some(script) = text(arguments, "script") else { return Ok(None) };
        self.script_of(library, &script, span).map(|rules| Some(Arc::new(rules)))
    }

    /// The rules of a script of a library.
    fn script_of(&self, library: ClassId, script: &str, span: Span) -> Result<Rules, Diagnostic> {
        let slot = self.slot(library);
        let unreadable = |reason: String| {
            fault!(CONVERSION, "the conversion script `{script}` of `{}` cannot be read: {reason}",
                slot.name;
                help: "load the library from its folder")
            .at(span)
        };
        let Origin::Head(_, Some(folder)) = &slot.origin else {
            return Err(unreadable("the library is not in a folder".to_owned()));
        };
        let address = format!("modelica://{}/", slot.name);
        let path = folder.path.join(script.strip_prefix(&address).unwrap_or(script));
        let read = folder.files.read(&path);
        let (source, text) = read.map_err(|fault| unreadable(fault.message.to_string()))?;
        Rules::of_script(&syntax::parse_script(source, &text)?)
    }
}

/// The annotation of a class.
fn annotation_of(class: &ClassDefinition) -> Option<&Annotation> {
    match &class.specifier {
        ClassSpecifier::Long(long) => {
            long.sections.iter().rev().find_map(|section| match section {
                Section::Annotation(annotation) => Some(annotation),
                _ => None,
            })
        }
        ClassSpecifier::Short(short) => short.comment.annotation.as_ref(),
        _ => None,
    }
}

fn elements(arguments: &[Argument]) -> impl Iterator<Item = &ElementModification> {
    arguments.iter().filter_map(|argument| match argument {
        Argument::Element(element) => Some(element),
        Argument::Redeclaration(_) => None,
    })
}

fn is_named(element: &ElementModification, name: &str) -> bool {
    element.name.node.is_simple() && element.name.node.last().is_some_and(|last| last == name)
}

/// What stands in parentheses behind a name of an annotation.
fn inside<'a>(
    annotation: Option<&'a Annotation>,
    name: &'a str,
) -> impl Iterator<Item = &'a ElementModification> {
    let all = annotation.into_iter().flat_map(|annotation| elements(&annotation.arguments));
    let named = all.filter(move |element| is_named(element, name));
    named.flat_map(|element| {
        let inner = element.modification.as_ref();
        inner.into_iter().flat_map(|modification| elements(&modification.arguments))
    })
}

/// The texts that an argument is bound to: one, or an array of them.
fn texts(arguments: &[Argument], name: &str) -> Vec<Arc<str>> {
    let text = |e: &Expression| match &e.kind {
        ExpressionKind::String(text) => Some(text.clone()),
        _ => None,
    };
    let bound = elements(arguments).filter(|element| is_named(element, name)).find_map(|element| {
        match &element.modification.as_ref()?.binding {
            Some(Binding::Expression(value)) => Some(value),
            _ => None,
        }
    });
    match bound.map(|value| &value.kind) {
        Some(ExpressionKind::Array(values)) => values.iter().filter_map(text).collect(),
        Some(_) => bound.and_then(text).into_iter().collect(),
        None => Vec::new(),
    }
}

fn text(arguments: &[Argument], name: &str) -> Option<Arc<str>> {
    texts(arguments, name).into_iter().next()
}
