//! A simulation in progress.

use super::before_event::BeforeEvent;
use super::event::CrossingSearch;
use super::event_rush::EventRush;
use super::integrators::nonstiff::{Distance, Nonstiff, Patience};
use super::integrators::{Integrator, Problem};
use super::nominals::Nominals;
use super::progress::Progress;
use super::recorder::Recorder;
use super::switches::Watch;
use super::{Effort, SimErrorKind};

/// Whether the simulation continues after an event.
#[derive(PartialEq)]
pub enum After {
    /// The step still holds.
    Resume,
    /// The next step begins here: the integrator was restarted, or continues with its past.
    Restarted,
    /// The model ended the simulation.
    Terminated,
    /// An event is to be handled, before which the simulation ends.
    Stopped,
}

/// Why a simulation ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// It reached its stop time.
    AtStop,
    /// An event is to be handled, at which it was to end.
    AtEvent,
    /// The model ended it (`terminate`).
    Terminated,
}

/// A simulation in progress; `t` and `y` are how far it has come.
pub struct Run<'a> {
    pub(super) problem: Problem<'a>,
    pub(super) integrator: &'a mut dyn Integrator,
    /// Takes the place of an explicit one in slides, and the other way round.
    pub(super) implicit: &'a mut dyn Integrator,
    /// The explicit method for steps of this length, until it is known whether it suits.
    pub(super) nonstiff: Option<(&'a mut Nonstiff, Distance)>,
    /// How long it may continue, while it does.
    pub(super) patience: Option<Patience>,
    /// Whether the method is explicit, or exact.
    pub(super) is_explicit: bool,
    /// Whether the system solves its loops itself.
    pub(super) solves_loops: bool,
    pub(super) crossings: &'a mut CrossingSearch,
    pub(super) before_event: &'a mut BeforeEvent,
    pub(super) watch: &'a mut Watch,
    pub(super) nominals: &'a Nominals,
    pub(super) y: &'a mut Vec<f64>,
    pub(super) effort: &'a mut Effort,
    pub(super) t: f64,
    pub(super) recorder: Recorder<'a>,
    pub(super) rush: EventRush,
    pub(super) branch_switches: BranchSwitches,
    pub(super) progress: Progress,
    /// Whether it continues another one.
    pub(super) is_resumed: bool,
}

/// When another branch was tried the last time.
pub(super) struct BranchSwitches {
    pub(super) last_jump: f64,
    /// When algebraic unknowns were solved for because no step could be made.
    pub(super) last_solved: f64,
}

impl BranchSwitches {
    pub(super) const NONE: BranchSwitches =
        BranchSwitches { last_jump: f64::NEG_INFINITY, last_solved: f64::NEG_INFINITY };
}

impl Run<'_> {
    pub fn restart(&mut self) -> Result<(), SimErrorKind> {
        self.start_crossings()?;
        self.restart_integrator()
    }

    pub(super) fn restart_integrator(&mut self) -> Result<(), SimErrorKind> {
        self.problem.elapsed = 0.0;
        self.integrator.restart(&mut self.problem, self.t, self.y)
    }

    pub(crate) fn start_crossings(&mut self) -> Result<bool, SimErrorKind> {
        self.crossings.start(&mut self.problem, self.t, self.y).map_err(SimErrorKind::Evaluation)
    }
}
