//! Where a loop variable without a range is used as a subscript (MLS §11.2.2.1).

use crate::name::Ident;
use crate::syntax::ast::{
    ComponentReference, Expression, ExpressionKind, ReferencePart, Statement, StatementKind,
    Subscript,
};

/// `array[…, i, …]` with `i` as subscript number `dimension`, counted from 0.
pub(super) struct SubscriptUse {
    pub(super) array: ComponentReference,
    pub(super) dimension: usize,
}

/// What a deduced range is looked for in.
#[derive(Clone, Copy)]
pub(super) enum Body<'b> {
    /// Of a loop.
    Statements(&'b [Statement]),
    /// Of an array constructor with iterators.
    Expression(&'b Expression),
}

/// All subscripts that are exactly the variable `name`.
pub(super) fn subscript_uses(name: Ident, body: Body<'_>) -> Vec<SubscriptUse> {
    let mut search = SubscriptSearch { name, found: Vec::new() };
    match body {
        Body::Statements(statements) => search.statements(statements),
        Body::Expression(expression) => search.expression(expression),
    }
    search.found
}

struct SubscriptSearch {
    name: Ident,
    found: Vec<SubscriptUse>,
}

impl SubscriptSearch {
    fn statements(&mut self, statements: &[Statement]) {
        for statement in statements {
            self.statement(statement);
        }
    }

    fn statement(&mut self, statement: &Statement) {
        match &statement.kind {
            StatementKind::Assign { target, value } => {
                self.reference(target);
                self.expression(value);
            }
            StatementKind::MultiAssign { targets, value } => {
                targets.iter().flatten().for_each(|target| self.reference(target));
                self.expression(value);
            }
            StatementKind::Call(call) => self.expression(call),
            StatementKind::If { branches, otherwise } => {
                self.branches(branches);
                self.statements(otherwise);
            }
            StatementKind::For { indices, body } => {
                indices.iter().filter_map(|i| i.range.as_ref()).for_each(|r| self.expression(r));
                self.statements(body);
            }
            StatementKind::While { condition, body } => {
                self.expression(condition);
                self.statements(body);
            }
            StatementKind::When { branches } => self.branches(branches),
            StatementKind::Break | StatementKind::Return => {}
        }
    }

    fn branches(&mut self, branches: &[(Expression, Vec<Statement>)]) {
        for (condition, statements) in branches {
            self.expression(condition);
            self.statements(statements);
        }
    }

    fn expressions<'e>(&mut self, expressions: impl IntoIterator<Item = &'e Expression>) {
        expressions.into_iter().for_each(|expression| self.expression(expression));
    }

    fn expression(&mut self, expression: &Expression) {
        match &expression.kind {
            ExpressionKind::Reference(reference) => self.reference(reference),
            ExpressionKind::Call { arguments, .. } => {
                self.expressions(&arguments.positional);
                self.expressions(arguments.named.iter().map(|named| &named.value));
                self.expressions(arguments.iterators.iter().filter_map(|i| i.range.as_ref()));
            }
            ExpressionKind::Guarded { condition, values, .. } => {
                self.expression(condition);
                self.expression(values);
            }
            ExpressionKind::PartialApplication { named, .. } => {
                self.expressions(named.iter().map(|named| &named.value));
            }
            ExpressionKind::Unary { operand, .. } => self.expression(operand),
            ExpressionKind::Binary { .. } => self.expressions(expression.operands()),
            ExpressionKind::If { branches, otherwise } => {
                for (condition, value) in branches {
                    self.expression(condition);
                    self.expression(value);
                }
                self.expression(otherwise);
            }
            ExpressionKind::Range { start, step, stop } => {
                self.expression(start);
                self.expressions(step.as_deref());
                self.expression(stop);
            }
            ExpressionKind::Array(elements) => self.expressions(elements),
            ExpressionKind::ArrayIteration { element, indices } => {
                self.expression(element);
                self.expressions(indices.iter().filter_map(|i| i.range.as_ref()));
            }
            ExpressionKind::Matrix(rows) => self.expressions(rows.iter().flatten()),
            ExpressionKind::Tuple(elements) => self.expressions(elements.iter().flatten()),
            ExpressionKind::Subscripted { base, subscripts } => {
                self.expression(base);
                self.subscripts(subscripts);
            }
            ExpressionKind::Field { base, .. } => self.expression(base),
            ExpressionKind::Real(_)
            | ExpressionKind::Integer(_)
            | ExpressionKind::Boolean(_)
            | ExpressionKind::String(_)
            | ExpressionKind::TypeName(_)
            | ExpressionKind::Code(_)
            | ExpressionKind::End => {}
        }
    }

    fn subscripts(&mut self, subscripts: &[Subscript]) {
        for subscript in subscripts {
            if let Subscript::Index(expression) = subscript {
                self.expression(expression);
            }
        }
    }

    fn reference(&mut self, reference: &ComponentReference) {
        for (at, part) in reference.parts.iter().enumerate() {
            for (dimension, subscript) in part.subscripts.iter().enumerate() {
                if self.is_variable(subscript) {
                    let array = up_to(reference, at);
                    self.found.push(SubscriptUse { array, dimension });
                }
            }
            self.subscripts(&part.subscripts);
        }
    }

    fn is_variable(&self, subscript: &Subscript) -> bool {
        match subscript {
            Subscript::Index(Expression { kind: ExpressionKind::Reference(reference), .. }) => {
                reference.as_ident() == Some(self.name)
            }
            _ => false,
        }
    }
}

/// `a[1].b` of `a[1].b[i].c` for the part `b`.
fn up_to(reference: &ComponentReference, part: usize) -> ComponentReference {
    let mut parts = reference.parts[..=part].to_vec();
    if let Some(last) = parts.last_mut() {
        *last = ReferencePart { name: last.name, subscripts: Vec::new() };
    }
    ComponentReference { global: reference.global, parts, span: reference.span }
}
