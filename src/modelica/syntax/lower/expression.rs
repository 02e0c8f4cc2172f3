//! Expressions (MLS §A.2.7): the flat list of operands and operators becomes a tree.

use super::{Lowered, ident, name};
use crate::diag::Diagnostic;
use crate::fault;
use crate::name::Ident;
use crate::syntax::ast::{
    Arguments, BinaryOperator, ComponentReference, Expression, ExpressionKind, ForIndex,
    NamedArgument, ReferencePart, Subscript, UnaryOperator,
};
use crate::syntax::errors::SYNTAX_ERROR;
use crate::syntax::foreign;
use crate::syntax::parser::{Node, Nodes, Rule};
use std::sync::Arc;

/// Precedence of the operators (MLS §3.2), loosest first. `:` is read by [`range`].
const OR: u8 = 1;
const AND: u8 = 2;
const NOT: u8 = 3;
const RELATION: u8 = 4;
const ADDITION: u8 = 5;
const MULTIPLICATION: u8 = 6;
const POWER: u8 = 7;

/// The expression that the grammar promises next.
pub(super) fn expression(nodes: &mut Nodes<'_>) -> Lowered<Expression> {
    let mut parts = nodes.enter(Rule::expression);
    if let Some(branches) = parts.try_enter(Rule::if_expression) {
        return conditional(branches);
    }
    let whole = range(&mut parts)?;
    match parts.next() {
        None => Ok(whole),
        Some(extra) => Err(unassociated(&parts, &extra)),
    }
}

/// The error of `a < b < c`, `a ^ b ^ c` and `a:b:c:d`.
fn unassociated<'i>(parts: &Nodes<'i>, extra: &Node<'i>) -> Diagnostic {
    let operator = extra.as_str();
    fault!(SYNTAX_ERROR, "`{operator}` cannot follow an operator of the same kind")
        .help("put one of the two operations in parentheses")
        .at(parts.span(extra))
}

/// The expression that comes next, if one does.
pub(super) fn try_expression(nodes: &mut Nodes<'_>) -> Lowered<Option<Expression>> {
    match nodes.peek() {
        Some(Rule::expression) => expression(nodes).map(Some),
        _ => Ok(None),
    }
}

/// All expressions that come next.
pub(super) fn expressions(nodes: &mut Nodes<'_>) -> Lowered<Vec<Expression>> {
    let mut all = Vec::new();
    while let Some(one) = try_expression(nodes)? {
        all.push(one);
    }
    Ok(all)
}

fn conditional(mut parts: Nodes<'_>) -> Lowered<Expression> {
    let mut branches = Vec::new();
    loop {
        let first = expression(&mut parts)?;
        let Some(value) = try_expression(&mut parts)? else {
            let kind = ExpressionKind::If { branches, otherwise: Box::new(first) };
            return Ok(Expression::new(kind, parts.whole));
        };
        branches.push((first, value));
    }
}

/// `a`, `a:b` or `a:step:b`.
fn range(parts: &mut Nodes<'_>) -> Lowered<Expression> {
    let start = binary(parts, OR)?;
    if !parts.skip(Rule::range_operator) {
        return Ok(start);
    }
    let second = binary(parts, OR)?;
    let (step, stop) = if parts.skip(Rule::range_operator) {
        (Some(Box::new(second)), binary(parts, OR)?)
    } else {
        (None, second)
    };
    let span = start.span.to(stop.span);
    let kind = ExpressionKind::Range { start: Box::new(start), step, stop: Box::new(stop) };
    Ok(Expression::new(kind, span))
}

/// Operands joined by operators of at least this precedence.
fn binary(parts: &mut Nodes<'_>, least: u8) -> Lowered<Expression> {
    let mut left = operand(parts, least)?;
    let mut ceiling = POWER;
    while let Some(operator) = peek_operator(parts) {
        let precedence = precedence(operator);
        if precedence < least || precedence > ceiling {
            break;
        }
        parts.expect(Rule::binary_operator);
        let right = binary(parts, precedence + 1)?;
        let span = left.span.to(right.span);
        left = Expression::operation(operator, left, right, span);
        // Relations and powers do not associate: `a < b < c` and `a ^ b ^ c` are not valid
        // Modelica.
        ceiling = if matches!(precedence, RELATION | POWER) { precedence - 1 } else { precedence };
    }
    Ok(left)
}

fn operand(parts: &mut Nodes<'_>, least: u8) -> Lowered<Expression> {
    let Some(node) = parts.take(Rule::unary_operator) else { return primary(parts) };
    let start = parts.span(&node);
    let (operator, precedence) = match node.as_str() {
        "-" => (UnaryOperator::Minus, MULTIPLICATION),
        "+" => (UnaryOperator::Plus, MULTIPLICATION),
        ".-" => (UnaryOperator::ElementwiseMinus, MULTIPLICATION),
        ".+" => (UnaryOperator::ElementwisePlus, MULTIPLICATION),
        _ => (UnaryOperator::Not, NOT + 1),
    };
    // After another operator (`a / -b * c`, beyond the MLS) a sign binds to its factor alone.
    let operand = binary(parts, precedence.max(least))?;
    let span = start.to(operand.span);
    Ok(Expression::new(ExpressionKind::Unary { operator, operand: Box::new(operand) }, span))
}

fn peek_operator(parts: &mut Nodes<'_>) -> Option<BinaryOperator> {
    let operator = match parts.peek_text(Rule::binary_operator)? {
        "+" => BinaryOperator::Add,
        "-" => BinaryOperator::Subtract,
        "*" => BinaryOperator::Multiply,
        "/" => BinaryOperator::Divide,
        "^" => BinaryOperator::Power,
        ".+" => BinaryOperator::ElementwiseAdd,
        ".-" => BinaryOperator::ElementwiseSubtract,
        ".*" => BinaryOperator::ElementwiseMultiply,
        "./" => BinaryOperator::ElementwiseDivide,
        ".^" => BinaryOperator::ElementwisePower,
        "<" => BinaryOperator::Less,
        "<=" => BinaryOperator::LessEqual,
        ">" => BinaryOperator::Greater,
        ">=" => BinaryOperator::GreaterEqual,
        "==" => BinaryOperator::Equal,
        "<>" => BinaryOperator::NotEqual,
        "and" => BinaryOperator::And,
        _ => BinaryOperator::Or,
    };
    Some(operator)
}

fn precedence(operator: BinaryOperator) -> u8 {
    match operator {
        BinaryOperator::Or => OR,
        BinaryOperator::And => AND,
        BinaryOperator::Less
        | BinaryOperator::LessEqual
        | BinaryOperator::Greater
        | BinaryOperator::GreaterEqual
        | BinaryOperator::Equal
        | BinaryOperator::NotEqual => RELATION,
        BinaryOperator::Add
        | BinaryOperator::Subtract
        | BinaryOperator::ElementwiseAdd
        | BinaryOperator::ElementwiseSubtract => ADDITION,
        BinaryOperator::Multiply
        | BinaryOperator::Divide
        | BinaryOperator::ElementwiseMultiply
        | BinaryOperator::ElementwiseDivide => MULTIPLICATION,
        BinaryOperator::Power | BinaryOperator::ElementwisePower => POWER,
    }
}

fn primary(parts: &mut Nodes<'_>) -> Lowered<Expression> {
    let Some(node) = parts.next() else { panic!("the grammar promises an operand") };
    let span = parts.span(&node);
    let kind = match node.as_rule() {
        Rule::component_reference => {
            let reference = component_reference(parts.inside(node))?;
            return reference_or_call(parts, reference);
        }
        Rule::keyword_function => {
            let ident = Ident::new(node.as_str());
            return reference_or_call(parts, ComponentReference::from_name(&ident.into(), span));
        }
        Rule::parenthesized => return parenthesized(parts, node),
        Rule::unsigned_number => number(node.as_str()),
        Rule::STRING => ExpressionKind::String(super::string(&node)),
        Rule::boolean_literal => ExpressionKind::Boolean(node.as_str() == "true"),
        Rule::end_subscript => ExpressionKind::End,
        Rule::type_name_quoted => ExpressionKind::TypeName(name(&mut parts.inside(node)).node),
        Rule::code_quoted => {
            ExpressionKind::Code(parts.inside(node).expect(Rule::code).as_str().into())
        }
        Rule::array => array(parts.inside(node))?,
        Rule::matrix => matrix(parts.inside(node))?,
        other => panic!("the grammar has no operand {other:?}"),
    };
    Ok(Expression::new(kind, span))
}

fn number(text: &str) -> ExpressionKind {
    let whole = text.bytes().all(|byte| byte.is_ascii_digit());
    match text.parse::<i64>() {
        Ok(integer) if whole => ExpressionKind::Integer(integer),
        // The grammar's numbers are a subset of Rust's; an overflow reads as infinity, which is
        // refused when the number is used.
        _ => ExpressionKind::Real(text.parse().unwrap_or(f64::NAN)),
    }
}

fn reference_or_call(parts: &mut Nodes<'_>, function: ComponentReference) -> Lowered<Expression> {
    let start = function.span;
    let Some(inside) = parts.try_enter(Rule::function_call_args) else {
        return Ok(Expression::new(ExpressionKind::Reference(function), start));
    };
    if let Some(part) = function.parts.iter().find(|part| !part.subscripts.is_empty()) {
        let subscripts = part.subscripts[0].span();
        return Err(fault!(
            SYNTAX_ERROR,
            "the called function `{}` has subscripts",
            function.name()
        )
        .help("subscript the result instead: `(f(x))[1]`")
        .at(subscripts));
    }
    let span = start.to(inside.whole);
    let arguments = Box::new(arguments(inside)?);
    Ok(Expression::new(ExpressionKind::Call { function, arguments }, span))
}

fn arguments(mut inside: Nodes<'_>) -> Lowered<Arguments> {
    let mut all = Arguments::default();
    loop {
        match inside.peek() {
            Some(Rule::named_argument) => {
                let argument = inside.enter(Rule::named_argument);
                all.named.push(named_argument(argument)?);
            }
            Some(Rule::for_indices) => all.iterators = for_indices(&mut inside)?,
            Some(_) => {
                let value = argument_value(&mut inside)?;
                if let Some(last) = all.named.last() {
                    let help = foreign::decimal_commas([&last.value, &value])
                        .unwrap_or_else(|| "name it as well, or move it to the front".to_owned());
                    return Err(fault!(
                        SYNTAX_ERROR,
                        "a positional argument cannot follow a named one"
                    )
                    .help(help)
                    .at(value.span));
                }
                all.positional.push(value);
            }
            None => return Ok(all),
        }
    }
}

fn named_argument(mut parts: Nodes<'_>) -> Lowered<NamedArgument> {
    Ok(NamedArgument { name: ident(&mut parts), value: argument_value(&mut parts)? })
}

fn argument_value(parts: &mut Nodes<'_>) -> Lowered<Expression> {
    let Some(mut partial) = parts.try_enter(Rule::function_partial_application) else {
        return expression(parts);
    };
    let mut target = partial.enter(Rule::type_specifier);
    let function = name(&mut target).node;
    let mut named = Vec::new();
    while let Some(argument) = partial.try_enter(Rule::named_argument) {
        named.push(named_argument(argument)?);
    }
    Ok(Expression::new(ExpressionKind::PartialApplication { function, named }, partial.whole))
}

/// `(e)`, `(e)[i]`, `(e).name` or an output list.
fn parenthesized<'i>(parts: &mut Nodes<'i>, node: Node<'i>) -> Lowered<Expression> {
    let mut inside = parts.inside(node);
    let mut outputs = Vec::new();
    while inside.peek().is_some() {
        outputs.push(if inside.skip(Rule::omitted) {
            None
        } else {
            Some(expression(&mut inside)?)
        });
    }
    let base = match outputs.as_mut_slice() {
        [None] => Expression::new(ExpressionKind::Tuple(Vec::new()), inside.whole),
        [Some(_)] => match outputs.pop().flatten() {
            Some(one) => Expression { span: inside.whole, ..one },
            None => unreachable!("a list of one expression"),
        },
        _ => Expression::new(ExpressionKind::Tuple(outputs), inside.whole),
    };
    let start = base.span;
    if let Some(mut field) = parts.try_enter(Rule::field) {
        let span = start.to(field.whole);
        let kind = ExpressionKind::Field { base: Arc::new(base), name: ident(&mut field).node };
        return Ok(Expression::new(kind, span));
    }
    let Some(list) = parts.try_enter(Rule::array_subscripts) else { return Ok(base) };
    let span = start.to(list.whole);
    let kind = ExpressionKind::Subscripted { base: Box::new(base), subscripts: subscripts(list)? };
    Ok(Expression::new(kind, span))
}

fn array(mut inside: Nodes<'_>) -> Lowered<ExpressionKind> {
    let mut elements = expressions(&mut inside)?;
    if inside.peek().is_none() {
        return Ok(ExpressionKind::Array(elements));
    }
    let Some(element) = elements.pop() else { panic!("the grammar promises an element") };
    let indices = for_indices(&mut inside)?;
    Ok(ExpressionKind::ArrayIteration { element: Box::new(element), indices })
}

fn matrix(mut inside: Nodes<'_>) -> Lowered<ExpressionKind> {
    let mut rows = Vec::new();
    while let Some(mut row) = inside.try_enter(Rule::matrix_row) {
        rows.push(expressions(&mut row)?);
    }
    Ok(ExpressionKind::Matrix(rows))
}

/// The loop variables that the grammar promises next.
pub(super) fn for_indices(nodes: &mut Nodes<'_>) -> Lowered<Vec<ForIndex>> {
    let mut list = nodes.enter(Rule::for_indices);
    let mut indices = Vec::new();
    while let Some(mut index) = list.try_enter(Rule::for_index) {
        let name = ident(&mut index);
        let is_guarded = index.skip(Rule::word_guard);
        let range = match try_expression(&mut index)? {
            Some(condition) if is_guarded => {
                let values = Box::new(expression(&mut index)?);
                let (span, condition) = (condition.span.to(values.span), Box::new(condition));
                let kind = ExpressionKind::Guarded { name: name.node, condition, values };
                Some(Expression::new(kind, span))
            }
            range => range,
        };
        indices.push(ForIndex { name, range });
    }
    Ok(indices)
}

/// The component reference that the grammar promises next.
pub(super) fn reference(nodes: &mut Nodes<'_>) -> Lowered<ComponentReference> {
    component_reference(nodes.enter(Rule::component_reference))
}

fn component_reference(mut inside: Nodes<'_>) -> Lowered<ComponentReference> {
    let global = inside.skip(Rule::global_dot);
    // Most have one part: a script of a million statements has millions of them.
    let mut parts = Vec::with_capacity(1);
    while let Some(name) = inside.take(Rule::IDENT) {
        let subscripts = optional_subscripts(&mut inside)?;
        parts.push(ReferencePart { name: Ident::new(name.as_str()), subscripts });
    }
    Ok(ComponentReference { global, parts, span: inside.whole })
}

/// The subscripts that come next; empty if none do.
pub(super) fn optional_subscripts(nodes: &mut Nodes<'_>) -> Lowered<Vec<Subscript>> {
    match nodes.try_enter(Rule::array_subscripts) {
        Some(list) => subscripts(list),
        None => Ok(Vec::new()),
    }
}

fn subscripts(mut list: Nodes<'_>) -> Lowered<Vec<Subscript>> {
    let mut all = Vec::new();
    while list.peek().is_some() {
        all.push(match list.take(Rule::all_subscript) {
            Some(colon) => Subscript::All(list.span(&colon)),
            None => Subscript::Index(expression(&mut list)?),
        });
    }
    Ok(all)
}
