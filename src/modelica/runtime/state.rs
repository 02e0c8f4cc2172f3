//! The state of a running system in parts, each by what it belongs to.

use super::delay_buffer::History;
use super::instants::Clock;
use super::modes::{Modes, Treated};
use super::newton::LoopSolver;
use super::partial_observation::OtherVariables;
use super::simulation_log::SimulationLog;
use super::state_selection::Choice;
use super::transport_record::Record;
use crate::codegen::code::Outputs;
use crate::codegen::program::Program;
use crate::sim::{Failure, Pattern};
use crate::symbolic::VarId;
use serde::{Deserialize, Serialize};
use std::sync::OnceLock;

/// What is known of the relations between events.
#[derive(Debug, Clone)]
pub(super) struct RelationState {
    /// Times at which relations on time switch.
    pub(super) switches: Vec<Option<f64>>,
    /// Whether no event has followed the initialization yet: relations on time have literally the
    /// values that they have at the start, not those after it.
    pub(super) is_at_start: bool,
    /// Relations on time that change after their instants.
    pub(super) postponed: Vec<bool>,
    /// Whether relations have changed in the event at hand.
    pub(super) has_changed: Vec<bool>,
    /// Relations that keep changing in the round at hand.
    pub(super) inconsistent: Vec<bool>,
    /// Whether the last event of each relation has changed no value of events.
    pub(super) is_idle: Vec<bool>,
    /// Whether the event at hand has changed values of events.
    pub(super) has_effect: bool,
    /// Whether relations have been kept at a value that their sides did not quite have.
    pub(super) held: Vec<bool>,
    /// Whether such relations are kept so from the beginning of the event at hand.
    pub(super) keeps_held: bool,
    /// What the tolerance makes of the sides of relations, and whether it tolerates relations that
    /// do not hold, and by how much it has.
    pub(super) uncertainty: Vec<f64>,
    pub(super) is_lenient: bool,
    pub(super) tolerated: Vec<f64>,
    /// What the code of the crossing functions computes.
    pub(super) crossing_values: Vec<f64>,
    /// Relations that events keep as they are, as long as their sides differ by no more.
    pub(super) kept: Vec<(usize, f64)>,
    /// The modes on both sides of relations.
    pub(super) modes: Modes,
    /// What was done about relations that chattered.
    pub(super) treated: Vec<Treated>,
}

impl RelationState {
    pub(super) fn new(program: &Program) -> RelationState {
        RelationState {
            switches: vec![None; program.switching.relations.len()],
            is_at_start: false,
            postponed: vec![false; program.switching.relations.len()],
            has_changed: vec![false; program.switching.relations.len()],
            inconsistent: vec![false; program.switching.relations.len()],
            is_idle: vec![false; program.switching.relations.len()],
            has_effect: false,
            held: vec![false; program.switching.relations.len()],
            keeps_held: false,
            uncertainty: vec![0.0; program.switching.relations.len()],
            is_lenient: false,
            tolerated: vec![0.0; program.switching.relations.len()],
            crossing_values: Vec::new(),
            kept: Vec::new(),
            modes: Modes::default(),
            treated: Vec::new(),
        }
    }
}

/// Values of a start that was solved: those of unknowns of loops and of relations.
#[derive(Debug, Clone)]
pub(super) struct SolvedStart {
    pub(super) time: f64,
    /// Of recorded inputs that were set from outside.
    pub(super) given: Vec<(u32, f64)>,
    /// In the order of the places that are restored; none where it could not be solved.
    pub(super) values: Option<Vec<f64>>,
}

/// Solvers of algebraic loops, and the states that were selected.
#[derive(Debug, Clone, Default)]
pub(super) struct LoopState {
    /// One for every loop of the initial system, of the system, and of that at events, in order.
    pub(super) initial_solvers: Vec<LoopSolver>,
    pub(super) solvers: Vec<LoopSolver>,
    pub(super) event_solvers: Vec<LoopSolver>,
    /// Whether a start is given up where Newton's method fails with the branches at hand.
    pub(super) is_brief: bool,
    /// Whether the branches at hand are kept where they cannot be solved.
    pub(super) keeps_branches: bool,
    /// The start with the parameters of the model, once it was needed.
    pub(super) own_start: Option<Box<SolvedStart>>,
    /// One for every selection of states.
    pub(super) choices: Vec<Choice>,
    /// The unknowns of linear systems, by their workspaces.
    pub(super) linear: Vec<(u32, Vec<VarId>)>,
    /// Whether the iteration variables are solved for in every evaluation.
    pub(super) solves_loops: bool,
    /// Whether the registers hold the solution of all loops at the time and the states that they hold.
    pub(super) is_solved: bool,
    /// The solution where an event was located, which is where it is handled.
    pub(super) at_event: SolutionAtEvent,
    /// That of the Jacobian of the states alone, where loops are solved inside: full.
    pub(super) full_pattern: OnceLock<Pattern>,
}

/// Values of variables that were solved for, with the time, the unknowns of the integrator and the
/// relations that they follow from.
#[derive(Debug, Clone, Default)]
pub(super) struct SolutionAtEvent {
    pub(super) time: f64,
    pub(super) y: Vec<f64>,
    pub(super) relations: Vec<f64>,
    /// Of the variables that the sequence assigns, and of the iteration variables.
    pub(super) solved: Vec<f64>,
}

/// What delays and pipes remember.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct DelayState {
    /// The past of delayed expressions, and by how much they are delayed.
    pub(super) histories: Vec<History>,
    pub(super) delay_times: Vec<f64>,
    /// What variable delays and pipes have recorded.
    pub(super) transported: Vec<Record>,
}

impl DelayState {
    pub(super) fn new(program: &Program) -> DelayState {
        DelayState {
            histories: vec![History::default(); program.events.delays.len()],
            delay_times: vec![0.0; program.events.delays.len()],
            transported: Vec::new(),
        }
    }

    /// Whether it is one of this program that has been started.
    pub(super) fn fits(&self, program: &Program) -> bool {
        self.histories.len() == program.events.delays.len()
            && self.delay_times.len() == self.histories.len()
            && self.transported.len() == program.events.transports.len()
            && self.histories.iter().all(History::is_valid)
            && self.transported.iter().all(|record| record.profile.is_valid())
    }
}

/// Clocks, and what discrete variables were before.
#[derive(Debug, Clone)]
pub(super) struct EventState {
    /// The samples.
    pub(super) clocks: Vec<Clock>,
    /// Values that discrete variables had before an event.
    pub(super) before: Vec<f64>,
    /// Values that variables of discrete loops had in the pass before.
    pub(super) previous_iterate: Vec<f64>,
    /// Whether samples are true that an event at the same time makes false.
    pub(super) sampled: bool,
    /// The variable that changed last in an event iteration.
    pub(super) unstable: u32,
}

impl EventState {
    pub(super) fn new(program: &Program) -> EventState {
        EventState {
            clocks: Vec::with_capacity(program.events.samples.len()),
            before: vec![0.0; program.events.discrete.len()],
            previous_iterate: vec![0.0; program.events.iterated.len()],
            sampled: false,
            unstable: 0,
        }
    }

    /// Keeps the values of the variables of discrete loops.
    pub(super) fn note_iterate(&mut self, program: &Program, registers: &[f64]) {
        for (slot, variable) in self.previous_iterate.iter_mut().zip(&program.events.iterated) {
            *slot = registers[variable.0 as usize];
        }
    }

    /// One of them that has another value now.
    pub(super) fn changed_iterate(&self, program: &Program, registers: &[f64]) -> Option<u32> {
        let mut previous = self.previous_iterate.iter().zip(&program.events.iterated);
        let moved = previous.find(|(old, variable)| **old != registers[variable.0 as usize]);
        moved.map(|(_, variable)| variable.0)
    }
}

/// What is observed.
#[derive(Debug, Clone)]
pub(super) struct OutputState {
    pub(super) observed: Option<Outputs>,
    /// What is observed where variables that nothing reads have no value.
    pub(super) others: OtherVariables,
    /// What [`System::observe_only`] was asked for.
    pub(super) observed_variables: Option<Vec<usize>>,
    /// Of the observed variables those of which a mean is a value.
    pub(super) has_means: Vec<bool>,
}

impl OutputState {
    pub(super) fn new(program: &Program) -> OutputState {
        OutputState {
            observed: None,
            others: OtherVariables::default(),
            observed_variables: None,
            has_means: program.observed.iter().map(|v| program.has_means(*v)).collect(),
        }
    }
}

/// What is said, and the failure that is to come.
#[derive(Debug, Clone, Default)]
pub(super) struct MessageState {
    /// What reads a parameter that a function has left without value fails with.
    pub(super) lacking: Option<Failure>,
    /// The text of the assertion that failed last, with its values, and its number.
    pub(super) failed_message: Option<(u32, String)>,
    /// The log of a simulation, where there is a listener.
    pub(super) log: Option<SimulationLog>,
    /// The conditions of assertions, as evaluated last.
    pub(super) hold: Vec<f64>,
}

/// Values that states and discrete variables have at the start, whatever the initial equations say; all
/// other variables follow from them.
#[derive(Debug, Clone, Default)]
pub struct GivenStart {
    /// Positions among the states, and values.
    pub states: Vec<(usize, f64)>,
    /// Positions of discrete variables among the variables, and values.
    pub discrete: Vec<(usize, f64)>,
}
