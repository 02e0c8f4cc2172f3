//! Resolves the names in expressions: components become their flat paths, constants of packages
//! their values, functions their full names (MLS §5.3, §5.6.2).

use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::{
    CONDITIONAL_COMPONENT, NOT_CONSTANT, NOT_SUPPORTED, SIZE_MISMATCH, TOO_LARGE,
};
use crate::flatten::expressions::array_iterations::is_sum_of_nothing;
use crate::flatten::expressions::local::Local;
use crate::flatten::flat_expression::{call, subscripted};
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::lookup::classes::Classes;
use crate::flatten::unknown;
use crate::inference::is_arithmetic;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    BinaryOperator, ComponentReference, Expression, ExpressionKind, NamedArgument, ReferencePart,
    Subscript, UnaryOperator,
};
use crate::value::Value;
use std::sync::Arc;

/// The deepest nesting of expressions, bindings that lead to one another included.
const MAX_DEPTH: usize = 400;

impl Instantiation<'_> {
    /// The expression with its names resolved.
    pub(crate) fn resolve(
        &mut self,
        e: &Expression,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        if self.depth >= MAX_DEPTH {
            return Err(fault!(TOO_LARGE, "expressions are nested too deeply").at(e.span));
        }
        self.depth += 1;
        let resolved = self.resolve_kind(e, context, local);
        self.depth -= 1;
        resolved
    }

    fn resolve_kind(
        &mut self,
        e: &Expression,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let sub = |this: &mut Self, inner: &Expression| this.resolve(inner, context, local);
        let kind = match &e.kind {
            ExpressionKind::Real(_)
            | ExpressionKind::Integer(_)
            | ExpressionKind::Boolean(_)
            | ExpressionKind::String(_)
            | ExpressionKind::TypeName(_)
            | ExpressionKind::Code(_)
            | ExpressionKind::End => e.kind.clone(),
            ExpressionKind::Reference(reference) => {
                return self.reference(reference, context, local);
            }
            ExpressionKind::Call { function, arguments } => {
                return self.call(e.span, function, arguments, context, local);
            }
            ExpressionKind::PartialApplication { function, named } => {
                let function = self.function_name(function, context, e.span)?;
                let named = self.named_arguments(named, context, local)?;
                ExpressionKind::PartialApplication { function, named }
            }
            ExpressionKind::Unary { operator, operand } => {
                let operand = sub(self, operand)?;
                return self.unary(*operator, operand, local, e.span);
            }
            ExpressionKind::Binary { .. } => return self.chain(e, context, local),
            ExpressionKind::If { branches, otherwise } => {
                return self.if_expression(e.span, branches, otherwise, context, local);
            }
            ExpressionKind::Range { start, step: None, stop }
                if is_boolean(start) && is_boolean(stop) =>
            {
                return Ok(booleans(start, stop));
            }
            ExpressionKind::Range { start, step, stop } => ExpressionKind::Range {
                start: Box::new(sub(self, start)?),
                step: step.as_ref().map(|step| sub(self, step).map(Box::new)).transpose()?,
                stop: Box::new(sub(self, stop)?),
            },
            ExpressionKind::Guarded { .. } => {
                let message = "`guard` is supported only in scripts";
                return Err(fault!(NOT_SUPPORTED, "{message}").at(e.span));
            }
            ExpressionKind::Array(elements) => {
                ExpressionKind::Array(self.all(elements, context, local)?)
            }
            ExpressionKind::ArrayIteration { element, indices } => {
                return self.array_iteration(element, indices, e.span, context, local);
            }
            ExpressionKind::Matrix(rows) => ExpressionKind::Matrix(
                rows.iter()
                    .map(|row| self.all(row, context, local))
                    .collect::<Result<_, Diagnostic>>()?,
            ),
            ExpressionKind::Tuple(parts) => ExpressionKind::Tuple(
                parts
                    .iter()
                    .map(|part| part.as_ref().map(|part| sub(self, part)).transpose())
                    .collect::<Result<_, Diagnostic>>()?,
            ),
            ExpressionKind::Subscripted { base, subscripts } => {
                let base = sub(self, base)?;
                let subscripts = self.subscripts(subscripts, context, local)?;
                return Ok(subscripted(base, subscripts, e.span));
            }
            ExpressionKind::Field { base, name } => {
                return self.field_of(base, *name, e.span, context, local);
            }
        };
        Ok(Expression::new(kind, e.span))
    }

    /// The operation, or the call of the function that a record overloads the operator with.
    fn unary(
        &mut self,
        operator: UnaryOperator,
        operand: Expression,
        local: &Local,
        span: Span,
    ) -> Result<Expression, Diagnostic> {
        let sign = match operator {
            UnaryOperator::Minus | UnaryOperator::ElementwiseMinus => "'-'",
            UnaryOperator::Not => "'not'",
            UnaryOperator::Plus | UnaryOperator::ElementwisePlus => "'+'",
        };
        if let Some(call) = self.overloaded_unary(sign, &operand, local, span)? {
            return Ok(call);
        }
        let kind = ExpressionKind::Unary { operator, operand: Box::new(operand) };
        Ok(Expression::new(kind, span))
    }

    /// A chain of operations is not deeper than its operands.
    fn chain(
        &mut self,
        e: &Expression,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let (first, operations) = e.chain();
        let mut resolved = self.resolve(first, context, local)?;
        for one in operations {
            let right = self.resolve(one.right, context, local)?;
            resolved = self.binary(one.operator, (resolved, right), local, one.whole.span)?;
        }
        Ok(resolved)
    }

    fn binary(
        &mut self,
        operator: BinaryOperator,
        (left, right): (Expression, Expression),
        local: &Local,
        span: Span,
    ) -> Result<Expression, Diagnostic> {
        let call = self.overloaded_binary(operator, &left, &right, local, span)?;
        if let Some(call) = call {
            return Ok(call);
        }
        let [left, right] = match is_arithmetic(operator) {
            true => [left, right].map(|side| self.types().number_of_enumeration(side, local)),
            false => [left, right],
        };
        Ok(match operator {
            BinaryOperator::Add | BinaryOperator::Subtract if is_sum_of_nothing(&right) => left,
            BinaryOperator::Add if is_sum_of_nothing(&left) => right,
            _ => Expression::operation(operator, left, right, span),
        })
    }

    /// Branches whose conditions hold no variables are chosen at once: the others may name what
    /// does not exist, such as the element before the first one.
    fn if_expression(
        &mut self,
        span: Span,
        branches: &[(Expression, Expression)],
        otherwise: &Expression,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let mut resolved = Vec::with_capacity(branches.len());
        for (condition, value) in branches {
            let condition = self.resolve(condition, context, local)?;
            match self.literal_condition(&condition) {
                Some(true) if resolved.is_empty() => return self.resolve(value, context, local),
                Some(false) => continue,
                _ => {}
            }
            match self.resolve(value, context, local) {
                Ok(value) => resolved.push((condition, value)),
                Err(error) if !self.may_be_left_out(&error) => return Err(error),
                Err(error) if self.known_condition(&condition, local) == Some(false) => {
                    self.warn_of_absent(error);
                }
                Err(error) => return self.up_to_taken(resolved, error, span, local),
            }
        }
        let otherwise = match self.resolve(otherwise, context, local) {
            Ok(otherwise) => otherwise,
            Err(error) if !self.may_be_left_out(&error) => return Err(error),
            Err(error) => return self.up_to_taken(resolved, error, span, local),
        };
        if resolved.is_empty() {
            return Ok(otherwise);
        }
        let kind = ExpressionKind::If { branches: resolved, otherwise: Box::new(otherwise) };
        Ok(Expression::new(kind, span))
    }

    /// Whether an error in a branch counts only if the branch is taken: an element beyond the end of an
    /// array, or a conditional component that is absent.
    fn may_be_left_out(&self, error: &Diagnostic) -> bool {
        let is_absent = error.code == CONDITIONAL_COMPONENT;
        error.code == SIZE_MISMATCH || is_absent && !self.classes.library.is_strict()
    }

    /// Conditional components belong into connections only (MLS §4.4.5).
    fn warn_of_absent(&mut self, error: Diagnostic) {
        if error.code == CONDITIONAL_COMPONENT {
            let help = "only `connect` equations may name it: parameters exclude this branch, which \
                        is left out";
            self.warnings.add_once(error.help(help));
        }
    }

    /// An if-expression whose later branches name what does not exist, up to the branch whose
    /// condition parameters make true: the element of an empty array is not an error where it is
    /// not read. The parameters cannot be set any more.
    ///
    /// # Errors
    /// Parameters do not choose a branch.
    fn up_to_taken(
        &mut self,
        mut branches: Vec<(Expression, Expression)>,
        error: Diagnostic,
        span: Span,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let is_taken = |(condition, _): &_| self.known_condition(condition, local) == Some(true);
        let Some(taken) = branches.iter().position(is_taken) else { return Err(error) };
        self.warn_of_absent(error);
        let (_, otherwise) = branches.swap_remove(taken);
        branches.truncate(taken);
        if branches.is_empty() {
            return Ok(otherwise);
        }
        let kind = ExpressionKind::If { branches, otherwise: Box::new(otherwise) };
        Ok(Expression::new(kind, span))
    }

    /// The value that constants and parameters give a resolved condition.
    fn known_condition(&mut self, condition: &Expression, local: &Local) -> Option<bool> {
        if local.is_open_in(condition) {
            return None;
        }
        match self.flat_value(condition) {
            Ok(Value::Boolean(truth)) => Some(truth),
            _ => None,
        }
    }

    /// The value of a resolved condition without references.
    fn literal_condition(&mut self, condition: &Expression) -> Option<bool> {
        if let ExpressionKind::Boolean(truth) = condition.kind {
            return Some(truth);
        }
        if !crate::flatten::types::has_only_literals(condition) {
            return None;
        }
        match self.flat_value(condition) {
            Ok(Value::Boolean(truth)) => Some(truth),
            _ => None,
        }
    }

    pub(crate) fn all(
        &mut self,
        expressions: &[Expression],
        context: ScopeId,
        local: &Local,
    ) -> Result<Vec<Expression>, Diagnostic> {
        expressions.iter().map(|e| self.resolve(e, context, local)).collect()
    }

    pub(crate) fn named_arguments(
        &mut self,
        named: &[NamedArgument],
        context: ScopeId,
        local: &Local,
    ) -> Result<Vec<NamedArgument>, Diagnostic> {
        named
            .iter()
            .map(|argument| {
                let value = self.resolve(&argument.value, context, local)?;
                Ok(NamedArgument { name: argument.name, value })
            })
            .collect()
    }

    pub(crate) fn subscripts(
        &mut self,
        subscripts: &[Subscript],
        context: ScopeId,
        local: &Local,
    ) -> Result<Vec<Subscript>, Diagnostic> {
        subscripts
            .iter()
            .map(|subscript| match subscript {
                Subscript::All(span) => Ok(Subscript::All(*span)),
                Subscript::Index(e) => {
                    let index = match self.classes.type_range(e, context, local)? {
                        Some(values) => values,
                        None => self.resolve(e, context, local)?,
                    };
                    Ok(Subscript::Index(self.types().boolean_subscript(index, local)))
                }
            })
            .collect()
    }

    /// A reference as an expression: `time`, a loop variable, a component or a constant.
    pub(crate) fn reference(
        &mut self,
        reference: &ComponentReference,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let first = &reference.parts[0];
        if !reference.global {
            if let Some(value) = local.get(first.name) {
                return match value {
                    Some(value) if reference.as_ident().is_some() => Ok(value.clone()),
                    Some(value) if reference.parts.len() > 1 => {
                        self.part_of_value(value.clone(), reference, context, local)
                    }
                    _ => self.local_reference(reference, context, local),
                };
            }
            if self.classes.has_component(context, first.name)? {
                let node = self.classes.node_of(context);
                return self.walk(node, &reference.parts, reference, context, local);
            }
            if reference.as_ident().is_some_and(|name| name == "time") {
                if local.values {
                    return Err(fault!(NOT_CONSTANT, "`time` is not known at translation")
                        .at(reference.span));
                }
                return Ok(Expression::new(
                    ExpressionKind::Reference(reference.clone()),
                    reference.span,
                ));
            }
        }
        self.constant(reference, context, local)
    }

    /// A component of the record that a loop variable stands for.
    fn part_of_value(
        &mut self,
        value: Expression,
        reference: &ComponentReference,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let mut value = value;
        for (at, part) in reference.parts.iter().enumerate() {
            if at > 0 {
                value = component_of(value, part.name, reference.span);
            }
            let subscripts = self.subscripts(&part.subscripts, context, local)?;
            value = subscripted(value, subscripts, reference.span);
        }
        Ok(value)
    }

    fn local_reference(
        &mut self,
        reference: &ComponentReference,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let mut parts = Vec::with_capacity(reference.parts.len());
        for part in &reference.parts {
            let subscripts = self.subscripts(&part.subscripts, context, local)?;
            parts.push(ReferencePart { name: part.name, subscripts });
        }
        let resolved = ComponentReference { global: false, parts, span: reference.span };
        Ok(Expression::new(ExpressionKind::Reference(resolved), reference.span))
    }
}

impl Classes<'_> {
    /// The diagnostic for a name that is neither a component nor a constant.
    pub(crate) fn unknown_name(
        &self,
        reference: &ComponentReference,
        context: ScopeId,
    ) -> Diagnostic {
        let known = self.tree.component_names(self.node_of(context));
        unknown::name(&reference.name(), &known, reference.span)
    }
}

/// A component of a record: the argument of its constructor, where it is written as such.
fn component_of(record: Expression, name: Ident, span: Span) -> Expression {
    if let ExpressionKind::Call { arguments, .. } = &record.kind
        && let Some(argument) = arguments.named.iter().find(|one| one.name.node == name)
    {
        return argument.value.clone();
    }
    Expression::new(ExpressionKind::Field { base: Arc::new(record), name }, span)
}

fn is_boolean(e: &Expression) -> bool {
    matches!(e.kind, ExpressionKind::Boolean(_))
}

/// The literals of a range of Booleans (MLS §10.4.3); none of them show their type as `fill(false, 0)`.
fn booleans(start: &Expression, stop: &Expression) -> Expression {
    let is_in = |truth: &bool| {
        let below = matches!(start.kind, ExpressionKind::Boolean(true)) && !*truth;
        let above = matches!(stop.kind, ExpressionKind::Boolean(false)) && *truth;
        !below && !above
    };
    let span = start.span.to(stop.span);
    let literal = |truth| Expression::new(ExpressionKind::Boolean(truth), span);
    let all: Vec<Expression> = [false, true].into_iter().filter(is_in).map(literal).collect();
    if all.is_empty() {
        let none = Expression::new(ExpressionKind::Integer(0), span);
        return call(&Name::from(Ident::new("fill")), vec![literal(false), none], span);
    }
    Expression::new(ExpressionKind::Array(all), span)
}
