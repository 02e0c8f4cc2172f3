//! The names in expressions, equations and statements.

use super::{Entity, OccurrenceSearch, identifiers};
use crate::flatten::{ClassId, Declared};
use crate::functions;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    Arguments, ComponentReference, Equation, EquationKind, Expression, ExpressionKind, ForIndex,
    Statement, StatementKind,
};
use crate::syntax::visit::{Visit, walk_equation, walk_expression, walk_reference, walk_statement};

impl OccurrenceSearch<'_> {
    /// Walks a body in which loop variables are in force.
    fn within(&mut self, indices: &[ForIndex], body: impl FnOnce(&mut Self)) {
        let outer = self.loops.len();
        for index in indices {
            let place = index.name.span.start as usize;
            let range = place..index.name.span.end as usize;
            self.add(range, Entity::Loop(place), true);
            self.loops.push((index.name.node, place));
        }
        body(self);
        self.loops.truncate(outer);
    }

    /// What the first part of a reference means that no class declares.
    fn undeclared(&self, name: Ident, is_called: bool) -> Option<Entity> {
        let text = name.as_str();
        let is_function = functions::is_builtin(text) || text == "time";
        let is_command = self.variables.is_some() && self.commands.contains(text);
        match &self.variables {
            Some(variables) if !is_called && variables.contains(&name) => {
                Some(Entity::Variable(name))
            }
            _ if is_called && (is_function || is_command) || text == "time" => {
                Some(Entity::Function(name))
            }
            Some(_) if !is_called => Some(Entity::Variable(name)),
            _ => None,
        }
    }

    /// A name in an expression; the class that it means, or that its component is of.
    fn written(&mut self, name: &Name, span: Span, is_called: bool) -> Option<ClassId> {
        let first = name.first()?;
        let local = self.loops.iter().rfind(|(known, _)| *known == first && !name.global);
        let is_variable =
            !name.global && self.variables.as_ref().is_some_and(|all| all.contains(&first));
        let own = match local {
            Some((_, place)) => Some(Entity::Loop(*place)),
            None if is_variable && !is_called => Some(Entity::Variable(first)),
            None => None,
        };
        let parts = match own {
            Some(_) => vec![None],
            None => self.library.parts_of_reference(self.scope, name),
        };
        let own = own.or_else(|| match parts.first() {
            Some(None) if name.is_simple() || !is_called => self.undeclared(first, is_called),
            _ => None,
        });
        if let Some(entity) = own
            && let Some(range) =
                identifiers(self.text, span.start as usize..span.end as usize).into_iter().next()
        {
            self.add(range, entity, false);
        }
        self.name(span, &parts);
        parts.last().copied().flatten().and_then(|last| self.library.class_of_declared(last))
    }

    fn call(&mut self, function: &ComponentReference, arguments: &Arguments) {
        walk_reference(self, function);
        let class = self.written(&function.name(), function.span, true);
        if self.variables.is_some()
            && let Some(first) = arguments.positional.first()
        {
            self.class_in_string(first);
        }
        self.within(&arguments.iterators, |walk| {
            arguments.positional.iter().for_each(|argument| walk.expression(argument));
            for argument in &arguments.named {
                walk.element_name(class, argument.name);
                walk.expression(&argument.value);
            }
        });
        let ranges = arguments.iterators.iter().flat_map(|index| &index.range);
        ranges.for_each(|range| self.expression(range));
    }

    /// Scripts name models in strings: `simulateModel("Plant")`.
    fn class_in_string(&mut self, argument: &Expression) {
        let ExpressionKind::String(text) = &argument.kind else { return };
        let is_name = text.split('.').all(super::is_identifier);
        // Without quotation marks, which are one byte each.
        let span =
            Span { start: argument.span.start + 1, end: argument.span.end - 1, ..argument.span };
        let bytes = span.start as usize..span.end as usize;
        if is_name && self.text.get(bytes) == Some(text) {
            let parts = self.library.parts_of_type(None, &Name::parse(text));
            if parts
                .last()
                .copied()
                .flatten()
                .is_some_and(|last| matches!(last, Declared::Class(_)))
            {
                self.name(span, &parts);
            }
        }
    }
}

impl Visit for OccurrenceSearch<'_> {
    fn reference(&mut self, reference: &ComponentReference) {
        walk_reference(self, reference);
        self.written(&reference.name(), reference.span, false);
    }

    fn expression(&mut self, expression: &Expression) {
        match &expression.kind {
            ExpressionKind::Call { function, arguments } => self.call(function, arguments),
            ExpressionKind::PartialApplication { function, named } => {
                // After the keyword `function`.
                let start = expression.span.start + "function".len() as u32;
                let span = Span { start: start.min(expression.span.end), ..expression.span };
                let class = self.written(function, span, true);
                for argument in named {
                    self.element_name(class, argument.name);
                    self.expression(&argument.value);
                }
            }
            ExpressionKind::ArrayIteration { indices, .. } => {
                self.within(indices, |walk| walk_expression(walk, expression));
            }
            _ => walk_expression(self, expression),
        }
    }

    fn equation(&mut self, equation: &Equation) {
        match &equation.kind {
            EquationKind::For { indices, .. } => {
                self.within(indices, |walk| walk_equation(walk, equation));
            }
            _ => walk_equation(self, equation),
        }
    }

    fn statement(&mut self, statement: &Statement) {
        match &statement.kind {
            StatementKind::For { indices, .. } => {
                self.within(indices, |walk| walk_statement(walk, statement));
            }
            _ => walk_statement(self, statement),
        }
    }
}
