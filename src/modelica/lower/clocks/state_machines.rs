//! States and transitions of state machines (MLS §17.1).

use crate::source::Span;
use crate::symbolic::VarId;
use indexmap::IndexMap;
use std::sync::Arc;

/// All states of a model, and what leads from one to another.
#[derive(Debug, Default)]
pub(in crate::lower) struct StateMachines {
    /// By the paths of their instances.
    pub(super) states: IndexMap<Arc<str>, State>,
    pub(super) transitions: Vec<Transition>,
    /// States named by `initialState`, with the places.
    pub(super) initial: Vec<(usize, Span)>,
    /// The transition whose condition is being lowered.
    pub(super) condition: Option<ConditionOf>,
}

/// A state of a state machine.
#[derive(Debug, Clone, Copy)]
pub(super) struct State {
    /// Whether it is active, a variable.
    pub(super) active: VarId,
    /// Whether it is active and being reset.
    pub(super) reset: VarId,
    /// `ticksInState()`, where that is asked for.
    pub(super) ticks: Option<VarId>,
    /// `timeInState()`, seconds, where that is asked for.
    pub(super) time: Option<VarId>,
    /// Where it is first named.
    pub(super) span: Span,
}

/// `transition(from, to, condition, …)`
#[derive(Debug, Clone, Copy)]
pub(super) struct Transition {
    pub(super) from: usize,
    pub(super) to: usize,
    pub(super) condition: VarId,
    pub(super) immediate: bool,
    pub(super) reset: bool,
    pub(super) synchronize: bool,
    pub(super) priority: i64,
    pub(super) span: Span,
}

/// Which transition a condition belongs to.
#[derive(Debug, Clone, Copy)]
pub(super) struct ConditionOf {
    /// The state that it leaves.
    pub(super) from: usize,
    pub(super) immediate: bool,
}

impl StateMachines {
    /// The innermost state that an instance is, or lies in.
    pub(super) fn around(&self, path: &str) -> Option<usize> {
        if self.states.is_empty() {
            return None;
        }
        let mut path = Some(path);
        while let Some(at) = path {
            if let Some(state) = self.states.get_index_of(at) {
                return Some(state);
            }
            path = at.rsplit_once('.').map(|(holder, _)| holder);
        }
        None
    }

    /// The innermost state that encloses another one.
    pub(super) fn enclosing(&self, state: usize) -> Option<usize> {
        let (path, _) = self.states.get_index(state)?;
        self.around(path.rsplit_once('.')?.0)
    }

    /// A state and those that enclose it, from the inside to the outside.
    pub(super) fn chain(&self, state: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(state), |state| self.enclosing(*state))
    }
}
