//! `stateSelect` is obeyed (MLS §4.9.7.1): checked once the states are chosen.
//!
//! `StateSelect.never` on a variable that nothing can take the place of, and `StateSelect.always` on
//! one whose derivative does not occur, are warnings, and errors where the specification is to be
//! followed in all.

use super::causalized::Alias;
use super::dummy_derivatives::ChosenStates;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::BaseType;
use crate::lower::errors::STATE_SELECT;
use crate::lower::{Dae, StateSelect, Variable, VariableKind};
use crate::symbolic::VarId;
use rustc_hash::FxHashSet;

/// Adds a warning for each variable whose `stateSelect` is not obeyed; the first is an error if
/// `strict`.
pub(super) fn check_state_select(
    dae: &mut Dae,
    aliases: &[Option<Alias>],
    chosen: &ChosenStates,
    strict: bool,
) -> Result<(), Diagnostic> {
    let mut has_alias = vec![false; dae.variables.len()];
    for (alias, variable) in aliases.iter().zip(&dae.variables) {
        // `der(x) = -x` makes a derivative an alias, which is not a variable that a user declares.
        if let (Some(alias), false) = (alias, matches!(variable.kind, VariableKind::Derivative(_)))
        {
            has_alias[alias.of.0 as usize] = true;
        }
    }
    let candidates = chosen.selections.iter().flat_map(|selection| &selection.candidates);
    let candidates: FxHashSet<VarId> = candidates.copied().collect();
    let mut found = Vec::new();
    for position in 0..aliases.len() {
        let variable = VarId(position as u32);
        let is_state = chosen.states.binary_search(&variable).is_ok();
        if candidates.contains(&variable) {
            continue;
        }
        let is_alias = aliases[position].is_some();
        // Of aliases, another one may be meant to be the state.
        found.extend((!is_alias).then(|| judged(dae, position, is_state, has_alias[position])));
    }
    for warning in found.into_iter().flatten() {
        match strict {
            true => return Err(warning),
            false => dae.warnings.push(warning.warning()),
        }
    }
    Ok(())
}

/// What is wrong with the choice of one variable.
fn judged(dae: &Dae, position: usize, is_state: bool, has_alias: bool) -> Option<Diagnostic> {
    let variable = &dae.variables[position];
    let name = &variable.name;
    let warning = match (variable.state_select, is_state) {
        (StateSelect::Never, true) if !has_alias => fault!(
            STATE_SELECT,
            "`{name}` has `stateSelect = StateSelect.never`, but is needed as a state";
            help: "remove the attribute, or write the equations so that another variable is \
                differentiated"
        ),
        (StateSelect::Always, false) if is_computed(variable) => fault!(
            STATE_SELECT,
            "`{name}` has `stateSelect = StateSelect.always`, but cannot be a state: its \
             derivative does not occur in the equations";
            help: "remove the attribute, or use the derivative"
        ),
        _ => return None,
    };
    Some(warning.at(variable.span))
}

/// Whether equations determine a variable, which may be constant between events.
fn is_computed(variable: &Variable) -> bool {
    variable.base == BaseType::Real
        && matches!(variable.kind, VariableKind::Unknown | VariableKind::Discrete)
}
