//! Modifications and component clauses as text.

use super::Printer;
use crate::syntax::ast::{
    Argument, Binding, CausalityPrefix, ComponentClause, ComponentDeclaration, ConnectionPrefix,
    Constraint, ElementModification, ElementPrefixes, ElementRedeclaration, Modification,
    RedeclaredElement, TypePrefixes, VariabilityPrefix,
};

impl Printer {
    pub(super) fn modification(&mut self, modification: &Modification) {
        if !modification.arguments.is_empty() || modification.binding.is_none() {
            self.word("(");
            self.list(&modification.arguments, Printer::argument);
            self.word(")");
        }
        match &modification.binding {
            Some(Binding::Expression(value)) => {
                self.word(" = ");
                self.expression(value);
            }
            Some(Binding::Break(_)) => self.word(" = break"),
            None => {}
        }
    }

    /// Arguments in parentheses, nothing for none.
    pub(super) fn class_modification(&mut self, arguments: &[Argument]) {
        if !arguments.is_empty() {
            self.word("(");
            self.list(arguments, Printer::argument);
            self.word(")");
        }
    }

    pub(super) fn argument(&mut self, argument: &Argument) {
        match argument {
            Argument::Element(element) => self.element_modification(element),
            Argument::Redeclaration(redeclaration) => self.redeclaration(redeclaration),
        }
    }

    fn element_modification(&mut self, element: &ElementModification) {
        self.flag(element.each, "each");
        self.flag(element.is_final, "final");
        self.show(&element.name.node);
        if let Some(modification) = &element.modification {
            self.modification(modification);
        }
        self.description(element.description.as_deref());
    }

    fn redeclaration(&mut self, redeclaration: &ElementRedeclaration) {
        let prefixes = match &redeclaration.element {
            RedeclaredElement::Class(class) => class.prefixes,
            RedeclaredElement::Component(clause) => clause.prefixes,
        };
        self.flag(prefixes.redeclare, "redeclare");
        self.flag(redeclaration.each, "each");
        self.flag(prefixes.is_final, "final");
        self.flag(prefixes.replaceable, "replaceable");
        match &redeclaration.element {
            RedeclaredElement::Class(class) => {
                self.class(&class.class);
                self.constraint(class.constraint.as_ref());
            }
            RedeclaredElement::Component(clause) => self.clause_without_prefixes(clause),
        }
    }

    pub(super) fn element_prefixes(&mut self, prefixes: ElementPrefixes) {
        self.flag(prefixes.redeclare, "redeclare");
        self.flag(prefixes.is_final, "final");
        self.flag(prefixes.inner, "inner");
        self.flag(prefixes.outer, "outer");
        self.flag(prefixes.replaceable, "replaceable");
    }

    pub(super) fn component_clause(&mut self, clause: &ComponentClause) {
        self.element_prefixes(clause.prefixes);
        self.clause_without_prefixes(clause);
    }

    fn clause_without_prefixes(&mut self, clause: &ComponentClause) {
        self.type_prefixes(clause.type_prefixes);
        self.show(&clause.type_specifier.name);
        self.subscripts(&clause.subscripts);
        self.word(" ");
        self.list(&clause.components, Printer::component);
        self.constraint(clause.constraint.as_ref());
    }

    pub(super) fn type_prefixes(&mut self, prefixes: TypePrefixes) {
        self.flag(prefixes.connection == Some(ConnectionPrefix::Flow), "flow");
        self.flag(prefixes.connection == Some(ConnectionPrefix::Stream), "stream");
        self.flag(prefixes.variability == Some(VariabilityPrefix::Constant), "constant");
        self.flag(prefixes.variability == Some(VariabilityPrefix::Parameter), "parameter");
        self.flag(prefixes.variability == Some(VariabilityPrefix::Discrete), "discrete");
        self.flag(prefixes.causality == Some(CausalityPrefix::Input), "input");
        self.flag(prefixes.causality == Some(CausalityPrefix::Output), "output");
    }

    fn component(&mut self, component: &ComponentDeclaration) {
        self.show(component.name.node);
        self.subscripts(&component.subscripts);
        if let Some(modification) = &component.modification {
            self.modification(modification);
        }
        if let Some(condition) = &component.condition {
            self.word(" if ");
            self.expression(condition);
        }
        self.comment(&component.comment);
    }

    pub(super) fn constraint(&mut self, constraint: Option<&Constraint>) {
        let Some(constraint) = constraint else { return };
        self.word(" constrainedby ");
        self.show(&constraint.target.name);
        self.class_modification(&constraint.modification);
        self.comment(&constraint.comment);
    }
}
