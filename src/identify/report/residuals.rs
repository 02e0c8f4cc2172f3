//! Statistics of the residuals of each series, and what their tests found.

use super::Section;
use super::explanations::{AUTOCORRELATION, R_SQUARED, RMSE, RUNS};
use super::parts::{engineering, explained, number, one_panel, scrolling, series, small_figure};
use super::view::View;
use crate::elementary;
use crate::plot::{Axis, MANY, Mark};
use crate::problem::{Finding, FindingKind, Periodogram, Solution, SolvedSeries, covariance_line};
use maud::{Markup, html};

/// Bars of a histogram.
const BINS: usize = 41;
/// Points of the curve of the normal distribution.
const CURVE: usize = 80;
/// Lags of the autocorrelation.
const LAGS: usize = 40;

pub fn section(view: &View) -> Option<Section> {
    let solution = view.solution;
    if solution.series.is_empty() && solution.validation.is_empty() {
        return None;
    }
    let tested = solution.series.iter().any(|series| series.residual_test.is_some());
    let content = html! {
        (scrolling("Table of the residuals", &table(view)))
        @if solution.series.iter().any(|own| !own.simulation.is_empty()) {
            (scrolling("Table of the predictions", &predictions(solution)))
        }
        (distributions(solution))
        (explained(&RMSE))
        (explained(&R_SQUARED))
        @if tested { (explained(&RUNS)) (explained(&AUTOCORRELATION)) }
    };
    Some(Section { id: "residuals", heading: "Statistics of the residuals", content, wide: true })
}

/// Residuals of a long series as a histogram, and their correlation by lag: in the picture of the fit
/// thousands of dots hide both.
fn distributions(solution: &Solution) -> Markup {
    let long = || solution.series.iter().filter(|own| own.points.len() > MANY);
    let periodograms = || solution.series.iter().filter_map(periodogram);
    html! {
        @if long().next().is_some() || periodograms().next().is_some() {
            div.figures.small {
                @for own in long() { (histogram(own)) (correlogram(own)) }
                @for drawn in periodograms() { (drawn) }
            }
        }
    }
}

/// The cumulated periodogram of residuals in their own standard deviations, with the band of white noise.
fn periodogram(own: &SolvedSeries) -> Option<Markup> {
    let found = Periodogram::of(&own.innovations())?;
    let m = found.cumulated.len() as f64;
    let at = |(k, share): (usize, &f64)| (0.5 * (k + 1) as f64 / m, *share);
    let line: Vec<(f64, f64)> = found.cumulated.iter().enumerate().map(at).collect();
    let band = found.band;
    let limits =
        [(0.0, band), (0.5, 1.0 + band), (f64::NAN, f64::NAN), (0.0, -band), (0.5, 1.0 - band)];
    let all = vec![series("", &limits, Mark::Dashed, 2), series("", &line, Mark::Line, 1)];
    let x = Axis::linear("cycles per sample", "");
    let drawn = one_panel(x, Axis::linear("share of the power", ""), 150.0, all);
    let label = format!("Cumulated periodogram of the innovations of {}", own.y[0]);
    let caption = html! {
        strong { (own.y[0]) } ": cumulated periodogram; that of white noise stays within its 95 % band."
    };
    Some(small_figure(&drawn, &label, &caption))
}

/// Residuals by ascending X, without those of failed simulations.
fn residuals(series: &SolvedSeries) -> Vec<f64> {
    let mut points = series.points.clone();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points.iter().map(|point| point[1] - point[2]).filter(|own| own.is_finite()).collect()
}

/// How often residuals occur, beside the normal distribution of the same standard deviation.
fn histogram(own: &SolvedSeries) -> Markup {
    let values = residuals(own);
    let spread = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let width = 2.0 * spread / BINS as f64;
    let mut counts = [0_usize; BINS];
    for value in &values {
        let bin = ((value + spread) / width) as usize;
        counts[bin.min(BINS - 1)] += 1;
    }
    let edge = |bin: usize| (bin as f64).mul_add(width, -spread);
    let bar = |(bin, count): (usize, &usize)| {
        let height = *count as f64;
        [(edge(bin), 0.0), (edge(bin), height), (edge(bin + 1), height), (edge(bin + 1), 0.0)]
    };
    let bars: Vec<(f64, f64)> = counts.iter().enumerate().flat_map(bar).collect();
    let normal = |k: usize| {
        let x = edge(1) + (edge(BINS - 1) - edge(1)) * k as f64 / CURVE as f64;
        let exponent = -0.5 * elementary::powi(x / own.rmse, 2);
        let density = elementary::exp(exponent) / (own.rmse * std::f64::consts::TAU.sqrt());
        (x, density * width * values.len() as f64)
    };
    let curve: Vec<(f64, f64)> = (0..=CURVE).map(normal).collect();
    let all = vec![
        series("", &bars, Mark::Area, 1),
        series("", &bars, Mark::Thin, 1),
        series("", &curve, Mark::Line, 2),
    ];
    let x = Axis::linear("residual", &own.y[1]);
    let drawn = one_panel(x, Axis::linear("count", ""), 150.0, all);
    let label = format!("Histogram of the residuals of {}", own.y[0]);
    let caption =
        html! { strong { (own.y[0]) } ": residuals, and the normal distribution of their RMSE." };
    small_figure(&drawn, &label, &caption)
}

/// The correlation of residuals that are 1, 2, ... points apart, with the limits ±2/√n.
fn correlogram(own: &SolvedSeries) -> Markup {
    let values = residuals(own);
    let square: f64 = values.iter().map(|value| value * value).sum();
    let at = |lag: usize| {
        let products = values.iter().zip(&values[lag..]).map(|(a, b)| a * b);
        (lag as f64, products.sum::<f64>() / square)
    };
    let all: Vec<(f64, f64)> = (1..=LAGS).map(at).collect();
    let limit = 2.0 / (values.len() as f64).sqrt();
    let last = LAGS as f64;
    let limits = [(0.0, limit), (last, limit), (f64::NAN, f64::NAN), (0.0, -limit), (last, -limit)];
    let all = vec![series("", &limits, Mark::Dashed, 2), series("", &all, Mark::Stems, 1)];
    let x = Axis::linear("lag in points", "");
    let mut drawn = one_panel(x, Axis::linear("autocorrelation", ""), 150.0, all);
    drawn.panels[0].zero_line = true;
    let label = format!("Autocorrelation of the residuals of {} up to lag {LAGS}", own.y[0]);
    let caption = html! { strong { (own.y[0]) } ": autocorrelation; noise lies within ±2/√n." };
    small_figure(&drawn, &label, &caption)
}

/// How large residuals are by how far ahead was predicted.
fn predictions(solution: &Solution) -> Markup {
    let all = || solution.series.iter().filter(|own| !own.simulation.is_empty());
    let steps = all().find_map(|own| Some(own.ahead.as_ref()?.samples));
    let shown = |error: Option<f64>, own: &SolvedSeries| {
        error.map_or_else(|| "–".to_owned(), |error| engineering(error, 4, &own.y[1]))
    };
    html! {
        table {
            thead {
                tr {
                    th scope="col" { "RMSE of" }
                    th scope="col" { "predictions over 1 sample" }
                    @if let Some(steps) = steps { th scope="col" { "over " (steps) " samples" } }
                    th scope="col" { "simulation from the start" }
                }
            }
            tbody {
                @for own in all() {
                    tr {
                        th scope="row" {
                            @if !own.experiment.is_empty() { (own.experiment) " / " }
                            (own.y[0])
                        }
                        td { (shown(Some(own.rmse), own)) }
                        @if steps.is_some() { td { (shown(own.error_ahead(), own)) } }
                        td { (shown(own.error_of_simulation(), own)) }
                    }
                }
            }
        }
    }
}

fn table(view: &View) -> Markup {
    let solution = view.solution;
    let sigmas = solution.series.iter().any(|series| series.sigma.is_some());
    let scales = solution.series.iter().any(|own| own.scale.is_some() || own.offset.is_some());
    let columns = (sigmas, scales);
    html! {
        table {
            thead {
                tr {
                    th scope="col" { "Series" }
                    th scope="col" { "Points" }
                    th scope="col" { "RMSE" }
                    @if sigmas { th scope="col" { "σ of the data" } }
                    @if scales { th scope="col" { "Scale, offset" } }
                    th scope="col" { "R²" }
                    th scope="col" { "Runs (expected)" }
                    th scope="col" { "p-value" }
                    th scope="col" { "Autocorrelation" }
                    th scope="col" { "Remarks" }
                }
            }
            tbody {
                @for series in &solution.series { (row(solution, series, ("", columns))) }
                @for series in &solution.validation { (row(solution, series, (" (validation)", columns))) }
            }
        }
        @for own in &solution.likelihood.covariances {
            p { "Covariance of " (covariance_line(own)) "." }
        }
    }
}

fn row(
    solution: &Solution,
    series: &SolvedSeries,
    (kind, (sigmas, scales)): (&str, (bool, bool)),
) -> Markup {
    html! {
        tr {
            th scope="row" {
                @if !series.experiment.is_empty() { (series.experiment) " / " }
                (series.y[0]) (kind)
            }
            td { (series.points.len()) }
            td { (engineering(series.rmse, 4, &series.y[1])) }
            @if sigmas {
                td {
                    @match series.sigma { Some(sigma) => (engineering(sigma, 4, &series.y[1])), None => "–" }
                    @if series.sigma_estimated { " (estimated)" }
                    @if series.sigma_computed { " (root mean square, from the model)" }
                }
            }
            @if scales {
                td {
                    @for (k, own) in series.scale.iter().chain(&series.offset).enumerate() {
                        @if k > 0 { br; }
                        @if !own.name.is_empty() { (own.name) " = " }
                        (number(own.value, 5))
                        @if let Some(deviation) = own.deviation { " ± " (number(deviation, 2)) }
                    }
                    @if series.scale.is_none() && series.offset.is_none() { "–" }
                }
            }
            td { @match series.r_squared { Some(r) => (number(r, 6)), None => "–" } }
            @match series.residual_test {
                Some([runs, expected, probability, autocorrelation]) => {
                    td { (runs) " (" (number(expected, 3)) ")" }
                    td { (number(probability, 2)) }
                    td { (number(autocorrelation, 2)) }
                }
                None => { td { "–" } td { "–" } td { "–" } }
            }
            td { @if kind.is_empty() { (reading(solution, series)) } @else { "not fitted" } }
        }
    }
}

/// What the tests found in this series; they stand as sentences at the head of the page.
fn reading(solution: &Solution, series: &SolvedSeries) -> Markup {
    let label = match series.experiment.is_empty() {
        true => series.y[0].clone(),
        false => format!("{} / {}", series.experiment, series.y[0]),
    };
    let about = |finding: &&Finding| finding.series.contains(&label);
    let mut found: Vec<&str> =
        solution.findings.iter().filter(about).filter_map(|finding| name(finding.kind)).collect();
    found.dedup();
    html! {
        @if !found.is_empty() { span.bad { (found.join(", ")) } }
        @else if series.residual_test.is_none() { "not tested" }
        @else { span.good { "no remark" } }
    }
}

/// What a finding about residuals is called in the table.
fn name(kind: FindingKind) -> Option<&'static str> {
    Some(match kind {
        FindingKind::Outlier => "outliers",
        FindingKind::Bias => "mean is not zero",
        FindingKind::Autocorrelation => "neighbours are correlated",
        FindingKind::UnequalVariance => "spread changes",
        FindingKind::HeavyTails => "not normal",
        FindingKind::PoorFit => "poor fit",
        FindingKind::Sigma => "contradicts σ",
        FindingKind::ColumnsEqual => "same as another column",
        _ => return None,
    })
}
