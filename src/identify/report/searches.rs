//! Where every search with a different seed ended, sorted.

use super::Section;
use super::explanations::SEARCHES;
use super::parts::{explained, figure, number, one_panel, series};
use super::view::View;
use crate::plot::{Axis, Mark};
use maud::html;

pub fn section(view: &View) -> Option<Section> {
    let all = &view.solution.outcome.searches;
    if all.len() < 2 {
        return None;
    }
    let mut sorted: Vec<f64> =
        all.iter().map(|own| own.objective).filter(|objective| objective.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let as_good = all.iter().filter(|own| own.as_good).count();
    let best = sorted.first().copied().unwrap_or(f64::NAN);
    let sentence = format!(
        "The best objective, {}, was found within 1 % by {as_good} of {} searches.",
        number(best, 5),
        all.len()
    );
    let points: Vec<(f64, f64)> =
        sorted.iter().enumerate().map(|(k, objective)| (k as f64 + 1.0, *objective)).collect();
    let objective = "objective (smaller is better)";
    let is_positive = best > 0.0;
    let y =
        if is_positive { Axis::logarithmic(objective, "") } else { Axis::linear(objective, "") };
    let drawn = vec![series("", &points, Mark::Thin, 1), series("", &points, Mark::Points, 1)];
    let drawing = one_panel(Axis::linear("search, sorted", ""), y, 230.0, drawn);
    let caption = html! { (sentence) };
    let content = html! {
        (figure(&drawing, &sentence, &caption))
        (explained(&SEARCHES))
    };
    Some(Section { id: "searches", heading: "All searches", content, wide: false })
}
