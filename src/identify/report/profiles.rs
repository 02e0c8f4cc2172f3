//! Profiles: the smallest sum of squares with one parameter fixed, and where it crosses the limit of
//! the 95 % interval.

use super::Section;
use super::explanations::PROFILE;
use super::parts::{explained, legend, number, one_panel, series, small_figure};
use super::view::{View, is_logarithmic};
use crate::elementary;
use crate::plot::{Axis, Figure, Mark};
use crate::problem::{Profile, Solution, SolvedParameter};
use maud::{Markup, html};

/// A profile is drawn up to so many times the rise from its least to the limit.
const SHOWN: f64 = 2.5;
/// Points of the parabola of the linearized model.
const PARABOLA: usize = 60;

impl Solution {
    /// The profiles of the parameters, by their names; empty without profiles.
    pub fn profile_figures(&self) -> Vec<(String, Figure)> {
        let titled = |parameter: &SolvedParameter| {
            let profile = self.profile_of(parameter)?;
            let title = format!("{}: profile of {}", self.class_name(), profile.name);
            Some((profile.name.clone(), Figure { title, ..drawing(self, parameter, profile) }))
        };
        self.parameters.iter().filter_map(titled).collect()
    }
}

pub fn section(view: &View) -> Option<Section> {
    view.solution.profiles.as_ref()?;
    let all = || view.solution.parameters.iter().map(|own| (own, view.solution.profile_of(own)));
    let without: Vec<&str> =
        all().filter(|(_, found)| found.is_none()).map(|(own, _)| own.name.as_str()).collect();
    let content = html! {
        @if let Some(first) = all().find_map(|(own, found)| Some(drawing(view.solution, own, found?))) { (legend(&first)) }
        div.figures.small {
            @for (parameter, profile) in all() {
                @if let Some(profile) = profile { (one(view.solution, parameter, profile)) }
            }
        }
        @if !without.is_empty() {
            p.note {
                "Without profile: " (without.join(", ")) ". Where it ended, the search ranges of the \
                 other parameters of the combination would end it, not the data."
            }
        }
        (explained(&PROFILE))
    };
    Some(Section { id: "profiles", heading: "Profiles", content, wide: true })
}

fn one(solution: &Solution, parameter: &SolvedParameter, profile: &Profile) -> Markup {
    let end = |end: Option<f64>| end.map_or("open".to_owned(), |value| number(value, 4));
    let [low, high] = profile.interval.map(end);
    let label = format!("Profile of {}; 95 % interval {low} to {high}", profile.name);
    let caption = html! {
        strong { (profile.name) } ": 95 % interval " (low) " to " (high)
        @if profile.interval.iter().any(Option::is_none) {
            ". " span.bad { "Open: the limit is not reached within the search range." }
        } @else { "." }
    };
    small_figure(&drawing(solution, parameter, profile), &label, &caption)
}

fn drawing(solution: &Solution, parameter: &SolvedParameter, profile: &Profile) -> Figure {
    let points: Vec<(f64, f64)> = profile.points.iter().map(|point| (point[0], point[1])).collect();
    let least = points.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0.0, 0.0));
    let top = SHOWN.mul_add(profile.limit - least.1, least.1);
    let curve = below(&points, top);
    let ends = [curve.first(), curve.last()].map(|end| end.map_or(parameter.value, |end| end.0));
    let level = [(ends[0], profile.limit), (ends[1], profile.limit)];
    let crossings: Vec<(f64, f64)> =
        profile.interval.iter().flatten().map(|end| (*end, profile.limit)).collect();
    let mut all = vec![
        series("95 % limit", &level, Mark::Dashed, 2),
        series("profile", &curve, Mark::Line, 1),
        series("", &curve, Mark::Dots, 1),
    ];
    let parabola = below(&parabola(parameter, least, profile.limit, ends), top);
    if !parabola.is_empty() {
        all.insert(1, series("linearized", &parabola, Mark::Thin, 0));
    }
    all.push(series("", &crossings, Mark::Crosses, 2));
    all.push(series("best", &[least], Mark::Points, 0));
    let logarithmic = is_logarithmic(parameter, ends[0], ends[1]);
    let x = solution.axis_of(parameter, logarithmic);
    one_panel(x, Axis::linear("sum of squares", ""), 190.0, all)
}

/// What the linearized model would give: a parabola through the ends of its interval.
fn parabola(
    parameter: &SolvedParameter,
    least: (f64, f64),
    limit: f64,
    [from, to]: [f64; 2],
) -> Vec<(f64, f64)> {
    let Some([low, high]) = parameter.interval else { return Vec::new() };
    let logarithmic = parameter.logarithmic && low > 0.0 && least.0 > 0.0 && from > 0.0;
    let scale = |value: f64| if logarithmic { elementary::ln(value) } else { value };
    let half = 0.5 * (scale(high) - scale(low));
    let point = |k: usize| {
        let x = from + (to - from) * k as f64 / PARABOLA as f64;
        let away = (scale(x) - scale(least.0)) / half;
        (x, (limit - least.1).mul_add(away * away, least.1))
    };
    (0..=PARABOLA).map(point).collect()
}

/// The part of a curve with one valley that lies below `top`; at its ends the line to the next
/// point is cut there.
fn below(points: &[(f64, f64)], top: f64) -> Vec<(f64, f64)> {
    let mut kept = Vec::new();
    for (k, &(x, y)) in points.iter().enumerate() {
        if y <= top {
            kept.push((x, y));
            continue;
        }
        let next_to = [k.checked_sub(1), Some(k + 1)];
        let inside = next_to.into_iter().flatten().filter_map(|l| points.get(l));
        if let Some(&(inner, low)) = inside.into_iter().find(|point| point.1 <= top) {
            let share = (top - low) / (y - low);
            kept.push((inner + share * (x - inner), top));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_profile_is_cut_where_it_leaves_the_picture() {
        let points = [(0.0, 9.0), (1.0, 4.0), (2.0, 0.0), (3.0, 1.0), (4.0, 3.0)];
        let cut = [(1.5, 2.0), (2.0, 0.0), (3.0, 1.0), (3.5, 2.0)];
        assert_eq!(below(&points, 2.0), cut);
        assert_eq!(below(&points, 100.0), points);
    }
}
