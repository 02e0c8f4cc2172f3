//! The names in the declarations of classes.

use super::{Entity, OccurrenceSearch, identifiers};
use crate::flatten::{ClassId, Declared};
use crate::name::{Ident, Name};
use crate::source::{Span, Spanned};
use crate::syntax::ast::{
    Annotation, Argument, Binding, ClassDefinition, ClassElement, ClassSpecifier, Comment,
    ComponentClause, ComponentDeclaration, Constraint, Element, Exclusion, Extends, External,
    Import, ImportKind, InteractiveKind, LongClass, Modification, RedeclaredElement, Section,
    ShortClass, Subscript, TypeSpecifier,
};
use crate::syntax::visit::Visit as _;
use std::ops::Range;

fn bytes(span: Span) -> Range<usize> {
    span.start as usize..span.end as usize
}

impl OccurrenceSearch<'_> {
    /// The names of a written name with what its parts mean.
    pub(super) fn name(&mut self, span: Span, parts: &[Option<Declared>]) {
        let written = identifiers(self.text, bytes(span));
        for (range, part) in written.into_iter().zip(parts) {
            if let Some(declared) = part {
                self.add(range, Entity::Declared(*declared), false);
            }
        }
    }

    fn declare(&mut self, name: Spanned<Ident>, declared: Declared) {
        self.add(bytes(name.span), Entity::Declared(declared), true);
    }

    /// A class with all that is in it.
    pub(super) fn class(&mut self, id: ClassId, class: &ClassDefinition) {
        self.declare(class.name, Declared::Class(id));
        let around = self.scope;
        match &class.specifier {
            ClassSpecifier::Long(long) => {
                self.scope = Some(id);
                self.long(id, long);
                self.scope = around;
            }
            ClassSpecifier::Short(short) => {
                self.scope = self.library.enclosing(id);
                self.short(short);
                self.scope = around;
                self.comment(&short.comment);
            }
            ClassSpecifier::Enumeration(enumeration) => {
                for literal in enumeration.literals.iter().flatten() {
                    self.declare(literal.name, Declared::Literal(id, literal.name.node));
                }
                self.comment(&enumeration.comment);
            }
            ClassSpecifier::Derivative(derivative) => {
                self.scope = self.library.enclosing(id);
                let function = self.specifier(&derivative.target);
                for variable in &derivative.variables {
                    self.element_name(function, *variable);
                }
                self.scope = around;
            }
        }
    }

    fn long(&mut self, id: ClassId, long: &LongClass) {
        if let Some(arguments) = &long.class_extends {
            self.arguments(Some(id), arguments);
        }
        for section in &long.sections {
            match section {
                Section::Elements { elements, .. } => {
                    elements.iter().for_each(|element| self.element(id, element));
                }
                Section::Equations { equations, .. } => {
                    equations.iter().for_each(|equation| self.equation(equation));
                }
                Section::Algorithm { statements, .. } => {
                    statements.iter().for_each(|statement| self.statement(statement));
                }
                Section::External(external) => self.external(external),
                Section::Annotation(annotation) => self.annotation(annotation),
            }
        }
        let Spanned { span, .. } = long.end_name;
        self.add(bytes(span), Entity::Declared(Declared::Class(id)), false);
    }

    fn short(&mut self, short: &ShortClass) {
        let target = self.specifier(&short.target);
        self.subscripts(&short.subscripts);
        self.arguments(target, &short.modification);
    }

    fn element(&mut self, id: ClassId, element: &Element) {
        match element {
            Element::Import(import) => self.import(import),
            Element::Extends(extends) => self.extends(extends),
            Element::Class(nested) => {
                if let Some(Declared::Class(own)) = self.own_class(id, nested.class.name.node) {
                    self.class(own, &nested.class);
                }
                self.constraint(nested.constraint.as_ref());
            }
            Element::Component(clause) => {
                let target = self.clause_type(clause);
                for component in &clause.components {
                    let name = component.name.node;
                    let known = self.library.element(id, name);
                    self.declare(component.name, known.unwrap_or(Declared::Component(id, name)));
                    self.component(target, component);
                }
            }
        }
    }

    fn own_class(&self, id: ClassId, name: Ident) -> Option<Declared> {
        let full = self.library.name_of(id).child(name);
        self.library.find(&full).map(Declared::Class)
    }

    fn import(&mut self, import: &Import) {
        let written = identifiers(self.text, bytes(import.span));
        // After the keyword.
        let mut written = written.into_iter().skip(1);
        let library = self.library;
        let (name, members): (&Name, &[Ident]) = match &import.kind {
            ImportKind::Qualified(name) | ImportKind::Unqualified(name) => (name, &[]),
            ImportKind::Renaming(_, name) => {
                let meaning = library.parts_of_reference(None, name).pop().flatten();
                if let Some((range, declared)) = written.next().zip(meaning) {
                    self.add(range, Entity::Declared(declared), false);
                }
                (name, &[])
            }
            ImportKind::Group(package, names) => (package, names),
        };
        let of_members = members
            .iter()
            .map(|member| library.parts_of_reference(None, &name.child(*member)).pop().flatten());
        let parts = library.parts_of_reference(None, name).into_iter().chain(of_members);
        for (range, part) in written.zip(parts) {
            if let Some(declared) = part {
                self.add(range, Entity::Declared(declared), false);
            }
        }
    }

    fn extends(&mut self, extends: &Extends) {
        let base = self.specifier(&extends.base);
        self.arguments(base, &extends.modification);
        for excluded in &extends.excluded {
            match excluded {
                Exclusion::Component(name) => self.element_name(base, *name),
                Exclusion::Connection(left, right) => {
                    self.reference(left);
                    self.reference(right);
                }
            }
        }
        extends.annotation.iter().for_each(|annotation| self.annotation(annotation));
    }

    /// The type of a clause, with all that is written once for its components.
    fn clause_type(&mut self, clause: &ComponentClause) -> Option<ClassId> {
        let target = self.specifier(&clause.type_specifier);
        self.subscripts(&clause.subscripts);
        self.constraint(clause.constraint.as_ref());
        target
    }

    fn component(&mut self, target: Option<ClassId>, component: &ComponentDeclaration) {
        self.subscripts(&component.subscripts);
        component.modification.iter().for_each(|one| self.modification(target, one));
        component.condition.iter().for_each(|condition| self.expression(condition));
        self.comment(&component.comment);
    }

    fn constraint(&mut self, constraint: Option<&Constraint>) {
        if let Some(constraint) = constraint {
            let target = self.specifier(&constraint.target);
            self.arguments(target, &constraint.modification);
            self.comment(&constraint.comment);
        }
    }

    /// The name of a type; its class.
    fn specifier(&mut self, specifier: &TypeSpecifier) -> Option<ClassId> {
        let parts = self.library.parts_of_type(self.scope, &specifier.name);
        self.name(specifier.span, &parts);
        match parts.last().copied().flatten()? {
            Declared::Class(class) => Some(class),
            _ => None,
        }
    }

    fn subscripts(&mut self, subscripts: &[Subscript]) {
        for subscript in subscripts {
            if let Subscript::Index(index) = subscript {
                self.expression(index);
            }
        }
    }

    /// The name of an element of a class.
    pub(super) fn element_name(&mut self, class: Option<ClassId>, name: Spanned<Ident>) {
        let found = class.and_then(|class| self.library.element(class, name.node));
        if let Some(declared) = found {
            self.add(bytes(name.span), Entity::Declared(declared), false);
        }
    }

    fn modification(&mut self, target: Option<ClassId>, modification: &Modification) {
        self.arguments(target, &modification.arguments);
        if let Some(Binding::Expression(value)) = &modification.binding {
            self.expression(value);
        }
    }

    /// The arguments of the modification of a class.
    fn arguments(&mut self, target: Option<ClassId>, arguments: &[Argument]) {
        for argument in arguments {
            match argument {
                Argument::Element(element) => {
                    let parts = self.followed(target, &element.name.node);
                    self.name(element.name.span, &parts);
                    let inner = parts.last().copied().flatten();
                    let inner = inner.and_then(|inner| self.library.class_of_declared(inner));
                    element.modification.iter().for_each(|one| self.modification(inner, one));
                }
                Argument::Redeclaration(redeclaration) => match &redeclaration.element {
                    RedeclaredElement::Class(nested) => self.redeclared_class(target, nested),
                    RedeclaredElement::Component(clause) => {
                        let own = self.clause_type(clause);
                        for component in &clause.components {
                            self.element_name(target, component.name);
                            self.component(own, component);
                        }
                    }
                },
            }
        }
    }

    /// What the parts of the name of a modified element mean.
    fn followed(&self, target: Option<ClassId>, name: &Name) -> Vec<Option<Declared>> {
        let mut at = target.map(Declared::Class);
        let step = |part: &Ident| {
            at = at.and_then(|of| self.library.element_of(of, *part));
            at
        };
        name.parts.iter().map(step).collect()
    }

    fn redeclared_class(&mut self, target: Option<ClassId>, nested: &ClassElement) {
        self.element_name(target, nested.class.name);
        if let ClassSpecifier::Short(short) = &nested.class.specifier {
            self.short(short);
        }
        self.constraint(nested.constraint.as_ref());
    }

    fn external(&mut self, external: &External) {
        external.output.iter().for_each(|output| self.reference(output));
        external.arguments.iter().for_each(|argument| self.expression(argument));
    }

    fn comment(&mut self, comment: &Comment) {
        comment.annotation.iter().for_each(|annotation| self.annotation(annotation));
    }

    /// The expressions of an annotation, such as `Dialog(enable = use_T)`.
    fn annotation(&mut self, annotation: &Annotation) {
        self.arguments(None, &annotation.arguments);
    }

    /// A statement of a script.
    pub(super) fn interactive(&mut self, kind: &InteractiveKind) {
        match kind {
            InteractiveKind::Statement(statement) => self.statement(statement),
            InteractiveKind::Expression(expression) => self.expression(expression),
            InteractiveKind::Declaration(clause) => {
                let target = self.clause_type(clause);
                for component in &clause.components {
                    let Spanned { node, span } = component.name;
                    self.add(bytes(span), Entity::Variable(node), true);
                    self.component(target, component);
                }
            }
            InteractiveKind::Import(import) => self.import(import),
            // Classes are walked by their names; commands have no names in them.
            InteractiveKind::Class(_) | InteractiveKind::Command { .. } => {}
        }
    }
}
