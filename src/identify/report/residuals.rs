//! Statistics of the residuals of each series, and how they are read.

use super::Section;
use super::explanations::{AUTOCORRELATION, R_SQUARED, RMSE, RUNS};
use super::parts::{explained, number, quantity, scrolling};
use super::view::View;
use crate::identify::problem::SolvedSeries;
use maud::{Markup, html};

/// Runs that are less probable than this do not come by chance; the same limit as for the notes.
const IMPROBABLE: f64 = 0.01;

pub(super) fn section(view: &View) -> Option<Section> {
    let solution = view.solution;
    if solution.series.is_empty() && solution.validation.is_empty() {
        return None;
    }
    let tested = solution.series.iter().any(|series| series.residual_test.is_some());
    let content = html! {
        (scrolling("Statistics of the residuals", &table(view)))
        (explained(&RMSE))
        (explained(&R_SQUARED))
        @if tested { (explained(&RUNS)) (explained(&AUTOCORRELATION)) }
    };
    Some(Section { id: "residuals", heading: "Statistics of the residuals", content, wide: true })
}

fn table(view: &View) -> Markup {
    let solution = view.solution;
    html! {
        table {
            thead {
                tr {
                    th scope="col" { "Series" }
                    th scope="col" { "Points" }
                    th scope="col" { "RMSE" }
                    th scope="col" { "R²" }
                    th scope="col" { "Runs (expected)" }
                    th scope="col" { "Probability" }
                    th scope="col" { "Autocorrelation" }
                    th scope="col" { "Reading" }
                }
            }
            tbody {
                @for series in &solution.series { (row(series, "")) }
                @for series in &solution.validation { (row(series, " (validation)")) }
            }
        }
    }
}

fn row(series: &SolvedSeries, kind: &str) -> Markup {
    html! {
        tr {
            th scope="row" {
                @if !series.experiment.is_empty() { (series.experiment) " / " }
                (series.y[0]) (kind)
            }
            td { (series.points.len()) }
            td { (quantity(series.rmse, 4, &series.y[1])) }
            td { @match series.r_squared { Some(r) => (number(r, 6)), None => "–" } }
            @match series.residual_test {
                Some([runs, expected, probability, autocorrelation]) => {
                    td { (runs) " (" (number(expected, 3)) ")" }
                    td { (number(probability, 2)) }
                    td { (number(autocorrelation, 2)) }
                }
                None => { td { "–" } td { "–" } td { "–" } }
            }
            td { (reading(series)) }
        }
    }
}

fn reading(series: &SolvedSeries) -> Markup {
    let Some([runs, expected, probability, autocorrelation]) = series.residual_test else {
        return html! { "too few points to test" };
    };
    let limit = 2.0 / (series.points.len() as f64).sqrt();
    html! {
        @if probability < IMPROBABLE && runs < expected {
            span.bad { "not noise: the model misses something systematic" }
        } @else if probability < IMPROBABLE {
            span.bad { "not noise: the residuals alternate" }
        } @else if autocorrelation.abs() > limit {
            span.bad { "neighbours are correlated (limit ±" (number(limit, 2)) ")" }
        } @else {
            span.good { "no sign of a systematic error" }
        }
    }
}
