//! Names in expressions, equations and statements.

use super::NameCheck;
use crate::flatten::checks::scope::Component;
use crate::flatten::declared::Declared;
use crate::flatten::lookup::types::Predefined;
use crate::flatten::unknown;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    ComponentReference, Equation, EquationKind, Expression, ExpressionKind, ForIndex, Statement,
    StatementKind,
};
use crate::syntax::visit::{Visit, walk_equation, walk_expression, walk_reference, walk_statement};

impl NameCheck<'_, '_> {
    /// A name in an expression.
    fn value(&mut self, name: &Name, span: Span) {
        let Some(first) = name.first() else { return };
        let is_time = name.is_simple() && first.as_str() == "time";
        if is_time || self.is_loop_variable(name, first) {
            return;
        }
        let scope = self.scope.map(|scope| scope.class);
        let parts = self.library.parts_of_reference(scope, name);
        let Some(at) = parts.iter().position(Option::is_none) else { return };
        if self.may_be_undeclared(&parts, at) {
            return;
        }
        match at.checked_sub(1).and_then(|last| parts[last]) {
            Some(last @ Declared::Component(..)) => {
                self.missing_component(last, name, at, span);
            }
            Some(Declared::Predefined(_)) => {}
            _ if self.is_first_of_package(name, at) => {
                let known = scope.map_or(Vec::new(), |scope| self.library.component_names(scope));
                self.errors.push(unknown::name(name, &known, span));
            }
            _ => {}
        }
    }

    pub(super) fn is_loop_variable(&self, name: &Name, first: Ident) -> bool {
        !name.global && self.loops.contains(&first)
    }

    /// The part of a name at `at`, which the component before it does not have.
    fn missing_component(&mut self, of: Declared, name: &Name, at: usize, span: Span) {
        let part = name.parts[at];
        let Declared::Component(owner, own) = of else { return };
        let Some(scope) = self.scope else { return };
        let Some(component) = scope.of(owner).own_component(own) else { return };
        if is_variable(&component) {
            let path = Name::new(name.parts[..at].iter().copied()).to_string();
            self.errors.push(unknown::component_of_variable(&path, part, span));
        } else if let Some(class) = component.class() {
            let known = self.library.component_names(class.class);
            self.errors.push(unknown::component(class.name(), part, &known, span));
        }
    }

    /// Walks a body in which loop variables are in force.
    fn within(&mut self, indices: &[ForIndex], body: impl FnOnce(&mut Self)) {
        let outer = self.loops.len();
        self.loops.extend(indices.iter().map(|index| index.name.node));
        body(self);
        self.loops.truncate(outer);
    }
}

/// Whether a component has no components: numbers, truths, strings and literals of enumerations.
fn is_variable(component: &Component<'_>) -> bool {
    use Predefined::{AssertionLevel, Boolean, Integer, Real, StateSelect, String};
    let is_enumeration = || component.class().is_some_and(|class| class.is_enumeration());
    match component.predefined() {
        Some(Real | Integer | Boolean | String | StateSelect | AssertionLevel) => true,
        Some(Predefined::ExternalObject | Predefined::Clock) => false,
        None => is_enumeration(),
    }
}

impl Visit for NameCheck<'_, '_> {
    fn reference(&mut self, reference: &ComponentReference) {
        walk_reference(self, reference);
        self.value(&reference.name(), reference.span);
    }

    fn expression(&mut self, expression: &Expression) {
        match &expression.kind {
            ExpressionKind::Call { function, arguments } => {
                self.call(function, arguments);
                self.within(&arguments.iterators, |walk| {
                    let named = arguments.named.iter().map(|argument| &argument.value);
                    let ranges = arguments.iterators.iter().flat_map(|index| &index.range);
                    let all = arguments.positional.iter().chain(named).chain(ranges);
                    all.for_each(|argument| walk.expression(argument));
                });
            }
            ExpressionKind::PartialApplication { function, named } => {
                self.partial_application(function, named, expression.span);
                walk_expression(self, expression);
            }
            ExpressionKind::ArrayIteration { indices, .. } => {
                self.within(indices, |walk| walk_expression(walk, expression));
            }
            _ => walk_expression(self, expression),
        }
    }

    fn equation(&mut self, equation: &Equation) {
        self.comment(&equation.comment);
        match &equation.kind {
            EquationKind::For { indices, .. } => {
                self.within(indices, |walk| walk_equation(walk, equation));
            }
            _ => walk_equation(self, equation),
        }
    }

    fn statement(&mut self, statement: &Statement) {
        self.comment(&statement.comment);
        match &statement.kind {
            StatementKind::For { indices, .. } => {
                self.within(indices, |walk| walk_statement(walk, statement));
            }
            _ => walk_statement(self, statement),
        }
    }
}
