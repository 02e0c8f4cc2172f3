//! Files with values of parameters (`.ssv`), for models and for functional mock-up units.

use super::imported::Given;
use super::variable_unit::VariableUnit;
use crate::Session;
use crate::diag::Fault;
use crate::errors::BAD_FMU;
use crate::fmi::ParameterSet;
use crate::fmi::import::Imported;
use crate::fmi::parameter_set::{ENDING, Parameter, ParameterValue};
use crate::identify::errors::UNITS_DIFFER;
use crate::units::Definitions;
use crate::{bail, fault};
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
    let text = session.world.read_text(path)?;
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
        let unit = unit_of(session, &parameter.name);
        let value = session.converted((parameter, &set.units), unit, path)?;
        session.set_parameter_text(&parameter.name, &text(&value))?;
    }
    Ok(())
}

/// Gives a parameter of a set the value that the model translated last has been given, in the unit of the
/// model; what a fit knows of it no longer holds.
pub fn replace(session: &Session, set: &mut ParameterSet, name: &str, text: &str) {
    let Some(own) = set.parameters.iter_mut().find(|own| own.name == name) else { return };
    own.value = match (text.trim(), text.trim().parse()) {
        (_, Ok(number)) => ParameterValue::Number(number),
        ("true", _) => ParameterValue::Truth(true),
        ("false", _) => ParameterValue::Truth(false),
        (text, _) => ParameterValue::Text(text.to_owned()),
    };
    own.unit = unit_of(session, name).map(|unit| unit.symbol).filter(|unit| !unit.is_empty());
    own.estimate = None;
}

/// The unit of a parameter of the model translated last.
fn unit_of(session: &Session, name: &str) -> Option<VariableUnit> {
    let model = session.last_model()?;
    let at = model.program.find_variable(name).ok()?;
    let variable = &model.program.variables()[at];
    let (symbol, is_relative) = (variable.unit.to_string(), variable.is_relative);
    Some(VariableUnit { symbol, is_relative, ..VariableUnit::default() })
}

/// Adds the values of a file to those of a unit.
///
/// # Errors
/// As those of [`set`].
pub fn give(
    session: &mut Session,
    path: &Path,
    (unit, given): (&Imported, &mut Given),
) -> Result<(), Fault> {
    let set = read(session, path)?;
    for parameter in &set.parameters {
        let own = unit.description.find(&parameter.name);
        let own = own.map(|own| VariableUnit::of_imported(unit, own));
        let value = session.converted((parameter, &set.units), own, path)?;
        given.add(unit, &parameter.name, &text(&value))?;
    }
    Ok(())
}

impl Session {
    /// The value of a parameter in the unit that it has in the model, which is noted where it is not that
    /// of the file.
    fn converted(
        &mut self,
        parameter: (&Parameter, &Definitions),
        own: Option<VariableUnit>,
        path: &Path,
    ) -> Result<ParameterValue, Fault> {
        let (value, said) = in_unit(parameter, &own.unwrap_or_default(), path)?;
        said.note.into_iter().for_each(|sentence| self.note(UNITS_DIFFER, sentence));
        said.warnings.into_iter().for_each(|sentence| self.warn(UNITS_DIFFER, sentence));
        Ok(value)
    }
}

/// What is to be said of a value that was in another unit than its variable.
#[derive(Debug, Default)]
pub(crate) struct Said {
    /// How it was converted.
    pub(crate) note: Option<String>,
    /// Units that a file defines otherwise than they are known.
    pub(crate) warnings: Vec<String>,
}

/// A value in the unit of its variable, and what is to be said where it was in another one. Names of units
/// that are not known are those of the set, or of the model. Where one of the units is not said, the value is
/// taken as it is.
///
/// # Errors
/// Units that are not known, or do not measure the same.
pub(crate) fn in_unit(
    (parameter, units): (&Parameter, &Definitions),
    own: &VariableUnit,
    file: &Path,
) -> Result<(ParameterValue, Said), Fault> {
    let unchanged = || (parameter.value.clone(), Said::default());
    let (ParameterValue::Number(value), Some(from)) = (&parameter.value, parameter.unit.as_deref())
    else {
        return Ok(unchanged());
    };
    let (name, to, file) = (&parameter.name, own.symbol.as_str(), file.display());
    if from == to || to.is_empty() {
        return Ok(unchanged());
    }
    let of_set = units.contradiction(from, &format!("`{file}`"));
    let warnings: Vec<String> = of_set.into_iter().chain(own.contradictions([from, to])).collect();
    let read = units.find(from).or_else(|| own.definitions.defined(from));
    let absolute = read.zip(own.definitions.find(to)).and_then(|(from, to)| from.to(to));
    let Some(absolute) = absolute else {
        let fault = fault!(
            BAD_FMU,
            "`{name}` in `{file}` is in {from}, which cannot be converted to {to}";
            help: "write its value there in {to}"
        );
        return Err(fault.help_if(warnings.into_iter().next()));
    };
    let conversion = if own.is_relative { absolute.of_differences() } else { absolute };
    if conversion.is_identity() {
        return Ok((parameter.value.clone(), Said { note: None, warnings }));
    }
    let words = conversion.in_words();
    let note = format!("`{name}` in `{file}` is converted from {from} to {to}{words}");
    let said = Said { note: Some(note), warnings };
    Ok((ParameterValue::Number(conversion.apply(*value)), said))
}

fn text(value: &ParameterValue) -> String {
    match value {
        ParameterValue::Number(value) => value.to_string(),
        ParameterValue::Truth(value) => value.to_string(),
        ParameterValue::Text(text) => text.clone(),
    }
}
