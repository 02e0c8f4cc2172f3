//! The loop of a simulation: steps, each up to its end or to an event.

use super::instants::same_time;
use super::integrators::Problem;
use super::run::{After, Ended, Run};
use super::{Effort, EventOutcome, Events, Offending, Residual, SimErrorKind};

impl Run<'_> {
    pub(super) fn run(&mut self) -> Result<Ended, SimErrorKind> {
        let ends = |after: &After| matches!(after, After::Terminated | After::Stopped);
        let mut after = self.initialize()?;
        if after == After::Restarted && self.is_curve() {
            after = self.follow_curve()?;
        }
        while !ends(&after) && self.t < self.problem.settings.stop {
            after = match self.step() {
                Ok(time_event) => {
                    self.count_step();
                    self.advance_to_end_of_step(time_event)?
                }
                Err(_) if self.patience.is_some() => self.end_explicit_steps()?,
                Err(kind) => self.jump(kind).or_else(|kind| self.take_loops_inside(kind))?,
            };
            if ends(&after) {
                break;
            }
            self.watch_explicit_steps()?;
            self.watch_progress()?;
            let Problem { settings, budget, statistics, .. } = &mut self.problem;
            budget.extend(self.t, settings.stop, statistics.attempts());
        }
        self.end_slide();
        // The end of a part is not the end of the simulation.
        if !self.is_resumed {
            let finished = self.problem.system.finish(self.t, self.y);
            if finished.map_err(SimErrorKind::Evaluation)? {
                self.record()?;
            }
        }
        Ok(match after {
            After::Terminated => Ended::Terminated,
            After::Stopped => Ended::AtEvent,
            After::Resume | After::Restarted => Ended::AtStop,
        })
    }

    fn initialize(&mut self) -> Result<After, SimErrorKind> {
        let system = &mut *self.problem.system;
        if !self.is_resumed {
            system.initialize(self.t, self.y).map_err(SimErrorKind::Initialization)?;
        }
        if !self.y.iter().all(|y| y.is_finite()) {
            return Err(SimErrorKind::NotFinite);
        }
        // Steps no longer than a delay that is all but zero would come to no end.
        let (longest, way) = (system.longest_step(), self.problem.settings.stop - self.t);
        if way > 0.0
            && (longest <= 0.0 || way / longest > self.problem.settings.max_total_steps as f64)
        {
            return Err(SimErrorKind::StepBudget);
        }
        system.check(self.t, self.y).map_err(SimErrorKind::Evaluation)?;
        if self.recorder.points.next() == Some(self.t) {
            self.record()?;
            self.advance_output();
        }
        if way > 0.0 && self.problem.system.has_event_at_start() {
            self.problem.statistics.time_events += 1;
            self.problem.system.crossed(None, way);
            if self.whole_event(self.t)? == EventOutcome::Terminate {
                return Ok(After::Terminated);
            }
        }
        self.begin_explicit_steps();
        self.restart()?;
        Ok(After::Restarted)
    }

    fn count_step(&mut self) {
        self.problem.statistics.explicit_steps += u64::from(self.patience.is_some());
        if self.problem.settings.counts_effort {
            Effort::count(&mut self.effort.unknowns, self.integrator.dominant());
        }
    }

    /// Makes a step; whether it ended at a time event.
    fn step(&mut self) -> Result<bool, SimErrorKind> {
        let stop = self.problem.settings.stop;
        let event = self.problem.system.next_time_event(self.t);
        // The hundredth tick of a clock may miss the end by a rounding.
        let event = event.map(|event| if same_time(event, stop) { stop } else { event });
        let event = event.filter(|event| *event > self.t && *event <= stop);
        let mut limit = event.unwrap_or(stop);
        limit = limit.min(self.t + self.problem.system.longest_step());
        if self.recorder.points.ends_at_points {
            limit = self.recorder.points.next().map_or(limit, |point| limit.min(point));
        }
        self.integrator.step(&mut self.problem, limit)?;
        let Some(event) = event else { return Ok(false) };
        // A step to an output point may end next to an event: the same time to the system.
        let next = self.problem.system.next_time_event(self.integrator.time());
        Ok(next.is_none_or(|next| next > event))
    }

    /// Goes to the end of the step, or to the event that made the rest of it void.
    fn advance_to_end_of_step(&mut self, time_event: bool) -> Result<After, SimErrorKind> {
        let end = self.integrator.time();
        loop {
            self.y.copy_from_slice(self.integrator.state());
            let begin = self.t;
            match self.first_event(end)? {
                Some(event) => {
                    self.remember(begin, event)?;
                    self.record_before(event)?;
                    if self.problem.settings.stops_at_events {
                        self.t = event;
                        return Ok(After::Stopped);
                    }
                    self.problem.statistics.state_events += 1;
                    Effort::count(&mut self.effort.crossings, self.crossings.last());
                    self.count_switches(begin, event)?;
                    let after = self.handle_event(event, true)?;
                    if after != After::Terminated && self.treat_chattering()? {
                        return Ok(After::Restarted);
                    }
                    if after != After::Resume || event >= end {
                        return Ok(after);
                    }
                }
                None if time_event => {
                    self.remember(begin, end)?;
                    self.record_before(end)?;
                    if self.problem.settings.stops_at_events {
                        self.t = end;
                        return Ok(After::Stopped);
                    }
                    self.problem.statistics.time_events += 1;
                    return self.handle_event(end, false);
                }
                None => {
                    self.remember(begin, end)?;
                    self.record_before(end)?;
                    self.t = end;
                    self.y.copy_from_slice(self.integrator.state());
                    self.look_between_steps()?;
                    self.check_step(begin)?;
                    if self.recorder.points.next() == Some(end) {
                        self.record()?;
                        self.advance_output();
                    }
                    return Ok(After::Resume);
                }
            }
        }
    }

    /// What is in the way where `kind` does not say it.
    pub(super) fn offending(&mut self, kind: SimErrorKind) -> Option<Offending> {
        match kind {
            SimErrorKind::StepSize | SimErrorKind::Singular | SimErrorKind::NotFinite => {
                self.fastest_unknown().map(|at| Offending::Unknown(at as u32))
            }
            SimErrorKind::Chattering | SimErrorKind::Accumulation => {
                self.crossings.last().map(|at| Offending::Crossing(at as u32))
            }
            _ => None,
        }
    }

    /// The unknown that is not finite, or else changes fastest.
    fn fastest_unknown(&mut self) -> Option<usize> {
        let n = self.problem.nominal.len();
        if let Some(at) = self.y.iter().position(|y| !y.is_finite()) {
            return Some(at).filter(|at| *at < n);
        }
        let mut derivatives = vec![0.0; n];
        self.problem.system.rhs(self.t, self.y, &mut derivatives).ok()?;
        if let Some(at) = derivatives.iter().position(|derivative| !derivative.is_finite()) {
            return Some(at);
        }
        let speed =
            |at: usize| derivatives[at].abs() / self.y[at].abs().max(self.problem.nominal[at]);
        (0..self.problem.system.n_differential()).max_by(|a, b| speed(*a).total_cmp(&speed(*b)))
    }
}
