//! The read-only walk over expressions, statements and equations.

use crate::syntax::ast::{
    Argument, Arguments, Binding, ComponentReference, Equation, EquationKind, Expression,
    ExpressionKind, ForIndex, Modification, RedeclaredElement, Statement, StatementKind, Subscript,
};

/// Reads a tree. Comments and annotations are not visited.
pub trait Visit {
    /// An expression, before its parts; of a chain of operations the whole, and then the operands.
    fn expression(&mut self, expression: &Expression) {
        walk_expression(self, expression);
    }

    /// A component reference: in an expression, a called function's name, a left side, a
    /// `connect`.
    fn reference(&mut self, reference: &ComponentReference) {
        walk_reference(self, reference);
    }

    /// A statement, before its parts.
    fn statement(&mut self, statement: &Statement) {
        walk_statement(self, statement);
    }

    /// An equation, before its parts.
    fn equation(&mut self, equation: &Equation) {
        walk_equation(self, equation);
    }
}

/// Visits the parts of an expression.
pub fn walk_expression<V: Visit + ?Sized>(visitor: &mut V, expression: &Expression) {
    match &expression.kind {
        ExpressionKind::Real(_)
        | ExpressionKind::Integer(_)
        | ExpressionKind::Boolean(_)
        | ExpressionKind::String(_)
        | ExpressionKind::TypeName(_)
        | ExpressionKind::Code(_)
        | ExpressionKind::End => {}
        ExpressionKind::Reference(reference) => visitor.reference(reference),
        ExpressionKind::Call { function, arguments } => {
            visitor.reference(function);
            walk_call_arguments(visitor, arguments);
        }
        ExpressionKind::PartialApplication { named, .. } => {
            named.iter().for_each(|argument| visitor.expression(&argument.value));
        }
        ExpressionKind::Unary { operand, .. } => visitor.expression(operand),
        ExpressionKind::Binary { .. } => {
            expression.operands().for_each(|operand| visitor.expression(operand));
        }
        ExpressionKind::If { branches, otherwise } => {
            for (condition, value) in branches {
                visitor.expression(condition);
                visitor.expression(value);
            }
            visitor.expression(otherwise);
        }
        ExpressionKind::Range { start, step, stop } => {
            visitor.expression(start);
            step.iter().for_each(|step| visitor.expression(step));
            visitor.expression(stop);
        }
        ExpressionKind::Guarded { condition, values, .. } => {
            visitor.expression(condition);
            visitor.expression(values);
        }
        ExpressionKind::Array(elements) => {
            elements.iter().for_each(|element| visitor.expression(element));
        }
        ExpressionKind::ArrayIteration { element, indices } => {
            visitor.expression(element);
            walk_indices(visitor, indices);
        }
        ExpressionKind::Matrix(rows) => {
            rows.iter().flatten().for_each(|element| visitor.expression(element));
        }
        ExpressionKind::Tuple(outputs) => {
            outputs.iter().flatten().for_each(|output| visitor.expression(output));
        }
        ExpressionKind::Subscripted { base, subscripts } => {
            visitor.expression(base);
            walk_subscripts(visitor, subscripts);
        }
        ExpressionKind::Field { base, .. } => visitor.expression(base),
    }
}

fn walk_call_arguments<V: Visit + ?Sized>(visitor: &mut V, arguments: &Arguments) {
    arguments.positional.iter().for_each(|argument| visitor.expression(argument));
    arguments.named.iter().for_each(|argument| visitor.expression(&argument.value));
    walk_indices(visitor, &arguments.iterators);
}

fn walk_indices<V: Visit + ?Sized>(visitor: &mut V, indices: &[ForIndex]) {
    indices.iter().flat_map(|index| &index.range).for_each(|range| visitor.expression(range));
}

fn walk_subscripts<V: Visit + ?Sized>(visitor: &mut V, subscripts: &[Subscript]) {
    for subscript in subscripts {
        if let Subscript::Index(index) = subscript {
            visitor.expression(index);
        }
    }
}

/// Visits the subscripts of a reference.
pub fn walk_reference<V: Visit + ?Sized>(visitor: &mut V, reference: &ComponentReference) {
    reference.parts.iter().for_each(|part| walk_subscripts(visitor, &part.subscripts));
}

/// Visits the expressions of a modification, those of its redeclarations included.
pub fn walk_modification<V: Visit + ?Sized>(visitor: &mut V, modification: &Modification) {
    walk_arguments(visitor, &modification.arguments);
    if let Some(Binding::Expression(value)) = &modification.binding {
        visitor.expression(value);
    }
}

/// Visits the expressions of modification arguments, those of redeclared components included;
/// not those of redeclared classes.
pub(crate) fn walk_arguments<V: Visit + ?Sized>(visitor: &mut V, arguments: &[Argument]) {
    for argument in arguments {
        match argument {
            Argument::Element(element) => {
                element.modification.iter().for_each(|one| walk_modification(visitor, one));
            }
            Argument::Redeclaration(redeclaration) => {
                let RedeclaredElement::Component(clause) = &redeclaration.element else { continue };
                walk_subscripts(visitor, &clause.subscripts);
                for component in &clause.components {
                    walk_subscripts(visitor, &component.subscripts);
                    component.modification.iter().for_each(|one| walk_modification(visitor, one));
                    component.condition.iter().for_each(|one| visitor.expression(one));
                }
            }
        }
    }
}

/// Visits the parts of a statement.
pub fn walk_statement<V: Visit + ?Sized>(visitor: &mut V, statement: &Statement) {
    match &statement.kind {
        StatementKind::Assign { target, value } => {
            visitor.reference(target);
            visitor.expression(value);
        }
        StatementKind::MultiAssign { targets, value } => {
            targets.iter().flatten().for_each(|target| visitor.reference(target));
            visitor.expression(value);
        }
        StatementKind::Call(call) => visitor.expression(call),
        StatementKind::If { branches, otherwise } => {
            walk_branches(visitor, branches);
            otherwise.iter().for_each(|one| visitor.statement(one));
        }
        StatementKind::For { indices, body } => {
            walk_indices(visitor, indices);
            body.iter().for_each(|one| visitor.statement(one));
        }
        StatementKind::While { condition, body } => {
            visitor.expression(condition);
            body.iter().for_each(|one| visitor.statement(one));
        }
        StatementKind::When { branches } => walk_branches(visitor, branches),
        StatementKind::Break | StatementKind::Return => {}
    }
}

fn walk_branches<V: Visit + ?Sized>(visitor: &mut V, branches: &[(Expression, Vec<Statement>)]) {
    for (condition, body) in branches {
        visitor.expression(condition);
        body.iter().for_each(|one| visitor.statement(one));
    }
}

/// Visits the parts of an equation.
pub fn walk_equation<V: Visit + ?Sized>(visitor: &mut V, equation: &Equation) {
    match &equation.kind {
        EquationKind::Equal { left, right } => {
            visitor.expression(left);
            visitor.expression(right);
        }
        EquationKind::If { branches, otherwise } => {
            walk_equation_branches(visitor, branches);
            otherwise.iter().for_each(|one| visitor.equation(one));
        }
        EquationKind::For { indices, body } => {
            walk_indices(visitor, indices);
            body.iter().for_each(|one| visitor.equation(one));
        }
        EquationKind::Connect { left, right } => {
            visitor.reference(left);
            visitor.reference(right);
        }
        EquationKind::When { branches } => walk_equation_branches(visitor, branches),
        EquationKind::Call(call) => visitor.expression(call),
    }
}

fn walk_equation_branches<V: Visit + ?Sized>(
    visitor: &mut V,
    branches: &[(Expression, Vec<Equation>)],
) {
    for (condition, body) in branches {
        visitor.expression(condition);
        body.iter().for_each(|one| visitor.equation(one));
    }
}
