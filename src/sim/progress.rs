//! Progress: steps so short that the end is out of reach, because relations without events
//! (`noEvent`) switch again and again.
//!
//! The integrator steps across such relations. Where the fields on both sides point at each other,
//! the steps become about as short as the tolerance times the time in which the solution changes.
//! Where they are so short that the end would need [`FAR`] steps, the relations are looked at for
//! some steps; if one of them switches in many of these, they get events from there on, and the
//! solution slides.

use super::event::sign;
use super::simulator::Run;
use super::{DaeSystem, SimErrorKind};

/// Attempts of steps whose lengths tell how far the end is.
const WINDOW: u64 = 500;
/// So many attempts up to the end are too many. A relay at the tolerance 1e-4 needs about 1e4 for
/// the time in which its solution changes by its own size.
const FAR: f64 = 1e4;
/// Steps in which relations are looked at.
const LOOKS: u32 = 64;
/// Of these, those in which one relation switches that are chattering. A relay switches in 14 with
/// `rodas4`; an oscillation has ten steps or more between two zeros.
const SWITCHES: u32 = 10;
/// Of these, those in which the difference of its sides turns back that are chattering: `radau5` at the
/// tolerance 1e-8 stays on one side of a relay, and turns in every other step. No oscillation is
/// resolved with three steps between its turns.
const TURNS: u32 = 20;
/// A turn changes the difference by this part of it at least; what rounding changes is less.
const TURN: f64 = 0.25;

/// What is seen of a relation between steps.
#[derive(Debug, Clone, Copy, Default)]
struct Look {
    /// left − right, and by how much it has changed.
    difference: f64,
    change: f64,
    switches: u32,
    turns: u32,
}

impl Look {
    fn next(&mut self, difference: f64) {
        let change = difference - self.difference;
        let is_large = change.abs() > TURN * difference.abs().max(self.difference.abs());
        self.switches += u32::from(sign(difference) != sign(self.difference));
        self.turns += u32::from(is_large && change * self.change < 0.0);
        (self.difference, self.change) = (difference, change);
    }
}

/// How the simulation gets on.
#[derive(Debug, Default)]
pub(super) struct Progress {
    /// Time and attempts where the window at hand began.
    begin: Option<(f64, u64)>,
    /// How often relations were looked at, and what was seen of each.
    looks: u32,
    relations: Vec<Look>,
    differences: Vec<f64>,
    /// Whether relations have events now, or there are none that could have any.
    is_over: bool,
}

impl Progress {
    fn end_of_looking(&mut self) {
        (self.begin, self.looks) = (None, 0);
        self.relations.clear();
    }

    fn look(&mut self) {
        if self.looks == 0 {
            let first = |z: &f64| Look { difference: *z, ..Look::default() };
            self.relations.extend(self.differences.iter().map(first));
        }
        let pairs = self.relations.iter_mut().zip(&self.differences);
        pairs.for_each(|(relation, difference)| relation.next(*difference));
        self.looks += 1;
    }

    fn is_chattering(&self) -> bool {
        self.relations.iter().any(|seen| seen.switches >= SWITCHES || seen.turns >= TURNS)
    }
}

impl Run<'_> {
    /// Behind a step: relations without events get some where they keep the solution from getting
    /// on.
    pub(super) fn watch_progress(&mut self) -> Result<(), SimErrorKind> {
        let treats = self.problem.settings.treats_chattering;
        if self.progress.is_over || !treats || self.problem.system.is_constrained() {
            return Ok(());
        }
        if self.progress.looks > 0 {
            return self.look_at_literal_relations();
        }
        let (begin, before) = *self.progress.begin.get_or_insert((self.t, self.attempts()));
        let attempts = self.attempts() - before;
        if attempts < WINDOW {
            return Ok(());
        }
        self.progress.begin = None;
        let remaining = self.problem.settings.stop - self.t;
        match remaining * attempts as f64 > FAR * (self.t - begin) {
            true => self.look_at_literal_relations(),
            false => Ok(()),
        }
    }

    fn attempts(&self) -> u64 {
        let statistics = &self.problem.statistics;
        statistics.steps + statistics.error_failures + statistics.newton_failures
    }

    fn look_at_literal_relations(&mut self) -> Result<(), SimErrorKind> {
        let (system, progress) = (&mut *self.problem.system, &mut self.progress);
        let looked = system.literal_relations(self.t, self.y, &mut progress.differences);
        if looked.is_err() {
            progress.end_of_looking();
            return Ok(());
        }
        progress.is_over = progress.differences.is_empty();
        progress.look();
        if progress.looks < LOOKS {
            return Ok(());
        }
        let is_chattering = progress.is_chattering();
        progress.end_of_looking();
        match is_chattering {
            true => self.give_events(),
            false => Ok(()),
        }
    }

    fn give_events(&mut self) -> Result<(), SimErrorKind> {
        self.refuse_with_directions()?;
        self.progress.is_over = true;
        let given = self.problem.system.give_events(self.t, self.y);
        if !given.map_err(SimErrorKind::Evaluation)? {
            return Ok(());
        }
        let n_crossings = self.problem.system.n_crossings();
        self.crossings.resize(n_crossings);
        self.watch.resize(n_crossings);
        self.restart()
    }
}
