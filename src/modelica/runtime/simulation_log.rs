//! What is kept of a simulation for the user: warnings and printed strings, and unknowns that equations
//! left open.

use crate::diag::Code;
use crate::source::Span;

/// More are counted only.
const MOST: usize = 200;

/// What is recorded of a simulation.
#[derive(Debug, Clone, Default)]
pub(super) struct SimulationLog {
    pub(super) recorded: Vec<LogMessage>,
    pub(super) omitted: u64,
    /// Which warnings hold now, so that each is recorded when it begins.
    pub(super) active: Vec<bool>,
    /// What the equations left open.
    pub(super) open: Vec<Open>,
}

/// A message of a model, or about a variable of it.
#[derive(Debug, Clone, PartialEq)]
pub struct LogMessage {
    /// When, seconds.
    pub time: f64,
    /// The text.
    pub text: String,
    /// What kind of warning it is; `None` for something printed.
    pub warning: Option<Code>,
    /// Where it is written.
    pub span: Span,
}

impl SimulationLog {
    pub(super) fn record(&mut self, message: LogMessage) {
        match self.recorded.len() < MOST {
            true => self.recorded.push(message),
            false => self.omitted += 1,
        }
    }
}

/// What a loop left open when it was noticed first.
#[derive(Debug, Clone)]
pub(super) struct Open {
    pub(super) time: f64,
    pub(super) what: OpenLoop,
}

/// The loop.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum OpenLoop {
    /// A linear system by its workspace, with the places of the unknowns.
    Linear { system: u32, places: Vec<usize> },
    /// A torn loop of the initial system.
    Initial { block: u32 },
    /// Another torn loop; those of events are numbered after those between events.
    Later { block: u32 },
}

impl SimulationLog {
    pub(super) fn note_open(&mut self, time: f64, what: OpenLoop) {
        let is_same = |known: &Open| match (&known.what, &what) {
            (OpenLoop::Linear { system: a, .. }, OpenLoop::Linear { system: b, .. }) => a == b,
            (a, b) => a == b,
        };
        if !self.open.iter().any(is_same) {
            self.open.push(Open { time, what });
        }
    }
}
