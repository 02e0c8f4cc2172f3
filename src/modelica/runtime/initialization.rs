//! Initialization (MLS §8.6): the initial system, redundant initial equations, the first instant.

use super::event_iteration::MAX_ROUNDS;
use super::execution::run;
use super::system::System;
use crate::sim::{EventOutcome, Failure};

/// How far, relative to their size or 1, the sides of a redundant initial equation may differ.
const CONSISTENT: f64 = 1e-6;

impl System {
    /// From the start values; where Newton's method fails with parameters that were set, from the solution
    /// with those of the model, before everything else is tried.
    fn solve_initial_system(&mut self, t: f64) -> Result<(), Failure> {
        if !self.has_other_parameters() {
            return self.solve_from_start_values(t);
        }
        self.loops.is_brief = true;
        let brief = self.solve_from_start_values(t).or_else(|_| self.lead_from_own_parameters(t));
        self.loops.is_brief = false;
        brief.or_else(|_| self.solve_from_start_values(t))
    }

    /// Compares both sides of the initial equations that were not needed.
    fn check_initial_values(&mut self) -> Result<(), Failure> {
        for (number, check) in self.program.initial_checks.iter().enumerate() {
            run(&check.tape, &mut self.registers)?;
            let [a, b] = [check.outputs[0], check.outputs[1]];
            let (a, b) = (self.registers[a as usize], self.registers[b as usize]);
            if (a - b).abs() > CONSISTENT * a.abs().max(b.abs()).max(1.0) {
                return Err(Failure::Inconsistent { check: number as u32 });
            }
        }
        Ok(())
    }

    /// Solves the initial system, with what the events of the first instant do.
    pub(super) fn solve_for_start(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        self.forget_notices();
        self.relations.treated.clear();
        self.relations.kept.clear();
        self.delays.transported.clear();
        self.solve_initial_system(t)?;
        self.note_open_at_start(t);
        self.check_initial_values()?;
        self.assert_at_event()?;
        self.log_assertions_at_event(t)?;
        self.improve_choices()?;
        self.start_clocks(t)?;
        self.delays.start_histories(&self.program, &mut self.registers, t)?;
        self.delays.start_transported(&self.program, &mut self.registers, t)?;
        self.start_sensitivities()?;
        self.iterate_at_start(t)?;
        self.improve_choices()?;
        self.reschedule();
        self.unload(y);
        self.assert_all()?;
        self.log_assertions(t)
    }

    /// What follows the initial system: `pre(v) := v` and the events of the first instant.
    pub(super) fn iterate_at_start(&mut self, t: f64) -> Result<(), Failure> {
        let program = self.program.clone();
        if let Some(initial) = program.events.initial {
            self.registers[initial.0 as usize] = 0.0;
        }
        if program.events.is_empty() {
            return Ok(());
        }
        self.update_previous();
        while self.event(t)? == EventOutcome::Again {}
        // What was before the start is what the events of the first instant lead to.
        for _ in 0..MAX_ROUNDS {
            let other = self.delays.start_histories(&self.program, &mut self.registers, t)?;
            if !(self.delays.start_transported(&self.program, &mut self.registers, t)?
                | self.delays.load_transported(&self.program, &mut self.registers, t, true)
                | other)
            {
                return Ok(());
            }
            self.delays.load_delayed(&self.program, &mut self.registers, t);
            while self.event(t)? == EventOutcome::Again {}
        }
        Err(Failure::EventIteration { variable: self.events.unstable })
    }
}
