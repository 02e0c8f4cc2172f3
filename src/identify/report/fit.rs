//! Measured points, the model's curve with its 95 % band, and the residuals below.

use super::Section;
use super::explanations::BAND;
use super::parts::{explained, figure, one_panel, series};
use super::view::{self, CurvePoint, View};
use crate::Descriptions;
use crate::plot::{Axis, Figure, MANY, Mark, Panel, Series, of_points, of_residuals};
use crate::problem::{Band, SolvedSeries, SolvedState, SpectrumFigures};
use maud::{Markup, html};
use std::path::Path;

/// Quantile 0.975 of the normal distribution.
const NORMAL: f64 = 1.959_963_984_540_054;

/// A series, its curve, and what it is besides a fitted one.
type Shown<'v> = (&'v SolvedSeries, &'v [CurvePoint], &'static str);

/// All series: those that were fitted, then those that were kept for validation.
fn all<'v>(view: &'v View<'_>) -> Vec<Shown<'v>> {
    let solution = view.solution;
    let with = |series: &'v [SolvedSeries], curves: &'v [Vec<CurvePoint>], kind: &'static str| {
        series.iter().zip(curves).map(move |(series, curve)| (series, curve.as_slice(), kind))
    };
    let fitted = with(&solution.series, &view.curves, "");
    fitted.chain(with(&solution.validation, &view.validation_curves, "validation")).collect()
}

/// The first series, beside the table of the result.
pub fn section(view: &View) -> Option<Section> {
    let (series, curve, kind) = all(view).into_iter().next()?;
    let content = html! {
        (one(series, (curve, kind), &view.solution.subject.descriptions))
        @if curve.iter().any(|at| at.confidence.is_some()) { (explained(&BAND)) }
    };
    Some(Section { id: "fit", heading: "Fit and residuals", content, wide: false })
}

/// The other series, and curves of what was not measured.
pub(super) fn others(view: &View) -> Option<Section> {
    let all = all(view);
    let others = all.get(1..).unwrap_or_default();
    let solution = view.solution;
    let mut planes = crate::problem::planes(&solution.series, &solution.inferred.spectra);
    planes.extend(crate::problem::planes(&solution.validation, &[]));
    let states = &solution.inferred.states;
    let measured = others.is_empty() && planes.is_empty();
    if measured && view.unmeasured.is_empty() && states.is_empty() {
        return None;
    }
    let descriptions = &view.solution.subject.descriptions;
    let content = html! {
        div.figures {
            @for own in &planes { (in_plane(own)) }
            @for (series, curve, kind) in others { (one(series, (curve, kind), descriptions)) }
            @for band in &view.unmeasured { (unmeasured(band, descriptions)) }
            @for own in states { (state(own, descriptions)) }
        }
    };
    Some(Section { id: "series", heading: "Further series", content, wide: true })
}

/// A spectrum in the plane of complex numbers, and over the frequency.
fn in_plane(own: &SpectrumFigures<'_>) -> Markup {
    let name = if own.name.is_empty() { "spectrum" } else { own.name };
    let label = format!("{name}: the measured spectrum and the simulated one in the complex plane");
    let caption = html! { strong { (name) } ": Nyquist plot, both axes to the same scale." };
    let over = format!("{name}: magnitude, phase and residuals over the frequency");
    let below = html! {
        strong { (name) } ": Bode plot; residuals in per cent of the magnitude."
    };
    html! {
        (figure(&own.plane, &label, &caption))
        (figure(&own.bode, &over, &below))
    }
}

fn name(series: &SolvedSeries, kind: &str) -> String {
    let parts = [series.experiment.as_str(), series.y[0].as_str(), kind];
    parts.iter().filter(|part| !part.is_empty()).copied().collect::<Vec<_>>().join(" / ")
}

fn one(
    series: &SolvedSeries,
    (curve, kind): (&[CurvePoint], &str),
    descriptions: &Descriptions,
) -> Markup {
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
        @if let Some(name) = Path::new(&series.file).file_name() { " from " (name.to_string_lossy()) }
        ". Residual: measured minus "
        @if series.simulation.is_empty() { "simulated." } @else { "predicted." }
    };
    figure(&drawing(series, curve, descriptions), &label, &caption)
}

fn drawing(solved: &SolvedSeries, curve: &[CurvePoint], descriptions: &Descriptions) -> Figure {
    let mut points = solved.points.clone();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let column = |value: fn(&[f64; 3]) -> f64| -> Vec<(f64, f64)> {
        points.iter().map(|point| (point[0], value(point))).collect()
    };
    // Between samples a prediction is not a line.
    let is_predicted = !solved.simulation.is_empty();
    let line = match curve.is_empty() || is_predicted {
        true => column(|point| point[2]),
        false => curve.iter().map(|at| (at.x, at.y)).collect(),
    };
    let [x, y] = [&solved.x, &solved.y].map(|quantity| descriptions.axis(quantity));
    let residual = Axis::linear("residual", &y.unit);
    let mut fit = bands(curve);
    let is_long = points.len() > MANY;
    let measured = series("measured", &column(|point| point[1]), of_points(points.len()), 0);
    let name = if is_predicted { "predicted from all earlier samples" } else { "simulated" };
    let simulated = series(name, &line, Mark::Line, 1);
    fit.extend(if is_long { [measured, simulated] } else { [simulated, measured] });
    let others =
        [("script's best", &solved.script), ("simulated from the start", &solved.simulation)];
    for (name, points) in others.into_iter().filter(|(_, points)| !points.is_empty()) {
        let mut own: Vec<(f64, f64)> = points.iter().map(|[x, y]| (*x, *y)).collect();
        own.sort_by(|a, b| a.0.total_cmp(&b.0));
        fit.push(series(name, &own, Mark::Dashed, 2));
    }
    if let Some(ahead) = &solved.ahead {
        let mut own: Vec<(f64, f64)> = ahead.points.iter().map(|[x, y, _]| (*x, *y)).collect();
        own.sort_by(|a, b| a.0.total_cmp(&b.0));
        let name = format!("predicted over {} samples", ahead.samples);
        fit.push(series(&name, &own, Mark::Thin, 3));
    }
    let residuals = column(|point| point[1] - point[2]);
    let residuals = vec![series("", &residuals, of_residuals(is_long), 0)];
    let panel = |y, height, zero_line, series| Panel { x: x.clone(), y, height, zero_line, series };
    Figure {
        title: String::new(),
        panels: vec![panel(y, 230.0, false, fit), panel(residual, 100.0, true, residuals)],
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

/// A state that a filter and a smoother have found.
fn state(own: &SolvedState, descriptions: &Descriptions) -> Markup {
    let kinds = [("from measurements up to then", 1, 2), ("from all measurements", 3, 4)];
    let mut all = Vec::new();
    for (number, (name, value, sd)) in kinds.into_iter().enumerate() {
        let colour = 1 + 2 * number;
        let edge =
            |side: f64| move |at: &[f64; 5]| (at[0], (side * NORMAL).mul_add(at[sd], at[value]));
        let upper = own.points.iter().map(edge(1.0));
        let around: Vec<(f64, f64)> =
            upper.chain(own.points.iter().rev().map(edge(-1.0))).collect();
        let line: Vec<(f64, f64)> = own.points.iter().map(|at| (at[0], at[value])).collect();
        all.push(series(&format!("95 % band, {name}"), &around, Mark::Area, colour));
        all.push(series(name, &line, Mark::Line, colour));
    }
    let y = descriptions.axis(&own.y);
    let name = match own.experiment.is_empty() {
        true => own.y[0].clone(),
        false => format!("{} / {}", own.experiment, own.y[0]),
    };
    let label = format!("{name}: the state as filter and smoother find it, with 95 % bands");
    let caption =
        html! { strong { (name) } ": the state, as the filter and the smoother find it." };
    figure(&one_panel(Axis::linear("time", "s"), y, 230.0, all), &label, &caption)
}

/// The curve of a variable that was not measured.
fn unmeasured(band: &Band, descriptions: &Descriptions) -> Markup {
    let points = view::points(band);
    let name = format!("{} / {}", band.experiment, band.y[0]);
    let mut all = bands(&points);
    let line: Vec<(f64, f64)> = points.iter().map(|at| (at.x, at.y)).collect();
    all.push(series("simulated", &line, Mark::Line, 1));
    let [x, y] = [&band.x, &band.y].map(|quantity| descriptions.axis(quantity));
    let label = format!("{name}: the simulated curve with its band; it was not measured");
    let caption = html! { strong { (name) } ": not measured." };
    figure(&one_panel(x, y, 230.0, all), &label, &caption)
}
