//! Integration methods of the two tools that are not here, and what is taken instead.

use crate::Session;
use crate::errors::METHOD_REPLACED;
use crate::models::simulation::SimulationOptions;

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
const EXPLICIT: &[&str] = &["cerk23", "cerk34", "cerk45", "godess"];

/// The options with a method that there is; said when it is another one than asked for.
pub(super) fn with_method_of_ours(
    session: &mut Session,
    options: SimulationOptions,
) -> SimulationOptions {
    let Some(requested) = options.method.as_deref() else { return options };
    let is_in = |names: &[&str]| names.iter().any(|name| name.eq_ignore_ascii_case(requested));
    let ours = match () {
        () if is_in(IMPLICIT) => "dassl",
        () if is_in(EXPLICIT) => "dopri5",
        () => return options,
    };
    let text =
        format!("the integration method `{requested}` is not available; `{ours}` is used instead");
    session.note(METHOD_REPLACED, text);
    SimulationOptions { method: Some(ours.to_owned()), ..options }
}
