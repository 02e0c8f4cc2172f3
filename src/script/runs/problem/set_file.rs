//! Values of an experiment's parameters that a file of SSP gives: `set = "parameters.ssv"`.

use super::data::Notes;
use super::file::{ProblemFile, ValueEntry};
use super::flat::variable_unit;
use crate::Session;
use crate::diag::{Diagnostic, Fault};
use crate::flatten::FlatModel;
use crate::fmi::import::Imported;
use crate::fmi::parameter_set::{Parameter, ParameterValue};
use crate::identify::problem::Origins;
use crate::models::variable_unit::VariableUnit;
use crate::models::{parameter_sets, simulation};
use std::path::Path;

/// What knows the units of parameters.
enum Declarations<'u> {
    Unit(&'u Imported),
    /// Flat once a value in a unit was found.
    Model(Option<Box<FlatModel>>),
}

/// Reads the values of the files that experiments name, in the units of the model.
///
/// # Errors
///
/// A file that cannot be read or is none of SSP; values in units that cannot be converted.
pub(super) fn read(
    session: &mut Session,
    file: &mut ProblemFile,
    unit: Option<&Imported>,
    folder: &Path,
    (notes, origins): (&mut Notes, &mut Origins),
) -> Result<(), Vec<Diagnostic>> {
    let mut declarations = unit.map_or(Declarations::Model(None), Declarations::Unit);
    for entry in &mut file.experiment {
        let place = entry.places.at(&["set"]);
        let one = |fault: Fault| vec![fault.at(place)];
        let Some(own) = entry.set.file.clone() else { continue };
        let path = folder.join(&own);
        let set = parameter_sets::read(session, &path).map_err(one)?;
        let bytes = session.world.read_bytes(&path).map_err(one)?;
        origins.add(format!("`{}`", own.display()), &bytes);
        for parameter in set.parameters {
            let unit = declarations.unit(session, &file.model, &parameter)?;
            let (value, said) =
                parameter_sets::in_unit((&parameter, &set.units), &unit, &own).map_err(one)?;
            said.note.into_iter().for_each(|sentence| notes.add(sentence));
            said.warnings.into_iter().for_each(|sentence| notes.warn(sentence));
            entry.set.values.insert(parameter.name, value_entry(value));
        }
    }
    Ok(())
}

impl Declarations<'_> {
    fn unit(
        &mut self,
        session: &mut Session,
        model: &str,
        parameter: &Parameter,
    ) -> Result<VariableUnit, Vec<Diagnostic>> {
        if parameter.unit.is_none() {
            return Ok(VariableUnit::default());
        }
        let flat = match self {
            Declarations::Unit(unit) => {
                let variable = unit.description.find(&parameter.name);
                return Ok(variable
                    .map_or(VariableUnit::default(), |own| VariableUnit::of_imported(unit, own)));
            }
            Declarations::Model(flat) => flat,
        };
        if flat.is_none() {
            *flat = Some(Box::new(simulation::flattened(session, model)?.model));
        }
        Ok(flat
            .as_ref()
            .map_or(VariableUnit::default(), |flat| variable_unit(flat, &parameter.name)))
    }
}

fn value_entry(value: ParameterValue) -> ValueEntry {
    match value {
        ParameterValue::Number(value) => ValueEntry::Number(value),
        ParameterValue::Truth(value) => ValueEntry::Truth(value),
        ParameterValue::Text(text) => ValueEntry::Text(text),
    }
}
