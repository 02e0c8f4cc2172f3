//! What the run took, what failed, every generation, and the problem as it was written.

use super::Section;
use super::parts::{number, scrolling};
use super::view::View;
use crate::problem::Solution;
use maud::{Markup, html};

/// Generations in the table; of a longer run an even choice.
const ROWS: usize = 200;
/// Causes of failure that are named.
const CAUSES: usize = 5;

pub fn section(view: &View) -> Option<Section> {
    let solution = view.solution;
    let content = html! {
        (counts(solution))
        @if !solution.course.history.is_empty() {
            details {
                summary { "Generations" }
                (scrolling("Generations", &generations(solution)))
            }
        }
        @if !solution.provenance.problem.is_empty() {
            details {
                summary { "The problem as it was written" }
                (scrolling("The problem", &html! { pre { (solution.provenance.problem) } }))
            }
        }
    };
    Some(Section { id: "run", heading: "The run", content, wide: true })
}

fn counts(solution: &Solution) -> Markup {
    let failed: u64 = solution.effort.failures.values().sum();
    let share = 100.0 * failed as f64 / solution.effort.evaluations.max(1) as f64;
    let mut causes: Vec<(&String, &u64)> = solution.effort.causes.iter().collect();
    causes.sort_by(|a, b| b.1.cmp(a.1));
    let seed = solution
        .provenance
        .seed
        .map_or_else(|| "-".to_owned(), |seed| seed.map(|entry| entry.to_string()).join(" "));
    html! {
        dl.facts {
            div { dt { "Model" } dd { (solution.subject.model) } }
            div { dt { "Method" } dd { (solution.subject.method) } }
            @if !solution.subject.operators.is_empty() {
                div { dt { "Operators" }
                    dd { @for (kind, label) in &solution.subject.operators { (kind) " " (label) "; " } } }
            }
            div { dt { "Stopped" } dd { (solution.outcome.stop) } }
            div { dt { "Generations" } dd { (solution.effort.generations) } }
            div { dt { "Individuals" } dd { (solution.effort.evaluations) ", " (failed) " failed (" (number(share, 2)) "\u{a0}%)" } }
            div { dt { "Simulations" } dd { (solution.effort.simulations) " for the search, " (solution.effort.simulations_for_statistics) " for the standard errors"
                @if let Some(profiles) = &solution.profiles { ", " (profiles.simulations) " for the profiles" } } }
            @if let Some(how) = &solution.outcome.ending.derivatives {
                div { dt { "Derivatives" } dd { (how) } }
            }
            div { dt { "Seed" } dd { (seed) } }
        }
        @if !causes.is_empty() {
            p { "Failures:" }
            ul { @for (cause, count) in causes.iter().take(CAUSES) { li { (count) " × " (cause) } } }
        }
        @if !solution.effort.changes.is_empty() {
            p { "Changed during the run:" }
            ul {
                @for (generation, setting, value) in &solution.effort.changes {
                    li { (setting) " = " (value) " after generation " (generation) }
                }
            }
        }
    }
}

fn generations(solution: &Solution) -> Markup {
    let every = solution.course.history.len().div_ceil(ROWS).max(1);
    let last = solution.course.history.len().saturating_sub(1);
    let shown =
        solution.course.history.iter().enumerate().filter(|(k, _)| k % every == 0 || *k == last);
    html! {
        table {
            thead {
                tr {
                    @for heading in ["Generation", "Best", "Mean", "Worst", "Failures"] {
                        th scope="col" { (heading) }
                    }
                    @for parameter in &solution.parameters { th scope="col" { (parameter.name) } }
                }
            }
            tbody {
                @for (k, generation) in shown {
                    tr {
                        th scope="row" { (k + 1) }
                        td { (number(generation.best, 6)) }
                        td { (number(generation.mean, 4)) }
                        td { (number(generation.worst, 4)) }
                        td { (generation.failures) }
                        @for value in solution.course.trace.get(k).into_iter().flatten() {
                            td { (number(*value, 6)) }
                        }
                    }
                }
            }
        }
    }
}
