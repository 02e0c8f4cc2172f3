//! Correlations of the estimates, and the joint 95 % ellipses of correlated pairs among what was
//! evaluated nearby.

use super::Section;
use super::explanations::{CONDITION, CORRELATION, ELLIPSE};
use super::parts::{axis, explained, number, one_panel, scrolling, series, small_figure};
use super::view::{Pair, View, is_logarithmic};
use crate::elementary;
use crate::ga::has_failed;
use crate::plot::{Figure, Mark};
use crate::problem::SolvedParameter;
use maud::{Markup, html};

/// Ellipses drawn; with more parameters the table shows the others.
const DRAWN: usize = 24;
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
    let drawn = &view.pairs[..view.pairs.len().min(DRAWN)];
    let content = html! {
        (scrolling("Correlations", &table(view, rows)))
        (explained(&CORRELATION))
        @if let Some(condition) = view.solution.condition {
            p { "Condition number: " strong { (number(condition, 3)) } }
            (explained(&CONDITION))
        }
        @if drawn.is_empty() {
            p { "No two estimates are correlated beyond ±0.5, so no ellipse is shown." }
        } @else {
            div.figures.small { @for pair in drawn { (one(view, pair)) } }
            @if view.pairs.len() > drawn.len() {
                p { "Drawn: the " (drawn.len()) " strongest of " (view.pairs.len()) " correlated pairs." }
            }
            (explained(&ELLIPSE))
        }
    };
    Some(Section { id: "pairs", heading: "Pairs of parameters", content, wide: true })
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

fn one(view: &View, pair: &Pair) -> Markup {
    let of = |k: usize| &view.solution.parameters[k];
    let (across, up) = (of(pair.first), of(pair.second));
    let Some(drawn) = drawing(view, pair) else { return html! {} };
    let correlation = number(pair.correlation, 3);
    let label = format!("{} across and {} up with their 95 % ellipse", across.name, up.name);
    let caption = html! {
        strong { (across.name) " and " (up.name) } ": correlation " (correlation) "."
    };
    small_figure(&drawn, &label, &caption)
}

/// `None` where a standard error is missing.
fn drawing(view: &View, pair: &Pair) -> Option<Figure> {
    let parameters = &view.solution.parameters;
    let (across, up) = (&parameters[pair.first], &parameters[pair.second]);
    let radius = view.ellipse_radius_squared().sqrt();
    let edge = ellipse(across, up, pair.correlation, radius)?;
    let frame = |values: fn(&(f64, f64)) -> f64, parameter| {
        let low = edge.iter().map(values).fold(f64::INFINITY, f64::min);
        let high = edge.iter().map(values).fold(f64::NEG_INFINITY, f64::max);
        widened(parameter, low, high)
    };
    let (wide, high) = (frame(|at| at.0, across), frame(|at| at.1, up));
    let [good, others, failed] = individuals(view, pair, wide, high);
    let logarithmic = |parameter, [low, high]: [f64; 2]| is_logarithmic(parameter, low, high);
    let mut all =
        vec![series("95 % ellipse", &edge, Mark::Area, 1), series("", &edge, Mark::Line, 1)];
    let clouds = [
        ("evaluated", &others, Mark::Dots, 3),
        ("best 10 %", &good, Mark::Dots, 2),
        ("failed", &failed, Mark::Crosses, 4),
    ];
    let shown = clouds.into_iter().filter(|cloud| !cloud.1.is_empty());
    all.extend(shown.map(|(name, points, mark, colour)| series(name, points, mark, colour)));
    all.push(series("result", &[(across.value, up.value)], Mark::Points, 0));
    let x = axis(across, logarithmic(across, wide));
    let y = axis(up, logarithmic(up, high));
    Some(one_panel(x, y, 250.0, all))
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
    let moved = |parameter: &SolvedParameter, error: f64, by: f64| match parameter.logarithmic {
        true => parameter.value * elementary::exp(by * error / parameter.value),
        false => by.mul_add(error, parameter.value),
    };
    let corner = |k: usize| {
        let (sine, cosine) = elementary::sin_cos(std::f64::consts::TAU * k as f64 / CORNERS as f64);
        let x = moved(across, a, radius * cosine);
        (x, moved(up, b, radius * (correlation * cosine + rest * sine)))
    };
    let edge: Vec<(f64, f64)> = (0..=CORNERS).map(corner).collect();
    let drawable = edge.iter().all(|(x, y)| x.is_finite() && y.is_finite());
    drawable.then_some(edge)
}

/// A quarter more on both sides, in the scale that is drawn.
fn widened(parameter: &SolvedParameter, low: f64, high: f64) -> [f64; 2] {
    if is_logarithmic(parameter, low, high) {
        let more = elementary::powf(high / low, 0.25);
        return [low / more, high * more];
    }
    let more = 0.25 * (high - low);
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
