//! `-csvInput`: inputs of a model that follow the columns of a table, interpolated linearly.

use crate::bail;
use crate::diag::{At, Diagnostic, Fault};
use crate::fault;
use crate::flatten::Variable;
use crate::mat::MatFile;
use crate::script::Session;
use crate::script::errors::BAD_ARGUMENT;
use crate::script::models::simulation;
use crate::syntax::ast::CausalityPrefix;
use std::sync::Arc;

/// The class around a model whose inputs follow the columns of a file that have their names; the
/// model itself without a file.
///
/// # Errors
/// The file has no column `time` or none of an input, or the model has no inputs.
pub(super) fn driven(
    session: &mut Session,
    problem: &str,
    file: Option<&str>,
) -> Result<String, Vec<Diagnostic>> {
    let Some(file) = file else { return Ok(problem.to_owned()) };
    let flat = simulation::flat_model(session, problem)?;
    let is_input = |v: &&Variable| v.causality == Some(CausalityPrefix::Input) && v.top_level;
    let inputs: Vec<Arc<str>> =
        flat.variables.values().filter(is_input).map(|variable| variable.name.clone()).collect();
    let at = session.call_site();
    let text = class_text(session, problem, &inputs, file).at(at).map_err(|error| vec![error])?;
    session.load_text(&format!("inputs of {problem}"), &text)?;
    Ok(NAME.to_owned())
}

/// The class around the model.
const NAME: &str = "GAPILibDriven";

fn class_text(
    session: &mut Session,
    problem: &str,
    inputs: &[Arc<str>],
    file: &str,
) -> Result<String, Fault> {
    let data = super::matrices::read_file(session, file)?;
    let time = data.matrix("time")?.row_major();
    if inputs.is_empty() {
        bail!(BAD_ARGUMENT, "`-csvInput` in `simflags`: `{problem}` has no inputs");
    }
    let mut tables = String::new();
    let mut bindings = Vec::new();
    for (number, name) in inputs.iter().enumerate() {
        let rows = rows(&data, &time, name)?;
        tables.push_str(&format!(
            "  Modelica.Blocks.Sources.CombiTimeTable gapi_input_{number}(table = [{rows}], \
             extrapolation = Modelica.Blocks.Types.Extrapolation.HoldLastPoint);\n"
        ));
        bindings.push(format!("{name} = gapi_input_{number}.y[1]"));
    }
    let (class, own) = match problem.split_once('(') {
        Some((class, own)) => (class, own.trim_end().strip_suffix(')').unwrap_or(own)),
        None => (problem, ""),
    };
    let own = std::iter::once(own.to_owned()).filter(|own| !own.is_empty());
    let all = own.chain(bindings).collect::<Vec<_>>().join(", ");
    Ok(format!("model {NAME}\n  extends {class}({all});\n{tables}end {NAME};\n"))
}

/// The points of an input.
fn rows(data: &MatFile, time: &[f64], name: &str) -> Result<String, Fault> {
    let values = data.matrix(name)?.row_major();
    if values.len() != time.len() {
        return Err(fault!(BAD_ARGUMENT, "`time` and `{name}` have different lengths"));
    }
    let pairs =
        time.iter().zip(&values).filter(|(time, value)| time.is_finite() && value.is_finite());
    Ok(pairs.map(|(time, value)| format!("{time:e}, {value:e}")).collect::<Vec<_>>().join("; "))
}
