//! `reinit` sets states only (MLS §8.3.5): checked once the states are chosen.

use super::causalized::{Alias, Selection};
use crate::diag::Diagnostic;
use crate::fault;
use crate::lower::Dae;
use crate::lower::errors::NOT_SUPPORTED;
use crate::symbolic::VarId;

/// Only states can be set.
pub(super) fn check_reinits(
    dae: &Dae,
    aliases: &[Option<Alias>],
    states: &[VarId],
    selections: &[Selection],
) -> Result<(), Diagnostic> {
    for reinit in &dae.events.reinits {
        let state = aliases[reinit.state.0 as usize].map_or(reinit.state, |alias| alias.of);
        let chosen = selections.iter().any(|s| s.states.contains(&state));
        if states.binary_search(&state).is_err() || chosen {
            let name = &dae.variable(reinit.state).name;
            return Err(fault!(NOT_SUPPORTED, "`reinit` of `{name}`, which is not a state";
                help: "set `stateSelect = StateSelect.always` for `{name}`")
            .at(reinit.span));
        }
    }
    Ok(())
}
