//! What each experiment contributes to what is known of each parameter.

use super::Section;
use super::parts::scrolling;
use super::view::View;
use crate::table::significant;
use maud::{Markup, html};

pub fn section(view: &View) -> Option<Section> {
    let solution = view.solution;
    let all = &solution.inferred.contributions;
    if all.is_empty() {
        return None;
    }
    let table = html! {
        table {
            thead {
                tr {
                    th scope="col" { "Parameter" }
                    @for own in all { th scope="col" { (own.experiment) } }
                }
            }
            tbody {
                @for (k, parameter) in solution.parameters.iter().enumerate() {
                    tr {
                        th scope="row" { (parameter.name) }
                        @for own in all { td { (cell(own.shares[k], own.without[k])) } }
                    }
                }
            }
        }
    };
    let names: Vec<String> = solution.parameters.iter().map(|own| own.name.clone()).collect();
    let content = html! {
        @for sentence in &solution.inferred.contributed(&names) { p { (sentence) } }
        (scrolling("Contribution of each experiment to each parameter", &table))
        p.note {
            "The share of the experiment in what the data say of the parameter; below it, how many times \
             as wide the 95 % interval is without this experiment."
        }
    };
    Some(Section { id: "contributions", heading: "Information by experiment", content, wide: true })
}

/// A bar as long as the share, and the factor by which the interval widens.
fn cell(share: Option<f64>, without: Option<f64>) -> Markup {
    let Some(share) = share else { return html! { "–" } };
    let percent = 100.0 * share;
    html! {
        meter min="0" max="1" value={ (format!("{share:.4}")) } { (significant(percent, 2)) " %" }
        br;
        (significant(percent, 2)) " %"
        br;
        @match without { Some(factor) => { "× " (significant(factor, 2)) }, None => { "not determined" } }
    }
}
