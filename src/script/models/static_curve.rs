//! Curves written naturally, as `input Real i; output Real V;`: where X is an input at the top of a
//! model, a class around the model gives it the value of a parameter, and the points are evaluated one
//! by one.
//!
//! The parameter has a measured value by default: at zero a coefficient may vanish, and the equations
//! would be sorted as if it always did.

use super::simulation;
use crate::Session;
use crate::diag::{Diagnostic, Fault};
use crate::fault;
use crate::flatten::FlatModel;
use crate::identify::CompiledModel;
use crate::name::Ident;
use crate::registry::BAD_OPTION;
use crate::syntax::ast::CausalityPrefix;
use std::collections::BTreeSet;

/// The class that is made around a model.
const NAME: &str = "GAPILibStaticCurve";

/// The parameter that stands for X.
pub(crate) const DRIVER: &str = "gapi_x";

/// Whether X is an input of the model that nothing drives.
///
/// # Errors
///
/// What is wrong with the model.
pub(crate) fn is_driven(
    session: &mut Session,
    problem: &str,
    x_name: &str,
) -> Result<bool, Vec<Diagnostic>> {
    if x_name.is_empty() || x_name == "time" {
        return Ok(false);
    }
    Ok(is_open_input(&simulation::flattened(session, problem)?.model, x_name))
}

/// Whether a variable of a model is a scalar input that nothing drives.
pub(crate) fn is_open_input(flat: &FlatModel, name: &str) -> bool {
    let input = flat.variables.get(name).filter(|variable| variable.binding.is_none());
    input.is_some_and(|variable| {
        variable.causality == Some(CausalityPrefix::Input) && variable.dims.is_empty()
    })
}

/// A class around `problem`, `Class` or `Class(modification)`, in which X has the value of
/// [`DRIVER`], by default `typical`.
pub(crate) fn around(
    session: &mut Session,
    problem: &str,
    (x_name, typical): (&str, f64),
) -> Result<String, Vec<Diagnostic>> {
    let (class, inner) = match problem.split_once('(') {
        Some((class, inner)) => (class.trim(), inner.trim_end().strip_suffix(')').unwrap_or(inner)),
        None => (problem.trim(), ""),
    };
    let comma = if inner.trim().is_empty() { "" } else { ", " };
    let text = format!(
        "model {NAME}\n  extends {class}({inner}{comma}{x_name} = {DRIVER});\n  parameter Real {DRIVER} = {typical:e};\nend {NAME};\n"
    );
    session.load_text("the class around a static curve", &text)?;
    Ok(NAME.to_owned())
}

/// Top-level names on which a model depends, without the class made by [`around`]: it is made again for
/// every curve.
pub(crate) fn without_class_around(roots: &BTreeSet<Ident>) -> BTreeSet<Ident> {
    roots.iter().copied().filter(|root| *root != *NAME).collect()
}

/// The model of a class made by [`around`].
///
/// # Errors
///
/// `bad-option` where the model has states, so that Y does not follow from X alone.
pub(crate) fn model(
    name: &str,
    translated: &simulation::Translated,
    x_name: &str,
) -> Result<CompiledModel, Fault> {
    let states = &translated.program.sorted().states;
    if !states.is_empty() {
        return Err(fault!(
            BAD_OPTION,
            "X is the input `{x_name}`, but `{name}` has states, so its outputs depend on the \
             history of `{x_name}`"
        )
        .help(format!(
            "use `time` as X and read `{x_name}` from a column of the data (`inputs` of a \
             problem), or bind it in the model, as in `{x_name} = 0.1*time`"
        )));
    }
    Ok(CompiledModel::new(name, translated.program.clone()).driven_by(x_name, DRIVER))
}

/// A value of X that is not zero, if there is one.
pub(crate) fn typical(x: &[f64]) -> f64 {
    x.iter().copied().rev().find(|x| x.is_finite() && *x != 0.0).unwrap_or(0.0)
}
