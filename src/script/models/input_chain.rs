//! Inputs that oscillate: each is the first of a chain of states of which each is the derivative of the one
//! before. Equations that contain derivatives of the input find them there, and the linear part of the model
//! has its columns.

use crate::codegen::{InputChain, ORDERS};
use crate::diag::Fault;
use crate::fault;
use crate::flatten::{Attribute, FlatModel, Variability, Variable};
use crate::lower::StateSelect;
use crate::registry::BAD_OPTION;
use crate::source::{SourceId, Span};
use crate::syntax;
use crate::syntax::ast::{Comment, Equation, EquationKind, Expression, ExpressionKind};
use std::sync::Arc;

/// What the derivatives of an input are called in its chain, the last one that of the parameter.
const DERIVATIVES: [&str; ORDERS] = ["derivative", "second derivative", "third derivative"];

/// The names of the derivatives of an input.
fn derivatives(input: &str) -> [String; ORDERS] {
    let input = input.replace('\'', "\"");
    DERIVATIVES.map(|derivative| format!("'{derivative} of {input}'"))
}

/// Makes `first` the first state of a chain; the chain of each of its elements, in their order.
///
/// # Errors
///
/// Names that cannot be written as expressions.
pub(super) fn add(flat: &mut FlatModel, first: Variable) -> Result<Vec<InputChain>, Fault> {
    let names = derivatives(&first.name);
    let elements = elements(&first.dims);
    let of_element = |element: &String| {
        let [derivative, second, end] = names.each_ref().map(|name| format!("{name}{element}"));
        InputChain { states: [format!("{}{element}", first.name), derivative, second], end }
    };
    let chains = elements.iter().map(of_element).collect();
    let plain = Variable {
        attributes: [].into_iter().collect(),
        description: None,
        ..state(first.clone())
    };
    let mut left = first.name.clone();
    flat.variables.insert(first.name.clone(), state(first));
    for (at, name) in names.iter().enumerate() {
        let name: Arc<str> = name.as_str().into();
        let kind =
            EquationKind::Equal { left: parsed(&format!("der({left})"))?, right: parsed(&name)? };
        flat.equations.push(Equation { kind, comment: Comment::default(), span: Span::NONE });
        let own = Variable { name: name.clone(), protected: true, ..plain.clone() };
        let own = match at + 1 < ORDERS {
            true => state(own),
            false => Variable {
                variability: Variability::Parameter,
                binding: Some(parsed(&zeros(&own.dims))?),
                ..own
            },
        };
        flat.variables.insert(name.clone(), own);
        left = name;
    }
    Ok(chains)
}

/// The variable as a state that begins with its start value.
fn state(mut variable: Variable) -> Variable {
    let always = ExpressionKind::Integer(StateSelect::Always as i64 + 1);
    for (name, kind) in [("fixed", ExpressionKind::Boolean(true)), ("stateSelect", always)] {
        let value = Expression::new(kind, Span::NONE);
        variable.attributes.insert(name, Attribute { value, is_final: false });
    }
    Variable { causality: None, is_input: false, ..variable }
}

fn zeros(dims: &[usize]) -> String {
    match dims {
        [] => "0.0".to_owned(),
        dims => {
            let sizes: Vec<String> = dims.iter().map(usize::to_string).collect();
            format!("zeros({})", sizes.join(", "))
        }
    }
}

/// What stands after the name of a variable in those of its elements, row by row.
fn elements(dims: &[usize]) -> Vec<String> {
    let mut subscripts = vec![String::new()];
    for size in dims {
        let extended = |before: &String| {
            let comma = if before.is_empty() { "" } else { "," };
            (1..=*size).map(|i| format!("{before}{comma}{i}")).collect::<Vec<_>>()
        };
        subscripts = subscripts.iter().flat_map(extended).collect();
    }
    match dims {
        [] => subscripts,
        _ => subscripts.iter().map(|subscript| format!("[{subscript}]")).collect(),
    }
}

/// An expression from text.
///
/// # Errors
///
/// Text that is none.
pub(super) fn parsed(text: &str) -> Result<Expression, Fault> {
    syntax::parse_expression(SourceId::NONE, text)
        .map_err(|error| fault!(BAD_OPTION, "{}", error.message))
}
