//! The head of the page: what was found in a few lines, and what must be known about it.

use super::parts::number;
use super::view::View;
use crate::problem::Verdict;
use maud::{Markup, html};

pub fn head(view: &View) -> Markup {
    let solution = view.solution;
    let points: usize = solution.series.iter().map(|series| series.points.len()).sum();
    html! {
        h1 { (view.title) }
        @if let Some(error) = solution.script_error() {
            p.lead { strong.bad { (error.sentence()) } }
        }
        p.lead { (verdict(view)) }
        p.facts {
            (points) " data points; objective (" (solution.subject.fitness_name) ") "
            (number(solution.fitness, 6))
            @if let Some(test) = &solution.likelihood.chi_square {
                "; chi-square " (number(test.value, 4)) " for " (number(test.freedom, 4))
                " degrees of freedom, p-value " (number(test.probability, 2))
            }
        }
    }
}

/// What must be known about the numbers.
pub(super) fn remarks(view: &View) -> Markup {
    html! {
        @if !view.notes.is_empty() {
            h3 #notes-heading { "Remarks" }
            ul.notes { @for note in &view.notes { li class=(note.weight) { (note.sentence) } } }
        }
        @if !view.next.is_empty() {
            h3 #next-heading { "The next measurement" }
            ul.next { @for sentence in &view.next { li { (sentence) } } }
        }
        @for (heading, sentences) in &view.intervals {
            h3 { (heading) }
            ul.next { @for sentence in sentences { li { (sentence) } } }
        }
    }
}

/// One or two sentences: how the search ended, and how many parameters are identifiable.
fn verdict(view: &View) -> Markup {
    let parameters = &view.solution.parameters;
    let judged: Vec<Verdict> = parameters.iter().filter_map(|p| p.verdict).collect();
    let identifiable = judged.iter().filter(|v| **v == Verdict::Identifiable).count();
    html! {
        @if view.solution.has_strong_pattern() {
            strong.bad {
                "The model does not describe these data within their noise: the residuals have a "
                "pattern."
            }
            " "
        }
        strong class=(view.ending.class) { (view.ending.sentence) } " "
        @if view.solution.may_be_misread() {
            "The data may be read wrongly: check the units and the signs of the data, and the ranges, "
            "before anything is said of the parameters."
        } @else if judged.is_empty() {
            "Standard errors are not available, so there is no statement on identifiability."
        } @else if identifiable == parameters.len() {
            @if identifiable == 1 { "The parameter is" }
            @else { "All " (identifiable) " parameters are" }
            " identifiable from these data" (condition(view)) "."
        } @else {
            (identifiable) " of " (parameters.len())
            @if parameters.len() == 1 { " parameter is " } @else { " parameters are " }
            "identifiable from these data" (condition(view)) "."
        }
    }
}

/// What the statement depends on.
fn condition(view: &View) -> String {
    let given = match view.solution.at_ends().as_slice() {
        [] => String::new(),
        names => format!(", given the values of {} at ends of their ranges", names.join(", ")),
    };
    let assumption = view.solution.assumption();
    given + &assumption.map_or_else(String::new, |assumption| format!(", {assumption}"))
}
