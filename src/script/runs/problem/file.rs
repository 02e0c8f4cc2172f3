//! A problem as a TOML file or a record of a script states it.

use super::places::Places;
use super::refusal;
use crate::diag::Diagnostic;
use crate::models::filter::Ahead;
use crate::registry::BAD_OPTION;
use crate::source::{SourceId, Span};
use crate::{bail, fault};
use indexmap::IndexMap;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::ops::Deref;
use std::path::PathBuf;

/// A problem as the file says it.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ProblemFile {
    pub title: Option<String>,
    /// `Class` or `Class(modification)`; empty for the only class of the files.
    #[serde(default)]
    pub model: String,
    /// Modelica files and folders, relative to the problem's file.
    #[serde(default)]
    pub files: Vec<PathBuf>,
    #[serde(default)]
    pub parameters: IndexMap<String, ParameterEntry>,
    /// Process noise of states.
    #[serde(default)]
    pub noise: IndexMap<String, NoiseEntry>,
    /// Samples over which the report predicts, with process noise.
    pub prediction_steps: Option<usize>,
    pub experiment: Vec<ExperimentEntry>,
    /// That errors of outputs at one instant are correlated, in all experiments.
    pub covariance: Option<CovarianceEntry>,
    pub fitness: Option<OneOrMany>,
    #[serde(default)]
    pub method: MethodEntry,
    #[serde(default)]
    pub stop: StopEntry,
    pub seed: Option<[f64; 6]>,
    /// Number of searches with different seeds.
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
    /// Fits to resampled data.
    pub bootstrap: Option<BootstrapEntry>,
    /// Markov chains.
    pub posterior: Option<PosteriorEntry>,
    /// What is known of it beside its entries.
    #[serde(skip)]
    pub context: Context,
}

/// What is known of a problem beside its entries.
#[derive(Debug, Clone, Default)]
pub(super) struct Context {
    /// What its process noise is compared with.
    pub filtering: Filtering,
    /// Where its entries are written.
    pub places: Places,
    /// The text for the report.
    pub text: String,
}

impl ProblemFile {
    /// All entries, in their order.
    pub(super) fn table(&self) -> toml::Table {
        // What could be read once can be read again.
        self.context.text.parse().unwrap_or_default()
    }
}

/// A parameter: free within a range, or fixed, or tied to others.
#[derive(Debug, Clone)]
pub(super) struct ParameterEntry(pub ParameterTable);

impl Deref for ParameterEntry {
    type Target = ParameterTable;

    fn deref(&self) -> &ParameterTable {
        &self.0
    }
}

/// The value of a parameter or the initial value of a state.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum ValueEntry {
    Number(f64),
    Truth(bool),
    /// A String, or a literal of an enumeration.
    Text(String),
}

/// What the table of a parameter holds.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ParameterTable {
    pub min: Option<f64>,
    pub max: Option<f64>,
    /// `linear` or `log`.
    pub scale: Option<String>,
    pub start: Option<f64>,
    pub unit: Option<String>,
    pub fixed: Option<ValueEntry>,
    /// An expression of other parameters.
    pub tied: Option<String>,
    /// The name is that of a state, whose initial value is meant.
    #[serde(default)]
    pub initial: bool,
    /// Every experiment has its own.
    #[serde(default)]
    pub(crate) per_experiment: bool,
    /// What is known of it without the data.
    pub prior: Option<PriorEntry>,
}

/// An experiment.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ExperimentEntry {
    pub name: Option<String>,
    pub data: PathBuf,
    /// The variable that the outputs were measured over; `time` unless given.
    pub x: Option<Column>,
    /// Variables that were measured, or parts of a spectrum.
    pub outputs: IndexMap<String, Column>,
    /// The response to oscillations that was measured, in place of a course of time.
    pub spectrum: Option<SpectrumEntry>,
    /// Inputs of the model that follow columns of the data.
    #[serde(default)]
    pub inputs: IndexMap<String, Column>,
    /// The column of time for the inputs; that of X unless given.
    pub(crate) input_time: Option<String>,
    /// Values of parameters in this experiment.
    #[serde(default)]
    pub set: SetEntry,
    /// Initial values of states in this experiment.
    #[serde(default)]
    pub start: IndexMap<String, ValueEntry>,
    /// That errors of outputs at one instant are correlated.
    pub covariance: Option<CovarianceEntry>,
    pub weight: Option<f64>,
    /// Not used for the fit, compared at the end.
    #[serde(default)]
    pub validation: bool,
    /// Before it all derivatives were zero.
    #[serde(default)]
    pub(crate) steady_state: bool,
    /// Whether its simulation comes to rest before 0.
    #[serde(default)]
    pub(crate) rest: bool,
    /// When its simulation begins, in seconds; its initial values are those of this time.
    pub start_time: Option<f64>,
    pub stop_time: Option<f64>,
    /// Where its rows are cut into parts with separate initial values.
    pub segments: Option<SegmentsEntry>,
    pub tolerance: Option<f64>,
    pub integrator: Option<String>,
    /// Steps after which a simulation is given up.
    pub max_steps: Option<u64>,
    /// Seconds on the clock after which a simulation is given up.
    pub(crate) max_seconds: Option<f64>,
    /// Where its entries are written.
    #[serde(skip)]
    pub places: Places,
}

/// Which spectrum of the model was measured.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SpectrumEntry {
    /// The input of the model that oscillates.
    pub input: String,
    /// The variable that answers.
    pub output: String,
    /// What their ratio is multiplied with; −1 where a current flows out.
    pub factor: Option<f64>,
    /// When the operating point is reached, in seconds; the start of the simulation unless given.
    pub at: Option<f64>,
    /// `modulus`, `unit` or `proportional`.
    pub weighting: Option<String>,
}

/// Values of parameters: a table, or the name of a file of SSP, whose values are read into it.
#[derive(Debug, Clone, Default)]
pub(super) struct SetEntry {
    pub file: Option<PathBuf>,
    pub values: IndexMap<String, ValueEntry>,
}

/// The weight of a series.
#[derive(Debug, Clone, Copy)]
pub(super) struct WeightEntry(pub f64);

/// Where an experiment is cut.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum SegmentsEntry {
    /// At gaps, and where time starts again.
    Auto,
    /// At these times, in seconds.
    Times(Vec<f64>),
}

/// A column of the data: its name, several names of replicate measurements, or names with more.
#[derive(Debug, Clone)]
pub(super) enum Column {
    Name(String),
    Replicates(Vec<String>),
    More(Box<ColumnEntry>),
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ColumnEntry {
    /// For `x`: the variable of the model.
    pub variable: Option<String>,
    pub column: Option<String>,
    /// Columns of replicate measurements of an output.
    #[serde(default)]
    pub columns: Vec<String>,
    /// The unit of the column; must be that of the variable after `factor`.
    pub unit: Option<String>,
    /// The column's values times this are in the variable's unit.
    pub factor: Option<f64>,
    /// For an input: `hold` or `linear` between its samples.
    pub interpolation: Option<String>,
    pub weight: Option<WeightEntry>,
    /// Standard deviation of the measurement.
    pub sigma: Option<SigmaEntry>,
    /// Of relative data, the scale and the offset of the simulation, which are estimated.
    pub scale: Option<ScaleEntry>,
    pub offset: Option<OffsetEntry>,
    /// How the errors are distributed: `normal`, `lognormal`, `laplace`, `loglaplace`, `student` or
    /// `poisson`.
    pub error: Option<String>,
    /// Limits of detection, and of saturation: values at or beyond them are known to be there only.
    pub below: Option<LimitEntry>,
    pub above: Option<LimitEntry>,
    /// Those of the distribution of Student.
    pub degrees_of_freedom: Option<f64>,
    /// Seconds by which it is measured later: a number or a parameter.
    pub delay: Option<DelayEntry>,
    /// What its values are multiplied with, to see whether they fit better so.
    #[serde(skip)]
    pub tried: Option<f64>,
}

/// A covariance: a matrix for all outputs, `estimate`, or a table.
#[derive(Debug, Clone)]
pub(super) enum CovarianceEntry {
    Estimated(String),
    Given(Vec<Vec<f64>>),
    More(CovarianceTable),
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CovarianceTable {
    /// The outputs that it is meant for; all unless given.
    #[serde(default)]
    pub outputs: Vec<String>,
    /// Covariances, or `estimate`.
    pub matrix: Option<MatrixEntry>,
    /// Correlations, where the outputs have their sigmas.
    pub correlation: Option<Vec<Vec<f64>>>,
    /// Experiments that name one group share an estimated covariance.
    pub group: Option<String>,
}

/// Covariances, or `estimate`.
#[derive(Debug, Clone)]
pub(super) enum MatrixEntry {
    Estimated(String),
    Given(Vec<Vec<f64>>),
}

/// A scale that is estimated: `estimate`, a name that outputs share, or a table.
#[derive(Debug, Clone)]
pub(super) enum ScaleEntry {
    Words(String),
    More(ScaleTable),
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ScaleTable {
    /// What outputs share it by.
    pub name: Option<String>,
    /// `positive` or `any`.
    pub sign: Option<String>,
}

/// An offset that is estimated: `estimate`, or a name that outputs share.
#[derive(Debug, Clone)]
pub(super) struct OffsetEntry(pub String);

/// A limit of measured values: a number, or the name of a column.
#[derive(Debug, Clone)]
pub(super) enum LimitEntry {
    Number(f64),
    Column(String),
}

/// A number, or the name of a parameter of the problem that is not one of the model.
#[derive(Debug, Clone)]
pub(super) enum DelayEntry {
    Seconds(f64),
    Parameter(String),
}

/// A standard deviation: a number, or words for a column, a formula or `estimate`.
#[derive(Debug, Clone)]
pub(super) enum SigmaEntry {
    Number(f64),
    Words(String),
}

/// What predictions are made with.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) enum Filtering {
    /// Noise and measurements.
    #[default]
    Filtered,
    /// Measurements and the noise that is given; what is estimated is 0.
    WithoutNoise,
    /// No measurements; also at these times, as in what follows.
    Simulated(MoreTimes),
    /// Noise and measurements, and after them those that are later.
    Smoothed(MoreTimes),
    /// In the experiments of these names, the states that the filter has found so many samples before.
    Ahead(BTreeMap<String, Ahead>, MoreTimes),
}

/// Times at which states are estimated besides those of the rows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct MoreTimes {
    /// The seconds between them.
    pub every: Option<f64>,
    /// The last one, where it is not that of the last row.
    pub until: Option<f64>,
}

/// Process noise of a state: a number, `estimate`, or a table.
#[derive(Debug, Clone)]
pub(super) enum NoiseEntry {
    Number(f64),
    Words(String),
    More(NoiseTable),
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct NoiseTable {
    /// The root of its spectral density, a number or `estimate`.
    pub value: Option<SigmaEntry>,
    pub min: Option<f64>,
    pub max: Option<f64>,
    pub start: Option<f64>,
    /// The standard deviation of the initial value.
    pub initial: Option<f64>,
}

#[derive(Debug, Clone)]
pub(super) enum OneOrMany {
    One(String),
    Many(Vec<String>),
    /// A name with settings: `{ name = "huber", delta = 2 }`.
    Set(FitnessEntry),
}

impl OneOrMany {
    /// The names of all.
    pub(super) fn names(&self) -> Vec<&str> {
        match self {
            OneOrMany::One(name) => vec![name],
            OneOrMany::Many(names) => names.iter().map(String::as_str).collect(),
            OneOrMany::Set(entry) => vec![&entry.name],
        }
    }
}

/// A fitness function or an operator with its settings.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct FitnessEntry {
    pub name: String,
    #[serde(flatten)]
    pub settings: IndexMap<String, f64>,
}

/// The method: its name and its settings.
#[derive(Debug, Clone, Default, Deserialize)]
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
    /// A name, which may be followed by settings: `sbx(eta = 5)`.
    Name(String),
    /// `{ name = "sbx", eta = 5 }`.
    Set(FitnessEntry),
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

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StopEntry {
    pub generations: Option<u64>,
    pub evaluations: Option<u64>,
    pub seconds: Option<f64>,
    pub target: Option<f64>,
    pub stagnation: Option<u64>,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CheckpointEntry {
    pub generations: Option<u64>,
    pub seconds: Option<f64>,
}

/// `true`, `false`, or names of variables.
#[derive(Debug, Clone)]
pub(super) enum BandsEntry {
    Requested(bool),
    Variables(Vec<String>),
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DesignEntry {
    /// How many points are to be added.
    pub points: Option<usize>,
    /// Where X may be chosen.
    pub range: Option<[f64; 2]>,
    /// Variables that could be measured besides, with the standard deviation of a measurement.
    #[serde(default)]
    pub outputs: IndexMap<String, f64>,
    /// Operating points at which spectra could be measured.
    #[serde(default)]
    pub operating_points: Vec<OperatingPointEntry>,
}

/// An operating point of all spectra: what it has instead of theirs.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct OperatingPointEntry {
    /// When it is reached, s.
    pub at: Option<f64>,
    /// Values of parameters.
    #[serde(default)]
    pub set: IndexMap<String, ValueEntry>,
}

/// `"uniform"`, `"loguniform"`, `{ mean, sd }` or `{ median, factor }`.
#[derive(Debug, Clone)]
pub(super) enum PriorEntry {
    Name(String),
    Numbers(PriorNumbers),
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PriorNumbers {
    pub mean: Option<f64>,
    pub sd: Option<f64>,
    pub median: Option<f64>,
    pub factor: Option<f64>,
    /// Of a distribution of Laplace.
    pub scale: Option<f64>,
    /// `normal`, `laplace` or `uniform`.
    pub distribution: Option<String>,
    /// Of a uniform distribution; the range unless given.
    pub min: Option<f64>,
    pub max: Option<f64>,
    /// The base of the logarithm whose density is meant.
    pub base: Option<f64>,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BootstrapEntry {
    pub samples: Option<usize>,
    /// `residuals`, `parametric` or `cases`.
    pub resampling: Option<String>,
    /// `bca`, `percentile` or `basic`.
    pub interval: Option<String>,
}

#[derive(Debug, Clone, Default, Deserialize)]
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
    let mut file: ProblemFile =
        toml::from_str(text).map_err(|error| refusal::refusal(source, text, &error))?;
    let places = Places::of(source, text);
    file.context = Context { places, text: text.to_owned(), ..Context::default() };
    let table = file.table();
    refusal::printable(&table).map_err(|fault| fault.at(Span::new(source, 0, 0)))?;
    if file.noise.is_empty() && table.contains_key("noise") {
        let fault = fault!(BAD_OPTION, "`[noise]` names no state")
            .help("write a state with its noise, `T = \"estimate\"`, or remove the table");
        return Err(fault.at(file.context.places.at(&["noise"])));
    }
    for (number, entry) in file.experiment.iter_mut().enumerate() {
        let own = file.context.places.within(&["experiment", &number.to_string()]);
        entry.places = own.cloned().unwrap_or_default();
    }
    Ok(file)
}

/// The problem with the entries of `table`, which are written nowhere.
///
/// # Errors
///
/// Entries of another type, too many or missing ones.
pub(super) fn of_table(table: toml::Table) -> Result<ProblemFile, Diagnostic> {
    let file = ProblemFile::deserialize(table.clone());
    let file = file.map_err(|error| refusal::refusal(SourceId::NONE, "", &error))?;
    refusal::printable(&table).map_err(|fault| fault.at(Span::NONE))?;
    let context = Context { text: table.to_string(), ..Context::default() };
    Ok(ProblemFile { context, ..file })
}

impl ColumnEntry {
    pub(super) fn named(column: Option<String>) -> ColumnEntry {
        ColumnEntry {
            variable: None,
            column,
            columns: Vec::new(),
            unit: None,
            factor: None,
            interpolation: None,
            weight: None,
            sigma: None,
            scale: None,
            offset: None,
            error: None,
            below: None,
            above: None,
            degrees_of_freedom: None,
            delay: None,
            tried: None,
        }
    }
}

impl ExperimentEntry {
    /// The name of the experiment with this number, counted from 0.
    pub(super) fn label(&self, number: usize) -> String {
        self.name.clone().unwrap_or_else(|| format!("experiment {}", number + 1))
    }

    /// The outputs with their columns, one for each replicate.
    pub(super) fn all_outputs(&self) -> impl Iterator<Item = (&String, ColumnEntry)> {
        self.outputs.iter().flat_map(|(name, column)| {
            column.replicates().into_iter().map(move |entry| (name, entry))
        })
    }
}

impl ExperimentEntry {
    /// An error about X, which is a column that no variable has the name of: most often of the times.
    pub(super) fn about_x(&self, error: Diagnostic) -> Diagnostic {
        match &self.x {
            Some(Column::Name(column)) => error.help(format!(
                "if `{column}` is the column of the times, write `x = {{ variable = \"time\", \
                 column = \"{column}\" }}`"
            )),
            _ => error,
        }
    }
}

impl Column {
    /// Changes its entry.
    pub(super) fn change(&mut self, change: impl FnOnce(&mut ColumnEntry)) {
        let mut entry = match self {
            Column::Replicates(columns) => {
                ColumnEntry { columns: columns.clone(), ..ColumnEntry::named(None) }
            }
            Column::Name(name) => ColumnEntry::named(Some(name.clone())),
            Column::More(entry) => (**entry).clone(),
        };
        change(&mut entry);
        *self = Column::More(Box::new(entry));
    }

    /// With the variable's name for what is not said; of replicates the first one.
    pub(super) fn entry(&self) -> ColumnEntry {
        match self {
            Column::Name(column) => ColumnEntry::named(Some(column.clone())),
            Column::Replicates(columns) => ColumnEntry::named(columns.first().cloned()),
            Column::More(entry) => {
                let column = entry.column.clone().or_else(|| entry.columns.first().cloned());
                ColumnEntry { column, ..(**entry).clone() }
            }
        }
    }

    /// One entry for each column of an output: of replicate measurements there are several.
    pub(super) fn replicates(&self) -> Vec<ColumnEntry> {
        let columns = match self {
            Column::Replicates(columns) => columns.as_slice(),
            Column::More(entry) => entry.columns.as_slice(),
            Column::Name(_) => &[],
        };
        let one = |column: &String| ColumnEntry { column: Some(column.clone()), ..self.entry() };
        match columns {
            [] => vec![self.entry()],
            columns => columns.iter().map(one).collect(),
        }
    }
}

/// The kinds of parameter that an entry may be.
pub(super) enum Role {
    Free { range: [f64; 2], logarithmic: Option<bool> },
    Fixed(ValueEntry),
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
        let limits = [("min", self.min), ("max", self.max), ("start", self.start)];
        let infinite =
            limits.iter().find(|(_, limit)| limit.is_some_and(|limit| !limit.is_finite()));
        if let Some((which, Some(limit))) = infinite {
            bail!(BAD_OPTION, "`{which}` of `{name}` is {limit}"; help: "write a finite number");
        }
        match (self.min, self.max, &self.fixed, &self.tied) {
            (Some(min), Some(max), None, None) => Ok(Role::Free { range: [min, max], logarithmic }),
            (None, None, Some(value), None) => Ok(Role::Fixed(value.clone())),
            (None, None, None, Some(expression)) => Ok(Role::Tied(expression.clone())),
            _ => bail!(
                BAD_OPTION,
                "`{name}` must have either `min` and `max`, or `fixed`, or `tied`";
                help: "write for example `{name} = {{ min = 0.1, max = 10 }}`"
            ),
        }
    }
}

impl ValueEntry {
    /// The number.
    ///
    /// # Errors
    ///
    /// Strings, `true` and `false`, infinite numbers and NaN.
    pub(super) fn number(&self, name: &str) -> Result<f64, crate::diag::Fault> {
        match self {
            ValueEntry::Number(value) if value.is_finite() => Ok(*value),
            ValueEntry::Number(value) => {
                bail!(BAD_OPTION, "the value of `{name}` is {value}"; help: "write a finite number")
            }
            ValueEntry::Truth(value) => {
                bail!(BAD_OPTION, "the value of `{name}` is {value}"; help: "write a number")
            }
            ValueEntry::Text(text) => {
                bail!(BAD_OPTION, "the value of `{name}` is \"{text}\""; help: "write a number")
            }
        }
    }
}
