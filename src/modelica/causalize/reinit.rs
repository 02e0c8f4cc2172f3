//! `reinit` sets states only (MLS §8.3.6): checked once the states are chosen. That of a discrete variable
//! is an assignment to it, with a warning; a strict check refuses it before.

use super::causalized::{Alias, Selection};
use crate::diag::Diagnostic;
use crate::fault;
use crate::lower::errors::NOT_SUPPORTED;
use crate::lower::{Dae, Reinit, VariableKind};
use crate::symbolic::VarId;

/// Makes of each `reinit` of a discrete variable that an equation determines a branch of this equation.
pub(super) fn assign_discrete(dae: &mut Dae, aliases: &[Option<Alias>]) {
    let (of_discrete, others) = std::mem::take(&mut dae.events.reinits)
        .into_iter()
        .partition(|reinit| dae.variable(reinit.state).kind == VariableKind::Discrete);
    dae.events.reinits = others;
    let of_discrete: Vec<Reinit> = of_discrete;
    for reinit in of_discrete {
        let alias = aliases[reinit.state.0 as usize].filter(|alias| !alias.negated);
        let left = dae.pool.variable(alias.map_or(reinit.state, |alias| alias.of));
        let Some(at) = dae.events.equations.iter().position(|equation| equation.left == left)
        else {
            // Refused below.
            dae.events.reinits.push(reinit);
            continue;
        };
        let before = dae.events.equations[at].right;
        let right = dae.pool.if_then_else(reinit.condition, reinit.value, before);
        dae.events.equations[at].right = right;
        let name = &dae.variable(reinit.state).name;
        let warning = fault!(NOT_SUPPORTED,
            "`reinit` of `{name}`, which is discrete, is taken as an equation for it";
            help: "write `{name} = …` in the when-clause instead of `reinit`");
        dae.warnings.push(warning.at(reinit.span).warning());
    }
}

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
