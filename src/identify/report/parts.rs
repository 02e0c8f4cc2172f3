//! Pieces that several sections use.

use super::explanations::Explanation;
use crate::elementary;
use crate::plot::{Axis, Figure, Mark, Panel, Scale, Series};
use crate::problem::{Solution, SolvedParameter};
use crate::table::significant;
use maud::{Markup, PreEscaped, html};

/// A figure with a caption; `label` says in words what it shows.
pub fn figure(figure: &Figure, label: &str, caption: &Markup) -> Markup {
    html! {
        figure {
            (PreEscaped(figure.inline(label)))
            figcaption { (caption) }
        }
    }
}

/// The same for figures that stand side by side.
pub(crate) fn small_figure(figure: &Figure, label: &str, caption: &Markup) -> Markup {
    html! {
        figure {
            (PreEscaped(figure.small(label)))
            figcaption { (caption) }
        }
    }
}

/// The legend of figures that stand side by side.
pub(super) fn legend(figure: &Figure) -> Markup {
    html! { figure.legend { (PreEscaped(figure.legend())) } }
}

/// A table, or anything else that may be wider than the screen; `label` names it.
pub(crate) fn scrolling(label: &str, content: &Markup) -> Markup {
    html! { div.scroll tabindex="0" role="region" aria-label=(label) { (content) } }
}

/// What a statistic means, with its threshold, and where the guide says more.
pub fn explained(explanation: &Explanation) -> Markup {
    html! {
        p.explanation {
            (explanation.line) " "
            a href={ "#" (explanation.anchor()) } { "More about " (explanation.topic) }
        }
    }
}

/// A number with its unit.
pub fn quantity(value: f64, digits: usize, unit: &str) -> String {
    let unit = crate::plot::shown_unit(unit);
    match unit.is_empty() {
        true => number(value, digits),
        false => format!("{}\u{a0}{unit}", number(value, digits)),
    }
}

/// A number with its unit as engineers write it: 0.42 mV for 4.2e-4 V.
pub(super) fn engineering(value: f64, digits: usize, unit: &str) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        return quantity(value, digits, unit);
    }
    let power = 3 * (elementary::log10(value.abs()) / 3.0).floor() as i32;
    match crate::plot::prefixed(unit, power) {
        Some(prefixed) => quantity(value / elementary::powi(10.0, power), digits, &prefixed),
        None => quantity(value, digits, unit),
    }
}

/// A number as it is read: 1.2 × 10⁻⁷.
pub fn number(value: f64, digits: usize) -> String {
    let text = significant(value, digits).replace('-', "\u{2212}");
    let parts = text.split_once('e');
    match parts
        .and_then(|(digits, power)| Some((digits, power.replace('\u{2212}', "-").parse().ok()?)))
    {
        Some((digits, power)) => format!("{digits}\u{a0}×\u{a0}{}", crate::plot::power(power)),
        None => text,
    }
}

impl Solution {
    /// The axis of a parameter, by its description.
    pub(super) fn axis_of(&self, parameter: &SolvedParameter, logarithmic: bool) -> Axis {
        let SolvedParameter { name, unit, .. } = parameter;
        let scale = axis(parameter, logarithmic).scale;
        Axis { scale, ..Axis::of_variable(name, self.subject.descriptions.of(name), unit) }
    }
}

/// The axis of a parameter, by its name.
pub fn axis(parameter: &SolvedParameter, logarithmic: bool) -> Axis {
    let scale = if logarithmic { Scale::Logarithmic } else { Scale::Linear };
    Axis { scale, ..Axis::linear(&parameter.name, &parameter.unit) }
}

pub fn series(name: &str, points: &[(f64, f64)], mark: Mark, colour: usize) -> Series {
    let (x, y) = points.iter().copied().unzip();
    Series { name: name.to_owned(), x, y, mark, colour }
}

/// A figure of one panel without a title: headings are those of the page.
pub(crate) fn one_panel(x: Axis, y: Axis, height: f64, series: Vec<Series>) -> Figure {
    let panel = Panel { x, y, height, zero_line: false, series };
    Figure { title: String::new(), panels: vec![panel] }
}
