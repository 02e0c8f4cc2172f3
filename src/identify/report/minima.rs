//! Other minima whose objective the data do not distinguish from the result's.

use super::Section;
use super::explanations::MINIMA;
use super::parts::{explained, number, quantity, scrolling};
use super::view::View;
use maud::html;

pub fn section(view: &View) -> Option<Section> {
    let solution = view.solution;
    if view.minima.is_empty() {
        return None;
    }
    let table = html! {
        table {
            thead {
                tr {
                    th scope="col" { "Objective" }
                    @for parameter in &solution.parameters { th scope="col" { (parameter.name) } }
                }
            }
            tbody {
                tr {
                    th scope="row" { (number(solution.fitness, 6)) " (the result)" }
                    @for p in &solution.parameters { td { (quantity(p.value, 5, &p.unit)) } }
                }
                @for (values, objective) in &view.minima {
                    tr {
                        th scope="row" { (number(*objective, 6)) }
                        @for (value, p) in values.iter().zip(&solution.parameters) {
                            td { (quantity(*value, 5, &p.unit)) }
                        }
                    }
                }
            }
        }
    };
    let content = html! { (scrolling("Table of other minima", &table)) (explained(&MINIMA)) };
    Some(Section { id: "minima", heading: "Other minima", content, wide: true })
}
