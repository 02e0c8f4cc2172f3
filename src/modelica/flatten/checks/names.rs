//! The names that a class writes: of types, base classes, and in its expressions.

use super::scope::Scope;
use crate::flatten::declared::Declared;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    Argument, ClassSpecifier, ComponentClause, ComponentReference, Constraint, Element, Equation,
    EquationKind, Expression, ExpressionKind, ForIndex, Modification, RedeclaredElement, Section,
    Statement, StatementKind, Subscript, TypeSpecifier,
};
use crate::syntax::visit::{
    Visit, walk_equation, walk_expression, walk_modification, walk_reference, walk_statement,
};

/// A name and where it is written.
pub(crate) struct Written {
    pub name: Name,
    pub span: Span,
    /// It is the base of an extends clause.
    pub(crate) is_base: bool,
}

/// All names that a class itself writes, those of loop variables left out. What short classes
/// write is looked up in the class around them and not listed.
pub(crate) fn of(class: Scope<'_>) -> Vec<Written> {
    let mut walk = WrittenNames::default();
    if !matches!(class.definition().specifier, ClassSpecifier::Long(_)) {
        return Vec::new();
    }
    class.elements().for_each(|(_, element)| walk.element(element));
    for section in class.sections() {
        match section {
            Section::Equations { equations, .. } => {
                equations.iter().for_each(|equation| walk.equation(equation));
            }
            Section::Algorithm { statements, .. } => {
                statements.iter().for_each(|statement| walk.statement(statement));
            }
            _ => {}
        }
    }
    walk.written
}

/// Whether a simple name means a component in a class.
pub(crate) fn is_component(class: Scope<'_>, name: Ident) -> bool {
    let found = class.library.parts_of_reference(Some(class.class), &name.into());
    matches!(found.first(), Some(Some(Declared::Component(..))))
}

#[derive(Default)]
struct WrittenNames {
    written: Vec<Written>,
    loops: Vec<Ident>,
}

impl WrittenNames {
    fn element(&mut self, element: &Element) {
        match element {
            Element::Import(_) => {}
            Element::Extends(extends) => {
                let at = self.written.len();
                self.specifier(&extends.base);
                if let Some(base) = self.written.get_mut(at) {
                    base.is_base = true;
                }
                self.arguments(&extends.modification);
            }
            Element::Component(clause) => self.clause(clause),
            Element::Class(nested) => {
                // The target of a nested short class is looked up here.
                if let ClassSpecifier::Short(short) = &nested.class.specifier {
                    self.specifier(&short.target);
                    self.subscripts(&short.subscripts);
                    self.arguments(&short.modification);
                }
                self.constraint(nested.constraint.as_ref());
            }
        }
    }

    fn clause(&mut self, clause: &ComponentClause) {
        self.specifier(&clause.type_specifier);
        self.subscripts(&clause.subscripts);
        for component in &clause.components {
            self.subscripts(&component.subscripts);
            component.modification.iter().for_each(|one| self.modification(one));
            component.condition.iter().for_each(|one| self.expression(one));
        }
        self.constraint(clause.constraint.as_ref());
    }

    fn constraint(&mut self, constraint: Option<&Constraint>) {
        if let Some(constraint) = constraint {
            self.specifier(&constraint.target);
            self.arguments(&constraint.modification);
        }
    }

    fn specifier(&mut self, specifier: &TypeSpecifier) {
        let (name, span) = (specifier.name.clone(), specifier.span);
        self.written.push(Written { name, span, is_base: false });
    }

    fn subscripts(&mut self, subscripts: &[Subscript]) {
        for subscript in subscripts {
            if let Subscript::Index(index) = subscript {
                self.expression(index);
            }
        }
    }

    fn modification(&mut self, modification: &Modification) {
        self.arguments(&modification.arguments);
        let binding = Modification { arguments: Vec::new(), ..modification.clone() };
        walk_modification(self, &binding);
    }

    fn arguments(&mut self, arguments: &[Argument]) {
        for argument in arguments {
            match argument {
                Argument::Element(element) => {
                    element.modification.iter().for_each(|one| self.modification(one));
                }
                Argument::Redeclaration(redeclaration) => match &redeclaration.element {
                    RedeclaredElement::Component(clause) => self.clause(clause),
                    RedeclaredElement::Class(nested) => {
                        if let ClassSpecifier::Short(short) = &nested.class.specifier {
                            self.specifier(&short.target);
                            self.arguments(&short.modification);
                        }
                    }
                },
            }
        }
    }

    fn within(&mut self, indices: &[ForIndex], body: impl FnOnce(&mut Self)) {
        let outer = self.loops.len();
        self.loops.extend(indices.iter().map(|index| index.name.node));
        body(self);
        self.loops.truncate(outer);
    }
}

impl Visit for WrittenNames {
    fn reference(&mut self, reference: &ComponentReference) {
        walk_reference(self, reference);
        if reference.global || !self.loops.contains(&reference.parts[0].name) {
            let parts = reference.parts.iter().map(|part| part.name).collect();
            let name = Name { global: reference.global, parts };
            self.written.push(Written { name, span: reference.span, is_base: false });
        }
    }

    fn expression(&mut self, expression: &Expression) {
        let indices = match &expression.kind {
            ExpressionKind::ArrayIteration { indices, .. } => indices.as_slice(),
            ExpressionKind::Call { arguments, .. } => &arguments.iterators,
            _ => &[],
        };
        self.within(indices, |walk| walk_expression(walk, expression));
    }

    fn equation(&mut self, equation: &Equation) {
        let indices = match &equation.kind {
            EquationKind::For { indices, .. } => indices.as_slice(),
            _ => &[],
        };
        self.within(indices, |walk| walk_equation(walk, equation));
    }

    fn statement(&mut self, statement: &Statement) {
        let indices = match &statement.kind {
            StatementKind::For { indices, .. } => indices.as_slice(),
            _ => &[],
        };
        self.within(indices, |walk| walk_statement(walk, statement));
    }
}
