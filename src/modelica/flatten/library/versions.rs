//! Which versions of other libraries a library was written for (MLS §18.8.2), and the rules that
//! convert it to those that are loaded.

use super::conversion_rules::{Conversion, Conversions, Rules};
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

    /// The rules that convert users of a version of a library to the one that is loaded, in as many
    /// steps as it takes: a `from` with `to` leads to another old version. A version that the library
    /// does not name is taken as the next later one that it names: what has changed since then has
    /// changed since the older one, too.
    fn rules_from(
        &self,
        library: ClassId,
        version: &str,
        span: Span,
    ) -> Result<Option<Arc<Conversion>>, Diagnostic> {
        let definition = self.read(library).definition.clone();
        let annotation = annotation_of(&definition);
        let own = annotation.and_then(|annotation| text(&annotation.arguments, "version"));
        let asked = Arc::<str>::from(version);
        let (mut now, mut passed) =
            (next_named(annotation, version, own.as_deref()).unwrap_or(asked), Vec::new());
        let mut steps = Vec::new();
        while own.as_deref() != Some(&*now) && !needs_no_conversion(annotation, &now) {
            let found = steps_from(annotation, &now);
            let direct = |one: &&[Argument]| text(one, "to").is_none_or(|to| Some(to) == own);
            let Some(arguments) = found.iter().find(|one| direct(one)).or(found.first()) else {
                break;
            };
            steps.push(self.rules_of_step(library, arguments, span)?);
            passed.push(now.clone());
            let Some(to) = text(arguments, "to") else {
                return Ok(Some(Arc::new(Conversion::new(steps))));
            };
            if passed.contains(&to) || !is_known(annotation, &to, own.as_deref()) {
                return Err(leads_nowhere(&definition, [version, &to], own.as_deref(), span));
            }
            now = to;
        }
        Ok((!steps.is_empty()).then(|| Arc::new(Conversion::new(steps))))
    }

    /// The rules of one `from`: of its script or its list.
    fn rules_of_step(
        &self,
        library: ClassId,
        arguments: &[Argument],
        span: Span,
    ) -> Result<Rules, Diagnostic> {
        if let Some(script) = text(arguments, "script") {
            return self.script_of(library, &script, span);
        }
        value(arguments, "change").map_or(Ok(Rules::default()), Rules::of_change)
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

/// Whether users of a version need no rules.
fn needs_no_conversion(annotation: Option<&Annotation>, version: &str) -> bool {
    let conversion =
        inside(annotation, "conversion").filter(|one| is_named(one, "noneFromVersion"));
    let bound = conversion.filter_map(|one| string(bound(one)?));
    bound.into_iter().any(|known| &*known == version)
}

/// The content of each `from` of a library that concerns a version.
fn steps_from<'a>(annotation: Option<&'a Annotation>, version: &str) -> Vec<&'a [Argument]> {
    let from = inside(annotation, "conversion").filter(|one| is_named(one, "from"));
    let arguments = from.filter_map(|one| one.modification.as_ref()).map(|m| &*m.arguments);
    arguments
        .filter(|one| strings(one, "version").iter().any(|known| &**known == version))
        .collect()
}

/// The next later version that a library names in its conversions, for one that it does not name.
fn next_named(
    annotation: Option<&Annotation>,
    version: &str,
    own: Option<&str>,
) -> Option<Arc<str>> {
    if is_known(annotation, version, own) {
        return None;
    }
    let none = inside(annotation, "conversion").filter(|one| is_named(one, "noneFromVersion"));
    let none = none.filter_map(|one| string(bound(one)?));
    let from = inside(annotation, "conversion").filter(|one| is_named(one, "from"));
    let from = from.filter_map(|one| one.modification.as_ref());
    let named = from.flat_map(|one| strings(&one.arguments, "version")).chain(none);
    let own = own.map(Arc::from);
    let asked = numbers(version);
    let later = named.chain(own).filter(|one| !asked.is_empty() && numbers(one) > asked);
    later.min_by_key(|one| numbers(one))
}

/// The numbers of a version up to those of a build, for comparison.
fn numbers(version: &str) -> Vec<u64> {
    let version = version.split(['-', '+', ' ']).next().unwrap_or_default();
    version.split('.').map_while(|part| part.parse().ok()).collect()
}

/// Whether a version is the loaded one, or one that a library tells how to convert.
fn is_known(annotation: Option<&Annotation>, version: &str, own: Option<&str>) -> bool {
    own == Some(version)
        || needs_no_conversion(annotation, version)
        || !steps_from(annotation, version).is_empty()
}

fn leads_nowhere(
    library: &ClassDefinition,
    [from, to]: [&str; 2],
    own: Option<&str>,
    span: Span,
) -> Diagnostic {
    fault!(CONVERSION, "`{}` is converted from version {from} to {to} only, not to the loaded \
                        version {}",
        library.name.node, own.unwrap_or("without a number");
        help: "convert the library that uses it, or load version {to}")
    .at(span)
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

/// The arguments in parentheses after a name of an annotation.
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

/// The strings that an argument is bound to: one, or an array of them.
fn strings(arguments: &[Argument], name: &str) -> Vec<Arc<str>> {
    let bound = value(arguments, name);
    match bound.map(|value| &value.kind) {
        Some(ExpressionKind::Array(values)) => values.iter().filter_map(string).collect(),
        Some(_) => bound.and_then(string).into_iter().collect(),
        None => Vec::new(),
    }
}

/// What an argument is bound to.
fn value<'a>(arguments: &'a [Argument], name: &str) -> Option<&'a Expression> {
    elements(arguments).filter(|element| is_named(element, name)).find_map(bound)
}

fn bound(element: &ElementModification) -> Option<&Expression> {
    match &element.modification.as_ref()?.binding {
        Some(Binding::Expression(value)) => Some(value),
        _ => None,
    }
}

fn string(e: &Expression) -> Option<Arc<str>> {
    match &e.kind {
        ExpressionKind::String(text) => Some(text.clone()),
        _ => None,
    }
}

fn text(arguments: &[Argument], name: &str) -> Option<Arc<str>> {
    strings(arguments, name).into_iter().next()
}
