//! The front of two objectives and its knee.

use super::Section;
use super::explanations::FRONT;
use super::parts::{explained, figure, number, one_panel, series};
use super::view::View;
use crate::plot::{Axis, Mark};
use maud::html;

pub fn section(view: &View) -> Option<Section> {
    let solution = view.solution;
    let [across, up] = solution.pareto.objectives.as_slice() else { return None };
    if solution.pareto.front.len() < 2 {
        return None;
    }
    let at = |point: &(Vec<f64>, Vec<f64>)| (point.1[0], point.1[1]);
    let points: Vec<(f64, f64)> = solution.pareto.front.iter().map(at).collect();
    let knee = solution.pareto.knee.and_then(|knee| points.get(knee)).copied();
    let mut all = vec![series("front", &points, Mark::Points, 1)];
    all.extend(knee.map(|knee| series("knee", &[knee], Mark::Crosses, 2)));
    let drawing = one_panel(Axis::linear(across, ""), Axis::linear(up, ""), 300.0, all);
    let label = format!("The front of {across} and {up}, {} points", points.len());
    let caption = html! {
        (points.len()) " points"
        @if let Some((x, y)) = knee { ", knee at " (number(x, 4)) ", " (number(y, 4)) }
        @if let Some((volume, _)) = &solution.pareto.hypervolume { ", hypervolume " (number(*volume, 4)) }
        "."
    };
    let content = html! { (figure(&drawing, &label, &caption)) (explained(&FRONT)) };
    Some(Section { id: "front", heading: "Front of the objectives", content, wide: false })
}
