//! The objective over the generations.

use super::Section;
use super::explanations::CONVERGENCE;
use super::parts::{explained, figure, number, one_panel, series};
use super::view::View;
use crate::ga::has_failed;
use crate::plot::{Axis, Figure, Mark, undrowned};
use maud::html;

pub fn section(view: &View) -> Option<Section> {
    let history = &view.solution.course.history;
    if history.len() < 2 {
        return None;
    }
    let best: Vec<f64> = history.iter().map(|generation| generation.best).collect();
    let mean: Vec<f64> = history.iter().map(|generation| generation.mean).collect();
    let label = format!(
        "The objective over {} generations: best so far, best of the generation, and mean",
        history.len()
    );
    // Least squares after a script's search are none of its generations.
    let reached =
        best.iter().copied().filter(|best| best.is_finite()).fold(f64::INFINITY, f64::min);
    let caption = html! {
        "After " (history.len()) " generations the best so far is " (number(reached, 5)) "."
    };
    let content = html! {
        (figure(&drawing(&best, &mean), &label, &caption))
        (explained(&CONVERGENCE))
    };
    Some(Section { id: "convergence", heading: "Convergence", content, wide: false })
}

fn drawing(best: &[f64], mean: &[f64]) -> Figure {
    let numbered = |values: &[f64]| -> Vec<(f64, f64)> {
        let shown = |value: &f64| if has_failed(*value) { f64::NAN } else { *value };
        values.iter().enumerate().map(|(k, value)| (k as f64 + 1.0, shown(value))).collect()
    };
    let mut so_far = f64::INFINITY;
    let falling: Vec<f64> = best
        .iter()
        .map(|value| {
            so_far = so_far.min(*value);
            so_far
        })
        .collect();
    // What lies far above the best of the first generation would leave it a few pixels.
    let first = best.iter().copied().find(|best| !has_failed(*best)).unwrap_or(f64::INFINITY);
    let low = |values: &[f64]| numbered(&undrowned(values, first));
    let objective = "objective (smaller is better)";
    let y = match best.iter().filter(|value| value.is_finite()).all(|value| *value > 0.0) {
        true => Axis::logarithmic(objective, ""),
        false => Axis::linear(objective, ""),
    };
    let mut all = vec![
        series("mean", &low(mean), Mark::Thin, 3),
        series("best of the generation", &low(best), Mark::Thin, 2),
        series("best so far", &numbered(&falling), Mark::Line, 1),
    ];
    all.retain(|series| series.y.iter().any(|value| value.is_finite()));
    one_panel(Axis::linear("generation", ""), y, 230.0, all)
}
