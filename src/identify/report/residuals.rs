//! Statistics of the residuals of each series, and what their tests found.

use super::Section;
use super::explanations::{AUTOCORRELATION, R_SQUARED, RMSE, RUNS};
use super::parts::{explained, number, quantity, scrolling};
use super::view::View;
use crate::problem::{Finding, FindingKind, Solution, SolvedSeries};
use maud::{Markup, html};

pub fn section(view: &View) -> Option<Section> {
    let solution = view.solution;
    if solution.series.is_empty() && solution.validation.is_empty() {
        return None;
    }
    let tested = solution.series.iter().any(|series| series.residual_test.is_some());
    let content = html! {
        (scrolling("Table of the residuals", &table(view)))
        (explained(&RMSE))
        (explained(&R_SQUARED))
        @if tested { (explained(&RUNS)) (explained(&AUTOCORRELATION)) }
    };
    Some(Section { id: "residuals", heading: "Statistics of the residuals", content, wide: true })
}

fn table(view: &View) -> Markup {
    let solution = view.solution;
    let sigmas = solution.series.iter().any(|series| series.sigma.is_some());
    html! {
        table {
            thead {
                tr {
                    th scope="col" { "Series" }
                    th scope="col" { "Points" }
                    th scope="col" { "RMSE" }
                    @if sigmas { th scope="col" { "σ of the data" } }
                    th scope="col" { "R²" }
                    th scope="col" { "Runs (expected)" }
                    th scope="col" { "Probability" }
                    th scope="col" { "Autocorrelation" }
                    th scope="col" { "Findings" }
                }
            }
            tbody {
                @for series in &solution.series { (row(solution, series, ("", sigmas))) }
                @for series in &solution.validation { (row(solution, series, (" (validation)", sigmas))) }
            }
        }
    }
}

fn row(solution: &Solution, series: &SolvedSeries, (kind, sigmas): (&str, bool)) -> Markup {
    html! {
        tr {
            th scope="row" {
                @if !series.experiment.is_empty() { (series.experiment) " / " }
                (series.y[0]) (kind)
            }
            td { (series.points.len()) }
            td { (quantity(series.rmse, 4, &series.y[1])) }
            @if sigmas {
                td {
                    @match series.sigma { Some(sigma) => (quantity(sigma, 4, &series.y[1])), None => "–" }
                    @if series.sigma_estimated { " (estimated)" }
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
        @else { span.good { "no finding" } }
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
