//! Files with values of parameters (`.ssv`), for models and for functional mock-up units.

use super::imported::Given;
use crate::Session;
use crate::diag::Fault;
use crate::errors::BAD_FMU;
use crate::fmi::ParameterSet;
use crate::fmi::import::Imported;
use crate::fmi::parameter_set::{ENDING, Parameter, ParameterValue};
use crate::{bail, fault, units};
use std::path::Path;

/// Whether a path is that of a file with values of parameters.
pub fn is_set(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(ENDING))
}

/// Reads a file.
///
/// # Errors
/// It cannot be read, or is not a parameter set.
pub fn read(session: &Session, path: &Path) -> Result<ParameterSet, Fault> {
    let shown = path.display();
    if !is_set(path) {
        bail!(BAD_FMU, "`{shown}` is not a file `.{ENDING}`";
            help: "give the values of parameters in a parameter set of SSP, as `gapi identify` writes it");
    }
    let text = session.read_text(path)?;
    ParameterSet::read(&text)
        .map_err(|why| fault!(BAD_FMU, "`{shown}` is not a parameter set of SSP: {why}"))
}

/// Gives the model translated last the values of a file.
///
/// # Errors
/// As those of [`read`]; parameters that the model does not have, units that do not measure the same.
pub fn set(session: &mut Session, path: &Path) -> Result<(), Fault> {
    let set = read(session, path)?;
    for parameter in &set.parameters {
        let model = session.last_model();
        let unit = model.and_then(|model| {
            let at = model.program.find_variable(&parameter.name).ok()?;
            Some(model.program.variables()[at].unit.to_string())
        });
        let text = text_in(parameter, unit.as_deref())?;
        session.set_parameter_text(&parameter.name, &text)?;
    }
    Ok(())
}

/// Adds the values of a file to those of a unit.
///
/// # Errors
/// As those of [`set`].
pub fn give(
    session: &Session,
    path: &Path,
    (unit, given): (&Imported, &mut Given),
) -> Result<(), Fault> {
    for parameter in &read(session, path)?.parameters {
        let variable = unit.description.find(&parameter.name);
        let own = variable.and_then(|own| unit.description.attributes_of(own).unit);
        given.add(unit, &parameter.name, &text_in(parameter, own.as_deref())?)?;
    }
    Ok(())
}

/// A value in the unit of its variable, as text.
fn text_in(parameter: &Parameter, unit: Option<&str>) -> Result<String, Fault> {
    let value = match &parameter.value {
        ParameterValue::Number(value) => *value,
        ParameterValue::Truth(value) => return Ok(value.to_string()),
        ParameterValue::Text(text) => return Ok(text.clone()),
    };
    let (Some(from), Some(to)) = (parameter.unit.as_deref(), unit) else {
        return Ok(value.to_string());
    };
    if from == to || to.is_empty() {
        return Ok(value.to_string());
    }
    let conversion = units::unit(from).zip(units::unit(to)).and_then(|(from, to)| from.to(to));
    match conversion {
        Some(conversion) => Ok(conversion.apply(value).to_string()),
        None => Err(fault!(
            BAD_FMU,
            "the value of `{}` is in {from}, which cannot be converted to {to}", parameter.name;
            help: "write it in {to}"
        )),
    }
}
