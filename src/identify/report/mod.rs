//! The report page: what a run found, how well it fits, and what the data say about it, as one HTML
//! file without any request to elsewhere.
//!
//! All that the page says is there without a script. The script adds what paper cannot do: the values
//! under the pointer, a closer look, series switched off. Figures are SVG in colours of the style sheet,
//! so that they follow the reader's choice of light or dark; tables that are wider than the screen
//! scroll by themselves and can be reached with the keyboard. A section whose data are missing is left
//! out. Each statistic is explained in a line with its threshold, and leads to the chapter of the guide
//! on reading reports, which is part of the page.

mod contributions;
mod convergence;
mod explanations;
mod fit;
mod front;
mod guide;
mod minima;
mod pairs;
mod parts;
mod profiles;
mod residuals;
mod run;
mod searches;
mod sensitivity;
mod summary;
mod table;
mod traces;
mod view;
mod waterfall;

use super::problem::Solution;
use crate::page::Page;
use maud::{Markup, html};
use view::View;

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");

impl Solution {
    /// `report.html`.
    pub fn html(&self) -> String {
        let view = View::of(self);
        Page {
            title: &self.subject.title,
            style: STYLE,
            scripts: &[SCRIPT],
            data: &[],
            body: body(&view),
        }
        .document()
    }
}

/// A section of the page: the id that links lead to, its heading, and its content.
struct Section {
    id: &'static str,
    heading: &'static str,
    content: Markup,
    /// As wide as the page instead of a column.
    wide: bool,
}

fn body(view: &View) -> Markup {
    let mut sections: Vec<Section> = [
        table::section(view),
        fit::section(view),
        fit::others(view),
        convergence::section(view),
        waterfall::section(view),
        searches::section(view),
        residuals::section(view),
        minima::section(view),
        pairs::section(view),
        contributions::section(view),
        profiles::section(view),
        sensitivity::section(view),
        front::section(view),
        traces::section(view),
        run::section(view),
    ]
    .into_iter()
    .flatten()
    .collect();
    without_empty_halves(&mut sections);
    html! {
        a.skip href="#content" { "Skip to the result" }
        header { (summary::head(view)) }
        nav aria-label="Sections" {
            @for section in &sections { a href={ "#" (section.id) } { (section.heading) } }
            a href="#guide" { "How to read this page" }
        }
        main #content {
            @for section in &sections {
                section.wide[section.wide] id=(section.id) aria-labelledby={ (section.id) "-heading" } {
                    h2 id={ (section.id) "-heading" } { (section.heading) }
                    (section.content)
                }
            }
            section.wide #guide aria-labelledby="guide-heading" {
                h2 #guide-heading { "How to read this page" }
                details { summary { "Show the chapter" } (guide::chapter()) }
            }
        }
        footer { p { "gapilib " (view.solution.provenance.version) } }
    }
}

/// A section that would have no neighbour in its row is as wide as the page.
fn without_empty_halves(sections: &mut [Section]) {
    for row in sections.chunk_by_mut(|a, b| a.wide == b.wide) {
        let is_odd = row.len() % 2 == 1;
        if let Some(last) = row.last_mut().filter(|_| is_odd) {
            last.wide = true;
        }
    }
}
