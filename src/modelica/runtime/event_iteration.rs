//! Event iteration (MLS §8.5, §8.6): solving with the discrete equations until relations agree with
//! the variables and `pre(v) = v` for all discrete variables.
//!
//! ```text
//! pre(v) := v, samples that are due := true
//! repeat
//!     solve until relations and variables of discrete loops stay as they are
//!     check assertions, carry out terminate and reinit
//!     pre(v) := v
//! until nothing changed
//! ```
//!
//! Samples are true in all rounds of their event; after it the iteration is repeated with all of
//! them false, as an event of its own if the model shows them.

use super::execution::run;
use super::instants::{Change, Clock, Stage, either};
use super::system::System;
use crate::sim::{EventOutcome, Failure};
use crate::symbolic::VarId;
use rustc_hash::FxHashSet;

/// Rounds of an event iteration after which recurring values are searched for.
pub(super) const MAX_ROUNDS: usize = 100;
/// Most rounds, however new the values are: a counter that counts itself never has the same again.
const MOST_ROUNDS: usize = 10_000;
/// Passes of a round after which recurring values end it.
const MAX_PASSES: usize = 60;
/// Most passes, however new the values are: each of 200 relays in a chain may wait for the one before.
const MOST_PASSES: usize = 10_000;
/// Passes in which all relations may change; from then on one after the other.
const PASSES_AT_ONCE: usize = 10;
/// Relative difference of Reals that solving a loop again may make.
const ROUNDING: f64 = 1e-10;

/// What a pass changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Moved {
    /// Relations, or what is rounded.
    Relation,
    /// Variables of discrete loops alone.
    Iterated,
}

impl System {
    /// Times of samples from `t` on, with the parameters as they are.
    pub(super) fn start_clocks(&mut self, t: f64) -> Result<(), Failure> {
        let program = self.program.clone();
        let clocks = &program.events.clocks;
        run(&clocks.tape, &mut self.registers)?;
        self.events.clocks.clear();
        let pairs = clocks.outputs.chunks_exact(2);
        for (pair, since_start) in pairs.zip(&program.events.since_start) {
            let (start, interval) =
                (self.registers[pair[0] as usize], self.registers[pair[1] as usize]);
            let start = if *since_start { start + t } else { start };
            self.events.clocks.push(Clock::at(start, interval, t));
        }
        Ok(())
    }

    /// Sets the samples that are due; whether there are any.
    fn samples_due(&mut self, t: f64) -> bool {
        let mut any = false;
        for (clock, variable) in self.events.clocks.iter_mut().zip(&self.program.events.samples) {
            let due = clock.is_due(t);
            self.registers[variable.0 as usize] = f64::from(u8::from(due));
            any |= due;
        }
        any
    }

    fn clear_samples(&mut self) {
        for variable in &self.program.events.samples {
            self.registers[variable.0 as usize] = 0.0;
        }
    }

    /// `pre(v) := v`; whether a discrete variable had another value.
    pub(super) fn update_previous(&mut self) -> bool {
        let mut changed = false;
        for previous in &self.program.events.previous {
            let value = self.registers[previous.of.0 as usize];
            let slot = &mut self.registers[previous.register as usize];
            let rounding =
                if previous.exact { 0.0 } else { ROUNDING * value.abs().max(slot.abs()) };
            if previous.discrete && (*slot - value).abs() > rounding {
                changed = true;
                self.events.unstable = previous.of.0;
            }
            *slot = value;
        }
        self.carry_to_previous();
        changed
    }

    /// An event at `t`, the variables being those before it.
    pub(super) fn event(&mut self, t: f64) -> Result<EventOutcome, Failure> {
        let program = self.program.clone();
        if program.events.is_empty() {
            let jumps = self.inputs.advance(&self.program, &mut self.registers, t);
            let y_changed = self.at_instant(t, |own| own.iterate_events(t, Stage::Event))?;
            return Ok(EventOutcome::Continue { y_changed: y_changed | jumps });
        }
        for (slot, variable) in self.events.before.iter_mut().zip(&program.events.discrete) {
            *slot = self.registers[variable.0 as usize];
        }
        if std::mem::take(&mut self.events.sampled) {
            self.clear_samples();
            return self.iterate(t).map(|outcome| self.with_discrete(outcome));
        }
        if program.events.need_left_limits() {
            self.solve(Stage::Continuous)?;
        }
        self.update_previous();
        let arrived = self.delays.advance_histories(&self.program, &mut self.registers, t)
            | self.delays.load_transported(&self.program, &mut self.registers, t, true)
            | self.inputs.advance(&self.program, &mut self.registers, t);
        let sampled = self.samples_due(t);
        let outcome = either(EventOutcome::Continue { y_changed: arrived }, self.iterate(t)?);
        match (sampled, outcome) {
            (true, EventOutcome::Continue { .. }) if program.events.shows_samples => {
                self.events.sampled = true;
                Ok(EventOutcome::Again)
            }
            (true, _) => {
                self.clear_samples();
                let outcome = either(outcome, self.iterate(t)?);
                Ok(self.with_discrete(outcome))
            }
            (false, _) => Ok(self.with_discrete(outcome)),
        }
    }

    /// The outcome, with what happened to discrete variables.
    fn with_discrete(&mut self, outcome: EventOutcome) -> EventOutcome {
        let mut pairs = self.events.before.iter().zip(&self.program.events.discrete);
        let changed = pairs.any(|(old, variable)| *old != self.registers[variable.0 as usize]);
        self.relations.has_effect |= changed;
        either(outcome, EventOutcome::Continue { y_changed: changed })
    }

    fn iterate(&mut self, t: f64) -> Result<EventOutcome, Failure> {
        self.at_instant(t, |own| own.iterate_at_borders(t))
    }

    /// Iterates; where that fails, once more with relations kept at their borders as they are.
    fn iterate_at_borders(&mut self, t: f64) -> Result<EventOutcome, Failure> {
        if !self.relations.held.contains(&true) {
            return self.iterate_rounds(t);
        }
        let (registers, changed) = (self.registers.clone(), self.relations.has_changed.clone());
        let first = self.iterate_rounds(t);
        let Err(Failure::Newton { .. } | Failure::Singular { .. } | Failure::EventIteration { .. }) =
            first
        else {
            return first;
        };
        self.registers.copy_from_slice(&registers);
        self.relations.has_changed = changed;
        self.relations.keeps_held = true;
        let kept = self.iterate_rounds(t);
        self.relations.keeps_held = false;
        kept.or(first)
    }

    /// Rounds until `pre(v) = v` and no state is set. Where relations do not come to rest with the
    /// previous values at hand, these follow after every pass: an element that breaks away leaves
    /// the range of the relation that caused it, and only what it was before holds it where it is.
    fn iterate_rounds(&mut self, t: f64) -> Result<EventOutcome, Failure> {
        let (mut changed, mut terminated) = (false, false);
        let mut is_stepwise = false;
        let mut known = FxHashSet::default();
        for round in 0..MOST_ROUNDS {
            // Recurring values recur for ever; those that are new each time may be a chain.
            if round >= MAX_ROUNDS && !known.insert(self.values_of_events()) {
                break;
            }
            let moves = match is_stepwise {
                true => self.pass(t, Stage::Event, Change::All)?.is_some(),
                false => match self.iterate_events(t, Stage::Event) {
                    Ok(any) => {
                        changed |= any;
                        false
                    }
                    Err(Failure::EventIteration { .. }) => {
                        is_stepwise = true;
                        continue;
                    }
                    Err(failure) => return Err(failure),
                },
            };
            terminated |= self.check_at_event(t)?;
            self.carry_through_event()?;
            let set = self.reinitialize()?;
            let moved = self.update_previous()
                | self.delays.load_transported(&self.program, &mut self.registers, t, true);
            changed |= set | moves;
            if !set && !moved && !moves {
                return Ok(match terminated {
                    true => EventOutcome::Terminate,
                    false => EventOutcome::Continue { y_changed: changed },
                });
            }
        }
        Err(Failure::EventIteration { variable: self.events.unstable })
    }

    /// The state that determines how an event iteration continues, as bits.
    fn values_of_events(&self) -> Vec<u64> {
        let program = &self.program;
        let discrete = program.events.discrete.iter().chain(&program.sorted.states);
        let relations = program.switching.relations.iter().map(|relation| relation.register);
        let previous = program.events.previous.iter().map(|previous| previous.register);
        let all = discrete.map(|v| v.0).chain(relations).chain(previous);
        all.map(|register| self.registers[register as usize].to_bits()).collect()
    }

    /// Solves once and updates relations; what changed, if anything.
    fn pass(&mut self, t: f64, stage: Stage, change: Change) -> Result<Option<Moved>, Failure> {
        self.events.note_iterate(&self.program, &self.registers);
        let is_known = stage == Stage::Event && self.take_noted_solution();
        let solved = if is_known { Ok(()) } else { self.solve(stage) };
        if let Err(failure) = solved {
            // The branch may be the wrong one: relations of what was solved before it tell.
            return match self.update_relations(t, change) {
                true => Ok(Some(Moved::Relation)),
                false => Err(self.refine(failure)),
            };
        }
        let lag = self.events.changed_iterate(&self.program, &self.registers);
        self.events.unstable = lag.unwrap_or(self.events.unstable);
        Ok(match (self.update_relations(t, change), lag) {
            (true, _) => Some(Moved::Relation),
            (false, Some(_)) => Some(Moved::Iterated),
            (false, None) => None,
        })
    }

    /// Solves and updates relations until they stay as they are; whether one changed.
    pub(super) fn iterate_events(&mut self, t: f64, stage: Stage) -> Result<bool, Failure> {
        let (mut any, mut recurs) = (false, false);
        let mut known = FxHashSet::default();
        for number in 0..MOST_PASSES {
            if number >= PASSES_AT_ONCE {
                recurs |= !known.insert(self.values_of_events());
            }
            if number >= MAX_PASSES && recurs {
                break;
            }
            let change = if number < PASSES_AT_ONCE { Change::All } else { Change::First };
            if number == PASSES_AT_ONCE {
                self.relations.inconsistent.fill(false);
            }
            match self.pass(t, stage, change) {
                Ok(None) => return Ok(any),
                Ok(Some(moved)) => any |= moved == Moved::Relation,
                Err(_)
                    if !self.loops.is_brief
                        && !self.loops.keeps_branches
                        && self.find_other_branch(t, stage) =>
                {
                    return Ok(true);
                }
                Err(failure) => return Err(failure),
            }
        }
        if self.find_combination(t, stage) {
            return Ok(true);
        }
        let (registers, inconsistent) =
            (self.registers.clone(), self.relations.inconsistent.clone());
        let outcome = self.iterate_leniently(t, stage);
        if outcome == Ok(true) {
            return Ok(true);
        }
        (self.registers, self.relations.inconsistent) = (registers, inconsistent);
        if self.find_lenient_combination(t, stage) {
            return Ok(true);
        }
        outcome?;
        Err(Failure::EventIteration { variable: self.events.unstable })
    }

    /// The same where relations are tolerated that hold but for what the tolerance makes of their
    /// sides; whether they then come to rest.
    fn iterate_leniently(&mut self, t: f64, stage: Stage) -> Result<bool, Failure> {
        self.relations.is_lenient = true;
        let mut rests = Ok(false);
        for _ in 0..MAX_PASSES {
            match self.pass(t, stage, Change::First) {
                Ok(None) => {
                    rests = Ok(true);
                    break;
                }
                Ok(Some(_)) => {}
                Err(failure) => {
                    rests = Err(failure);
                    break;
                }
            }
        }
        self.relations.is_lenient = false;
        rests
    }

    /// Checks the assertions of when-clauses; whether one of them ends the simulation.
    fn check_at_event(&mut self, t: f64) -> Result<bool, Failure> {
        let program = self.program.clone();
        let ends = &program.events.terminations;
        self.assert_at_event()?;
        self.log_assertions_at_event(t)?;
        run(&ends.tape, &mut self.registers)?;
        Ok(ends.outputs.iter().any(|end| self.registers[*end as usize] != 0.0))
    }

    /// Sets the states of the `reinit`s that are active; whether there are any.
    fn reinitialize(&mut self) -> Result<bool, Failure> {
        let program = self.program.clone();
        let reinits = &program.events.reinits;
        run(&reinits.tape, &mut self.registers)?;
        let mut any = false;
        let pairs = reinits.outputs.chunks_exact(2).zip(&program.events.reinitialized);
        for (number, (pair, (state, negated))) in pairs.enumerate() {
            if self.registers[pair[0] as usize] != 0.0 {
                let value = self.registers[pair[1] as usize];
                self.registers[state.0 as usize] = if *negated { -value } else { value };
                self.carry_through_reinit(number, *negated);
                self.relations.has_effect = true;
                any = true;
            }
        }
        Ok(any)
    }

    /// Times at which a rounding of time jumps or a sample is due next.
    pub(super) fn scheduled(&self) -> impl Iterator<Item = f64> {
        let samples = self.events.clocks.iter().map(Clock::time);
        self.jumps_of_roundings().flatten().chain(samples).filter(|time| time.is_finite())
    }

    /// Values of all discrete variables and their previous ones, for an event at the end;
    /// `terminal()` stays true for what is computed from them.
    pub(super) fn final_event(&mut self, t: f64, terminal: VarId) -> Result<(), Failure> {
        self.registers[terminal.0 as usize] = 1.0;
        let mut outcome = self.event(t);
        while outcome == Ok(EventOutcome::Again) {
            outcome = self.event(t);
        }
        outcome.map(|_| ())
    }
}
