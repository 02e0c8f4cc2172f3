//! What the page shows: the solution, and what is derived from it for drawing.

use crate::elementary;
use crate::problem::{
    Band, BandPoint, EndingKind, Finding, Severity, Solution, SolvedDescent, SolvedParameter,
    SolvedSeries,
};

/// Smallest correlation of a pair that is drawn with its ellipse: below it the ellipse is hardly
/// distinguishable from one with upright axes.
const CORRELATED: f64 = 0.5;
/// Quantile 0.95 of the chi-square distribution with two degrees of freedom.
const CHI_SQUARE: f64 = 5.991_464_547_107_98;

/// What the page shows.
pub struct View<'a> {
    pub(super) solution: &'a Solution,
    /// The heading, with the name of the model's class alone.
    pub(super) title: String,
    /// How the search ended.
    pub(super) ending: Ending<'a>,
    /// What must be known about the numbers, most important first.
    pub(super) notes: Vec<Note<'a>>,
    /// For each series its curve with bands, empty where there is none.
    pub(super) curves: Vec<Vec<CurvePoint>>,
    /// The same for the series that were not fitted.
    pub(super) validation_curves: Vec<Vec<CurvePoint>>,
    /// Curves of variables that were not measured.
    pub(super) unmeasured: Vec<&'a Band>,
    /// Pairs of parameters whose estimates are correlated, the strongest first.
    pub(super) pairs: Vec<Pair>,
    /// Results of all descents, in the order in which they ran.
    pub(super) descents: Vec<Descent>,
    /// Other minima: their parameters and objective.
    pub(super) minima: Vec<(Vec<f64>, f64)>,
    /// Measurements that would shrink intervals most, in words.
    pub(super) next: Vec<String>,
    /// Intervals by bootstrap and posterior, in words, under their headings.
    pub(super) intervals: Vec<(&'static str, Vec<String>)>,
}

/// How the search ended.
pub struct Ending<'a> {
    /// The class of the style.
    pub(super) class: &'static str,
    pub(super) sentence: &'a str,
}

/// Something that must be known.
pub struct Note<'a> {
    pub(super) sentence: &'a str,
    /// The class of the style: how much it changes what the numbers mean.
    pub(super) weight: &'static str,
}

/// A point of a simulated curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CurvePoint {
    pub(super) x: f64,
    pub(super) y: f64,
    /// Half-width of the 95 % confidence band of the curve.
    pub(super) confidence: Option<f64>,
    /// Half-width of the 95 % band of a new measurement.
    pub(super) prediction: Option<f64>,
}

/// A local search.
#[derive(Debug, Clone, PartialEq)]
pub struct Descent {
    /// Objective where it ended.
    pub(super) objective: f64,
    /// Whether it ended at a minimum.
    pub(super) minimum: bool,
    /// Whether it ended where the best did.
    pub(super) is_best: bool,
}

/// Two parameters and the correlation of their estimates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    pub(super) first: usize,
    pub(super) second: usize,
    pub(super) correlation: f64,
}

impl View<'_> {
    pub fn of(solution: &Solution) -> View<'_> {
        View {
            solution,
            title: solution.short_title(),
            ending: ending(solution),
            notes: notes(solution),
            curves: solution
                .series
                .iter()
                .enumerate()
                .map(|(k, s)| banded(solution, k, s))
                .collect(),
            validation_curves: solution.validation.iter().map(curve).collect(),
            pairs: pairs(solution),
            descents: solution.outcome.descents.iter().filter_map(descent).collect(),
            minima: solution
                .outcome
                .other_minima
                .iter()
                .map(|m| (m.values.clone(), m.objective))
                .collect(),
            unmeasured: solution.inferred.bands.iter().filter(|b| b.series.is_none()).collect(),
            next: solution.inferred.next_measurement.iter().flat_map(|n| n.sentences()).collect(),
            intervals: solution.inferred.intervals(),
        }
    }

    /// The correlation of two estimates, where it is known.
    pub(crate) fn correlation(&self, first: usize, second: usize) -> Option<f64> {
        *self.solution.correlations.as_ref()?.get(first)?.get(second)?
    }

    /// Square of the radius of the joint 95 % ellipse of two parameters, in standard errors: the
    /// quantile of the chi-square distribution where the standard deviations of the data are known;
    /// else twice that of F(2, ν), which has the closed form ν (0.05^(−2/ν) − 1).
    pub(crate) fn ellipse_radius_squared(&self) -> f64 {
        match self.solution.likelihood.degrees_of_freedom.filter(|freedom| *freedom > 0.0) {
            Some(freedom) if self.solution.likelihood.chi_square.is_none() => {
                freedom * (elementary::powf(0.05f64, -2.0 / freedom) - 1.0)
            }
            _ => CHI_SQUARE,
        }
    }
}

fn ending(solution: &Solution) -> Ending<'_> {
    let class = match solution.outcome.ending.kind {
        EndingKind::Minimum => "good",
        EndingKind::Untested => "neutral",
        EndingKind::StepLimit
        | EndingKind::Budget
        | EndingKind::Stopped
        | EndingKind::NoDescent => "bad",
    };
    Ending { class, sentence: &solution.outcome.ending.words }
}

/// `None` where the start could not be simulated.
fn descent(solved: &SolvedDescent) -> Option<Descent> {
    Some(Descent {
        objective: solved.objective?,
        minimum: solved.ending.is_at_minimum(),
        is_best: solved.group == 0 && solved.ending.is_at_minimum(),
    })
}

fn notes(solution: &Solution) -> Vec<Note<'_>> {
    let weight = |finding: &Finding| match finding.severity {
        Severity::Information => "information",
        Severity::Warning => "warning",
        Severity::Serious => "serious",
    };
    let note = |finding| Note { weight: weight(finding), sentence: &finding.sentence };
    let refused = solution.inferred.refusals.iter();
    let refused = refused.map(|sentence| Note { sentence, weight: "information" });
    // The head of the page says how the search ended.
    let findings = solution.findings.iter().filter(|f| f.sentence != solution.outcome.ending.words);
    findings.map(note).chain(refused).collect()
}

/// The curve of a fitted series: with bands where these were computed.
fn banded(solution: &Solution, place: usize, series: &SolvedSeries) -> Vec<CurvePoint> {
    let band = solution.inferred.bands.iter().find(|band| band.series == Some(place));
    band.map_or_else(|| curve(series), points)
}

/// The points of a band.
pub fn points(band: &Band) -> Vec<CurvePoint> {
    let point = |at: &BandPoint| CurvePoint {
        x: at.x,
        y: at.y,
        confidence: at.confidence,
        prediction: at.prediction,
    };
    band.points.iter().map(point).collect()
}

fn curve(series: &SolvedSeries) -> Vec<CurvePoint> {
    let point = |[x, y]: &[f64; 2]| CurvePoint { x: *x, y: *y, confidence: None, prediction: None };
    series.curve.iter().map(point).collect()
}

fn pairs(solution: &Solution) -> Vec<Pair> {
    let Some(rows) = &solution.correlations else { return Vec::new() };
    let n = solution.parameters.len();
    let all = (0..n).flat_map(|first| (first + 1..n).map(move |second| (first, second)));
    let known = all.filter_map(|(first, second)| {
        let correlation = (*rows.get(first)?.get(second)?)?;
        Some(Pair { first, second, correlation })
    });
    let mut pairs: Vec<Pair> = known.filter(|pair| pair.correlation.abs() >= CORRELATED).collect();
    pairs.sort_by(|a, b| b.correlation.abs().total_cmp(&a.correlation.abs()));
    pairs
}

/// Whether the axis of a parameter between two of its values is better drawn logarithmic.
pub(crate) fn is_logarithmic(parameter: &SolvedParameter, low: f64, high: f64) -> bool {
    parameter.logarithmic && low > 0.0 && high > 3.0 * low
}

/// Where in its range a value lies, from 0 to 1.
pub fn fraction(parameter: &SolvedParameter, value: f64) -> f64 {
    let [min, max] = parameter.range;
    let fraction = match parameter.logarithmic {
        true => elementary::ln(value / min) / elementary::ln(max / min),
        false => (value - min) / (max - min),
    };
    // A value on the other side of zero has no logarithm: it lies below the range.
    if fraction.is_nan() { 0.0 } else { fraction.clamp(0.0, 1.0) }
}
