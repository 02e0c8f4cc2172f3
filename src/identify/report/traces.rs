//! The best values so far over the generations, each within the range that was searched.

use super::Section;
use super::parts::{axis, legend, number, one_panel, series, small_figure};
use super::view::View;
use crate::plot::{Axis, Figure, Mark};
use crate::problem::SolvedParameter;
use maud::{Markup, html};

pub fn section(view: &View) -> Option<Section> {
    let solution = view.solution;
    if solution.course.trace.len() < 2 {
        return None;
    }
    let trace = solution.course.best_so_far();
    let content = html! {
        details {
            summary { "The best values so far, generation by generation" }
            (legend(&drawing(&solution.parameters[0], 0, &trace)))
            div.figures.small {
                @for (k, parameter) in solution.parameters.iter().enumerate() {
                    (one(parameter, k, &trace))
                }
            }
        }
    };
    Some(Section { id: "traces", heading: "Values over the generations", content, wide: true })
}

fn one(parameter: &SolvedParameter, place: usize, trace: &[Vec<f64>]) -> Markup {
    let label = format!("{} over the generations", parameter.name);
    let last = trace.last().and_then(|values| values.get(place)).copied().unwrap_or(f64::NAN);
    let caption =
        html! { strong { (parameter.name) } ": the search ends at " (number(last, 5)) "." };
    small_figure(&drawing(parameter, place, trace), &label, &caption)
}

fn drawing(parameter: &SolvedParameter, place: usize, trace: &[Vec<f64>]) -> Figure {
    let point = |(k, values): (usize, &Vec<f64>)| Some((k as f64 + 1.0, *values.get(place)?));
    let points: Vec<(f64, f64)> = trace.iter().enumerate().filter_map(point).collect();
    let [low, high] = parameter.range;
    let last = trace.len() as f64;
    let limits = [(1.0, low), (last, low), (f64::NAN, f64::NAN), (1.0, high), (last, high)];
    let logarithmic = parameter.logarithmic && low > 0.0;
    let y = axis(parameter, logarithmic);
    let all = vec![
        series("range", &limits, Mark::Dashed, 2),
        series("best so far", &points, Mark::Line, 1),
    ];
    one_panel(Axis::linear("generation", ""), y, 140.0, all)
}
