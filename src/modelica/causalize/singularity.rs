//! Structural singularity in the words of the model: the parts of the Dulmage-Mendelsohn
//! decomposition that have too many equations, and too few.
//!
//! A system is structurally singular if no matching assigns an equation to every unknown, whatever
//! numbers the equations contain. A system that is singular with the numbers that it has then is
//! numerically singular: that is found where its block is solved.

use crate::diag::Diagnostic;
use crate::fault;
use crate::graph::{Bipartite, DulmageMendelsohn, Matching, dulmage_mendelsohn};
use crate::lower::errors::{SINGULAR_SYSTEM, UNBALANCED_MODEL};
use crate::lower::{Dae, Equation};
use crate::source::Span;
use crate::symbolic::VarId;
use indexmap::{IndexMap, IndexSet};

/// The most instances named for an equation.
const MAX_OWNERS: usize = 4;
/// Variables that a message names.
const MAX_NAMES: usize = 6;
/// Equations that a message marks, of each part.
const MAX_MARKED: usize = 7;

/// Names the variables and equations that do not fit.
pub(super) fn report(
    dae: &Dae,
    system: &str,
    equations: &[Equation],
    unknowns: &[VarId],
    graph: &Bipartite,
    matching: &Matching,
) -> Diagnostic {
    let parts = dulmage_mendelsohn(graph, matching);
    let mut fault = match equations.len() == unknowns.len() {
        true => fault!(
            SINGULAR_SYSTEM,
            "the equations of {system} do not determine its variables: they are structurally \
             singular"
        ),
        false => fault!(
            UNBALANCED_MODEL,
            "{system} has {} unknowns but {} equations",
            unknowns.len(),
            equations.len()
        ),
    };
    let names = |list: &[usize]| names(dae, unknowns, list);
    if !parts.under_unknowns.is_empty() {
        fault = fault.help(under_determined(&parts, &names(&parts.under_unknowns)));
    }
    if !parts.over_equations.is_empty() {
        fault = fault.help(over_determined(&parts, &names(&parts.over_unknowns)));
    }
    if lacks_reference(&parts) {
        fault = fault.help(
            "if these are connected components, no potential is fixed: add a ground, or another \
             component with a reference value, and connect it",
        );
    }
    let marked = |list: &[usize]| places(dae, list.iter().map(|e| equations[*e])).into_iter();
    let mut redundant = marked(&parts.over_equations);
    let undetermined = parts.under_unknowns.first().map(|u| dae.variable(unknowns[*u]).span);
    let (first, text) = match undetermined {
        Some(span) if parts.under_equations.is_empty() => {
            (span, "no equation determines this".to_owned())
        }
        Some(span) => (span, "not determined, with others".to_owned()),
        None => {
            let (span, whose) = redundant.next().unwrap_or((Span::NONE, String::new()));
            (span, format!("one equation too many{whose}"))
        }
    };
    let mut diagnostic = fault.labelled(first, text);
    for (span, whose) in redundant.take(MAX_MARKED - 1) {
        diagnostic = diagnostic.related(span, format!("one of the redundant equations{whose}"));
    }
    for (span, whose) in marked(&parts.under_equations).take(MAX_MARKED) {
        let text = format!("contains variables that are not determined{whose}");
        diagnostic = diagnostic.related(span, text);
    }
    diagnostic
}

/// Whether as many equations are left without any unknown as are missing elsewhere: so do circuits
/// without a ground, whose balance of currents follows from the others while every equation contains
/// only differences of potentials.
fn lacks_reference(parts: &DulmageMendelsohn) -> bool {
    let missing = parts.under_unknowns.len() - parts.under_equations.len();
    missing > 0
        && !parts.under_equations.is_empty()
        && parts.over_unknowns.is_empty()
        && parts.over_equations.len() == missing
}

/// What to do about the part with fewer equations than unknowns.
fn under_determined(parts: &DulmageMendelsohn, names: &str) -> String {
    let (equations, unknowns) = (parts.under_equations.len(), parts.under_unknowns.len());
    let missing = match unknowns - equations {
        1 => "an equation that determines".to_owned(),
        n => format!("{n} equations that determine"),
    };
    let only = match equations {
        0 => String::new(),
        1 => format!(": only 1 equation contains these {unknowns} unknowns"),
        n => format!(": only {n} equations contain these {unknowns} unknowns"),
    };
    format!("add {missing} {names}{only}")
}

/// What to do about the part with more equations than unknowns.
fn over_determined(parts: &DulmageMendelsohn, names: &str) -> String {
    let (equations, unknowns) = (parts.over_equations.len(), parts.over_unknowns.len());
    let redundant = match equations - unknowns {
        1 => "one".to_owned(),
        n => n.to_string(),
    };
    match (unknowns, equations) {
        (0, 1) => "remove the marked equation: it contains no unknown".to_owned(),
        (0, _) => format!("remove {redundant} of the marked equations: they contain no unknown"),
        _ => format!(
            "remove {redundant} of the marked equations: they determine {names} more than once"
        ),
    }
}

/// The first names of a list of unknowns.
fn names(dae: &Dae, unknowns: &[VarId], list: &[usize]) -> String {
    let name = |u: &usize| format!("`{}`", dae.variable(unknowns[*u]).name);
    let shown: Vec<String> = list.iter().take(MAX_NAMES).map(name).collect();
    let more = if list.len() > MAX_NAMES { ", …" } else { "" };
    format!("{}{more}", shown.join(", "))
}

/// Where equations are written and, where instances share the place, whose they are.
fn places(dae: &Dae, equations: impl Iterator<Item = Equation>) -> IndexMap<Span, String> {
    let mut owners: IndexMap<Span, IndexSet<&str>> = IndexMap::new();
    for equation in equations {
        let owners = owners.entry(equation.span).or_default();
        let path = equation.instance.map_or("", |of| &*dae.instances[of.0 as usize]);
        owners.extend((!path.is_empty()).then_some(path));
    }
    let words = |owners: IndexSet<&str>| match owners.len() {
        0 => String::new(),
        n => {
            let shown: Vec<String> =
                owners.iter().take(MAX_OWNERS).map(|path| format!("`{path}`")).collect();
            let more = if n > MAX_OWNERS { ", …" } else { "" };
            format!(", in {}{more}", shown.join(", "))
        }
    };
    owners.into_iter().map(|(span, owners)| (span, words(owners))).collect()
}
