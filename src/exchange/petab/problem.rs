//! What a PEtab problem (version 1) consists of: the files that its YAML file names, and their rows.

use super::table::{Row, rows};
use crate::Refusal;
use crate::diag::Fault;
use crate::registry::BAD_OPTION;
use indexmap::IndexMap;
use saphyr::{LoadableYamlNode as _, Yaml};

/// The tables of a problem.
pub(super) struct Tables {
    /// The name of the file of the model.
    pub(super) model: String,
    pub(super) parameters: Vec<Row>,
    pub(super) conditions: IndexMap<String, Row>,
    pub(super) observables: Vec<Row>,
    pub(super) measurements: Vec<Row>,
}

/// Gives the text of a file beside the YAML file.
pub type ReadFile<'a> = &'a mut dyn FnMut(&str) -> Result<String, String>;

fn wrong(message: impl Into<String>) -> Refusal {
    Refusal::new(0..0, Fault::new(BAD_OPTION, message))
}

/// The names of files in an entry: one, or a list.
fn names(entry: &Yaml<'_>, key: &str) -> Vec<String> {
    let own = entry.as_mapping_get(key);
    let one = own.and_then(Yaml::as_str).map(str::to_owned);
    let list = own.and_then(Yaml::as_sequence);
    let list = list.into_iter().flatten().filter_map(|name| name.as_str().map(str::to_owned));
    one.into_iter().chain(list).collect()
}

/// The tables that the YAML file names.
///
/// # Errors
///
/// What is wrong with it or with a table; other versions, several models.
pub(super) fn read(yaml: &str, file: ReadFile<'_>) -> Result<Tables, Refusal> {
    let documents = Yaml::load_from_str(yaml)
        .map_err(|error| wrong(format!("the file is not YAML: {error}")))?;
    let document = documents.first().ok_or_else(|| wrong("the file is empty"))?;
    version(document)?;
    let problems = document.as_mapping_get("problems").and_then(Yaml::as_sequence);
    let problem = match problems.map(Vec::as_slice) {
        Some([one]) => one,
        Some(several) => {
            return Err(wrong(format!("{} problems in one file are not supported", several.len())));
        }
        None => return Err(wrong("the entry `problems` is missing: is it a file of PEtab?")),
    };
    let models = names(problem, "sbml_files");
    let [model] = models.as_slice() else {
        return Err(wrong(format!("the problem has {} models; one is supported", models.len())));
    };
    let mut all = |entry: &Yaml<'_>, key: &str, required: &[&str]| {
        let mut all = Vec::new();
        for name in names(entry, key) {
            let text =
                file(&name).map_err(|error| wrong(format!("cannot read `{name}`: {error}")))?;
            all.extend(rows(&name, &text, required)?);
        }
        match all.is_empty() {
            true => Err(wrong(format!("`{key}` names no table with rows"))),
            false => Ok(all),
        }
    };
    let parameters =
        all(document, "parameter_file", &["parameterId", "parameterScale", "estimate"])?;
    let observables =
        all(problem, "observable_files", &["observableId", "observableFormula", "noiseFormula"])?;
    let required = ["observableId", "simulationConditionId", "measurement", "time"];
    let measurements = all(problem, "measurement_files", &required)?;
    let mut conditions = IndexMap::new();
    for row in all(problem, "condition_files", &["conditionId"])? {
        let name = row.required("conditionId")?.to_owned();
        if conditions.contains_key(&name) {
            return Err(row.wrong("a row above has the same condition"));
        }
        conditions.insert(name, row);
    }
    Ok(Tables { model: model.clone(), parameters, conditions, observables, measurements })
}

/// Refuses other versions than 1.
fn version(document: &Yaml<'_>) -> Result<(), Refusal> {
    let version = document.as_mapping_get("format_version");
    let text = match version {
        Some(version) if version.as_integer().is_some() => {
            version.as_integer().map(|v| v.to_string())
        }
        Some(version) if version.as_floating_point().is_some() => {
            version.as_floating_point().map(|v| v.to_string())
        }
        Some(version) => version.as_str().map(str::to_owned),
        None => None,
    };
    match text.as_deref().map(|text| text.split('.').next().unwrap_or_default()) {
        Some("1") => Ok(()),
        Some(other) => Err(wrong(format!("version {other} of PEtab is not supported"))),
        None => Err(wrong("the entry `format_version` is missing: is it a file of PEtab?")),
    }
}
