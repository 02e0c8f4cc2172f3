//! The file that a problem is written in: TOML.

use super::places::{self, ExperimentPlaces, Places};
use crate::bail;
use crate::diag::{Diagnostic, Fault};
use crate::registry::BAD_OPTION;
use crate::source::{SourceId, Span};
use indexmap::IndexMap;
use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::path::PathBuf;

/// A problem as the file says it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ProblemFile {
    pub title: Option<String>,
    /// `Class` or `Class(modification)`; empty for the only class of the files.
    #[serde(default)]
    pub model: String,
    /// Modelica files and folders, relative to the problem's file.
    #[serde(default)]
    pub files: Vec<PathBuf>,
    pub parameters: IndexMap<String, ParameterEntry>,
    pub experiment: Vec<ExperimentEntry>,
    pub fitness: Option<OneOrMany>,
    #[serde(default)]
    pub method: MethodEntry,
    #[serde(default)]
    pub stop: StopEntry,
    pub seed: Option<[f64; 6]>,
    /// How often to search, each time with another seed.
    pub searches: Option<usize>,
    #[serde(default)]
    pub checkpoint: CheckpointEntry,
    /// Prediction bands: whether, or of which variables beside the measured ones.
    pub bands: Option<BandsEntry>,
    /// The next measurement.
    pub design: Option<DesignEntry>,
    /// Inequalities between parameters.
    #[serde(default)]
    pub constraints: Vec<String>,
    /// Fits to data drawn anew.
    pub bootstrap: Option<BootstrapEntry>,
    /// Markov chains.
    pub posterior: Option<PosteriorEntry>,
    /// Where its entries are written.
    #[serde(skip)]
    pub places: Places,
}

/// A parameter: free within a range, or fixed, or tied to others.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ParameterEntry {
    pub min: Option<f64>,
    pub max: Option<f64>,
    /// `linear` or `log`.
    pub scale: Option<String>,
    pub start: Option<f64>,
    pub unit: Option<String>,
    pub fixed: Option<f64>,
    /// An expression of other parameters.
    pub tied: Option<String>,
    /// The name is that of a state, whose initial value is meant.
    #[serde(default)]
    pub initial: bool,
    /// Every experiment has its own.
    #[serde(default)]
    pub per_experiment: bool,
    /// What is known of it without the data.
    pub prior: Option<PriorEntry>,
}

/// An experiment.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ExperimentEntry {
    pub name: Option<String>,
    pub data: PathBuf,
    /// The variable that the outputs were measured over; `time` unless given.
    pub x: Option<Column>,
    /// Variables that were measured.
    pub outputs: IndexMap<String, Column>,
    /// Inputs of the model that follow columns of the data.
    #[serde(default)]
    pub inputs: IndexMap<String, Column>,
    /// The column of time for the inputs; that of X unless given.
    pub input_time: Option<String>,
    /// Values of parameters in this experiment.
    #[serde(default)]
    pub set: IndexMap<String, f64>,
    /// Initial values of states in this experiment.
    #[serde(default)]
    pub start: IndexMap<String, f64>,
    pub weight: Option<f64>,
    /// Not used for the fit, compared at the end.
    #[serde(default)]
    pub validation: bool,
    /// Before it all derivatives were zero.
    #[serde(default)]
    pub steady_state: bool,
    pub stop_time: Option<f64>,
    pub tolerance: Option<f64>,
    pub integrator: Option<String>,
    /// Steps after which a simulation is given up.
    pub max_steps: Option<u64>,
    /// Seconds on the clock after which a simulation is given up.
    pub max_seconds: Option<f64>,
    /// Where its entries are written.
    #[serde(skip)]
    pub places: ExperimentPlaces,
}

/// A column of the data: its name, or its name with more.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub(super) enum Column {
    Name(String),
    More(ColumnEntry),
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ColumnEntry {
    /// For `x`: the variable of the model.
    pub variable: Option<String>,
    pub column: Option<String>,
    /// The unit of the column; must be that of the variable after `factor`.
    pub unit: Option<String>,
    /// The column's values times this are in the variable's unit.
    pub factor: Option<f64>,
    /// For an input: `hold` or `linear` between its samples.
    pub interpolation: Option<String>,
    pub weight: Option<f64>,
    /// Standard deviation of the measurement.
    pub sigma: Option<SigmaEntry>,
    /// How the errors are distributed: `normal` or `lognormal`.
    pub error: Option<String>,
    /// Seconds by which it is measured later: a number or a parameter.
    pub delay: Option<DelayEntry>,
}

/// A number, or the name of a parameter of the problem that is not one of the model.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub(super) enum DelayEntry {
    Seconds(f64),
    Parameter(String),
}

/// A standard deviation: a number, or words for a column, a formula or `estimate`.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub(super) enum SigmaEntry {
    Number(f64),
    Words(String),
}

#[derive(Debug, Deserialize)]
#[serde(untagged)]
pub(super) enum OneOrMany {
    One(String),
    Many(Vec<String>),
    /// A name with settings: `{ name = "huber", delta = 2 }`.
    Set(FitnessEntry),
}

/// A fitness function or an operator with its settings.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct FitnessEntry {
    pub name: String,
    #[serde(flatten)]
    pub settings: IndexMap<String, f64>,
}

/// The method: its name and its settings.
#[derive(Debug, Default, Deserialize)]
pub(super) struct MethodEntry {
    pub name: Option<String>,
    /// Whether least squares refine the result.
    pub polish: Option<bool>,
    pub sampling: Option<OperatorEntry>,
    pub selection: Option<OperatorEntry>,
    pub crossover: Option<OperatorEntry>,
    pub mutation: Option<OperatorEntry>,
    pub survival: Option<OperatorEntry>,
    #[serde(flatten)]
    pub settings: IndexMap<String, f64>,
}

/// An operator of the genetic algorithm.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum OperatorEntry {
    /// How often the usual one takes place.
    Frequency(f64),
    /// A name, which may have settings behind it: `sbx(eta = 5)`.
    Name(String),
    /// `{ name = "sbx", eta = 5 }`.
    Set(FitnessEntry),
}

impl<'de> Deserialize<'de> for OperatorEntry {
    fn deserialize<D: Deserializer<'de>>(reader: D) -> Result<OperatorEntry, D::Error> {
        reader.deserialize_any(OperatorVisitor)
    }
}

struct OperatorVisitor;

impl<'de> Visitor<'de> for OperatorVisitor {
    type Value = OperatorEntry;

    fn expecting(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter
            .write_str("an operator, such as \"sbx\" or { name = \"sbx\", eta = 5 }, or a number")
    }

    fn visit_f64<E>(self, value: f64) -> Result<OperatorEntry, E> {
        Ok(OperatorEntry::Frequency(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<OperatorEntry, E> {
        Ok(OperatorEntry::Frequency(value as f64))
    }

    fn visit_str<E>(self, name: &str) -> Result<OperatorEntry, E> {
        Ok(OperatorEntry::Name(name.to_owned()))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<OperatorEntry, A::Error> {
        FitnessEntry::deserialize(MapAccessDeserializer::new(map)).map(OperatorEntry::Set)
    }
}

impl MethodEntry {
    /// The operators that were chosen, with their kinds, in the order of a generation.
    pub(super) fn operators(&self) -> impl Iterator<Item = (&'static str, &OperatorEntry)> {
        let all = [
            ("sampling", &self.sampling),
            ("selection", &self.selection),
            ("crossover", &self.crossover),
            ("mutation", &self.mutation),
            ("survival", &self.survival),
        ];
        all.into_iter().filter_map(|(kind, entry)| Some((kind, entry.as_ref()?)))
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StopEntry {
    pub generations: Option<u64>,
    pub evaluations: Option<u64>,
    pub seconds: Option<f64>,
    pub target: Option<f64>,
    pub stagnation: Option<u64>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CheckpointEntry {
    pub generations: Option<u64>,
    pub seconds: Option<f64>,
}

/// `true`, `false`, or names of variables.
#[derive(Debug, Deserialize)]
#[serde(untagged)]
pub(super) enum BandsEntry {
    Wanted(bool),
    Variables(Vec<String>),
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DesignEntry {
    /// How many points are to be added.
    pub points: Option<usize>,
    /// Where X may be chosen.
    pub range: Option<[f64; 2]>,
    /// Variables that could be measured besides, with the standard deviation of a measurement.
    #[serde(default)]
    pub outputs: IndexMap<String, f64>,
}

/// `"uniform"`, `{ mean, sd }` or `{ median, factor }`.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub(super) enum PriorEntry {
    Name(String),
    Numbers(PriorNumbers),
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PriorNumbers {
    pub mean: Option<f64>,
    pub sd: Option<f64>,
    pub median: Option<f64>,
    pub factor: Option<f64>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BootstrapEntry {
    pub samples: Option<usize>,
    /// `residuals`, `parametric` or `cases`.
    pub resampling: Option<String>,
    /// `bca`, `percentile` or `basic`.
    pub interval: Option<String>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PosteriorEntry {
    /// Draws of each chain at most.
    pub samples: Option<usize>,
}

/// Reads a problem.
///
/// # Errors
///
/// What is wrong with the text, at its place.
pub(super) fn read(source: SourceId, text: &str) -> Result<ProblemFile, Diagnostic> {
    let mut file: ProblemFile = toml::from_str(text).map_err(|error| {
        let range = error.span().unwrap_or(0..0);
        let span = Span { source, start: range.start as u32, end: range.end as u32 };
        refusal(error.message()).at(span)
    })?;
    file.places = places::places(source, text);
    for (entry, places) in file.experiment.iter_mut().zip(&file.places.experiments) {
        entry.places = places.clone();
    }
    Ok(file)
}

/// What the parser says, in the words of TOML and in one line.
fn refusal(message: &str) -> Fault {
    let message = message.lines().collect::<Vec<_>>().join("; ");
    let message = message.replace("expected a map", "expected a table");
    let message = message.replace("expected a sequence", "expected an array");
    let message = message.replace("invalid type: map", "invalid type: table");
    let message = message.replace("invalid type: sequence", "invalid type: array");
    let fault = crate::fault!(BAD_OPTION, "{}", message.trim_end_matches('.'));
    match message.contains("expected a table") {
        true => fault.help("a table begins with its name in brackets, once; below it there are lines `name = value`"),
        false => fault,
    }
}

impl ColumnEntry {
    pub(super) fn named(column: Option<String>) -> ColumnEntry {
        ColumnEntry {
            variable: None,
            column,
            unit: None,
            factor: None,
            interpolation: None,
            weight: None,
            sigma: None,
            error: None,
            delay: None,
        }
    }
}

impl Column {
    /// With the variable's name for what is not said.
    pub(super) fn entry(&self) -> ColumnEntry {
        match self {
            Column::Name(column) => ColumnEntry::named(Some(column.clone())),
            Column::More(entry) => entry.clone(),
        }
    }
}

/// The kinds of parameter that an entry may be.
pub(super) enum Role {
    Free { range: [f64; 2], logarithmic: Option<bool> },
    Fixed(f64),
    Tied(String),
}

impl ParameterEntry {
    /// What the entry says.
    ///
    /// # Errors
    ///
    /// Where it says several things or nothing.
    pub(super) fn role(&self, name: &str) -> Result<Role, crate::diag::Fault> {
        let logarithmic = match self.scale.as_deref() {
            None => None,
            Some("log" | "logarithmic") => Some(true),
            Some("linear") => Some(false),
            Some(other) => {
                bail!(BAD_OPTION, "the scale of `{name}` is `{other}`"; help: "write \"linear\" or \"log\"")
            }
        };
        match (self.min, self.max, self.fixed, &self.tied) {
            (Some(min), Some(max), None, None) => Ok(Role::Free { range: [min, max], logarithmic }),
            (None, None, Some(value), None) => Ok(Role::Fixed(value)),
            (None, None, None, Some(expression)) => Ok(Role::Tied(expression.clone())),
            _ => bail!(
                BAD_OPTION,
                "`{name}` must have either `min` and `max`, or `fixed`, or `tied`";
                help: "write for example `{name} = {{ min = 0.1, max = 10 }}`"
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_another_type_are_refused_in_the_words_of_toml() {
        let refused = |text: &str| read(SourceId::NONE, text).expect_err("a refusal");
        let twice = refused("[[parameters]]\nname = \"k\"\n");
        assert_eq!(twice.message, "invalid type: array, expected a table");
        assert!(twice.helps.iter().any(|help| help.contains("brackets")));
        assert!(refused("searches = \"five\"\n").helps.is_empty());
    }
}
