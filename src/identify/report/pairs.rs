//! Correlations of the estimates, and the joint 95 % ellipses of correlated pairs among what was
//! evaluated nearby.

use super::Section;
use super::explanations::{CONDITION, CORRELATION, ELLIPSE};
use super::parts::{axis, explained, number, scrolling, series};
use super::view::{Pair, View, is_logarithmic};
use crate::elementary;
use crate::ga::has_failed;
use crate::plot::{Axis, Mark, Matrix, Series};
use crate::problem::SolvedParameter;
use maud::{Markup, PreEscaped, html};

/// Parameters whose pairs are drawn; with more parameters the table shows the others.
const DRAWN: usize = 7;
/// The diagonal shows the sum of squares up to so many times the distance of the 95 % limit.
const SHOWN: f64 = 1.6;
/// Individuals in one picture.
const DOTS: usize = 400;
/// Points of an ellipse.
const CORNERS: usize = 72;
/// The best so many individuals of a hundred are drawn in the strong colour.
const BEST_PERCENT: usize = 10;

pub fn section(view: &View) -> Option<Section> {
    let rows = view.solution.correlations.as_ref()?;
    if view.solution.parameters.len() < 2 {
        return None;
    }
    let shown = shown(view);
    let content = html! {
        (scrolling("Correlations", &table(view, rows)))
        (explained(&CORRELATION))
        @if let Some(condition) = view.solution.condition {
            p { "Condition number: " strong { (number(condition, 3)) } }
            (explained(&CONDITION))
        }
        @if shown.len() > 1 {
            (matrix(view, &shown))
            @if view.solution.parameters.len() > shown.len() {
                p { "Drawn: " (shown.len()) " of " (view.solution.parameters.len())
                    " parameters, those of the strongest correlations." }
            }
            (explained(&ELLIPSE))
        }
    };
    Some(Section { id: "pairs", heading: "Pairs of parameters", content, wide: true })
}

/// The parameters that are drawn, by their places: all, or those of the strongest correlations.
fn shown(view: &View) -> Vec<usize> {
    let mut strongest: Vec<usize> =
        view.pairs.iter().flat_map(|pair| [pair.first, pair.second]).collect();
    strongest.extend(0..view.solution.parameters.len());
    let mut shown: Vec<usize> = Vec::new();
    for place in strongest {
        if shown.len() < DRAWN && !shown.contains(&place) {
            shown.push(place);
        }
    }
    shown.sort_unstable();
    shown
}

fn table(view: &View, rows: &[Vec<Option<f64>>]) -> Markup {
    let parameters = &view.solution.parameters;
    html! {
        table.heat {
            thead {
                tr { td {} @for parameter in parameters { th scope="col" { (parameter.name) } } }
            }
            tbody {
                @for (k, (parameter, row)) in parameters.iter().zip(rows).enumerate() {
                    tr {
                        th scope="row" { (parameter.name) }
                        @for (l, entry) in row.iter().enumerate() {
                            @match entry {
                                Some(_) if k == l => { td.own { "1" } }
                                Some(c) => { td class=(shade(*c)) { (format!("{c:.2}").replace('-', "\u{2212}")) } }
                                None => { td { "–" } }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Three shades for each sign: from the 0.5 of an ellipse, from 0.8, and beyond 0.95.
fn shade(correlation: f64) -> &'static str {
    let strength = [0.5, 0.8, 0.95].iter().filter(|limit| correlation.abs() > **limit).count();
    match (correlation > 0.0, strength) {
        (true, 1) => "p1",
        (true, 2) => "p2",
        (true, 3) => "p3",
        (false, 1) => "n1",
        (false, 2) => "n2",
        (false, 3) => "n3",
        _ => "",
    }
}

/// Of each parameter, the pairs with those before it and its profile.
fn matrix(view: &View, shown: &[usize]) -> Markup {
    let of = |k: usize| &view.solution.parameters[k];
    let frames: Vec<[f64; 2]> = shown.iter().map(|k| frame(view, of(*k))).collect();
    let pair = |row: usize, column: usize| {
        let (across, up) = (shown[column], shown[row]);
        let correlation = view.correlation(across, up).unwrap_or(0.0);
        let pair = Pair { first: across, second: up, correlation };
        drawing(view, &pair, [frames[column], frames[row]])
    };
    let drawn = Matrix {
        axes: shown.iter().zip(&frames).map(|(k, frame)| own_axis(of(*k), *frame)).collect(),
        diagonal: shown.iter().zip(&frames).map(|(k, frame)| alone(view, of(*k), *frame)).collect(),
        pairs: (0..shown.len())
            .map(|row| (0..row).map(|column| pair(row, column)).collect())
            .collect(),
    };
    let names: Vec<&str> = shown.iter().map(|k| of(*k).name.as_str()).collect();
    let label = format!(
        "Matrix of {}: each pair with its 95 % ellipse, on the diagonal how the sum of squares rises",
        names.join(", ")
    );
    let with_profile = shown.iter().any(|k| view.solution.profile_of(of(*k)).is_some());
    html! {
        figure.matrix {
            (scrolling("Matrix of all pairs", &PreEscaped(drawn.inline(&label))))
            figcaption {
                "Below the diagonal: 95 % ellipse, individuals (orange: the best 10 %), and the result. \
                 On the diagonal: the sum of squares of the linearized model (thin)"
                @if with_profile { ", its profile" } " and the 95 % limit (dashed)."
            }
        }
    }
}

/// What an axis shows of a parameter: its ellipses with a margin.
fn frame(view: &View, own: &SolvedParameter) -> [f64; 2] {
    let radius = view.ellipse_radius_squared().sqrt();
    let [low, high] = own
        .deviation
        .map_or(own.range, |error| [moved(own, error, -radius), moved(own, error, radius)]);
    widened(own, low, high)
}

fn own_axis(own: &SolvedParameter, [low, high]: [f64; 2]) -> Axis {
    axis(own, is_logarithmic(own, low, high))
}

/// The rise of the sum of squares over a parameter, in units of the 95 % limit: of the linearized model,
/// and of the profile where there is one.
fn alone(view: &View, own: &SolvedParameter, [low, high]: [f64; 2]) -> Vec<Series> {
    let is_within = |x: f64| (low..=high).contains(&x);
    let mut all = vec![series("", &[(low, 1.0), (high, 1.0)], Mark::Dashed, 2)];
    if let (Some(error), Some(quantile)) = (own.deviation, view.solution.likelihood.quantile) {
        let at = |k: usize| {
            let away = SHOWN * (2.0 * k as f64 / CORNERS as f64 - 1.0);
            (moved(own, error, away * quantile), away * away)
        };
        let curve: Vec<(f64, f64)> = (0..=CORNERS).map(at).filter(|at| is_within(at.0)).collect();
        all.push(series("", &curve, Mark::Thin, 0));
    }
    if let Some(profile) = view.solution.profile_of(own) {
        let least = profile.points.iter().map(|point| point[1]).fold(f64::INFINITY, f64::min);
        let rise = |point: &[f64; 2]| (point[0], (point[1] - least) / (profile.limit - least));
        let shown = profile.points.iter().map(rise);
        let shown: Vec<(f64, f64)> =
            shown.filter(|(x, rise)| is_within(*x) && *rise <= SHOWN * SHOWN).collect();
        all.push(series("", &shown, Mark::Line, 1));
    }
    all
}

/// A pair in its frame; without the ellipse where a standard error is missing.
fn drawing(view: &View, pair: &Pair, [wide, high]: [[f64; 2]; 2]) -> Vec<Series> {
    let parameters = &view.solution.parameters;
    let (across, up) = (&parameters[pair.first], &parameters[pair.second]);
    let radius = view.ellipse_radius_squared().sqrt();
    let mut all = Vec::new();
    if let Some(edge) = ellipse(across, up, pair.correlation, radius) {
        all.push(series("", &edge, Mark::Area, 1));
        all.push(series("", &edge, Mark::Line, 1));
    }
    let [good, others, failed] = individuals(view, pair, wide, high);
    let clouds = [(&others, Mark::Dots, 3), (&good, Mark::Dots, 2), (&failed, Mark::Crosses, 4)];
    all.extend(clouds.map(|(points, mark, colour)| series("", points, mark, colour)));
    all.push(series("", &[(across.value, up.value)], Mark::Points, 0));
    all
}

/// The edge of the joint ellipse of two estimates, `radius` in standard errors. Where the logarithm
/// of a parameter is estimated, the ellipse is one of logarithms. `None` without standard errors.
fn ellipse(
    across: &SolvedParameter,
    up: &SolvedParameter,
    correlation: f64,
    radius: f64,
) -> Option<Vec<(f64, f64)>> {
    let (a, b) = (across.deviation?, up.deviation?);
    let rest = (1.0 - correlation * correlation).max(0.0).sqrt();
    let corner = |k: usize| {
        let (sine, cosine) = elementary::sin_cos(std::f64::consts::TAU * k as f64 / CORNERS as f64);
        let x = moved(across, a, radius * cosine);
        (x, moved(up, b, radius * (correlation * cosine + rest * sine)))
    };
    let edge: Vec<(f64, f64)> = (0..=CORNERS).map(corner).collect();
    let drawable = edge.iter().all(|(x, y)| x.is_finite() && y.is_finite());
    drawable.then_some(edge)
}

/// The value moved by so many standard errors; where its logarithm is estimated, that is moved.
fn moved(parameter: &SolvedParameter, error: f64, by: f64) -> f64 {
    match parameter.logarithmic {
        true => parameter.value * elementary::exp(by * error / parameter.value),
        false => by.mul_add(error, parameter.value),
    }
}

/// A tenth more on both sides, in the scale that is drawn.
fn widened(parameter: &SolvedParameter, low: f64, high: f64) -> [f64; 2] {
    if is_logarithmic(parameter, low, high) {
        let more = elementary::powf(high / low, 0.1);
        return [low / more, high * more];
    }
    let more = 0.1 * (high - low);
    [low - more, high + more]
}

type Points = Vec<(f64, f64)>;

/// What was evaluated within the frame: the best 10 % of it, the others, and what failed; an even
/// choice where it is much.
fn individuals(view: &View, pair: &Pair, wide: [f64; 2], high: [f64; 2]) -> [Points; 3] {
    let within = |value: f64, [low, high]: [f64; 2]| (low..=high).contains(&value);
    let all = view.solution.course.individuals.iter();
    let mut near: Vec<((f64, f64), f64)> = all
        .filter_map(|(values, objective)| {
            let at = (*values.get(pair.first)?, *values.get(pair.second)?);
            (within(at.0, wide) && within(at.1, high)).then_some((at, *objective))
        })
        .collect();
    let every = near.len().div_ceil(DOTS).max(1);
    near = near.into_iter().step_by(every).collect();
    let (failed, mut rated): (Vec<_>, Vec<_>) =
        near.into_iter().partition(|(_, objective)| has_failed(*objective));
    rated.sort_by(|a, b| a.1.total_cmp(&b.1));
    let others = rated.split_off((rated.len() * BEST_PERCENT).div_ceil(100));
    let places = |some: Vec<((f64, f64), f64)>| some.into_iter().map(|(at, _)| at).collect();
    [places(rated), places(others), places(failed)]
}
