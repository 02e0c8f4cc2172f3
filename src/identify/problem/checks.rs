//! Tests of the residuals, as findings.
//!
//! All tests of one solution together raise a false alarm in at most one of a hundred cases: each
//! is made at that level divided by their number (Bonferroni). Tests that assume what another one
//! refutes are not made: where neighbours are alike, or the spread changes, large residuals are not
//! outliers and their distribution is not asked.

use super::statistics::distributions::{
    chi_square_tails, f_upper, signs_two_sided, student_two_sided,
};
use super::statistics::freedom::Directions;
use super::statistics::outliers::{basis, outliers, rest_of};
use super::statistics::residuals::{deviation, mean, noise_beneath, normality, spearman};
use super::statistics::resolution::resolution;
use super::{
    ErrorModel, Finding, FindingKind, Problem, ResidualTest, Series, Severity, Sigma, Statistics,
    residual_test,
};
use crate::diag::suggest;
use crate::elementary;
use crate::ga::optimizer::FROM_THE_SOLVER;
use crate::table::significant;
use nalgebra::DMatrix;

/// More outliers than this are named by half as many.
const MOST_NAMED: usize = 20;
/// Probability of any false alarm among the residual tests of a solution.
const FAMILY: f64 = 0.01;
/// Tests of each series: runs, correlation, mean, signs, spread twice, distribution, outliers.
const TESTS: usize = 8;
/// Fewer points than these are not tested for patterns: their tests have no power at the level.
const FEW: usize = 8;
/// Standard deviations of series that differ by less than this are not worth a word.
const UNLIKE: f64 = 3.0;
/// At a minimum the residuals are orthogonal to the derivatives by every parameter that is free to
/// follow them: the limit of the test of a minimum, with room for the error of the simulation.
const FOLLOWED: f64 = 0.01;
/// A fit whose R² is below 0 by less than this is as good as a constant: it may be one.
const AS_GOOD: f64 = 1e-6;
/// So many equal values at an end of the data, and so many times as many as elsewhere, are no chance.
const TIED: usize = 3;
/// A fit that changes by so many standard deviations of the residuals across equal values does not
/// follow them: noise would have made them differ.
const CROSSES: f64 = 2.0;
/// Rows that are listed.
const LISTED: usize = 10;
/// Outliers are farther from the fit than this many standard deviations of the others.
const FAR: f64 = 2.0;
/// Standard errors that are too small by more than this factor: the residuals are no noise to speak of.
const STRONG: f64 = 2.0;
/// So many outliers are a distribution.
const MANY: usize = 3;

/// One series as the tests see it, in the order of X.
struct Own<'a> {
    label: String,
    /// Places among all points, in the order of X.
    points: Vec<usize>,
    /// Weighted residuals in that order.
    residuals: Vec<f64>,
    rows: &'a [usize],
    first: usize,
    has_sigma: bool,
    /// Whether the fitness counts large residuals less.
    robust: bool,
    /// Whether it is a likelihood with deviations that are estimated or computed.
    is_likelihood: bool,
    /// Whether these are deviations that the model computes.
    is_deviation: bool,
}

impl Own<'_> {
    fn row(&self, point: usize) -> usize {
        let own = point - self.first;
        self.rows.get(own).copied().unwrap_or(own + 1)
    }
}

/// What the residuals say about the data and the model. `simulated`: at the best values.
/// `resolved`: whether the errors of the solver are known to be small against them.
pub(crate) fn residual_findings(
    problem: &Problem,
    statistics: &Statistics,
    simulated: &[f64],
    resolved: bool,
) -> Vec<Finding> {
    let mut findings = Vec::new();
    if statistics.spread.freedom < 1.0 {
        return findings;
    }
    let repeated = |k: usize| statistics.repeated.iter().any(|pair| pair.0 == k);
    let all = series(problem, statistics);
    let alpha = FAMILY / (TESTS * all.len() + pairs(problem).len() + 1) as f64;
    let (mut suspects, rest) = suspected_outliers(statistics, &all, alpha);
    let followed = followed(statistics, &suspects);
    // A contradiction between a prior and the data is reported of the prior.
    let is_no_data = |k: usize| !problem.series[k].is_data();
    let raw = |own: &Own<'_>| -> Vec<f64> {
        let pairs = own.points.iter().zip(&own.residuals);
        pairs.map(|(&j, r)| r / statistics.weights[j]).collect()
    };
    let is_exact = |own: &Own<'_>| {
        let size = rms(&own.points.iter().map(|&j| simulated[j]).collect::<Vec<f64>>());
        !resolved && rms(&raw(own)) <= FROM_THE_SOLVER * problem.noise * size
    };
    // Standard errors are those of given deviations, or of the noise of other series.
    let has_errors = all
        .iter()
        .enumerate()
        .any(|(k, own)| !is_no_data(k) && (problem.series[k].sigma.is_known() || !is_exact(own)));
    for (k, own) in all.iter().enumerate().filter(|(k, _)| !repeated(*k) && !is_no_data(*k)) {
        let raw = raw(own);
        if is_exact(own) {
            findings.push(match is_followed(statistics, own) {
                true => passed_through(own),
                false => no_noise(own, has_errors),
            });
            suspects.retain(|j| !own.points.contains(j));
            continue;
        }
        findings.extend(poor_fit(problem, k, own, &raw));
        let steps = resolution(&problem.series[k].y);
        let is_rounding = |(&j, r): (&usize, &f64)| (r.abs() <= steps[j - own.first]).then_some(j);
        let rounding: Vec<usize> = own.points.iter().zip(&raw).filter_map(is_rounding).collect();
        suspects.retain(|j| !rounding.contains(j));
        findings.extend(saturated(&problem.series[k], own, &mut suspects));
        findings.extend(of_series(own, (simulated, &rest, &followed), alpha, &mut suspects));
    }
    findings.extend(chi_square(problem, statistics, &suspects, alpha));
    findings.extend(unlike_series(problem, statistics, &all, alpha));
    findings.extend(common_errors(problem, &all, alpha));
    findings
}

fn series<'a>(problem: &'a Problem, statistics: &Statistics) -> Vec<Own<'a>> {
    let mut first = 0;
    let one = |series: &'a super::Series| {
        let mut points: Vec<usize> = (first..first + series.x.len()).collect();
        let start = first;
        points.sort_by(|a, b| series.x[a - start].total_cmp(&series.x[b - start]));
        first += series.x.len();
        Own {
            label: series.label(),
            residuals: points.iter().map(|&j| statistics.residuals[j]).collect(),
            points,
            rows: &series.rows,
            first: start,
            has_sigma: series.sigma.is_known(),
            robust: statistics.spread.robust || !series.is_normal(),
            is_likelihood: matches!(
                ErrorModel::of(problem),
                ErrorModel::Computed | ErrorModel::Estimated
            ),
            is_deviation: matches!(series.role, super::Role::Deviation(_)),
        }
    };
    problem.series.iter().map(one).collect()
}

pub(crate) fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
}

/// Outliers of the linearized problem, each series in units of its own residuals, and the residuals
/// of all other points when the parameters no longer follow the outliers.
fn suspected_outliers(
    statistics: &Statistics,
    all: &[Own<'_>],
    alpha: f64,
) -> (Vec<usize>, Vec<f64>) {
    let mut units = vec![0.0; statistics.residuals.len()];
    // What nothing is compared with is no outlier.
    for own in all.iter().filter(|own| !own.is_deviation) {
        let size = rms(&own.residuals);
        let unit = if size > 0.0 { 1.0 / size } else { 0.0 };
        own.points.iter().for_each(|&j| units[j] = unit);
    }
    let scaled: Vec<f64> = statistics.residuals.iter().zip(&units).map(|(r, u)| r * u).collect();
    let column = |column: &Vec<f64>| {
        let parts = column.iter().zip(&statistics.weights).zip(&units);
        parts.map(|((d, w), u)| d * w * u).collect::<Vec<f64>>()
    };
    let jacobian: Vec<Vec<f64>> = statistics.jacobian.iter().map(column).collect();
    let mut rest = statistics.residuals.clone();
    if jacobian.iter().flatten().any(|value| !value.is_finite()) {
        return (Vec::new(), rest);
    }
    let found = outliers(&jacobian, &scaled, alpha);
    let points: Vec<usize> = found.iter().map(|outlier| outlier.point).collect();
    if !points.is_empty() {
        let kept: Vec<usize> = (0..scaled.len()).filter(|j| !points.contains(j)).collect();
        // Parameters held by a bound, and those of a robust fit, do not follow outliers.
        let follows = |column: &Vec<f64>| cosine(column, &scaled).abs() < FOLLOWED;
        let followed: Vec<Vec<f64>> = jacobian.iter().filter(|c| follows(c)).cloned().collect();
        let left = rest_of(&followed, &scaled, &kept);
        for (&j, left) in kept.iter().zip(&left).filter(|(j, _)| units[**j] > 0.0) {
            rest[j] = left / units[j];
        }
    }
    (points, rest)
}

/// The cosine of the angle between two vectors; 0 where one of them vanishes.
fn cosine(a: &[f64], b: &[f64]) -> f64 {
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let size = (product(a, a) * product(b, b)).sqrt();
    if size > 0.0 { product(a, b) / size } else { 0.0 }
}

/// Whether parameters, scales and offsets follow a series wherever its points are.
fn is_followed(statistics: &Statistics, own: &Own<'_>) -> bool {
    let columns = statistics.explicit_columns().map(|own| own.0);
    let columns = columns.unwrap_or_else(|| statistics.weighted(&statistics.jacobian));
    let directions = Directions::of(statistics.residuals.len(), &columns);
    directions.is_some_and(|directions| directions.follow(&own.points))
}

/// An orthonormal basis of what parameters, scales and offsets follow of the points. Parameters at ends of
/// their ranges follow nothing. Nothing where outliers have moved the fit: of the way back to where it would
/// be without them only the linear part is known, and the rest of it would look like a pattern.
fn followed(statistics: &Statistics, outliers: &[usize]) -> DMatrix<f64> {
    let points = statistics.residuals.len();
    let columns = statistics.explicit_columns().map(|own| own.0);
    let columns = columns.unwrap_or_else(|| statistics.weighted(&statistics.jacobian));
    let is_held = |k: usize| statistics.inward.get(k).is_some_and(Option::is_some);
    let columns = columns.into_iter().enumerate().filter(|(k, _)| !is_held(*k));
    let columns: Vec<Vec<f64>> = columns.map(|(_, column)| column).collect();
    match outliers.is_empty() {
        true => basis(&columns, &(0..points).collect::<Vec<usize>>()),
        false => DMatrix::zeros(points, 0),
    }
}

fn passed_through(own: &Own<'_>) -> Finding {
    let (count, them) = match own.points.len() {
        1 => ("The only point".to_owned(), "it"),
        count => (format!("All {count} points"), "them"),
    };
    let sentence = format!(
        "{count} of {} would be fitted exactly with any value: as many parameters, scales or offsets \
         act on {them} alone. They say nothing about the other parameters.",
        own.label
    );
    Finding::new(FindingKind::Missing, sentence).series(&own.label)
}

fn no_noise(own: &Own<'_>, has_errors: bool) -> Finding {
    let (kind, so) = match has_errors {
        true => (FindingKind::Missing, ""),
        false => (FindingKind::NoNoise, ", so there are no standard errors and no intervals"),
    };
    let sentence = format!(
        "The residuals of {} are as small as the errors of the simulation: the fit is exact. These \
         data have no noise{so}.",
        own.label
    );
    Finding::new(kind, sentence).series(&own.label)
}

fn poor_fit(problem: &Problem, k: usize, own: &Own<'_>, raw: &[f64]) -> Option<Finding> {
    let y = &problem.series[k].y;
    let mean = mean(y);
    let total: f64 = y.iter().map(|y| elementary::powi(y - mean, 2)).sum();
    let r_squared = 1.0 - raw.iter().map(|r| r * r).sum::<f64>() / total;
    let n = y.len() as f64;
    let by_chance = f_upper(1.0 - r_squared, [n, n - 1.0]) >= FAMILY;
    (total > 0.0 && y.len() > 2 && r_squared < -AS_GOOD).then(|| {
        let (severity, words) = match by_chance {
            true => (Severity::Information, "the model explains no more than the mean does"),
            false => (Severity::Serious, "the model does not describe these data"),
        };
        Finding::new(
            FindingKind::PoorFit,
            format!(
                "The fit of {} is worse than a constant (R² {}): within the search ranges, {words}.",
                own.label,
                significant(r_squared, 3)
            ),
        )
        .severity(severity)
        .series(&own.label)
        .statistic(r_squared, 0.0)
    })
}

/// Patterns, spread and distribution of one series; `suspects` keeps those outliers that are. `rest`:
/// the residuals without the influence of the outliers, which would look like a pattern. `followed`: what
/// the parameters follow of the points.
fn of_series(
    own: &Own<'_>,
    (simulated, rest, followed): (&[f64], &[f64], &DMatrix<f64>),
    alpha: f64,
    suspects: &mut Vec<usize>,
) -> Vec<Finding> {
    let mut findings = Vec::new();
    let kept: Vec<usize> =
        (0..own.points.len()).filter(|&j| !suspects.contains(&own.points[j])).collect();
    let residuals: Vec<f64> = kept.iter().map(|&j| rest[own.points[j]]).collect();
    if residuals.len() < FEW {
        findings.extend(bias(own, &residuals, None, alpha));
        findings.extend(outlier(own, suspects));
        return findings;
    }
    let rows: Vec<usize> = kept.iter().map(|&j| own.points[j]).collect();
    let test = residual_test(&residuals, &followed.select_rows(&rows));
    let serial = test
        .filter(|test| test.runs_probability < alpha || test.autocorrelation_probability < alpha);
    let alike = serial.is_some_and(|test| test.autocorrelation > 0.0);
    findings.extend(bias(own, &residuals, serial.filter(|_| alike), alpha));
    let left_out = own.points.len() - kept.len();
    findings.extend(serial.map(|test| correlated(own, (&test, left_out), alpha)));
    if alike {
        // Part of the pattern unless it stands alone.
        suspects.retain(|j| !own.points.contains(j) || stands_alone(own, *j));
        findings.extend(outlier(own, suspects));
        return findings;
    }
    let fitted: Vec<f64> = kept.iter().map(|&j| simulated[own.points[j]]).collect();
    let order: Vec<f64> = (0..kept.len()).map(|j| j as f64).collect();
    if let Some(finding) = spread(own, &residuals, &fitted, &order, alpha) {
        findings.push(finding);
        suspects.retain(|j| !own.points.contains(j));
        return findings;
    }
    findings.extend(outlier(own, suspects));
    let many = own.points.iter().filter(|point| suspects.contains(point)).count();
    let p = normality(&residuals);
    if p < alpha || many >= MANY {
        let p = normality(&own.residuals);
        findings.push(heavy_tails(own, p, alpha));
    }
    findings
}

/// Whether neither neighbour is off to the same side by half as much.
fn stands_alone(own: &Own<'_>, point: usize) -> bool {
    let Some(j) = own.points.iter().position(|known| *known == point) else { return false };
    let r = own.residuals[j];
    let like = |l: Option<usize>| {
        l.and_then(|l| own.residuals.get(l)).is_some_and(|other| other / r > 0.5)
    };
    !like(j.checked_sub(1)) && !like(Some(j + 1))
}

/// The mean of the residuals against its standard error, and their signs. Given sigmas say that
/// the noise is independent, so that a slow pattern is not noise; else a pattern leaves fewer
/// independent points.
fn bias(
    own: &Own<'_>,
    residuals: &[f64],
    pattern: Option<ResidualTest>,
    alpha: f64,
) -> Option<Finding> {
    let n = residuals.len() as f64;
    if n < 3.0 && !own.has_sigma {
        return None;
    }
    let (mean, spread) = (mean(residuals), deviation(residuals));
    let (size, count, freedom) = match (own.has_sigma, pattern) {
        (true, _) => {
            let beneath = if n < 2.0 { 0.0 } else { noise_beneath(residuals) };
            (beneath.max(1.0), n, if n < 3.0 { f64::MAX.sqrt() } else { n - 1.0 })
        }
        (false, None) => (spread, n, n - 1.0),
        (false, Some(test)) => {
            let rho = test.autocorrelation.min(0.99);
            let count = (n * (1.0 - rho) / (1.0 + rho)).max(2.0);
            (spread, count, count - 1.0)
        }
    };
    let t = mean * count.sqrt() / size;
    let mut p = student_two_sided(t, freedom.min(1e6));
    let positive = residuals.iter().filter(|r| **r > 0.0).count();
    // Residuals of one sign alone are no wave about zero.
    let one_sided = positive == 0 || positive == residuals.len();
    if pattern.is_none() || one_sided {
        p = p.min(signs_two_sided(positive as u64, residuals.len() as u64));
    }
    (p < alpha).then(|| {
        let size = match own.has_sigma {
            true => format!("their mean is {} times sigma", significant(mean, 2)),
            // Alike but for rounding: their standard deviation is no measure.
            false if spread <= 1e-9 * mean.abs() => format!("all are {}", significant(mean, 2)),
            false => {
                let ratio = significant(mean / spread, 2);
                format!("their mean is {ratio} times their standard deviation")
            }
        };
        Finding::new(
            FindingKind::Bias,
            format!(
                "The residuals of {} are biased: {size} ({} of {} are positive). On average, the simulation lies {} the data. Possible causes: a \
                 sensor offset, conflicting outputs, or a model that cannot reach the data.",
                own.label,
                positive,
                residuals.len(),
                if mean > 0.0 { "below" } else { "above" },
            ),
        )
        .series(&own.label)
        .statistic(p, alpha)
    })
}

/// `left_out`: the outliers that the test does not count, unlike the line of the series.
fn correlated(own: &Own<'_>, (test, left_out): (&ResidualTest, usize), alpha: f64) -> Finding {
    let rho = test.autocorrelation;
    let factor = ((1.0 + rho.abs()) / (1.0 - rho.abs()).max(0.01)).sqrt();
    let is_strong = rho > 0.0 && factor > STRONG;
    let factor = significant(factor, 2);
    let numbers = format!(
        "lag-1 autocorrelation {}, {} of the same sign, {} expected",
        significant(rho, 2),
        suggest::counted(test.runs as u64, "run"),
        significant(test.expected_runs, 3)
    );
    let without = match left_out {
        0 => String::new(),
        count => format!(" without {}", suggest::counted(count as u64, "outlier")),
    };
    let sentence = if rho > 0.0 {
        format!(
            "The residuals of {}{without} have a pattern: {numbers}. Either the model does not describe \
             part of these data (lack of fit), or their noise is autocorrelated; standard errors \
             are too small and intervals too narrow, by a factor of about {factor} for slowly varying \
             sensitivities.",
            own.label
        )
    } else {
        format!(
            "The residuals of {}{without} alternate: {numbers}. The noise is autocorrelated; standard \
             errors are too large, by a factor of about {factor} for slowly varying sensitivities.",
            own.label
        )
    };
    let severity = if is_strong { Severity::Serious } else { Severity::Warning };
    Finding::new(FindingKind::Autocorrelation, sentence)
        .severity(severity)
        .series(&own.label)
        .statistic(test.runs_probability.min(test.autocorrelation_probability), alpha)
}

fn spread(
    own: &Own<'_>,
    residuals: &[f64],
    fitted: &[f64],
    order: &[f64],
    alpha: f64,
) -> Option<Finding> {
    let size: Vec<f64> = residuals.iter().map(|r| r.abs()).collect();
    let value: Vec<f64> = fitted.iter().map(|v| v.abs()).collect();
    let (by_value, by_x) = (spearman(&size, &value), spearman(&size, order));
    let ((rho, p), what, help) = match by_value.1 <= by_x.1 {
        true => (
            by_value,
            "the size of the output",
            "Give `sigma` as a formula of the output or as a column, or minimize `relative`",
        ),
        false => (by_x, "x", "Give `sigma` as a column of the data"),
    };
    (p < alpha).then(|| {
        let way = if rho > 0.0 { "grows" } else { "falls" };
        Finding::new(
            FindingKind::UnequalVariance,
            format!(
                "The spread of the residuals of {} {way} with {what} (rank correlation {}): \
                 their variance is not constant (heteroscedastic), so the fit and its standard \
                 errors are not optimal. {help}.",
                own.label,
                significant(rho, 2)
            ),
        )
        .series(&own.label)
        .statistic(p, alpha)
    })
}

fn outlier(own: &Own<'_>, suspects: &[usize]) -> Option<Finding> {
    let (mut found, kept): (Vec<usize>, Vec<usize>) =
        (0..own.points.len()).partition(|&j| suspects.contains(&own.points[j]));
    let unit = rms(&kept.iter().map(|&j| own.residuals[j]).collect::<Vec<f64>>());
    // A point that the fit has followed away from the others is not far from it.
    found.retain(|&j| own.residuals[j].abs() >= FAR * unit);
    if found.is_empty() {
        return None;
    }
    let mut rows: Vec<(usize, f64)> =
        found.iter().map(|&j| (own.row(own.points[j]), own.residuals[j] / unit)).collect();
    rows.sort_by_key(|row| row.0);
    let text: Vec<String> = rows
        .iter()
        .map(|(row, r)| format!("row {row} ({} standard deviations)", significant(*r, 2)))
        .collect();
    let one = rows.len() == 1;
    let named = match text.len() > MOST_NAMED {
        true => {
            let left = text.len() - MOST_NAMED / 2;
            format!("{} and {left} more rows", text[..MOST_NAMED / 2].join(", "))
        }
        false => text.join(", "),
    };
    Some(
        Finding::new(
            FindingKind::Outlier,
            format!(
                "{named} of {} {} far from the fit while the others agree with it: check {}{}.",
                own.label,
                if one { "is" } else { "are" },
                if one { "this outlier" } else { "these outliers" },
                match (own.robust, own.is_likelihood, one) {
                    (true, ..) => "; the robust fitness gives it little weight",
                    // It has no robust form here.
                    (false, true, _) => "",
                    (false, false, true) => ", or minimize `huber`, which gives it less weight",
                    (false, false, false) => ", or minimize `huber`, which gives them less weight",
                },
            ),
        )
        .series(&own.label)
        .rows(rows.into_iter().map(|row| row.0).collect()),
    )
}

fn heavy_tails(own: &Own<'_>, p: f64, alpha: f64) -> Finding {
    Finding::new(
        FindingKind::HeavyTails,
        format!(
            "The residuals of {} are not normally distributed (Anderson-Darling, probability {}): \
             large ones are more frequent than in normal noise. {}.",
            own.label,
            significant(p, 2),
            match own.robust {
                true => "The robust fitness accounts for them",
                false => "A robust fitness such as `huber` is better suited to such data",
            }
        ),
    )
    .series(&own.label)
    .statistic(p, alpha)
}

/// Whether the residuals are as large as the given sigmas say, outliers left out.
fn chi_square(
    problem: &Problem,
    statistics: &Statistics,
    outliers: &[usize],
    alpha: f64,
) -> Option<Finding> {
    if ErrorModel::of(problem) != ErrorModel::Known || !statistics.spread.believed {
        return None;
    }
    let value = statistics.chi_square(problem, outliers);
    let freedom = statistics.spread.freedom - outliers.len() as f64;
    let [lower, upper] = chi_square_tails(value, freedom);
    let p = 2.0 * lower.min(upper);
    if p.is_nan() || p >= alpha {
        return None;
    }
    let ratio = (value / freedom).sqrt();
    let scaled: Vec<String> = statistics.uncertainty.as_ref().map_or_else(Vec::new, |found| {
        let one = |(free, se): (&super::Free, &f64)| {
            format!("{} {}", free.name, significant(ratio * se, 3))
        };
        problem.parameters.iter().zip(&found.standard_deviations).map(one).collect()
    });
    let what = if ratio > 1.0 {
        "Either sigma is too small, or the model does not describe part of these data"
    } else {
        "Sigma is too large: the residuals are smaller than it allows"
    };
    Some(
        Finding::new(
            FindingKind::Sigma,
            format!(
                "On average, the residuals are {} times the given sigma (chi-square {} for {} degrees of \
                 freedom, two-sided probability {}). {what}. The standard errors use the given \
                 sigma; scaled by the residuals they are: {}.",
                significant(ratio, 2),
                significant(value, 5),
                significant(freedom, 6),
                significant(p, 2),
                scaled.join(", ")
            ),
        )
        .statistic(p, alpha),
    )
}

/// Equal values at an end of the data, as of a sensor that is saturated there: the simulated values
/// continue where they stay. They are no outliers.
fn saturated(series: &super::Series, own: &Own<'_>, suspects: &mut Vec<usize>) -> Option<Finding> {
    let value = |point: usize| series.y[point - own.first];
    let size = rms(&own.residuals);
    let end = |sign: f64| {
        let most = series.y.iter().map(|y| sign * y).fold(f64::NEG_INFINITY, f64::max);
        let (tied, rest): (Vec<usize>, Vec<usize>) =
            (0..own.points.len()).partition(|&j| sign * value(own.points[j]) == most);
        let mut others: Vec<f64> = rest.iter().map(|&j| value(own.points[j])).collect();
        others.sort_by(f64::total_cmp);
        others.dedup();
        if rest.is_empty() {
            // Data that are all equal show no end, and are named before the search.
            return None;
        }
        // Rounded data have equal values everywhere.
        let usual = rest.len() as f64 / others.len().max(1) as f64;
        let beyond =
            -sign * tied.iter().map(|&j| own.residuals[j]).sum::<f64>() / tied.len() as f64;
        // A fit that follows equal values on the average crosses them.
        let (least, most) = tied.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |ends, &j| {
            (ends.0.min(own.residuals[j]), ends.1.max(own.residuals[j]))
        });
        let crosses = most - least > CROSSES * size;
        let is_one = tied.len() >= TIED
            && tied.len() as f64 >= TIED as f64 * usual
            && (beyond > size || crosses);
        is_one.then_some((
            tied,
            match (beyond > size, sign > 0.0) {
                (true, true) => ["largest", "lies above"],
                (true, false) => ["smallest", "lies below"],
                (false, true) => ["largest", "changes across"],
                (false, false) => ["smallest", "changes across"],
            },
        ))
    };
    let (tied, [which, where_fit]) = end(1.0).or_else(|| end(-1.0))?;
    let points: Vec<usize> = tied.iter().map(|&j| own.points[j]).collect();
    suspects.retain(|j| !points.contains(j));
    let mut rows: Vec<usize> = points.iter().map(|&point| own.row(point)).collect();
    rows.sort_unstable();
    let listed: Vec<String> = rows.iter().take(LISTED).map(usize::to_string).collect();
    let more = if rows.len() > LISTED { ", ..." } else { "" };
    let sentence = format!(
        "{} values of {} are equal to its {which} one, {} (rows {}{more}), and the fit \
         {where_fit} them: the sensor may be saturated there. Omit these rows; as they are, they \
         bias the estimates.",
        rows.len(),
        own.label,
        significant(value(points[0]), 5),
        listed.join(", ")
    );
    Some(Finding::new(FindingKind::Data, sentence).series(&own.label).rows(rows))
}

/// Pairs of series that were measured at the same points of one experiment.
fn pairs(problem: &Problem) -> Vec<(usize, usize)> {
    let series = &problem.series;
    let is_pair = |(a, b): &(usize, usize)| {
        let (a, b) = (&series[*a], &series[*b]);
        let are_data = a.is_data() && b.is_data();
        are_data && a.experiment == b.experiment && a.x == b.x && a.y != b.y && a.x.len() >= FEW
    };
    let all = (0..series.len()).flat_map(|a| (a + 1..series.len()).map(move |b| (a, b)));
    all.filter(is_pair).collect()
}

/// What counts errors together that two series have in common; nothing where that is not supported.
fn remedy_of_common_errors(problem: &Problem, pair: [usize; 2]) -> &'static str {
    let [a, b] = pair.map(|k| &problem.series[k]);
    let is_replicated = |own: &Series| {
        problem.series.iter().filter(|other| other.label() == own.label()).count() > 1
    };
    let is_plain = |own: &Series| {
        let is_formula = matches!(own.sigma, Sigma::Formula(_) | Sigma::Variable(_));
        own.is_normal() && own.joint.is_none() && own.weight == 1.0 && !is_formula
    };
    match () {
        () if a.label() == b.label() => {
            " Give the mean of the replicates as one column, with the standard deviation of the mean."
        }
        () if is_replicated(a) || is_replicated(b) || !is_plain(a) || !is_plain(b) => "",
        () => " The entry `covariance = \"estimate\"` of the experiment counts them together.",
    }
}

/// Errors that two outputs have in common.
fn common_errors(problem: &Problem, all: &[Own<'_>], alpha: f64) -> Vec<Finding> {
    let one = |(a, b): (usize, usize)| {
        let remedy = remedy_of_common_errors(problem, [a, b]);
        let (a, b) = (&all[a], &all[b]);
        let centred = |own: &Own<'_>| -> Vec<f64> {
            let mean = mean(&own.residuals);
            own.residuals.iter().map(|r| r - mean).collect()
        };
        let correlation = cosine(&centred(a), &centred(b));
        let freedom = a.residuals.len() as f64 - 2.0;
        let t = correlation * (freedom / (1.0 - correlation * correlation)).sqrt();
        let p = student_two_sided(t, freedom);
        let (who, what) = match a.label == b.label {
            true => (format!("two replicates of {}", a.label), "replicates"),
            false => (format!("{} and {}", a.label, b.label), "outputs"),
        };
        let sentence = format!(
            "The residuals of {who} are correlated ({}): the two {what} have errors in common, but \
             count as independent, so that standard errors are too small.{remedy}",
            significant(correlation, 2)
        );
        (p < alpha).then(|| {
            let finding = Finding::new(FindingKind::Autocorrelation, sentence);
            finding.series(&a.label).series(&b.label).statistic(p, alpha)
        })
    };
    pairs(problem).into_iter().filter_map(one).collect()
}

/// Series that share one variance although their residuals differ in size.
fn unlike_series(
    problem: &Problem,
    statistics: &Statistics,
    all: &[Own<'_>],
    alpha: f64,
) -> Option<Finding> {
    if ErrorModel::of(problem) != ErrorModel::OneVariance || all.len() < 2 {
        return None;
    }
    let total: f64 = statistics.residuals.iter().map(|r| r * r).sum();
    let n = statistics.residuals.len() as f64;
    let share = statistics.spread.freedom / n;
    let unlike = |own: &&Own<'_>| {
        let square: f64 = own.residuals.iter().map(|r| r * r).sum();
        let count = own.residuals.len() as f64;
        let (a, b) = (square / count, (total - square) / (n - count));
        let (ratio, freedom) = match a > b {
            true => (a / b, [count * share, (n - count) * share]),
            false => (b / a, [(n - count) * share, count * share]),
        };
        ratio > UNLIKE * UNLIKE && f_upper(ratio, freedom) < alpha
    };
    let found: Vec<&Own<'_>> = all.iter().filter(unlike).collect();
    if found.is_empty() {
        return None;
    }
    let text: Vec<String> = all
        .iter()
        .map(|own| format!("{} {}", own.label, significant(rms(&own.residuals), 3)))
        .collect();
    let mut finding = Finding::new(
        FindingKind::ScaleOfOutputs,
        format!(
            "The series share one variance, but their residuals differ in scale ({}): series \
             with small residuals have almost no influence. Give `sigma` for each output, or \
             `sigma = \
             \"estimate\"`.",
            text.join(", ")
        ),
    );
    finding.series = found.iter().map(|own| own.label.clone()).collect();
    Some(finding)
}
