//! The rewriting walk over whole trees.

use crate::source::Span;
use crate::syntax::ast::{
    Annotation, Argument, Arguments, Binding, ClassDefinition, ClassElement, ClassSpecifier,
    Comment, ComponentClause, ComponentDeclaration, ComponentReference, Constraint, Element,
    Equation, EquationKind, Exclusion, Expression, ExpressionKind, ForIndex, InteractiveKind,
    LongClass, Modification, NamedArgument, RedeclaredElement, Script, Section, Statement,
    StatementKind, StoredDefinition, Subscript,
};
use std::sync::Arc;

/// Changes a tree in place.
pub trait Rewrite {
    /// An expression.
    fn expression(&mut self, expression: &mut Expression) {
        rewrite_expression(self, expression);
    }

    /// A component reference: in an expression, a called function's name, a left side, a
    /// `connect`.
    fn reference(&mut self, reference: &mut ComponentReference) {
        rewrite_reference(self, reference);
    }

    /// A statement.
    fn statement(&mut self, statement: &mut Statement) {
        rewrite_statement(self, statement);
    }

    /// An equation.
    fn equation(&mut self, equation: &mut Equation) {
        rewrite_equation(self, equation);
    }

    /// A place: of every node that has one.
    fn span(&mut self, _span: &mut Span) {}
}

/// Rewrites the parts of an expression.
pub fn rewrite_expression<R: Rewrite + ?Sized>(rewriter: &mut R, expression: &mut Expression) {
    let (first, operations) = expression.chain_mut();
    if operations.is_empty() {
        return rewrite_operand(rewriter, first);
    }
    rewriter.expression(first);
    for one in operations {
        rewriter.expression(one.right);
        rewriter.span(one.span);
    }
}

fn rewrite_operand<R: Rewrite + ?Sized>(rewriter: &mut R, expression: &mut Expression) {
    rewriter.span(&mut expression.span);
    match &mut expression.kind {
        ExpressionKind::Real(_)
        | ExpressionKind::Integer(_)
        | ExpressionKind::Boolean(_)
        | ExpressionKind::String(_)
        | ExpressionKind::TypeName(_)
        | ExpressionKind::Code(_)
        | ExpressionKind::End
        | ExpressionKind::Binary { .. } => {}
        ExpressionKind::Reference(reference) => rewriter.reference(reference),
        ExpressionKind::Call { function, arguments } => {
            rewriter.reference(function);
            call_arguments(rewriter, arguments);
        }
        ExpressionKind::PartialApplication { named, .. } => named_arguments(rewriter, named),
        ExpressionKind::Unary { operand, .. } => rewriter.expression(operand),
        ExpressionKind::If { branches, otherwise } => {
            for (condition, value) in branches {
                rewriter.expression(condition);
                rewriter.expression(value);
            }
            rewriter.expression(otherwise);
        }
        ExpressionKind::Range { start, step, stop } => {
            rewriter.expression(start);
            step.iter_mut().for_each(|step| rewriter.expression(step));
            rewriter.expression(stop);
        }
        ExpressionKind::Guarded { condition, values, .. } => {
            rewriter.expression(condition);
            rewriter.expression(values);
        }
        ExpressionKind::Array(elements) => expressions(rewriter, elements),
        ExpressionKind::ArrayIteration { element, indices } => {
            rewriter.expression(element);
            for_indices(rewriter, indices);
        }
        ExpressionKind::Matrix(rows) => {
            rows.iter_mut().for_each(|row| expressions(rewriter, row));
        }
        ExpressionKind::Tuple(outputs) => {
            outputs.iter_mut().flatten().for_each(|output| rewriter.expression(output));
        }
        ExpressionKind::Subscripted { base, subscripts: list } => {
            rewriter.expression(base);
            subscripts(rewriter, list);
        }
        ExpressionKind::Field { base, .. } => rewriter.expression(Arc::make_mut(base)),
    }
}

fn expressions<R: Rewrite + ?Sized>(rewriter: &mut R, all: &mut [Expression]) {
    all.iter_mut().for_each(|one| rewriter.expression(one));
}

fn call_arguments<R: Rewrite + ?Sized>(rewriter: &mut R, arguments: &mut Arguments) {
    expressions(rewriter, &mut arguments.positional);
    named_arguments(rewriter, &mut arguments.named);
    for_indices(rewriter, &mut arguments.iterators);
}

fn named_arguments<R: Rewrite + ?Sized>(rewriter: &mut R, named: &mut [NamedArgument]) {
    for argument in named {
        rewriter.span(&mut argument.name.span);
        rewriter.expression(&mut argument.value);
    }
}

fn for_indices<R: Rewrite + ?Sized>(rewriter: &mut R, indices: &mut [ForIndex]) {
    for index in indices {
        rewriter.span(&mut index.name.span);
        index.range.iter_mut().for_each(|range| rewriter.expression(range));
    }
}

fn subscripts<R: Rewrite + ?Sized>(rewriter: &mut R, all: &mut [Subscript]) {
    for subscript in all {
        match subscript {
            Subscript::All(span) => rewriter.span(span),
            Subscript::Index(index) => rewriter.expression(index),
        }
    }
}

/// Rewrites the subscripts of a reference.
pub fn rewrite_reference<R: Rewrite + ?Sized>(
    rewriter: &mut R,
    reference: &mut ComponentReference,
) {
    rewriter.span(&mut reference.span);
    reference.parts.iter_mut().for_each(|part| subscripts(rewriter, &mut part.subscripts));
}

/// Rewrites the parts of a statement.
pub fn rewrite_statement<R: Rewrite + ?Sized>(rewriter: &mut R, statement: &mut Statement) {
    rewriter.span(&mut statement.span);
    match &mut statement.kind {
        StatementKind::Assign { target, value } => {
            rewriter.reference(target);
            rewriter.expression(value);
        }
        StatementKind::MultiAssign { targets, value } => {
            targets.iter_mut().flatten().for_each(|target| rewriter.reference(target));
            rewriter.expression(value);
        }
        StatementKind::Call(call) => rewriter.expression(call),
        StatementKind::If { branches, otherwise } => {
            statement_branches(rewriter, branches);
            statements(rewriter, otherwise);
        }
        StatementKind::For { indices, body } => {
            for_indices(rewriter, indices);
            statements(rewriter, body);
        }
        StatementKind::While { condition, body } => {
            rewriter.expression(condition);
            statements(rewriter, body);
        }
        StatementKind::When { branches } => statement_branches(rewriter, branches),
        StatementKind::Break | StatementKind::Return => {}
    }
    comment(rewriter, &mut statement.comment);
}

fn statements<R: Rewrite + ?Sized>(rewriter: &mut R, all: &mut [Statement]) {
    all.iter_mut().for_each(|one| rewriter.statement(one));
}

fn statement_branches<R: Rewrite + ?Sized>(
    rewriter: &mut R,
    branches: &mut [(Expression, Vec<Statement>)],
) {
    for (condition, body) in branches {
        rewriter.expression(condition);
        statements(rewriter, body);
    }
}

/// Rewrites the parts of an equation.
pub fn rewrite_equation<R: Rewrite + ?Sized>(rewriter: &mut R, equation: &mut Equation) {
    rewriter.span(&mut equation.span);
    match &mut equation.kind {
        EquationKind::Equal { left, right } => {
            rewriter.expression(left);
            rewriter.expression(right);
        }
        EquationKind::If { branches, otherwise } => {
            equation_branches(rewriter, branches);
            equations(rewriter, otherwise);
        }
        EquationKind::For { indices, body } => {
            for_indices(rewriter, indices);
            equations(rewriter, body);
        }
        EquationKind::Connect { left, right } => {
            rewriter.reference(left);
            rewriter.reference(right);
        }
        EquationKind::When { branches } => equation_branches(rewriter, branches),
        EquationKind::Call(call) => rewriter.expression(call),
    }
    comment(rewriter, &mut equation.comment);
}

fn equations<R: Rewrite + ?Sized>(rewriter: &mut R, all: &mut [Equation]) {
    all.iter_mut().for_each(|one| rewriter.equation(one));
}

fn equation_branches<R: Rewrite + ?Sized>(
    rewriter: &mut R,
    branches: &mut [(Expression, Vec<Equation>)],
) {
    for (condition, body) in branches {
        rewriter.expression(condition);
        equations(rewriter, body);
    }
}

/// Rewrites a modification.
pub(crate) fn rewrite_modification<R: Rewrite + ?Sized>(
    rewriter: &mut R,
    modification: &mut Modification,
) {
    rewriter.span(&mut modification.span);
    rewrite_arguments(rewriter, &mut modification.arguments);
    match &mut modification.binding {
        Some(Binding::Expression(value)) => rewriter.expression(value),
        Some(Binding::Break(span)) => rewriter.span(span),
        None => {}
    }
}

/// Rewrites the arguments of a modification.
pub(crate) fn rewrite_arguments<R: Rewrite + ?Sized>(rewriter: &mut R, arguments: &mut [Argument]) {
    for argument in arguments {
        match argument {
            Argument::Element(element) => {
                rewriter.span(&mut element.span);
                rewriter.span(&mut element.name.span);
                element.modification.iter_mut().for_each(|one| rewrite_modification(rewriter, one));
            }
            Argument::Redeclaration(redeclaration) => {
                rewriter.span(&mut redeclaration.span);
                match &mut redeclaration.element {
                    RedeclaredElement::Class(class) => class_element(rewriter, class),
                    RedeclaredElement::Component(clause) => component_clause(rewriter, clause),
                }
            }
        }
    }
}

fn comment<R: Rewrite + ?Sized>(rewriter: &mut R, comment: &mut Comment) {
    comment.annotation.iter_mut().for_each(|one| annotation(rewriter, one));
}

fn annotation<R: Rewrite + ?Sized>(rewriter: &mut R, annotation: &mut Annotation) {
    rewriter.span(&mut annotation.span);
    rewrite_arguments(rewriter, &mut annotation.arguments);
}

fn component_clause<R: Rewrite + ?Sized>(rewriter: &mut R, clause: &mut ComponentClause) {
    rewriter.span(&mut clause.span);
    rewriter.span(&mut clause.type_specifier.span);
    subscripts(rewriter, &mut clause.subscripts);
    clause.components.iter_mut().for_each(|one| component(rewriter, one));
    clause.constraint.iter_mut().for_each(|one| constraint(rewriter, one));
}

fn component<R: Rewrite + ?Sized>(rewriter: &mut R, component: &mut ComponentDeclaration) {
    rewriter.span(&mut component.span);
    rewriter.span(&mut component.name.span);
    subscripts(rewriter, &mut component.subscripts);
    component.modification.iter_mut().for_each(|one| rewrite_modification(rewriter, one));
    component.condition.iter_mut().for_each(|one| rewriter.expression(one));
    comment(rewriter, &mut component.comment);
}

fn constraint<R: Rewrite + ?Sized>(rewriter: &mut R, constraint: &mut Constraint) {
    rewriter.span(&mut constraint.span);
    rewriter.span(&mut constraint.target.span);
    rewrite_arguments(rewriter, &mut constraint.modification);
    comment(rewriter, &mut constraint.comment);
}

fn class_element<R: Rewrite + ?Sized>(rewriter: &mut R, element: &mut ClassElement) {
    rewrite_class(rewriter, Arc::make_mut(&mut element.class));
    element.constraint.iter_mut().for_each(|one| constraint(rewriter, one));
}

/// Rewrites a class and everything in it.
pub fn rewrite_class<R: Rewrite + ?Sized>(rewriter: &mut R, class: &mut ClassDefinition) {
    rewriter.span(&mut class.span);
    rewriter.span(&mut class.name.span);
    match &mut class.specifier {
        ClassSpecifier::Long(long) => long_class(rewriter, long),
        ClassSpecifier::Short(short) => {
            rewriter.span(&mut short.target.span);
            subscripts(rewriter, &mut short.subscripts);
            rewrite_arguments(rewriter, &mut short.modification);
            comment(rewriter, &mut short.comment);
        }
        ClassSpecifier::Enumeration(enumeration) => {
            for literal in enumeration.literals.iter_mut().flatten() {
                rewriter.span(&mut literal.name.span);
                comment(rewriter, &mut literal.comment);
            }
            comment(rewriter, &mut enumeration.comment);
        }
        ClassSpecifier::Derivative(derivative) => {
            rewriter.span(&mut derivative.target.span);
            derivative.variables.iter_mut().for_each(|variable| rewriter.span(&mut variable.span));
            comment(rewriter, &mut derivative.comment);
        }
    }
}

fn long_class<R: Rewrite + ?Sized>(rewriter: &mut R, class: &mut LongClass) {
    class.class_extends.iter_mut().for_each(|arguments| rewrite_arguments(rewriter, arguments));
    class.sections.iter_mut().for_each(|one| section(rewriter, one));
    rewriter.span(&mut class.end_name.span);
}

fn section<R: Rewrite + ?Sized>(rewriter: &mut R, section: &mut Section) {
    match section {
        Section::Elements { elements, .. } => {
            elements.iter_mut().for_each(|one| element(rewriter, one));
        }
        Section::Equations { equations: all, span, .. } => {
            rewriter.span(span);
            equations(rewriter, all);
        }
        Section::Algorithm { statements: all, span, .. } => {
            rewriter.span(span);
            statements(rewriter, all);
        }
        Section::External(external) => {
            rewriter.span(&mut external.span);
            external.output.iter_mut().for_each(|output| rewriter.reference(output));
            external.function.iter_mut().for_each(|function| rewriter.span(&mut function.span));
            expressions(rewriter, &mut external.arguments);
            external.annotation.iter_mut().for_each(|one| annotation(rewriter, one));
        }
        Section::Annotation(one) => annotation(rewriter, one),
    }
}

fn element<R: Rewrite + ?Sized>(rewriter: &mut R, element: &mut Element) {
    match element {
        Element::Import(import) => {
            rewriter.span(&mut import.span);
            comment(rewriter, &mut import.comment);
        }
        Element::Extends(extends) => {
            rewriter.span(&mut extends.span);
            rewriter.span(&mut extends.base.span);
            rewrite_arguments(rewriter, &mut extends.modification);
            extends.excluded.iter_mut().for_each(|one| exclusion(rewriter, one));
            extends.annotation.iter_mut().for_each(|one| annotation(rewriter, one));
        }
        Element::Class(class) => class_element(rewriter, class),
        Element::Component(clause) => component_clause(rewriter, clause),
    }
}

fn exclusion<R: Rewrite + ?Sized>(rewriter: &mut R, exclusion: &mut Exclusion) {
    match exclusion {
        Exclusion::Component(name) => rewriter.span(&mut name.span),
        Exclusion::Connection(left, right) => {
            rewriter.reference(left);
            rewriter.reference(right);
        }
    }
}

/// Rewrites a file and everything in it.
pub fn rewrite_stored_definition<R: Rewrite + ?Sized>(
    rewriter: &mut R,
    definition: &mut StoredDefinition,
) {
    rewriter.span(&mut definition.span);
    definition.within.iter_mut().for_each(|within| rewriter.span(&mut within.span));
    definition.classes.iter_mut().for_each(|class| rewrite_class(rewriter, Arc::make_mut(class)));
}

/// Rewrites a script and everything in it.
pub fn rewrite_script<R: Rewrite + ?Sized>(rewriter: &mut R, script: &mut Script) {
    rewriter.span(&mut script.span);
    for one in &mut script.statements {
        rewriter.span(&mut one.span);
        match &mut one.kind {
            InteractiveKind::Statement(statement) => rewriter.statement(statement),
            InteractiveKind::Expression(expression) => rewriter.expression(expression),
            InteractiveKind::Declaration(clause) => component_clause(rewriter, clause),
            InteractiveKind::Class(class) => rewrite_class(rewriter, Arc::make_mut(class)),
            InteractiveKind::Import(import) => {
                rewriter.span(&mut import.span);
                comment(rewriter, &mut import.comment);
            }
            InteractiveKind::Command { name, argument } => {
                rewriter.span(&mut name.span);
                rewriter.span(&mut argument.span);
            }
        }
    }
}
