//! Measured points, the model's curve with its 95 % band, and the residuals below.

use super::Section;
use super::explanations::BAND;
use super::parts::{explained, figure, one_panel, series};
use super::view::{self, CurvePoint, View};
use crate::plot::{Axis, Figure, Mark, Panel, Series};
use crate::problem::{Band, SolvedSeries};
use maud::{Markup, html};

pub fn section(view: &View) -> Option<Section> {
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
    let wide = all.len() + view.unmeasured.len() > 1;
    let content = html! {
        div.figures[wide] { @for (series, curve, kind) in &all { (one(series, curve, kind)) }
            @for band in &view.unmeasured { (unmeasured(band)) }
        }
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
        return html! { p.note { (name) ": the simulation failed, so no comparison is possible." } };
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
    let mut fit = bands(curve);
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

/// The bands of a curve; where the data leave it open there is none.
fn bands(curve: &[CurvePoint]) -> Vec<Series> {
    type Half = fn(&CurvePoint) -> Option<f64>;
    let kinds: [(&str, usize, Half); 2] = [
        ("95 % prediction band", 3, |at| at.prediction),
        ("95 % confidence band", 1, |at| at.confidence),
    ];
    let mut all = Vec::new();
    for (name, colour, half) in kinds {
        let parts = curve.split(|at| half(at).is_none()).filter(|part| part.len() > 1);
        for (k, part) in parts.enumerate() {
            let edge = |side: f64| {
                move |at: &CurvePoint| (at.x, half(at).unwrap_or(0.0).mul_add(side, at.y))
            };
            let upper = part.iter().map(edge(1.0));
            let edge: Vec<(f64, f64)> = upper.chain(part.iter().rev().map(edge(-1.0))).collect();
            // The legend names a band once.
            all.push(series(if k == 0 { name } else { "" }, &edge, Mark::Area, colour));
        }
    }
    all
}

/// The curve of a variable that was not measured.
fn unmeasured(band: &Band) -> Markup {
    let points = view::points(band);
    let name = format!("{} / {}", band.experiment, band.y[0]);
    let mut all = bands(&points);
    let line: Vec<(f64, f64)> = points.iter().map(|at| (at.x, at.y)).collect();
    all.push(series("simulated", &line, Mark::Line, 1));
    let [x, y] = [&band.x, &band.y].map(|[label, unit]| Axis::linear(label, unit));
    let label = format!("{name}: the simulated curve with its band; it was not measured");
    let caption = html! { strong { (name) } ": not measured." };
    figure(&one_panel(x, y, 230.0, all), &label, &caption)
}
