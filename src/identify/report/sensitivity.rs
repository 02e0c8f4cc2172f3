//! The sensitivity analysis over the whole search range, where one was asked for.

use super::Section;
use super::explanations::SENSITIVITY;
use super::parts::{explained, number, scrolling};
use super::view::View;
use maud::html;

pub fn section(view: &View) -> Option<Section> {
    let found = view.solution.importance.as_ref()?;
    let figure = |figure: Option<f64>, error: Option<f64>| match (figure, error) {
        (Some(figure), Some(error)) => format!("{} ± {}", number(figure, 3), number(error, 1)),
        (Some(figure), None) => number(figure, 3),
        (None, _) => "–".to_owned(),
    };
    let table = html! {
        table {
            thead {
                tr {
                    th scope="col" { "Parameter" }
                    @for heading in &found.headings { th scope="col" { (heading) } }
                }
            }
            tbody {
                @for parameter in &found.parameters {
                    tr {
                        th scope="row" { (parameter.name) }
                        @for k in 0..2 { td { (figure(parameter.figures[k], parameter.errors[k])) } }
                    }
                }
            }
        }
    };
    let content = html! {
        p { "Method: " (found.method) ", " (found.simulations) " simulations, " (found.failed) " failed." }
        (scrolling("Sensitivity over the search range", &table))
        (explained(&SENSITIVITY))
    };
    Some(Section { id: "sensitivity", heading: "Global sensitivity", content, wide: false })
}
