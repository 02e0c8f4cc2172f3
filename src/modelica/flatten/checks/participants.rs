//! The classes that take part in a class: those it extends, those of its components, those that its
//! modifications name, and the functions and packages that its expressions name.

use super::scope::Scope;
use crate::flatten::library::ClassId;
use crate::name::Name;
use crate::syntax::ast::{
    Argument, ClassSpecifier, ComponentClause, ComponentReference, Element, Modification,
    RedeclaredElement, Restriction, Section,
};
use crate::syntax::visit::{
    Visit, walk_arguments, walk_equation, walk_modification, walk_reference, walk_statement,
};
use rustc_hash::FxHashSet;

/// A class and all that take part in it, each once, in the order in which they are met.
pub(crate) fn of(root: Scope<'_>) -> Vec<Scope<'_>> {
    let mut seen: FxHashSet<ClassId> = [root.class].into_iter().collect();
    let mut found = vec![root];
    let mut next = 0;
    while next < found.len() {
        let class = found[next];
        next += 1;
        let mut direct = Direct { class, named: Vec::new() };
        direct.collect();
        found.extend(direct.named.into_iter().filter(|other| seen.insert(other.class)));
    }
    found
}

/// The classes that one class names itself.
struct Direct<'a> {
    class: Scope<'a>,
    named: Vec<Scope<'a>>,
}

impl Direct<'_> {
    fn collect(&mut self) {
        if let ClassSpecifier::Short(short) = &self.class.definition().specifier {
            if let Some(outside) = self.class.parent() {
                self.named.extend(outside.class_named(&short.target.name));
            }
            self.arguments(&short.modification);
        }
        for (_, element) in self.class.elements() {
            self.element(element);
        }
        for section in self.class.sections() {
            match section {
                Section::Equations { equations, .. } => {
                    equations.iter().for_each(|equation| walk_equation(self, equation));
                }
                Section::Algorithm { statements, .. } => {
                    statements.iter().for_each(|statement| walk_statement(self, statement));
                }
                _ => {}
            }
        }
    }

    fn element(&mut self, element: &Element) {
        match element {
            Element::Import(_) => {}
            Element::Extends(extends) => {
                self.name(&extends.base.name);
                self.arguments(&extends.modification);
            }
            Element::Component(clause) => self.clause(clause),
            Element::Class(nested) => {
                // What an operator record says about operators is about itself.
                let is_operator = matches!(
                    nested.class.restriction,
                    Restriction::Operator | Restriction::Function { operator: true, .. }
                );
                let in_operator = self.class.restriction() == Restriction::Operator;
                if is_operator || in_operator {
                    self.name(&Name::from(nested.class.name.node));
                }
            }
        }
    }

    fn clause(&mut self, clause: &ComponentClause) {
        self.name(&clause.type_specifier.name);
        if let Some(constraint) = &clause.constraint {
            self.name(&constraint.target.name);
        }
        for component in &clause.components {
            component.modification.iter().for_each(|one| self.modification(one));
            component.condition.iter().for_each(|one| self.expression(one));
        }
    }

    fn modification(&mut self, modification: &Modification) {
        walk_modification(self, modification);
        self.redeclared(&modification.arguments);
    }

    fn arguments(&mut self, arguments: &[Argument]) {
        walk_arguments(self, arguments);
        self.redeclared(arguments);
    }

    /// The classes that redeclarations name.
    fn redeclared(&mut self, arguments: &[Argument]) {
        for argument in arguments {
            match argument {
                Argument::Element(element) => {
                    element.modification.iter().for_each(|one| self.redeclared(&one.arguments));
                }
                Argument::Redeclaration(redeclaration) => match &redeclaration.element {
                    RedeclaredElement::Component(clause) => {
                        self.name(&clause.type_specifier.name);
                    }
                    RedeclaredElement::Class(nested) => {
                        if let ClassSpecifier::Short(short) = &nested.class.specifier {
                            self.name(&short.target.name);
                            self.arguments(&short.modification);
                        }
                    }
                },
            }
        }
    }

    fn name(&mut self, name: &Name) {
        self.named.extend(self.class.class_named(name));
    }
}

impl Visit for Direct<'_> {
    fn reference(&mut self, reference: &ComponentReference) {
        walk_reference(self, reference);
        let parts = reference.parts.iter().map(|part| part.name).collect();
        let mut name = Name { global: reference.global, parts };
        if !reference.global && self.class.component(name.parts[0]).is_some() {
            return;
        }
        while !name.parts.is_empty() {
            if let Some(class) = self.class.class_named(&name) {
                self.named.push(class);
                return;
            }
            name.parts.pop();
        }
    }
}
