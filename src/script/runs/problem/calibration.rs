//! The calibrated model as Modelica: the model of the problem with what its file sets and what was
//! found. Modelica modifies arrays as a whole, so that elements are written with their neighbors.

use super::file::{ProblemFile, Role, ValueEntry};
use super::{deviation, dynamics, enclosing_class};
use crate::codegen::Program;
use crate::identify::problem::{CalibratedModel, Solution, SolvedParameter, modelica_number};
use crate::source::Span;
use crate::syntax::print;
use indexmap::IndexMap;

/// What a problem's file says about the parameters of its model.
pub(super) struct Calibration {
    entries: Vec<Entry>,
    /// The parameters of the model that can be set, with their values.
    parameters: Vec<(String, f64)>,
    /// The scalar variables of the model.
    variables: Vec<String>,
}

struct Entry {
    name: String,
    /// The initial value of a state.
    initial: bool,
    /// As the file says it; `None` for the value that was found.
    text: Option<String>,
}

/// Elements of an array by their subscripts, as they are written.
type Elements = IndexMap<Vec<usize>, String>;

impl Calibration {
    pub(super) fn of(file: &ProblemFile, program: &Program) -> Calibration {
        let shared = file
            .parameters
            .iter()
            .filter(|(name, one)| !one.per_experiment && !dynamics::is_delay(file, name))
            .filter(|(name, _)| program.find_parameter(&deviation::parameter(name)).is_err())
            // Names in the `set` of experiments are none of the model.
            .filter(|(name, one)| {
                matches!(one.role(name), Ok(Role::Fixed(ValueEntry::Text(_))))
                    || program.variables().iter().any(|own| *own.name == ***name)
            });
        let entry = |(name, parameter): (&String, &super::file::ParameterEntry)| {
            let text = match parameter.role(name).ok()? {
                Role::Free { .. } => None,
                Role::Fixed(ValueEntry::Truth(value)) => Some(value.to_string()),
                Role::Fixed(ValueEntry::Number(value)) => Some(modelica_number(value)),
                Role::Fixed(text @ ValueEntry::Text(_)) => {
                    let at = program.find_parameter(name).ok();
                    let base = at.map(|at| &program.parameters()[at].base);
                    let declared = ("", base);
                    let literal = enclosing_class::value(&text, (name, Span::NONE), declared);
                    let literal = literal.ok()?;
                    Some(print::expression(&literal))
                }
                Role::Tied(expression) => Some(expression),
            };
            Some(Entry { name: name.clone(), initial: parameter.initial, text })
        };
        let known = program.parameters().iter();
        Calibration {
            entries: shared.filter_map(entry).collect(),
            parameters: known.map(|one| (one.name.to_string(), one.default)).collect(),
            variables: program.variables().iter().map(|one| one.name.to_string()).collect(),
        }
    }

    /// The modifications of the model with the values of a solution.
    pub(super) fn model(&self, solution: &Solution) -> CalibratedModel {
        let mut model = CalibratedModel::default();
        let mut arrays: IndexMap<(String, bool), Elements> = IndexMap::new();
        for entry in &self.entries {
            let found = solution.parameters.iter().find(|one| one.name == entry.name);
            let value = entry.text.clone().or(found.map(|one| modelica_number(one.value)));
            let Some(value) = value else { continue };
            let attribute = if entry.initial { ".start" } else { "" };
            model.assignments.push(format!("{}{attribute} = {value};", entry.name));
            match without_subscripts(&entry.name) {
                (path, indices) if indices.is_empty() => {
                    model.modifications.push(match entry.initial {
                        true => format!("{path}(start = {value}, fixed = true)"),
                        false => format!("{path} = {value}"),
                    })
                }
                (path, indices) => {
                    arrays.entry((path, entry.initial)).or_default().insert(indices, value);
                }
            }
        }
        for ((path, initial), elements) in arrays {
            match self.whole(&path, initial, &elements) {
                Some(modification) => model.modifications.push(modification),
                None => model.remarks.extend(elements.iter().map(|(indices, value)| {
                    let what = if initial { "the initial value of " } else { "" };
                    format!(
                        "not set, because other elements of the array are not known: {what}{path} \
                         {indices:?} = {value}"
                    )
                })),
            }
        }
        let is_elsewhere =
            |own: &&SolvedParameter| !self.entries.iter().any(|entry| entry.name == own.name);
        model.remarks.extend(solution.parameters.iter().filter(is_elsewhere).map(|own| {
            let why = match own.name.split_once('@') {
                Some((_, experiment)) => format!("the value of {experiment} alone"),
                None => "not a parameter of the model".to_owned(),
            };
            format!("not set, because it is {why}: {} = {}", own.name, modelica_number(own.value))
        }));
        model
    }

    /// The modification of an array, if all of its elements are known.
    fn whole(&self, path: &str, initial: bool, given: &Elements) -> Option<String> {
        let mut elements = given.clone();
        let same = |name: &str| {
            let (own, indices) = without_subscripts(name);
            (own == path).then_some(indices)
        };
        if !initial {
            for (name, value) in &self.parameters {
                if let Some(indices) = same(name) {
                    elements.entry(indices).or_insert_with(|| modelica_number(*value));
                }
            }
        }
        let count = self.variables.iter().filter(|name| same(name).is_some()).count();
        let rank = elements.keys().map(Vec::len).max()?;
        let sizes: Vec<usize> = (0..rank)
            .map(|at| elements.keys().filter_map(|key| key.get(at).copied()).max().unwrap_or(0))
            .collect();
        let values = nested(&elements, &sizes, &mut Vec::new())?;
        if count != elements.len() || elements.values().any(|value| value == "NaN") {
            return None;
        }
        let parts: Vec<&str> = path.split('.').collect();
        let (last, around) = parts.split_last()?;
        let own = match initial {
            true => format!("{last}(start = {values}, each fixed = true)"),
            false => format!("{last} = {values}"),
        };
        Some(around.iter().rev().fold(own, |inner, part| format!("{part}({inner})")))
    }
}

/// A name without its subscripts, and these.
fn without_subscripts(name: &str) -> (String, Vec<usize>) {
    let name = crate::name::Name::parse(name);
    let mut indices = Vec::new();
    let parts: Vec<String> = name
        .parts
        .iter()
        .map(|part| match part.subscripted() {
            Some((array, own)) => {
                indices.extend(own);
                array.to_string()
            }
            None => part.to_string(),
        })
        .collect();
    (parts.join("."), indices)
}

/// `{{1, 2}, {3, 4}}`; `None` where an element is missing.
fn nested(elements: &Elements, sizes: &[usize], at: &mut Vec<usize>) -> Option<String> {
    let Some(size) = sizes.get(at.len()) else { return elements.get(at).cloned() };
    let mut parts = Vec::new();
    for index in 1..=*size {
        at.push(index);
        parts.push(nested(elements, sizes, at)?);
        at.pop();
    }
    Some(format!("{{{}}}", parts.join(", ")))
}
