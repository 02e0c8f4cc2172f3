//! Expressions of the flat model, built from paths and values.

use crate::name::{Ident, Name};
use crate::source::{Span, Spanned};
use crate::syntax::ast::{
    Arguments, ComponentReference, Expression, ExpressionKind, NamedArgument, ReferencePart,
    Subscript,
};
use crate::value::{ArrayValue, Value};

/// A flat path as a reference.
pub fn flat_reference(path: &str, span: Span) -> ComponentReference {
    let mut parts = Vec::new();
    let mut rest = path;
    while !rest.is_empty() {
        let (text, after) = next_part(rest);
        rest = after;
        let (name, indices) = match text.strip_suffix(']').and_then(|t| t.rsplit_once('[')) {
            Some((name, indices)) => (name, indices),
            None => (text, ""),
        };
        let subscripts = indices
            .split(',')
            .filter_map(|index| index.parse().ok())
            .map(|index| Subscript::Index(Expression::new(ExpressionKind::Integer(index), span)))
            .collect();
        parts.push(ReferencePart { name: Ident::new(name), subscripts });
    }
    ComponentReference { global: false, parts, span }
}

/// The path up to the next dot outside quotes, and what follows.
fn next_part(path: &str) -> (&str, &str) {
    let mut quoted = false;
    for (at, character) in path.char_indices() {
        match character {
            '\'' => quoted = !quoted,
            '.' if !quoted => return (&path[..at], &path[at + 1..]),
            _ => {}
        }
    }
    (path, "")
}

/// A value written as an expression.
pub(crate) fn literal(value: &Value, span: Span) -> Expression {
    let kind = match value {
        Value::Real(number) => ExpressionKind::Real(*number),
        Value::Integer(number) => ExpressionKind::Integer(*number),
        Value::Boolean(truth) => ExpressionKind::Boolean(*truth),
        Value::String(text) => ExpressionKind::String(text.clone()),
        Value::Enumeration(value) => ExpressionKind::Integer(value.ordinal),
        Value::Array(array) => return array_literal(&array.dims, 0, array, span),
        Value::Record(record) => {
            let named = record.fields.iter().map(|(name, value)| NamedArgument {
                name: Spanned { node: *name, span },
                value: literal(value, span),
            });
            let arguments = Arguments { named: named.collect(), ..Arguments::default() };
            ExpressionKind::Call {
                function: ComponentReference::from_name(&record.type_name, span),
                arguments: Box::new(arguments),
            }
        }
        Value::TypeName(name) => {
            ExpressionKind::Reference(ComponentReference::from_name(name, span))
        }
        Value::VariableName(name) => {
            ExpressionKind::Reference(ComponentReference::from_name(&Name::parse(name), span))
        }
        Value::Function(function) => {
            ExpressionKind::Reference(ComponentReference::from_name(&function.name, span))
        }
        Value::External(object) => {
            ExpressionKind::Reference(ComponentReference::from_name(&object.class, span))
        }
        Value::Tuple(values) => {
            ExpressionKind::Tuple(values.iter().map(|value| Some(literal(value, span))).collect())
        }
    };
    Expression::new(kind, span)
}

fn array_literal(dims: &[usize], offset: usize, array: &ArrayValue, span: Span) -> Expression {
    let Some((size, inner)) = dims.split_first() else {
        return literal(&array.elements.get(offset), span);
    };
    let stride: usize = inner.iter().product();
    let elements: Vec<Expression> =
        (0..*size).map(|at| array_literal(inner, offset + at * stride, array, span)).collect();
    if elements.is_empty() {
        // An empty constructor has no size: `zeros` has (MLS §10.3.3).
        let sizes = dims.iter().map(|n| Expression::new(ExpressionKind::Integer(*n as i64), span));
        let arguments = Arguments { positional: sizes.collect(), ..Arguments::default() };
        let function = ComponentReference::from_name(&Name::parse("zeros"), span);
        let kind = ExpressionKind::Call { function, arguments: Box::new(arguments) };
        return Expression::new(kind, span);
    }
    Expression::new(ExpressionKind::Array(elements), span)
}

/// `base[subscripts]`, written shortly where the base allows it.
pub(crate) fn subscripted(base: Expression, subscripts: Vec<Subscript>, span: Span) -> Expression {
    if subscripts.is_empty() {
        return base;
    }
    let mut base = base;
    let literals: Option<Vec<usize>> = subscripts
        .iter()
        .map(|subscript| match subscript {
            Subscript::Index(Expression { kind: ExpressionKind::Integer(n), .. }) => {
                usize::try_from(*n).ok()
            }
            _ => None,
        })
        .collect();
    if let Some(indices) = literals
        && let Some(element) = element_at(&base, &indices)
    {
        return element.clone();
    }
    if let ExpressionKind::Reference(reference) = &mut base.kind
        && let Some(last) = reference.parts.last_mut()
        && last.subscripts.is_empty()
    {
        last.subscripts = subscripts;
        return base;
    }
    Expression::new(ExpressionKind::Subscripted { base: Box::new(base), subscripts }, span)
}

/// The element of an array constructor.
fn element_at<'e>(base: &'e Expression, indices: &[usize]) -> Option<&'e Expression> {
    let Some((first, rest)) = indices.split_first() else { return Some(base) };
    match &base.kind {
        ExpressionKind::Array(elements) => element_at(elements.get(first.checked_sub(1)?)?, rest),
        _ => None,
    }
}

/// The indices, from 1, of an element in an array, the last dimension fastest.
pub(crate) fn indices_of(mut at: usize, dims: &[usize]) -> Vec<usize> {
    let mut indices = vec![0; dims.len()];
    for (index, size) in indices.iter_mut().zip(dims).rev() {
        *index = at % size + 1;
        at /= size;
    }
    indices
}

/// The element of a value that belongs to one element of an array of components.
pub(crate) fn picked(value: Expression, indices: &[usize]) -> Expression {
    if indices.is_empty() {
        return value;
    }
    let span = value.span;
    let subscript =
        |at: &usize| Subscript::Index(Expression::new(ExpressionKind::Integer(*at as i64), span));
    let subscripts = indices.iter().map(subscript).collect();
    Expression::new(ExpressionKind::Subscripted { base: Box::new(value), subscripts }, span)
}

/// A call with positional arguments.
pub(crate) fn call(name: &Name, positional: Vec<Expression>, span: Span) -> Expression {
    let function = ComponentReference::from_name(name, span);
    let arguments = Box::new(Arguments { positional, ..Arguments::default() });
    Expression::new(ExpressionKind::Call { function, arguments }, span)
}
