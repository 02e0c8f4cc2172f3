//! Where every descent ended, sorted: a plateau shows that several starts reach one minimum.

use super::Section;
use super::explanations::WATERFALL;
use super::parts::{explained, figure, number, one_panel, series};
use super::view::{Descent, View};
use crate::plot::{Axis, Figure, Mark};
use maud::html;

pub fn section(view: &View) -> Option<Section> {
    // One descent is a point, and said elsewhere.
    if view.descents.len() < 2 {
        return None;
    }
    let mut sorted = view.descents.clone();
    sorted.sort_by(|a, b| a.objective.total_cmp(&b.objective));
    let best = sorted[0].objective;
    let reached = sorted.iter().filter(|descent| descent.is_best).count();
    // Those whose start could not be simulated count, too, as in the line on the ending.
    let of = view.solution.outcome.descents.len();
    let sentence = format!(
        "The best objective, {}, was reached by {reached} of {of} descents.",
        number(best, 5)
    );
    let caption = html! { (sentence) };
    let content = html! {
        (figure(&drawing(&sorted), &sentence, &caption))
        (explained(&WATERFALL))
    };
    Some(Section { id: "waterfall", heading: "All descents", content, wide: false })
}

fn drawing(sorted: &[Descent]) -> Figure {
    let numbered = || sorted.iter().enumerate().map(|(k, descent)| (k as f64 + 1.0, descent));
    let pick = |minimum: bool| -> Vec<(f64, f64)> {
        numbered().filter(|(_, d)| d.minimum == minimum).map(|(k, d)| (k, d.objective)).collect()
    };
    let positive = sorted.iter().all(|descent| descent.objective > 0.0);
    let objective = "objective (smaller is better)";
    let y = if positive { Axis::logarithmic(objective, "") } else { Axis::linear(objective, "") };
    let line: Vec<(f64, f64)> = numbered().map(|(k, descent)| (k, descent.objective)).collect();
    let mut all =
        vec![series("", &line, Mark::Thin, 1), series("minimum", &pick(true), Mark::Points, 1)];
    let cut = pick(false);
    if !cut.is_empty() {
        all.push(series("cut off", &cut, Mark::Crosses, 2));
    }
    one_panel(Axis::linear("descent, sorted", ""), y, 230.0, all)
}
