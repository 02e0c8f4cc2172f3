//! The solution: what was found, how well it fits, and what the data cannot tell.

use super::grounds::Grounds;
use super::{
    Ending, ErrorModel, FailureRegion, Finding, FindingKind, Importance, Inferred, OtherMinimum,
    Profile, Profiles, RangeEnd, Severity, SolvedCoefficient, SolvedDescent, residual_test,
};
use crate::Descriptions;
use crate::elementary;
use crate::ga::Generation;
use crate::search_record::SearchRecord;
use nalgebra::DMatrix;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Correlations above this are worth a word.
const STRONG: f64 = 0.95;

/// The solution of a problem.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Solution {
    /// What was solved.
    #[serde(flatten)]
    pub subject: Subject,
    /// The smallest value of the first objective.
    pub fitness: f64,
    /// The parameters.
    pub parameters: Vec<SolvedParameter>,
    /// The series with their residuals.
    pub series: Vec<SolvedSeries>,
    /// Series that were not used for the fit.
    pub validation: Vec<SolvedSeries>,
    /// Correlations of the parameters, row by row; `None` where they could not be computed.
    pub correlations: Option<Vec<Vec<Option<f64>>>>,
    /// Condition number of the sensitivities.
    pub condition: Option<f64>,
    /// What must be known about these numbers, most important first.
    #[serde(default)]
    pub findings: Vec<Finding>,
    /// The errors of measurement.
    #[serde(flatten)]
    pub likelihood: Likelihood,
    /// How the search ended.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// What it took.
    #[serde(flatten)]
    pub effort: Effort,
    /// How much each parameter matters, where that was asked before the fit.
    pub importance: Option<Importance>,
    /// Profiles of the parameters, where they were asked.
    pub profiles: Option<Profiles>,
    /// What was inferred beyond the estimates.
    #[serde(default)]
    pub inferred: Inferred,
    /// What the verdicts rest on.
    #[serde(skip)]
    pub grounds: Grounds,
    /// The objectives, where there are several their front.
    #[serde(flatten)]
    pub pareto: Pareto,
    /// What the script has found whose search least squares have ended; `None` where the problem
    /// was solved without a script of its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub script: Option<super::ScriptResult>,
    /// What repeats the run.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// The calibrated model, where the problem says more than its free parameters.
    #[serde(skip)]
    pub calibrated: Option<CalibratedModel>,
    /// The way of the search, for pictures.
    #[serde(skip)]
    pub course: Course,
}

/// What was solved, and how.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Subject {
    /// The heading.
    pub title: String,
    /// The model.
    pub model: String,
    /// The method.
    pub method: String,
    /// The operators that were chosen in place of the method's usual ones: kind, and name with
    /// settings.
    #[serde(default, skip_serializing_if = "indexmap::IndexMap::is_empty")]
    pub operators: indexmap::IndexMap<String, String>,
    /// The name of the first objective.
    pub fitness_name: String,
    /// What the models describe their variables and parameters as.
    #[serde(default, skip_serializing_if = "Descriptions::is_empty")]
    pub descriptions: Descriptions,
}

/// What is known of the errors of measurement, and how the residuals agree with it.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Likelihood {
    /// What was known of the errors of measurement.
    #[serde(default = "one_variance")]
    pub error_model: ErrorModel,
    /// Points less the parameters that the data determine; `None` where that is unknown.
    #[serde(default)]
    pub degrees_of_freedom: Option<f64>,
    /// Half-width of the 95 % intervals by the standard error; `None` where that is unknown.
    #[serde(default)]
    pub quantile: Option<f64>,
    /// The residuals against the given sigmas; `None` where not all are given.
    #[serde(default)]
    pub chi_square: Option<ChiSquare>,
    /// Negative logarithm of the likelihood of normal errors with the given or estimated standard
    /// deviations (maximum likelihood ones); `None` where the fitness is not one of normal errors.
    #[serde(default)]
    pub negative_log_likelihood: Option<f64>,
    /// The covariances of outputs with correlated errors.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub covariances: Vec<super::SolvedCovariance>,
}

/// How a search ended.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Outcome {
    /// Why the run ended.
    pub stop: String,
    /// Whether it ended at a minimum, and how that is known.
    #[serde(default)]
    pub ending: Ending,
    /// The descents by least squares, in their order.
    #[serde(default)]
    pub descents: Vec<SolvedDescent>,
    /// Minima beside the best whose sum of squares lies within the 95 % limit of the likelihood.
    #[serde(default)]
    pub other_minima: Vec<OtherMinimum>,
    /// All searches with different seeds, where there were several; the best is this one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub searches: Vec<SolvedSearch>,
}

/// What a search took.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Effort {
    /// Questions of the method.
    pub generations: u64,
    /// Individuals evaluated.
    pub evaluations: u64,
    /// Simulations that it took; equal genes are simulated once.
    pub simulations: u64,
    /// Further simulations for the statistics.
    pub simulations_for_statistics: u64,
    /// Failed individuals by kind.
    pub failures: indexmap::IndexMap<String, u64>,
    /// Failed individuals by cause.
    pub causes: indexmap::IndexMap<String, u64>,
    /// Where in the search space simulations failed, if that is a region.
    pub failure_region: Option<FailureRegion>,
    /// Settings changed during the run.
    pub changes: Vec<(u64, String, f64)>,
}

/// The objectives and, where there are several, the points of which none is better in all.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Pareto {
    /// Points of the front, where there are several objectives: parameters and objectives.
    pub front: Vec<(Vec<f64>, Vec<f64>)>,
    /// The place in the front that is farthest from the line between its ends.
    pub knee: Option<usize>,
    /// The hypervolume of the front, and the reference point that it is measured from: a tenth of
    /// the front's width beyond its worst values.
    pub hypervolume: Option<(f64, Vec<f64>)>,
    /// Names of the objectives.
    pub objectives: Vec<String>,
}

/// What repeats a run.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Provenance {
    /// The seed; `None` where no random numbers were drawn.
    pub seed: Option<[f64; 6]>,
    /// Version of the program.
    pub version: String,
    /// The problem as it was written; empty where it was put in Rust.
    pub problem: String,
}

/// The way of a search.
#[derive(Debug, Clone, Default)]
pub struct Course {
    /// Every generation: best, mean, worst, failures.
    pub history: Vec<Generation>,
    /// The values of the best individual of each generation.
    pub trace: Vec<Vec<f64>>,
    /// Evenly chosen individuals.
    pub individuals: Vec<(Vec<f64>, f64)>,
}

impl Course {
    /// What was observed of a search.
    pub(crate) fn of(observed: &SearchRecord) -> Course {
        Course {
            history: observed.history.generations.clone(),
            trace: observed.trace.clone(),
            individuals: observed.kept.clone(),
        }
    }

    /// The best values after each generation: without elitism those of a generation may be worse.
    pub(crate) fn best_so_far(&self) -> Vec<Vec<f64>> {
        let (mut least, mut best) = (f64::INFINITY, &Vec::new());
        let mut all = Vec::with_capacity(self.trace.len());
        for (generation, values) in self.history.iter().zip(&self.trace) {
            if generation.best < least && !values.is_empty() {
                (least, best) = (generation.best, values);
            }
            all.push(best.clone());
        }
        all
    }
}

/// What modifies the model of a problem to be the calibrated one.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CalibratedModel {
    /// Modifications as Modelica writes them.
    pub modifications: Vec<String>,
    /// The same as assignments to parameters and start values of the translated model.
    pub assignments: Vec<String>,
    /// What cannot be written so.
    pub remarks: Vec<String>,
}

/// A finished search.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SolvedSearch {
    /// Its seed.
    pub seed: [f64; 6],
    /// The smallest objective that it found; infinite where no simulation succeeded.
    #[serde(serialize_with = "finite", deserialize_with = "or_infinite")]
    pub objective: f64,
    /// Values of the parameters there.
    pub values: Vec<f64>,
    /// Questions of the method.
    pub generations: u64,
    /// Individuals evaluated.
    pub evaluations: u64,
    /// Whether its objective counts as equal to the best of all.
    pub(crate) as_good: bool,
}

/// An identified parameter.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct SolvedParameter {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its value.
    pub value: f64,
    /// The range that was searched.
    pub range: [f64; 2],
    /// Whether its logarithm was searched.
    pub logarithmic: bool,
    /// One standard deviation; `None` where infinite or unknown.
    pub deviation: Option<f64>,
    /// The 95 % interval about the value; where the data do not end it, the range does.
    pub interval: Option<[f64; 2]>,
    /// At which ends of the interval, the lower and the upper, it is the range that ends, not the data.
    #[serde(default, serialize_with = "sides", deserialize_with = "from_sides")]
    pub open: [bool; 2],
    /// Other parameters that stand at an end of their ranges where the interval ends, below and above:
    /// their ranges end it there, not the data.
    #[serde(default, skip_serializing_if = "is_ended_by_data")]
    pub held: [Vec<RangeEnd>; 2],
    /// All parts of the 95 % set, where other minima have parts of their own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pieces: Vec<[f64; 2]>,
    /// Whether the data determine it; `None` where unknown.
    pub determined: Option<bool>,
    /// Whether it lies at an end of its range.
    pub at_bound: bool,
    /// Whether the interval is that of its profile, because the linear one does not hold.
    #[serde(default)]
    pub by_profile: bool,
    /// Whether finite changes have shown what its derivative does not.
    #[serde(default)]
    pub in_steps: bool,
    /// What the data say about it; `None` where unknown.
    #[serde(default)]
    pub verdict: Option<Verdict>,
}

fn is_ended_by_data(held: &[Vec<RangeEnd>; 2]) -> bool {
    held.iter().all(Vec::is_empty)
}

/// What the data say about a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The data bound it.
    Identifiable,
    /// These data do not bound it, or on one side only; others of the kind may.
    PracticallyNonIdentifiable,
    /// No data of this kind bound it: it acts only in a combination with others.
    StructurallyNonIdentifiable,
    /// It changes nothing that was compared.
    WithoutEffect,
}

impl Verdict {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Verdict::Identifiable => "identifiable",
            Verdict::PracticallyNonIdentifiable => "practically non-identifiable from these data",
            Verdict::StructurallyNonIdentifiable => "structurally non-identifiable combination",
            Verdict::WithoutEffect => "without effect",
        }
    }
}

/// Weighted sum of squares where the standard deviations of the measurements are given.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ChiSquare {
    /// The sum.
    pub value: f64,
    /// Points less parameters.
    pub freedom: f64,
    /// Probability of a larger sum by chance.
    pub probability: f64,
}

fn one_variance() -> ErrorModel {
    ErrorModel::OneVariance
}

/// Predictions from the measurements up to so many samples before.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct PredictedAhead {
    /// How many.
    pub samples: usize,
    /// X, the prediction and the standard deviation of a measurement about it; points that have so many
    /// samples before them.
    pub points: Vec<[f64; 3]>,
}

/// What the curve of a series goes through.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum CurveKind {
    /// The simulated values.
    #[default]
    Simulated,
    /// Their logarithms, which are compared.
    Logarithms,
    /// The points are no simulated values, so that no curve goes through them.
    Missing,
}

/// A series with its simulation.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct SolvedSeries {
    /// The experiment.
    pub experiment: String,
    /// The variable and its unit.
    pub y: [String; 2],
    /// What it is given over, and the unit.
    pub x: [String; 2],
    /// The column of the data that X was read from; empty in a result that was read.
    #[serde(skip)]
    pub(crate) x_column: String,
    /// Where the data come from.
    pub file: String,
    /// Root of the mean squared residual.
    #[serde(deserialize_with = "number")]
    pub rmse: f64,
    /// Coefficient of determination.
    pub(crate) r_squared: Option<f64>,
    /// Standard deviation of the measurements, root mean square; `None` where it is not known.
    #[serde(default)]
    pub sigma: Option<f64>,
    /// Whether that was estimated with the parameters.
    #[serde(default)]
    pub(crate) sigma_estimated: bool,
    /// Whether the model computes sigma, which then is the root mean square.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) sigma_computed: bool,
    /// The standard deviations of the points, where the model computes them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) deviations: Vec<f64>,
    /// The scale of the simulation, where it was estimated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<SolvedCoefficient>,
    /// The offset of the simulation, where it was estimated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset: Option<SolvedCoefficient>,
    /// Runs of the same sign, how many are expected, the probability of that by chance, and the
    /// correlation of neighbours.
    pub(crate) residual_test: Option<[f64; 4]>,
    /// The simulated curve between the points, by ascending X, where it was simulated.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub curve: Vec<[f64; 2]>,
    /// X, measured, simulated.
    #[serde(deserialize_with = "points")]
    pub points: Vec<[f64; 3]>,
    /// X and what the best individual of a script gives, where the result is another one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub script: Vec<[f64; 2]>,
    /// X and a simulation from the start that sees no measurements, where the points are predictions.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub simulation: Vec<[f64; 2]>,
    /// Predictions over several samples, where they were asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ahead: Option<PredictedAhead>,
    /// What its curve is.
    #[serde(skip)]
    pub(super) curve_kind: CurveKind,
}

impl SolvedSeries {
    /// Its name in messages: `experiment / variable`.
    pub(super) fn label(&self) -> String {
        match self.experiment.is_empty() {
            true => self.y[0].clone(),
            false => format!("{} / {}", self.experiment, self.y[0]),
        }
    }

    /// Puts a series beside its simulation.
    pub fn new(series: &super::Series, simulated: &[f64]) -> SolvedSeries {
        let points: Vec<[f64; 3]> =
            series.x.iter().zip(&series.y).zip(simulated).map(|((x, y), s)| [*x, *y, *s]).collect();
        let mut solved = SolvedSeries {
            experiment: series.experiment.clone(),
            y: [series.y_name.clone(), shown_unit(&series.y_unit)],
            x_column: series.x_column.clone(),
            x: [series.x_name.clone(), shown_unit(&series.x_unit)],
            file: series.file.clone(),
            rmse: 0.0,
            r_squared: None,
            sigma: None,
            sigma_estimated: series.sigma.is_estimated(),
            sigma_computed: matches!(series.sigma, super::Sigma::Variable(_)),
            deviations: Vec::new(),
            scale: None,
            offset: None,
            residual_test: None,
            curve: Vec::new(),
            points,
            script: Vec::new(),
            simulation: Vec::new(),
            ahead: None,
            curve_kind: CurveKind::Simulated,
        };
        solved.measure();
        solved
    }

    /// What the residuals of the points say.
    fn measure(&mut self) {
        let n = self.points.len() as f64;
        let square: f64 = self.points.iter().map(|p| elementary::powi(p[1] - p[2], 2)).sum();
        let mean = self.points.iter().map(|p| p[1]).sum::<f64>() / n;
        let total: f64 = self.points.iter().map(|p| elementary::powi(p[1] - mean, 2)).sum();
        let mut ordered = self.points.clone();
        ordered.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let residuals: Vec<f64> = ordered.iter().map(|p| p[1] - p[2]).collect();
        self.rmse = (square / n).sqrt();
        self.r_squared = (total > 0.0).then(|| 1.0 - square / total);
        self.residual_test = residual_test(&residuals, &DMatrix::zeros(residuals.len(), 0))
            .map(|t| [t.runs as f64, t.expected_runs, t.runs_probability, t.autocorrelation]);
    }

    /// Compares the points with other predictions, which have these standard deviations.
    pub fn predict(&mut self, predictions: &[[f64; 2]]) {
        self.points.iter_mut().zip(predictions).for_each(|(point, own)| point[2] = own[0]);
        self.curve.clear();
        self.curve_kind = CurveKind::Missing;
        self.measure();
        if !self.deviations.is_empty() {
            self.deviations = predictions.iter().map(|own| own[1]).collect();
        }
        let square: f64 = predictions.iter().map(|own| own[1] * own[1]).sum();
        self.sigma = self.sigma.map(|_| (square / predictions.len() as f64).sqrt());
    }
}

/// The unit as it is written after a number: 1 is none.
fn shown_unit(unit: &str) -> String {
    if unit == "1" { String::new() } else { unit.to_owned() }
}

impl Solution {
    /// Takes standard errors and intervals away, and what was said of them. At the limit of a
    /// constraint they would be too small along it: the data may as well hold inside.
    pub(super) fn drop_intervals(&mut self) {
        for parameter in &mut self.parameters {
            parameter.deviation = None;
            parameter.forget();
        }
        (self.correlations, self.condition) = (None, None);
        self.findings.retain(|finding| !finding.kind.is_about_intervals());
    }

    /// Takes away everything that holds at a minimum only, and says that this is none.
    pub(super) fn drop_verdicts(&mut self) {
        self.drop_intervals();
        self.findings.retain(|finding| finding.kind.holds_anywhere());
        let words = self.outcome.ending.words.clone();
        let finding = Finding::new(FindingKind::NotAMinimum, words).severity(Severity::Serious);
        self.findings.insert(0, finding);
    }

    /// The profile of a parameter; members of structurally non-identifiable groups have none.
    pub(crate) fn profile_of(&self, parameter: &SolvedParameter) -> Option<&Profile> {
        self.profiles.as_ref()?.profiles.iter().find(|own| own.name == parameter.name)
    }

    /// Pairs of parameters that the data can hardly tell apart.
    pub(crate) fn strongly_correlated(&self) -> Vec<(usize, usize, f64)> {
        let Some(rows) = &self.correlations else { return Vec::new() };
        let n = self.parameters.len();
        let pairs = (0..n).flat_map(|k| (k + 1..n).map(move |l| (k, l)));
        pairs
            .filter_map(|(k, l)| Some((k, l, rows[k][l]?)))
            .filter(|(_, _, correlation)| correlation.abs() > STRONG)
            .collect()
    }
}

/// What is not a number is written as null.
/// JSON has no infinite numbers; both ways are the same for other formats, too.
#[allow(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
fn finite<S: Serializer>(value: &f64, writer: S) -> Result<S::Ok, S::Error> {
    Some(*value).filter(|value| value.is_finite()).serialize(writer)
}

/// Sides in words, from neither to both.
const SIDES: [&str; 4] = ["none", "below", "above", "both"];

#[allow(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
fn sides<S: Serializer>([below, above]: &[bool; 2], writer: S) -> Result<S::Ok, S::Error> {
    writer.serialize_str(SIDES[usize::from(*below) + 2 * usize::from(*above)])
}

fn from_sides<'de, D: Deserializer<'de>>(reader: D) -> Result<[bool; 2], D::Error> {
    let word = String::deserialize(reader)?;
    let place = SIDES.iter().position(|side| *side == word).unwrap_or(0);
    Ok([place % 2 == 1, place >= 2])
}

fn or_infinite<'de, D: Deserializer<'de>>(reader: D) -> Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(reader)?.unwrap_or(f64::INFINITY))
}

fn number<'de, D: Deserializer<'de>>(reader: D) -> Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(reader)?.unwrap_or(f64::NAN))
}

fn points<'de, D: Deserializer<'de>>(reader: D) -> Result<Vec<[f64; 3]>, D::Error> {
    let points = Vec::<[Option<f64>; 3]>::deserialize(reader)?;
    Ok(points.into_iter().map(|point| point.map(|value| value.unwrap_or(f64::NAN))).collect())
}
