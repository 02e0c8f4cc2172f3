//! Integration methods of the two tools that are not here, and what is taken instead.

use crate::script::Session;
use crate::script::errors::METHOD_REPLACED;
use crate::script::models::simulation::Wishes;

/// Methods that keep the tolerance with implicit formulas, or that choose between formulas.
const IMPLICIT: &[&str] = &[
    "deabm",
    "esdirk23a",
    "esdirk34a",
    "esdirk45a",
    "gbode",
    "impeuler",
    "imprungekutta",
    "irksco",
    "lsode",
    "lsode1",
    "lsode2",
    "mebdf",
    "mebdfi",
    "mexx",
    "odassl",
    "qss",
    "rungekuttaSsc",
    "sdirk34hw",
    "symSolver",
    "symSolverSsc",
    "trapezoid",
];

/// Methods that keep the tolerance with explicit formulas.
const EXPLICIT: &[&str] = &["cerk23", "cerk34", "cerk45", "dopri853", "godess"];

/// The wishes with a method that there is; said when it is another one than asked for.
pub(super) fn with_method_of_ours(session: &mut Session, wishes: Wishes) -> Wishes {
    let Some(wanted) = wishes.method.as_deref() else { return wishes };
    let is_in = |names: &[&str]| names.iter().any(|name| name.eq_ignore_ascii_case(wanted));
    let ours = match () {
        () if is_in(IMPLICIT) => "dassl",
        () if is_in(EXPLICIT) => "dopri5",
        () => return wishes,
    };
    let text =
        format!("the integration method `{wanted}` is not available; `{ours}` is used instead");
    session.note(METHOD_REPLACED, text);
    Wishes { method: Some(ours.to_owned()), ..wishes }
}
