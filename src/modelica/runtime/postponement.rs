//! Relations on time that hold at an instant and not after it, or vice versa, where what holds
//! after it has no values at the instant itself.
//!
//! ```text
//! z = if time <= 0 then 0 else y/time     at t = 0 the second branch is 0/0
//! ```
//!
//! A relation has at its instant the value that it has after it, so that all that happens at one
//! time is one event. Where the equations then fail, the instant itself has what the relation says
//! literally, and it changes a little later. At the start it has what it says literally as well: an
//! event at the same time follows where that is another value than after it.

use super::execution::run;
use super::instants::{AT_ONCE, same_time};
use super::system::System;
use crate::sim::Failure;

/// How much later, relative to the time.
const RELATIVE: f64 = 4.0 * AT_ONCE;
/// How much later than zero, seconds.
const ABSOLUTE: f64 = 1e-13;

/// A time a little after another one.
fn after(time: f64) -> f64 {
    time + if time == 0.0 { ABSOLUTE } else { RELATIVE * time.abs() }
}

impl System {
    /// The time at which a relation on time changes.
    pub(super) fn set_switch(&mut self, at: usize, time: Option<f64>) {
        let time = time.filter(|time| time.is_finite());
        self.relations.switches[at] =
            if self.relations.postponed[at] { time.map(after) } else { time };
    }

    /// The relations that change at `t` and do not have literally the value that they have after
    /// it.
    fn to_postpone(&self, t: f64) -> impl Iterator<Item = usize> + '_ {
        let relations = self.program.switching.relations.iter().enumerate();
        let switches = relations.zip(&self.relations.switches).zip(&self.relations.postponed);
        switches.filter_map(move |(((at, relation), switch), postponed)| {
            let (factor, _) = relation.time?;
            let is_at_instant = switch.is_some_and(|switch| same_time(t, switch));
            let operator = relation.operator;
            let differs = operator.holds(0.0, 0.0) != operator.holds(factor, 0.0);
            (is_at_instant && differs && !postponed).then_some(at)
        })
    }

    /// Whether a relation on time, or what is rounded of time, has another value after `t`.
    pub(super) fn changes_after(&self, t: f64) -> bool {
        self.to_postpone(t).next().is_some() || self.rounds_down_after(t)
    }

    /// Lets the relations that change at `t` change after it; whether there are any.
    pub(super) fn postpone(&mut self, t: f64) -> bool {
        let found: Vec<usize> = self.to_postpone(t).collect();
        for at in &found {
            self.relations.postponed[*at] = true;
            self.set_switch(*at, self.relations.switches[*at]);
        }
        !found.is_empty()
    }

    /// Tries what holds after an instant; where it fails, what holds literally at it.
    pub(super) fn at_instant<T>(
        &mut self,
        t: f64,
        attempt: impl Fn(&mut System) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        if self.to_postpone(t).next().is_none() {
            return attempt(self);
        }
        // Results that have had values before the event have some after it.
        let had_values = self.unread_have_values().is_ok();
        let (registers, log) = (self.registers.clone(), self.messages.log.clone());
        let relations = (
            self.relations.has_changed.clone(),
            self.relations.held.clone(),
            self.relations.tolerated.clone(),
        );
        let mut first = attempt(self);
        if had_values && first.is_ok() {
            first = self.unread_have_values().and(first);
        }
        if first.is_err() {
            (self.registers, self.messages.log) = (registers, log);
            (self.relations.has_changed, self.relations.held, self.relations.tolerated) = relations;
            self.postpone(t);
            return attempt(self).or(first);
        }
        first
    }

    /// Whether what is computed for results alone has values as well.
    fn unread_have_values(&mut self) -> Result<(), Failure> {
        let program = self.program.clone();
        run(&program.unread.values.tape, &mut self.registers)
    }
}
