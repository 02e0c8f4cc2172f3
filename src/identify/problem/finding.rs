//! Findings: what must be known about a solution, one sentence each, with the numbers on which it
//! is based.

use serde::{Deserialize, Serialize};

/// What a finding is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FindingKind {
    /// The best point is not a minimum.
    NotAMinimum,
    /// A parameter changes no compared point anywhere in its range.
    NoEffect,
    /// Parameters of which no data of this kind determine more than a combination.
    StructurallyNonIdentifiable,
    /// These data do not bound a parameter.
    PracticallyNonIdentifiable,
    /// Limits of a parameter that are not those of a standard error.
    Interval,
    /// A parameter lies at an end of its range, or no value in its range fits.
    AtBound,
    /// Strongly correlated parameters.
    Correlated,
    /// Ill-conditioned sensitivities.
    IllConditioned,
    /// Other parameters fit as well, or better.
    OtherMinimum,
    /// Not more points than parameters.
    TooFewPoints,
    /// Points without a number.
    MissingPoints,
    /// Columns that may be in another unit or have the other sign.
    Misread,
    /// How data were read: units converted, lines left out, inputs between their samples.
    Data,
    /// Single points far from the others.
    Outlier,
    /// A mean of the residuals that is not zero.
    Bias,
    /// Correlated residuals: a pattern that the model misses, or noise that is not independent.
    Autocorrelation,
    /// Residuals whose spread changes.
    UnequalVariance,
    /// Residuals with more large values than normal noise has.
    HeavyTails,
    /// A fit that is worse than a constant.
    PoorFit,
    /// The residuals contradict the given sigma.
    Sigma,
    /// Series of different units or scales in one sum.
    ScaleOfOutputs,
    /// An error model that was chosen or estimated.
    ErrorModel,
    /// The same numbers in two series.
    ColumnsEqual,
    /// A single point that determines a parameter.
    Dominant,
    /// Residuals as small as the errors of the simulation.
    NoNoise,
    /// The tolerance of the solver is too coarse for these data.
    SolverTolerance,
    /// How series that were not fitted are described.
    Validation,
    /// Where simulations fail.
    Failures,
    /// A prior that dominates the data or contradicts them.
    Prior,
    /// An experiment that is not at rest when its data begin.
    NotAtRest,
    /// Estimates at the limit of a constraint.
    Constraint,
    /// What the process noise explains.
    ProcessNoise,
    /// A statistic that could not be computed.
    Missing,
    /// Where the search of a script ended, and where least squares from there.
    Search,
}

impl FindingKind {
    /// Findings that rest on standard errors and intervals.
    pub(super) fn is_about_intervals(self) -> bool {
        matches!(
            self,
            FindingKind::StructurallyNonIdentifiable
                | FindingKind::PracticallyNonIdentifiable
                | FindingKind::Interval
                | FindingKind::AtBound
                | FindingKind::Correlated
                | FindingKind::IllConditioned
                | FindingKind::Dominant
                | FindingKind::Sigma
                | FindingKind::Prior
        )
    }

    /// Findings about single parameters that a profile replaces.
    pub(super) fn is_about_profile(self) -> bool {
        matches!(
            self,
            FindingKind::PracticallyNonIdentifiable | FindingKind::Interval | FindingKind::Missing
        )
    }

    /// Findings that need no minimum.
    pub(super) fn holds_anywhere(self) -> bool {
        matches!(
            self,
            FindingKind::MissingPoints
                | FindingKind::ColumnsEqual
                | FindingKind::Misread
                | FindingKind::ScaleOfOutputs
                | FindingKind::ErrorModel
                | FindingKind::SolverTolerance
                | FindingKind::Failures
                | FindingKind::Missing
        )
    }
}

/// How much a finding changes what the numbers mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// Worth knowing.
    Information,
    /// Some numbers mean less than they seem to.
    Warning,
    /// Some numbers must not be used.
    Serious,
}

/// Something that must be known about a solution.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// What it is about.
    pub kind: FindingKind,
    /// How serious it is.
    pub severity: Severity,
    /// The finding in words.
    pub sentence: String,
    /// The series that it is about: `experiment / variable`, or the variable alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub series: Vec<String>,
    /// Rows of the data, the first below the heading is 1.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rows: Vec<usize>,
    /// Names of parameters.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub parameters: Vec<String>,
    /// The statistic that was compared, mostly a probability.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// What it was compared with.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub threshold: Option<f64>,
}

impl Finding {
    /// A finding of a kind with its sentence; a warning about nothing in particular.
    pub fn new(kind: FindingKind, sentence: impl Into<String>) -> Finding {
        Finding {
            kind,
            severity: Severity::Warning,
            sentence: sentence.into(),
            series: Vec::new(),
            rows: Vec::new(),
            parameters: Vec::new(),
            value: None,
            threshold: None,
        }
    }

    /// With another severity.
    pub fn severity(mut self, severity: Severity) -> Finding {
        self.severity = severity;
        self
    }

    /// About a series.
    pub fn series(mut self, name: impl Into<String>) -> Finding {
        self.series.push(name.into());
        self
    }

    /// About rows of the data.
    pub fn rows(mut self, rows: Vec<usize>) -> Finding {
        self.rows = rows;
        self
    }

    /// About parameters.
    pub fn parameters<'a>(mut self, names: impl IntoIterator<Item = &'a str>) -> Finding {
        self.parameters = names.into_iter().map(str::to_owned).collect();
        self
    }

    /// With the statistic and what it was compared with.
    pub(crate) fn statistic(mut self, value: f64, threshold: f64) -> Finding {
        self.value = Some(value).filter(|value| value.is_finite());
        self.threshold = Some(threshold).filter(|threshold| threshold.is_finite());
        self
    }
}
