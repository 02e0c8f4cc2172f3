//! Models compiled with their linear part from an input to an output, for spectra: to the value of the input
//! is added a state that stays zero, the first of a chain ([`input_chain`]).

use super::input_chain::{self, parsed};
use super::simulation;
use super::translated::Translated;
use crate::Session;
use crate::causalize;
use crate::codegen::{InputChain, LinearPart, Program};
use crate::diag::{At as _, Diagnostic, Fault};
use crate::fault;
use crate::flatten::{BaseType, FlatModel, Variability, Variable};
use crate::registry::BAD_OPTION;
use crate::source::Span;
use crate::syntax;
use crate::syntax::ast::{CausalityPrefix, Expression, ExpressionKind};

/// What is added to the input.
const DEVIATION: &str = "'deviation of the input'";

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
    let chains = deviate(&mut flat, input).at(place).map_err(one)?;
    let mut sorted = causalize::causalize(&flat).map_err(one)?;
    let outputs = [output.to_owned()];
    let linear = LinearPart::add_to(&mut sorted, &chains, &outputs).at(place).map_err(one)?;
    let program = Program::compile(sorted).map_err(one)?;
    Ok((Translated::new(problem, flat, program), linear))
}

/// Adds the chain to the value of an input.
fn deviate(flat: &mut FlatModel, name: &str) -> Result<Vec<InputChain>, Fault> {
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
    let value = parsed(&format!("({held}) + {DEVIATION}"))?;
    flat.variables.insert(input.name.clone(), Variable { binding: Some(value), ..input.clone() });
    let deviation = Variable {
        name: DEVIATION.into(),
        protected: true,
        description: None,
        binding: None,
        attributes: [].into_iter().collect(),
        variability: Variability::Continuous,
        ..input
    };
    input_chain::add(flat, deviation)
}
