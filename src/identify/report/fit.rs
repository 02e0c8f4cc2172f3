//! Measured points, the model's curve with its 95 % band, and the residuals below.

use super::Section;
use super::explanations::BAND;
use super::parts::{explained, figure, series};
use super::view::{CurvePoint, View};
use crate::identify::problem::SolvedSeries;
use crate::plot::{Axis, Figure, Mark, Panel, Series};
use maud::{Markup, html};

pub(super) fn section(view: &View) -> Option<Section> {
    let solution = view.solution;
    let fitted =
        solution.series.iter().zip(&view.curves).map(|(series, curve)| (series, curve, ""));
    let kept = solution.validation.iter().zip(&view.validation_curves);
    let all: Vec<(&SolvedSeries, &Vec<CurvePoint>, &str)> =
        fitted.chain(kept.map(|(series, curve)| (series, curve, "validation"))).collect();
    if all.is_empty() {
        return None;
    }
    let banded = all.iter().any(|(_, curve, _)| curve.iter().any(|at| at.confidence.is_some()));
    let wide = all.len() > 1;
    let content = html! {
        div.figures[wide] { @for (series, curve, kind) in &all { (one(series, curve, kind)) } }
        @if banded { (explained(&BAND)) }
    };
    Some(Section { id: "fit", heading: "Fit and residuals", content, wide })
}

fn name(series: &SolvedSeries, kind: &str) -> String {
    let parts = [series.experiment.as_str(), series.y[0].as_str(), kind];
    parts.iter().filter(|part| !part.is_empty()).copied().collect::<Vec<_>>().join(" / ")
}

fn one(series: &SolvedSeries, curve: &[CurvePoint], kind: &str) -> Markup {
    let name = name(series, kind);
    if series.points.iter().any(|point| !point[2].is_finite()) {
        return html! { p.note { (name) ": the simulation failed, there is nothing to compare." } };
    }
    let label = format!(
        "{name}: {} measured points and the simulated curve over {}, and the residuals below",
        series.points.len(),
        series.x[0]
    );
    let caption = html! {
        strong { (name) } ": " (series.points.len())
        @if series.points.len() == 1 { " point" } @else { " points" }
        @if !series.file.is_empty() { " from " (series.file) }
        ". Residual: measured minus simulated."
    };
    figure(&drawing(series, curve), &label, &caption)
}

fn drawing(solved: &SolvedSeries, curve: &[CurvePoint]) -> Figure {
    let mut points = solved.points.clone();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let column = |value: fn(&[f64; 3]) -> f64| -> Vec<(f64, f64)> {
        points.iter().map(|point| (point[0], value(point))).collect()
    };
    let line = match curve.is_empty() {
        true => column(|point| point[2]),
        false => curve.iter().map(|at| (at.x, at.y)).collect(),
    };
    let x = Axis::linear(&solved.x[0], &solved.x[1]);
    let bands = [
        ("95 % of new measurements", 3, band(curve, |at| at.prediction)),
        ("95 % band of the curve", 1, band(curve, |at| at.confidence)),
    ];
    let bands = bands.into_iter().filter(|(_, _, edge)| !edge.is_empty());
    let mut fit: Vec<Series> =
        bands.map(|(name, colour, edge)| series(name, &edge, Mark::Area, colour)).collect();
    fit.push(series("simulated", &line, Mark::Line, 1));
    fit.push(series("measured", &column(|point| point[1]), Mark::Points, 0));
    let residuals = vec![series("", &column(|point| point[1] - point[2]), Mark::Stems, 0)];
    let panel = |label: &str, height, zero_line, series| Panel {
        x: x.clone(),
        y: Axis::linear(label, &solved.y[1]),
        height,
        zero_line,
        series,
    };
    Figure {
        title: String::new(),
        panels: vec![
            panel(&solved.y[0], 230.0, false, fit),
            panel("residual", 100.0, true, residuals),
        ],
    }
}

/// The edge of a band, there and back; empty where a half-width is missing.
fn band(curve: &[CurvePoint], half: fn(&CurvePoint) -> Option<f64>) -> Vec<(f64, f64)> {
    let halves: Option<Vec<f64>> = curve.iter().map(half).collect();
    let Some(halves) = halves else { return Vec::new() };
    let edge = |side: f64| {
        let at = move |(at, half): (&CurvePoint, &f64)| (at.x, side.mul_add(*half, at.y));
        curve.iter().zip(&halves).map(at).collect::<Vec<_>>()
    };
    edge(1.0).into_iter().chain(edge(-1.0).into_iter().rev()).collect()
}
