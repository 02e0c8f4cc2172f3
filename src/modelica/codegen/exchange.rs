//! What another simulator needs to know of a model before it simulates it: attributes of variables,
//! which variables follow from which states, and what only the simulator of this program offers.

use super::oscillations::TIME;
use super::program::{Program, VariableInfo};
use super::sequence::close;
use crate::causalize::Block;
pub use crate::lower::Attributes;
use crate::lower::VariableKind;
use crate::symbolic::{Expr, VarId};
use rustc_hash::FxHashSet;

/// What a variable is computed from between events.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Needs {
    /// States by their numbers.
    pub states: Vec<usize>,
    /// Parameters by their positions in [`Program::parameters`].
    pub parameters: Vec<usize>,
    /// The time.
    pub time: bool,
}

impl VariableInfo {
    /// Unit for people, empty if none.
    pub fn display_unit(&self) -> &str {
        &self.display_unit
    }
}

impl Program {
    /// Whether anything must hold between events: assertions that a simulator checks after each step.
    pub fn checks_steps(&self) -> bool {
        !(self.assertions.each.is_empty() && self.log_assertions.is_empty())
    }

    /// The attributes of a variable of [`Program::variables`] with the default values of the parameters.
    pub fn attributes(&self, variable: usize) -> Attributes {
        let Some(info) = self.variables().get(variable) else { return Attributes::default() };
        let dae = &self.sorted.dae;
        dae.defaults.attributes(dae, dae.variable(info.variable))
    }

    /// Number of event indicators of its systems.
    pub fn n_indicators(&self) -> usize {
        self.n_crossings() + self.selections.len() + 2 * self.events.transports.len()
    }

    /// Number of states.
    pub fn n_states(&self) -> usize {
        self.sorted.states.len()
    }

    /// What a variable of [`Program::variables`] is computed from between events; `None` where a loop is
    /// solved on the way, values of the past are read, or initial equations determine a parameter: it may follow from everything.
    pub fn needs_of(&self, variable: usize) -> Option<Needs> {
        let info = self.variables().get(variable)?;
        self.needs(self.resolve(info.variable).0)
    }

    /// The same for the derivative of a state.
    pub fn needs_of_derivative(&self, state: usize) -> Option<Needs> {
        if !self.continuous.iteration.is_empty() {
            return None;
        }
        let of = *self.sorted.states.get(state)?;
        let variables = (0..).map(VarId).zip(&self.sorted.dae.variables);
        let is_own =
            |kind: &VariableKind| matches!(kind, VariableKind::Derivative(one) if *one == of);
        let (derivative, _) = variables.into_iter().find(|(_, own)| is_own(&own.kind))?;
        // Some states cancel.
        let pattern = &self.continuous.pattern;
        let is_read = |column: &usize| pattern.column(*column).any(|at| pattern.rows[at] == state);
        let states = (0..self.n_states()).filter(is_read).collect();
        Some(Needs { states, ..self.needs(self.resolve(derivative).0)? })
    }

    fn needs(&self, source: VarId) -> Option<Needs> {
        let dae = &self.sorted.dae;
        let mut needed = close(&dae.pool, &self.sequence, FxHashSet::from_iter([source]));
        let events = &dae.events;
        let of_past = events.delays.iter().map(|delay| delay.variable);
        let piped =
            events.transports.iter().flat_map(|own| own.outputs()).map(|(variable, _)| variable);
        let loops = self.continuous.iteration.iter().copied();
        if of_past.chain(piped).chain(loops).any(|unknown| needed.contains(&unknown)) {
            return None;
        }
        let mut open: Vec<VarId> = needed.iter().copied().collect();
        while let Some(variable) = open.pop() {
            let own = dae.variable(variable);
            match (own.kind, own.binding) {
                (VariableKind::Solved, _) => return None,
                (VariableKind::Parameter { .. }, Some(binding)) => {
                    let others = dae.pool.variables(binding).into_iter();
                    open.extend(others.filter(|one| needed.insert(*one)));
                }
                _ => {}
            }
        }
        let places = |all: &[VarId]| {
            let found = all.iter().enumerate().filter(|(_, own)| needed.contains(own));
            found.map(|(at, _)| at).collect()
        };
        let parameters: Vec<VarId> = self.parameters().iter().map(|own| own.variable).collect();
        Some(Needs {
            states: places(&self.sorted.states),
            parameters: places(&parameters),
            time: needed.contains(&TIME),
        })
    }

    /// Whether initial equations determine parameters.
    pub fn has_solved_parameters(&self) -> bool {
        self.sorted.dae.variables.iter().any(|own| matches!(own.kind, VariableKind::Solved))
    }

    /// Whether equations read a parameter of [`Program::parameters`] beside the one that sets a
    /// derivative to it.
    pub fn reads_parameter_twice(&self, parameter: usize) -> bool {
        let Some(parameter) = self.parameters().get(parameter).map(|own| own.variable) else {
            return false;
        };
        let pool = &self.sorted.dae.pool;
        let mut same = vec![parameter];
        let blocks = self.sorted.blocks.iter().chain(&self.sorted.event_blocks);
        let blocks: Vec<&Block> = blocks.collect();
        for block in &blocks {
            for assignment in block.assignments() {
                if pool.as_variable(assignment.value) == Some(parameter) {
                    same.push(assignment.variable);
                }
            }
        }
        let reads = |e: Expr| {
            pool.as_variable(e) != Some(parameter)
                && same.iter().any(|own| pool.depends_on(e, *own))
        };
        blocks.iter().any(|block| {
            block.assignments().iter().any(|assignment| reads(assignment.value))
                || block.residuals().any(reads)
        })
    }

    /// Whether the default value of a parameter of [`Program::parameters`] follows from others that can
    /// be set: from them directly, or from what cannot be set and follows from them.
    pub fn follows_from_parameters(&self, parameter: usize) -> bool {
        let dae = &self.sorted.dae;
        let mut open: Vec<VarId> =
            self.parameters().get(parameter).map(|p| p.variable).into_iter().collect();
        let mut seen: FxHashSet<VarId> = open.iter().copied().collect();
        while let Some(variable) = open.pop() {
            let Some(binding) = dae.variable(variable).binding else { continue };
            for needed in dae.pool.variables(binding) {
                match dae.variable(needed).kind {
                    VariableKind::Parameter { tunable: true } | VariableKind::Solved => {
                        return true;
                    }
                    VariableKind::Parameter { tunable: false } if seen.insert(needed) => {
                        open.push(needed);
                    }
                    _ => {}
                }
            }
        }
        false
    }

    /// The number by which [`System::set_recorded`](crate::runtime::System::set_recorded) sets a
    /// recorded input that is held.
    pub fn recorded_input(&self, name: &str) -> Option<u32> {
        let dae = &self.sorted.dae;
        let signal = format!("$value({name})");
        let mut tracks = dae.events.recordings.iter().flat_map(|recording| &recording.tracks);
        let found = tracks.find(|track| *dae.variable(track.value).name == *signal)?;
        Some(found.value.0)
    }

    /// Whether a number is that of a recorded input.
    pub fn is_recorded_input(&self, number: u32) -> bool {
        let recordings = self.sorted.dae.events.recordings.iter();
        recordings.flat_map(|recording| &recording.tracks).any(|track| track.value.0 == number)
    }

    /// Whether the model needs values of the past: of `delay` or `spatialDistribution`.
    pub fn has_past(&self) -> bool {
        !(self.events.delays.is_empty() && self.events.transports.is_empty())
    }
}
