//! The result as a table: values with units, 95 % intervals, standard errors and verdicts.

use super::Section;
use super::explanations::{INTERVAL, STANDARD_ERROR};
use super::parts::{explained, number, quantity, scrolling};
use super::summary::remarks;
use super::view::{View, fraction};
use crate::problem::{SolvedParameter, Verdict};
use crate::table::digits_of;
use maud::{Markup, html};

/// Headings. On a phone, where each row is a block, they stand before the values.
const COLUMNS: [&str; 5] =
    ["Parameter", "Value", "95 % interval, search range", "Standard error", "Verdict"];

pub fn section(view: &View) -> Option<Section> {
    let content = html! {
        (scrolling("Estimated parameters", &table(view)))
        (remarks(view))
        (explained(&INTERVAL))
        (explained(&STANDARD_ERROR))
    };
    Some(Section { id: "result", heading: "Result", content, wide: false })
}

fn table(view: &View) -> Markup {
    html! {
        table.result role="table" {
            thead role="rowgroup" {
                tr role="row" {
                    @for heading in COLUMNS { th scope="col" role="columnheader" { (heading) } }
                }
            }
            tbody role="rowgroup" { @for parameter in &view.solution.parameters { (row(view, parameter)) } }
        }
    }
}

fn row(view: &View, parameter: &SolvedParameter) -> Markup {
    let script = view.solution.script.as_ref().filter(|script| script.probed);
    let own = script.and_then(|script| script.parameters.get(&parameter.name));
    let interval = html! {
        @match parameter.interval {
            Some(ends) => { (interval_in_words(parameter, ends)) }
            None => { "–" }
        }
        (range(parameter, script.is_none()))
    };
    let cells = [
        html! {
            strong { (quantity(parameter.value, parameter.digits(), &parameter.unit)) }
            @if let Some(own) = own {
                br; "script's best: " (quantity(*own, 5, &parameter.unit))
            }
        },
        interval,
        html! { (standard_error(parameter)) },
        verdict(view, parameter),
    ];
    html! {
        tr role="row" {
            th scope="row" role="rowheader" {
                (parameter.name)
                @let description = view.solution.subject.descriptions.of(&parameter.name);
                @if !description.is_empty() { span.ends { (description) } }
            }
            @for (heading, cell) in COLUMNS[1..].iter().zip(&cells) {
                td role="cell" data-label=(heading) { div { (cell) } }
            }
        }
    }
}

/// The interval, as far as the data end it, and its other parts.
fn interval_in_words(parameter: &SolvedParameter, [low, high]: [f64; 2]) -> String {
    let digits = digits_of(high - low, low.abs().max(high.abs()));
    let between =
        |[low, high]: [f64; 2]| format!("{} to {}", number(low, digits), number(high, digits));
    match parameter.open {
        [false, false] if parameter.pieces.is_empty() => between([low, high]),
        [false, false] => {
            let parts: Vec<String> = parameter.pieces.iter().map(|part| between(*part)).collect();
            parts.join("; ")
        }
        [false, true] => format!("at least {}", number(low, 4)),
        [true, false] => format!("at most {}", number(high, 4)),
        [true, true] => "the whole range".to_owned(),
    }
}

fn standard_error(parameter: &SolvedParameter) -> String {
    match parameter.deviation {
        Some(error) if error <= parameter.value.abs() => {
            format!("{}\u{a0}%", number(100.0 * error / parameter.value.abs(), 2))
        }
        Some(error) => quantity(error, 3, &parameter.unit),
        None if parameter.determined == Some(false) => "unbounded".to_owned(),
        None => "–".to_owned(),
    }
}

fn verdict(view: &View, parameter: &SolvedParameter) -> Markup {
    let assumption = view.solution.assumption();
    let class = match parameter.verdict {
        Some(Verdict::Identifiable) if assumption.is_none() => "good",
        _ => "bad",
    };
    html! {
        @match parameter.verdict {
            Some(verdict) => {
                span class=(class) { (verdict.words()) }
                @if let Some(assumption) = assumption { br; span.ends { "(" (assumption) ")" } }
            },
            None => span { "–" },
        }
        @if parameter.at_bound { br; span.bad { "at the end of its range" } }
    }
}

/// The ends of the range, and between them where the interval and the value lie.
/// `says_scale`: whether the logarithm was searched where the estimate follows it; scripts do not.
fn range(parameter: &SolvedParameter, says_scale: bool) -> Markup {
    let place = |value: f64| 4.0 + 112.0 * fraction(parameter, value);
    let [low, high] = parameter.interval.unwrap_or([parameter.value; 2]).map(place);
    let value = place(parameter.value);
    html! {
        span.ends { "in " (number(parameter.range[0], 4)) " to " (number(parameter.range[1], 4))
            @if parameter.logarithmic && says_scale { " (log)" }
        }
        svg.strip viewBox="0 0 120 14" aria-hidden="true" {
            line x1="4" x2="116" y1="7" y2="7" stroke="var(--frame)" stroke-width="1.5" {}
            line x1=(format!("{low:.1}")) x2=(format!("{high:.1}")) y1="7" y2="7" stroke="var(--c1)" stroke-width="5" stroke-opacity="0.6" {}
            line x1=(format!("{value:.1}")) x2=(format!("{value:.1}")) y1="1" y2="13" stroke="var(--ink)" stroke-width="2" {}
        }
    }
}
