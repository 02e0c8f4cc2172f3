//! Values of an experiment's parameters that a file of SSP gives: `set = "parameters.ssv"`.

use super::file::{ExperimentEntry, ValueEntry};
use crate::Session;
use crate::bail;
use crate::diag::Fault;
use crate::errors::BAD_FMU;
use crate::fmi::parameter_set::ParameterValue;
use crate::identify::Model;
use crate::identify::problem::Origins;
use crate::models::parameter_sets;
use std::path::Path;

/// Reads the values of the file that an experiment names, if it names one.
///
/// # Errors
///
/// A file that cannot be read or is none of SSP; values that are Strings.
pub(super) fn read(
    session: &Session,
    entry: &mut ExperimentEntry,
    folder: &Path,
    origins: &mut Origins,
) -> Result<(), Fault> {
    let Some(file) = entry.set.file.clone() else { return Ok(()) };
    let (path, shown) = (folder.join(&file), file.display());
    let set = parameter_sets::read(session, &path)?;
    origins.add(format!("`{shown}`"), &session.read_bytes(&path)?);
    for own in set.parameters {
        let value = match own.value {
            ParameterValue::Number(value) => ValueEntry::Number(value),
            ParameterValue::Truth(value) => ValueEntry::Truth(value),
            ParameterValue::Text(_) => bail!(
                BAD_FMU,
                "`{}` in `{shown}` is a String, which an experiment cannot set", own.name;
                help: "remove it there, and modify the model: `model = \"Class(name = …)\"`"
            ),
        };
        entry.set.units.extend(own.unit.map(|unit| (own.name.clone(), unit)));
        entry.set.values.insert(own.name, value);
    }
    Ok(())
}

/// Refuses values in other units than those of the model.
///
/// # Errors
///
/// The file says another unit than the model.
pub(super) fn check(entry: &ExperimentEntry, model: &dyn Model) -> Result<(), Fault> {
    for (name, unit) in &entry.set.units {
        let own = model.unit(name).filter(|own| !own.is_empty());
        if let Some(own) = own.filter(|own| own != unit) {
            let file = entry.set.file.clone().unwrap_or_default();
            bail!(
                BAD_FMU,
                "`{name}` in `{}` is in {unit}, but in {own} in the model", file.display();
                help: "write its value there in {own}"
            );
        }
    }
    Ok(())
}
