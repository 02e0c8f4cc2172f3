//! Events for relations inside `noEvent`, where they keep the simulation from getting on
//! ([`progress`](super::progress)).

use super::run::Run;
use super::{Events, Modes, SimErrorKind};

/// Attempts of steps whose lengths tell how far the end is.
const WINDOW: u64 = 500;
/// So many attempts up to the end are too many. A relay at the tolerance 1e-4 needs about 1e4 for
/// the time in which its solution changes by its own size.
const FAR: f64 = 1e4;
/// Steps in which relations are looked at.
const LOOKS: u32 = 64;

impl Run<'_> {
    /// After a step: relations without events get events where they keep the integration from
    /// advancing.
    pub(crate) fn watch_progress(&mut self) -> Result<(), SimErrorKind> {
        let treats = self.problem.settings.treats_chattering;
        if self.progress.is_over || !treats || self.problem.system.is_constrained() {
            return Ok(());
        }
        if self.progress.looks > 0 {
            return self.look_at_literal_relations();
        }
        let (begin, before) =
            *self.progress.begin.get_or_insert((self.t, self.problem.statistics.attempts()));
        let attempts = self.problem.statistics.attempts() - before;
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
        self.before_event.resize(n_crossings);
        self.watch.resize(n_crossings);
        self.restart()
    }
}
