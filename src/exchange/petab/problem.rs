//! What a PEtab problem consists of: the files that its YAML file names, and their rows.

use super::table::{Row, refuse_columns, rows};
use crate::Refusal;
use crate::diag::Fault;
use crate::registry::BAD_OPTION;
use indexmap::IndexMap;
use saphyr::{LoadableYamlNode as _, MarkedYaml};
use std::collections::BTreeMap;

/// The tables of a problem.
pub(super) struct Tables {
    /// The name and the text of the file of the model.
    pub(super) model: (String, String),
    pub(super) language: Language,
    /// Names in the model of those that tables use.
    pub(super) mapping: BTreeMap<String, String>,
    pub(super) parameters: Vec<Row>,
    pub(super) conditions: IndexMap<String, Row>,
    pub(super) observables: Vec<Row>,
    pub(super) measurements: Vec<Row>,
}

/// What the model is written in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Language {
    Sbml,
    /// Modelica, with the name of the class.
    Modelica(String),
}

/// Gives the text of a file beside the YAML file.
pub type ReadFile<'a> = &'a mut dyn FnMut(&str) -> Result<String, Fault>;

/// The YAML file, for faults at the places of its entries.
pub(super) struct File<'a> {
    pub(super) text: &'a str,
}

impl File<'_> {
    /// A fault at an entry, or in the file where there is none.
    pub(super) fn wrong(
        &self,
        entry: Option<&MarkedYaml<'_>>,
        message: impl Into<String>,
    ) -> Refusal {
        self.refusal(entry, Fault::new(BAD_OPTION, message))
    }

    /// The text of a file that an entry names.
    pub(super) fn read(
        &self,
        (name, entry): (&str, &MarkedYaml<'_>),
        read: ReadFile<'_>,
    ) -> Result<String, Refusal> {
        let help = "correct the name, or put the file there: names start from the YAML file";
        read(name).map_err(|fault| self.refusal(Some(entry), fault.help(help)))
    }

    fn refusal(&self, entry: Option<&MarkedYaml<'_>>, fault: Fault) -> Refusal {
        let place = entry.map_or(0..0, |own| {
            let start = self.offset(own.span.start.index());
            let end = self.offset(own.span.end.index()).max(start);
            let line = self.text[start..end].lines().next().unwrap_or_default();
            start..start + line.trim_end().len()
        });
        Refusal::new(place, fault)
    }

    /// Where the character of this number begins.
    fn offset(&self, character: usize) -> usize {
        let mut starts = self.text.char_indices().map(|(at, _)| at);
        starts.nth(character).unwrap_or(self.text.len())
    }
}

/// An entry of a mapping.
pub(super) fn entry<'a, 'i>(own: &'a MarkedYaml<'i>, key: &str) -> Option<&'a MarkedYaml<'i>> {
    own.data.as_mapping_get(key)
}

/// The names of files in an entry, one or a list, with their places.
fn names<'a, 'i>(own: &'a MarkedYaml<'i>, key: &str) -> Vec<(&'a str, &'a MarkedYaml<'i>)> {
    let Some(own) = entry(own, key) else { return Vec::new() };
    let list = own.data.as_sequence().map_or(std::slice::from_ref(own), Vec::as_slice);
    list.iter().filter_map(|one| Some((one.data.as_str()?, one))).collect()
}

/// The documents in a YAML file.
pub(super) fn documents<'i>(file: &File<'i>) -> Result<Vec<MarkedYaml<'i>>, Refusal> {
    MarkedYaml::load_from_str(file.text).map_err(|error| {
        let start = file.offset(error.marker().index());
        let fault = Fault::new(BAD_OPTION, format!("the file is not YAML: {}", error.info()));
        Refusal::new(start..start, fault)
    })
}

/// The tables that the YAML file of a problem in version 1 names.
///
/// # Errors
///
/// What is wrong with it or with a table; several models.
pub(super) fn read(
    file: &File<'_>,
    document: &MarkedYaml<'_>,
    read: ReadFile<'_>,
) -> Result<Tables, Refusal> {
    let problem = problem(file, document)?;
    let models = names(problem, "sbml_files");
    let [(model, place)] = models[..] else {
        let entry = entry(problem, "sbml_files").or(Some(problem));
        let message = format!("the problem has {} models; one is supported", models.len());
        return Err(file.wrong(entry, message));
    };
    let text = file.read((model, place), read)?;
    let mut all = |own: &MarkedYaml<'_>, key: &str, required: &[&str]| {
        all_rows((file, own), key, required, read)
    };
    let parameters =
        all(document, "parameter_file", &["parameterId", "parameterScale", "estimate"])?;
    let observables =
        all(problem, "observable_files", &["observableId", "observableFormula", "noiseFormula"])?;
    let required = ["observableId", "simulationConditionId", "measurement", "time"];
    let measurements = all(problem, "measurement_files", &required)?;
    refuse_columns(&parameters, &["priorDistribution", "priorParameters"], 1)?;
    refuse_columns(&observables, &["observablePlaceholders", "noisePlaceholders"], 1)?;
    let mut conditions = IndexMap::new();
    for row in all(problem, "condition_files", &["conditionId"])? {
        let name = row.required("conditionId")?.to_owned();
        if conditions.contains_key(&name) {
            return Err(row.wrong("a row above has the same condition"));
        }
        conditions.insert(name, row);
    }
    Ok(Tables {
        model: (model.to_owned(), text),
        language: Language::Sbml,
        mapping: BTreeMap::new(),
        parameters,
        conditions,
        observables,
        measurements,
    })
}

/// The rows of all tables that an entry names.
pub(super) fn all_rows(
    (file, own): (&File<'_>, &MarkedYaml<'_>),
    key: &str,
    required: &[&str],
    read: ReadFile<'_>,
) -> Result<Vec<Row>, Refusal> {
    let mut all = Vec::new();
    for (name, place) in names(own, key) {
        let text = file.read((name, place), read)?;
        all.extend(rows(name, &text, required)?);
    }
    match all.is_empty() {
        true => {
            let entry = entry(own, key).or(Some(own));
            Err(file.wrong(entry, format!("`{key}` names no table with rows")))
        }
        false => Ok(all),
    }
}

/// The problem of the file.
fn problem<'a, 'i>(
    file: &File<'_>,
    document: &'a MarkedYaml<'i>,
) -> Result<&'a MarkedYaml<'i>, Refusal> {
    let problems = entry(document, "problems");
    match problems.and_then(|own| own.data.as_sequence()).map(Vec::as_slice) {
        Some([one]) => Ok(one),
        Some(several) => {
            let message = format!("{} problems in one file are not supported", several.len());
            Err(file.wrong(problems, message))
        }
        None => {
            let message = "the entry `problems` is missing: is it a file of PEtab?";
            Err(file.wrong(Some(document), message))
        }
    }
}

/// The version, 1 or 2.
pub(super) fn version(file: &File<'_>, document: &MarkedYaml<'_>) -> Result<u8, Refusal> {
    let version = entry(document, "format_version");
    let text = version.and_then(|own| {
        let integer = own.data.as_integer().map(|number| number.to_string());
        let number = || own.data.as_floating_point().map(|number| number.to_string());
        integer.or_else(number).or_else(|| own.data.as_str().map(str::to_owned))
    });
    match text.as_deref().map(|text| text.split('.').next().unwrap_or_default()) {
        Some("1") => Ok(1),
        Some("2") => Ok(2),
        Some(other) => {
            Err(file.wrong(version, format!("version {other} of PEtab is not supported")))
        }
        None => {
            let message = "the entry `format_version` is missing: is it a file of PEtab?";
            Err(file.wrong(Some(document), message))
        }
    }
}
