//! Classes as if their library had been converted to the versions of the libraries that are loaded
//! (MLS §18.8.3): names of classes, elements and modifiers are rewritten where a class is read.

use super::conversion_rules::Conversion;
use super::old_names::{Meaning, OldNames};
use super::{Class, ClassId, Library};
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::CONVERSION;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    Annotation, Argument, Arguments, ClassDefinition, ClassSpecifier, ComponentClause,
    ComponentReference, Constraint, Element, Expression, ExpressionKind, ImportKind, ReferencePart,
    Section, TypeSpecifier,
};
use crate::syntax::visit::{Rewrite, rewrite_expression, rewrite_modification, rewrite_reference};
use std::sync::{Arc, OnceLock};

impl Library {
    /// A class as if converted, if its library is.
    pub(super) fn as_converted(&self, id: ClassId) -> Option<&Class> {
        if !self.is_any_converted() {
            return None;
        }
        let (all, at) = (&self.conversions.classes, id.0 as usize);
        while all.get(at).is_none() {
            all.push(OnceLock::new());
        }
        let class = all.get(at)?;
        class.get_or_init(|| self.converted(id).map(Box::new)).as_deref()
    }

    fn converted(&self, id: ClassId) -> Option<Class> {
        let written = self.read(id);
        let conversions = match self.conversions(written.name.first()?) {
            Ok(conversions) if conversions.is_empty() => return None,
            Ok(conversions) => conversions,
            Err(problem) => {
                let mut class = Class { index: OnceLock::new(), ..written.clone() };
                class.problems.push(problem);
                return Some(class);
            }
        };
        let names = OldNames { library: self, conversions: &conversions };
        let mut converter = Converter { names, scope: id, problems: Vec::new() };
        let mut definition = ClassDefinition::clone(&written.definition);
        converter.class(&mut definition, written.parent);
        let mut class = Class { index: OnceLock::new(), ..written.clone() };
        if let (Some(constraint), Some(parent)) = (&mut class.declared.constraint, written.parent) {
            converter.scope = parent;
            converter.constraint(constraint);
        }
        class.problems.append(&mut converter.problems);
        (class.imports, class.extends) = (Vec::new(), Vec::new());
        if let ClassSpecifier::Long(long) = &definition.specifier {
            for section in &long.sections {
                let Section::Elements { elements, .. } = section else { continue };
                for element in elements {
                    match element {
                        Element::Import(import) => class.imports.push(import.kind.clone()),
                        Element::Extends(extends) => class.extends.push(extends.clone()),
                        _ => {}
                    }
                }
            }
        }
        class.definition = Arc::new(definition);
        Some(class)
    }
}

/// Converts what one class says itself; classes in it are converted where they are read.
pub(super) struct Converter<'a> {
    pub(super) names: OldNames<'a>,
    pub(super) scope: ClassId,
    pub(super) problems: Vec<Diagnostic>,
}

impl<'a> Converter<'a> {
    pub(super) fn rules_of(&self, old: &Name) -> Option<&'a Conversion> {
        let library = old.first()?;
        let conversions = self.names.conversions.iter();
        conversions.filter(|(one, _)| *one == library).map(|(_, rules)| &**rules).next()
    }

    pub(super) fn impossible(&mut self, old: &Name, reason: &str, span: Span) {
        self.problems.push(
            fault!(CONVERSION, "`{old}` cannot be converted: {reason}";
                help: "change the library that uses it")
            .at(span),
        );
    }

    fn class(&mut self, class: &mut ClassDefinition, parent: Option<ClassId>) {
        match &mut class.specifier {
            ClassSpecifier::Short(short) => {
                // The name and the modifiers belong to the class around it.
                let around = parent.unwrap_or(self.scope);
                let own = std::mem::replace(&mut self.scope, around);
                self.typed(&mut short.target, &mut short.modification);
                self.scope = own;
                short.comment.annotation.iter_mut().for_each(|one| self.annotation(one));
            }
            ClassSpecifier::Long(long) => {
                if let Some(given) = &mut long.class_extends {
                    let replaced = self.names.replaced(self.scope);
                    self.modifiers(replaced.as_ref(), given, class.name.span);
                }
                long.sections.iter_mut().for_each(|section| self.section(section));
            }
            ClassSpecifier::Derivative(derivative) => self.type_name(&mut derivative.target),
            ClassSpecifier::Enumeration(_) => {}
        }
    }

    fn section(&mut self, section: &mut Section) {
        match section {
            Section::Elements { elements, .. } => {
                let written = std::mem::take(elements);
                elements.extend(written.into_iter().flat_map(|element| self.element(element)));
            }
            Section::Equations { equations, .. } => {
                equations.iter_mut().for_each(|equation| self.equation(equation));
            }
            Section::Algorithm { statements, .. } => {
                statements.iter_mut().for_each(|statement| self.statement(statement));
            }
            Section::External(external) => {
                external.arguments.iter_mut().for_each(|argument| self.expression(argument));
            }
            Section::Annotation(annotation) => self.annotation(annotation),
        }
    }

    /// The functions that an annotation names: derivatives and inverses.
    fn annotation(&mut self, annotation: &mut Annotation) {
        for argument in &mut annotation.arguments {
            let Argument::Element(element) = argument else { continue };
            let name = element.name.node.last().filter(|_| element.name.node.is_simple());
            if name.is_some_and(|name| name == "derivative" || name == "inverse")
                && let Some(modification) = &mut element.modification
            {
                rewrite_modification(self, modification);
            }
        }
    }

    fn element(&mut self, mut element: Element) -> Vec<Element> {
        match &mut element {
            Element::Import(import) => {
                let kinds = self.import(&import.kind, import.span);
                let copy =
                    |kind| Element::Import(crate::syntax::ast::Import { kind, ..import.clone() });
                return kinds.into_iter().map(copy).collect();
            }
            Element::Extends(extends) => self.typed(&mut extends.base, &mut extends.modification),
            Element::Class(nested) => {
                nested.constraint.iter_mut().for_each(|one| self.constraint(one));
            }
            Element::Component(clause) => {
                let clauses = self.clauses(clause.clone());
                return clauses.into_iter().map(Element::Component).collect();
            }
        }
        vec![element]
    }

    /// An import under the same name as before.
    fn import(&mut self, kind: &ImportKind, span: Span) -> Vec<ImportKind> {
        let mut new = |old: &Name| self.new_class(old, span).unwrap_or_else(|| old.clone());
        match kind {
            ImportKind::Qualified(old) => {
                let new = new(old);
                match old.last().filter(|_| new != *old) {
                    Some(name) => vec![ImportKind::Renaming(name, new)],
                    None => vec![kind.clone()],
                }
            }
            ImportKind::Renaming(name, old) => vec![ImportKind::Renaming(*name, new(old))],
            ImportKind::Unqualified(old) => vec![ImportKind::Unqualified(new(old))],
            ImportKind::Group(package, names) => {
                let each = names.iter();
                each.map(|name| ImportKind::Renaming(*name, new(&package.child(*name)))).collect()
            }
        }
    }

    /// The new name of an old class; `None` if it stays. Says why it cannot be converted.
    fn new_class(&mut self, old: &Name, span: Span) -> Option<Name> {
        let rules = self.rules_of(old)?;
        let new = rules.class(old);
        if new.is_none()
            && let Some(reason) = rules.message(old)
        {
            self.impossible(old, reason, span);
        }
        new
    }

    fn type_name(&mut self, specifier: &mut TypeSpecifier) {
        if let Some(Meaning::Old(old)) = self.names.meaning(self.scope, &specifier.name)
            && let Some(new) = self.new_class(&old, specifier.span)
        {
            specifier.name = new;
        }
    }

    /// The new `modelica://Name.of.a.class/path`, if the name of the class changes.
    fn address(&mut self, text: &str, span: Span) -> Option<Arc<str>> {
        const SCHEME: &str = "modelica://";
        let address = text.strip_prefix(SCHEME)?;
        let end = address.find(['/', '#', '?']).unwrap_or(address.len());
        let (class, rest) = address.split_at(end);
        let new = self.new_class(&Name::parse(class), span)?;
        Some(format!("{SCHEME}{new}{rest}").into())
    }

    /// A type and what modifies it.
    pub(super) fn typed(&mut self, specifier: &mut TypeSpecifier, modifiers: &mut Vec<Argument>) {
        let meaning = self.names.meaning(self.scope, &specifier.name);
        match self.modifiers(meaning.as_ref(), modifiers, specifier.span) {
            Some(new) => specifier.name = new,
            None => self.type_name(specifier),
        }
    }

    pub(super) fn constraint(&mut self, constraint: &mut Constraint) {
        self.typed(&mut constraint.target, &mut constraint.modification);
    }

    /// A clause of components, as one clause for each where their modifiers decide on their types.
    pub(super) fn clauses(&mut self, clause: ComponentClause) -> Vec<ComponentClause> {
        let meaning = self.names.meaning(self.scope, &clause.type_specifier.name);
        let depends = match &meaning {
            Some(Meaning::Old(old)) => {
                self.rules_of(old).is_some_and(|rules| rules.has_choices(old))
            }
            _ => false,
        };
        if !depends || clause.components.len() == 1 {
            return vec![self.clause(clause)];
        }
        let one = |component| ComponentClause { components: vec![component], ..clause.clone() };
        let clauses: Vec<ComponentClause> = clause.components.iter().cloned().map(one).collect();
        clauses.into_iter().map(|clause| self.clause(clause)).collect()
    }

    fn clause(&mut self, mut clause: ComponentClause) -> ComponentClause {
        let meaning = self.names.meaning(self.scope, &clause.type_specifier.name);
        let written = clause.type_specifier.clone();
        let mut chosen = None;
        for component in &mut clause.components {
            chosen = chosen.or(self.component(component, meaning.as_ref(), written.span));
        }
        match chosen {
            Some(new) => clause.type_specifier.name = new,
            None => self.type_name(&mut clause.type_specifier),
        }
        self.subscripts(&mut clause.subscripts);
        clause.constraint.iter_mut().for_each(|one| self.constraint(one));
        clause
    }

    /// The path of a component after its first name, in classes of the user and then in the first
    /// one of a library.
    fn path(&mut self, parts: &mut Vec<ReferencePart>, first: Meaning, span: Span) {
        let mut meaning = first;
        for at in 1..parts.len() {
            let name = parts[at].name;
            for old in self.names.old_bases(&meaning) {
                if self.renamed(parts, at, &old, span) {
                    return;
                }
            }
            match meaning {
                Meaning::Own(id) => match self.names.component(id, name) {
                    Some(next) => meaning = next,
                    None => return,
                },
                Meaning::Old(_) => return,
            }
        }
    }

    /// Gives an element of an old class its new name in a path.
    fn renamed(
        &mut self,
        parts: &mut Vec<ReferencePart>,
        at: usize,
        old: &Name,
        span: Span,
    ) -> bool {
        let Some(rules) = self.rules_of(old) else { return false };
        let path: Vec<Ident> = parts[at..].iter().map(|part| part.name).collect();
        if let Some(reason) = rules.message_of_element(old, &path) {
            self.impossible(&old.child(path[0]), reason, span);
            return true;
        }
        let Some((new, count)) = rules.element(old, &path) else { return false };
        let subscripts = std::mem::take(&mut parts[at + count - 1].subscripts);
        let mut named: Vec<ReferencePart> = new.parts.iter().map(|name| part(*name)).collect();
        if let Some(last) = named.last_mut() {
            last.subscripts = subscripts;
        }
        parts.splice(at..at + count, named);
        true
    }

    /// The class around that has a component of a name, and its type.
    fn component_around(&self, name: Ident) -> Option<Option<Meaning>> {
        let mut scope = Some(self.scope);
        while let Some(at) = scope {
            if self.names.has_component(at, name) {
                return Some(self.names.component(at, name));
            }
            scope = self.names.library.read(at).parent;
        }
        None
    }

    /// The longest part of a reference that names a class of a library, converted.
    fn class_reference(&mut self, reference: &mut ComponentReference) {
        let Some(Meaning::Old(old)) = self.names.meaning(self.scope, &reference.name()) else {
            return;
        };
        let Some(new) = self.new_class(&old, reference.span) else { return };
        let parts = std::mem::take(&mut reference.parts);
        // What both names end with keeps its subscripts.
        let mut converted: Vec<ReferencePart> = new.parts.iter().map(|name| part(*name)).collect();
        for (new, old) in converted.iter_mut().rev().zip(parts.into_iter().rev()) {
            new.subscripts = old.subscripts;
        }
        reference.parts = converted;
    }

    /// A name that the class inherits from a class of a library.
    fn inherited_name(&mut self, reference: &mut ComponentReference) {
        let own = Meaning::Own(self.scope);
        for old in self.names.old_bases(&own) {
            if self.renamed(&mut reference.parts, 0, &old, reference.span) {
                return;
            }
        }
    }

    fn named_arguments(&mut self, function: &ComponentReference, arguments: &mut Arguments) {
        let Some(meaning) = self.names.meaning(self.scope, &function.name()) else { return };
        for old in self.names.old_bases(&meaning) {
            let Some(rules) = self.rules_of(&old) else { continue };
            for argument in &mut arguments.named {
                if let Some((new, 1)) = rules.element(&old, &[argument.name.node])
                    && let (Some(name), true) = (new.last(), new.is_simple())
                {
                    argument.name.node = name;
                }
            }
        }
    }
}

impl Rewrite for Converter<'_> {
    fn expression(&mut self, e: &mut Expression) {
        if let ExpressionKind::Call { function, arguments } = &mut e.kind {
            self.named_arguments(&function.clone(), arguments);
        }
        if let ExpressionKind::String(text) = &mut e.kind
            && let Some(new) = self.address(text, e.span)
        {
            *text = new;
        }
        if let ExpressionKind::PartialApplication { function, .. } = &mut e.kind {
            let mut specifier = TypeSpecifier { name: function.clone(), span: e.span };
            self.type_name(&mut specifier);
            *function = specifier.name;
        }
        rewrite_expression(self, e);
    }

    fn reference(&mut self, reference: &mut ComponentReference) {
        rewrite_reference(self, reference);
        let Some(first) = reference.parts.first().map(|part| part.name) else { return };
        match self.component_around(first).filter(|_| !reference.global) {
            Some(Some(meaning)) => {
                let span = reference.span;
                self.path(&mut reference.parts, meaning, span);
            }
            Some(None) => {}
            None => {
                let before = reference.parts.len();
                self.class_reference(reference);
                if before == reference.parts.len() && !reference.global {
                    self.inherited_name(reference);
                }
            }
        }
    }
}

fn part(name: Ident) -> ReferencePart {
    ReferencePart { name, subscripts: Vec::new() }
}
