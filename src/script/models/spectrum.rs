//! Models compiled with their linear part from an input to an output, for spectra.
//!
//! To the value of the input is added a state that stays zero, and that is the first of a chain of states
//! of which each is the derivative of the one before: equations that contain derivatives of the input find
//! them there.

use super::simulation;
use super::translated::Translated;
use crate::Session;
use crate::causalize;
use crate::codegen::{InputChain, LinearPart, Program};
use crate::diag::{At as _, Diagnostic, Fault};
use crate::fault;
use crate::flatten::{Attribute, BaseType, FlatModel, Variability, Variable};
use crate::lower::StateSelect;
use crate::registry::BAD_OPTION;
use crate::source::{SourceId, Span};
use crate::syntax;
use crate::syntax::ast::{
    CausalityPrefix, Comment, Equation, EquationKind, Expression, ExpressionKind,
};

/// The states of the chain.
const CHAIN: [&str; 3] = ["'deviation of the input'", "'its rate'", "'its second derivative'"];
/// The derivative of the last one.
const END: &str = "'its third derivative'";

/// Compiles a model whose input oscillates around the value that it has, or begins with.
///
/// # Errors
///
/// What is wrong with the model; an input that is none, what has no linear part.
pub(crate) fn linearized(
    session: &mut Session,
    problem: &str,
    [input, output]: [&str; 2],
    place: Span,
) -> Result<(Translated, LinearPart), Vec<Diagnostic>> {
    let one = |error: Diagnostic| vec![error];
    let mut flat = simulation::flattened(session, problem)?.model.clone();
    deviate(&mut flat, input).at(place).map_err(one)?;
    let mut sorted = causalize::causalize(&flat).map_err(one)?;
    let chain = CHAIN.map(str::to_owned);
    let chain = InputChain { states: &chain, end: END };
    let linear = LinearPart::add_to(&mut sorted, &chain, output).at(place).map_err(one)?;
    let program = Program::compile(sorted).map_err(one)?;
    Ok((Translated::new(problem, flat, program), linear))
}

/// Adds the chain to the value of an input.
fn deviate(flat: &mut FlatModel, name: &str) -> Result<(), Fault> {
    let input = flat.variables.get(name).filter(|variable| {
        variable.causality == Some(CausalityPrefix::Input)
            && variable.dims.is_empty()
            && variable.base == BaseType::Real
    });
    let Some(input) = input.cloned() else {
        let known = flat.variables.values();
        let inputs = known.filter(|v| v.top_level && v.causality == Some(CausalityPrefix::Input));
        let inputs: Vec<&str> = inputs.map(|variable| &*variable.name).collect();
        let help = match inputs.as_slice() {
            [] => "declare one in the model: `input Real i;`, and connect it".to_owned(),
            inputs => format!("its inputs are {}", crate::diag::suggest::listed(inputs)),
        };
        return Err(fault!(BAD_OPTION, "`{name}` is not a Real input of the model").help(help));
    };
    let number = |value: f64| Expression::new(ExpressionKind::Real(value), Span::NONE);
    let start = input.attributes.get("start").map(|start| start.value.clone());
    let held = input.binding.clone().or(start).unwrap_or_else(|| number(0.0));
    let held = syntax::print::expression(&held);
    let value = parsed(&format!("({held}) + {}", CHAIN[0]))?;
    flat.variables.insert(input.name.clone(), Variable { binding: Some(value), ..input.clone() });
    let attribute = |kind| Attribute { value: Expression::new(kind, Span::NONE), is_final: false };
    let always = ExpressionKind::Integer(StateSelect::Always as i64 + 1);
    let plain = Variable {
        causality: None,
        is_input: false,
        protected: true,
        description: None,
        binding: None,
        attributes: [].into_iter().collect(),
        variability: Variability::Continuous,
        ..input
    };
    for (at, name) in CHAIN.iter().enumerate() {
        let mut state = Variable { name: (*name).into(), ..plain.clone() };
        state.attributes.insert("start", attribute(ExpressionKind::Real(0.0)));
        state.attributes.insert("fixed", attribute(ExpressionKind::Boolean(true)));
        state.attributes.insert("stateSelect", attribute(always.clone()));
        flat.variables.insert(state.name.clone(), state);
        let derivative = CHAIN.get(at + 1).unwrap_or(&END);
        let kind = EquationKind::Equal {
            left: parsed(&format!("der({name})"))?,
            right: parsed(derivative)?,
        };
        flat.equations.push(Equation { kind, comment: Comment::default(), span: Span::NONE });
    }
    let end = Variable {
        name: END.into(),
        binding: Some(number(0.0)),
        variability: Variability::Parameter,
        ..plain
    };
    flat.variables.insert(end.name.clone(), end);
    Ok(())
}

fn parsed(text: &str) -> Result<Expression, Fault> {
    syntax::parse_expression(SourceId::NONE, text)
        .map_err(|error| fault!(BAD_OPTION, "{}", error.message))
}
