//! The initial system (MLS §8.6): homotopy, redundant initial equations, the first instant.

use super::execution::run;
use super::instants::Stage;
use super::parameter_path::places;
use super::singular_systems::loops_of;
use super::system::System;
use crate::codegen::code::CompiledLoop;
use crate::lower::Homotopy;
use crate::sim::Failure;

/// How far, relative to their size or 1, the sides of a redundant initial equation may differ.
const CONSISTENT: f64 = 1e-6;

/// Parts of the way from simplified to actual expressions.
const FIRST_HOMOTOPY_STEP: f64 = 0.1;
const SMALLEST_HOMOTOPY_STEP: f64 = 1e-5;

/// Loops with more iteration variables are large. That of HeatExchangerSimulation of the standard
/// library has 226 and is solved without `homotopy`: with all branches before, it has not begun after
/// 90 s. In small loops branches cost little, and the way of `homotopy` chooses among solutions.
const LARGE: usize = 50;

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

    /// Solves the initial system from values of unknowns of loops and of relations, in the order of
    /// [`places`](super::parameter_path).
    pub(super) fn solve_start_from(&mut self, t: f64, values: &[f64]) -> Result<(), Failure> {
        self.take_start_values(t)?;
        let program = self.program.clone();
        for (value, at) in values.iter().zip(places(&program)) {
            self.registers[at] = *value;
        }
        self.iterate_events(t, Stage::Initial).map(|_| ())
    }

    /// Where a loop is large, with `homotopy`, and then without it, in the branches that the start values
    /// lead to, before others are tried: each of many branches costs as much as the first.
    pub(super) fn solve_from_start_values(&mut self, t: f64) -> Result<(), Failure> {
        let is_large = |torn: &CompiledLoop| torn.unknowns.len() > LARGE;
        let has_large = loops_of(&self.program.initial_steps).any(is_large);
        if has_large && self.program.sorted.dae.homotopy.is_some() {
            self.loops.keeps_branches = true;
            let outcome = self.solve_in_branches(t);
            self.loops.keeps_branches = false;
            if outcome.is_ok() {
                return outcome;
            }
        }
        self.solve_in_branches(t)
    }

    /// Of several solutions the one that `homotopy` leads to; directly where it leads nowhere.
    fn solve_in_branches(&mut self, t: f64) -> Result<(), Failure> {
        if let Some(homotopy) = self.program.sorted.dae.homotopy
            && self.follow_homotopy(t, homotopy).is_ok()
        {
            return Ok(());
        }
        self.take_start_values(t)?;
        let outcome = self.iterate_events(t, Stage::Initial).map(|_| ());
        let is_domain = matches!(outcome, Err(Failure::Domain { .. }));
        if is_domain { self.solve_from_nominal_values(t).or(outcome) } else { outcome }
    }

    /// Where something has no value with the solution of a loop that zero starts lead to, as a mole
    /// fraction n/N of a solution with N = 0 particles: the same with unknowns of loops at their
    /// nominal values instead of zero.
    fn solve_from_nominal_values(&mut self, t: f64) -> Result<(), Failure> {
        self.take_start_values(t)?;
        let program = self.program.clone();
        let loops = loops_of(&program.initial_steps).zip(&self.loops.initial_solvers);
        for (torn, solver) in loops {
            for (unknown, nominal) in torn.unknowns.iter().zip(solver.nominal()) {
                let value = &mut self.registers[*unknown as usize];
                *value = if *value == 0.0 { *nominal } else { *value };
            }
        }
        self.iterate_events(t, Stage::Initial).map(|_| ())
    }

    /// Solves the initial system with the simplified expressions of `homotopy` and continues from
    /// there to the actual ones, in shorter steps where a solution is missed.
    fn follow_homotopy(&mut self, t: f64, homotopy: Homotopy) -> Result<(), Failure> {
        let (active, lambda) = (homotopy.active.0 as usize, homotopy.lambda.0 as usize);
        self.take_start_values(t)?;
        self.registers[active] = 1.0;
        self.registers[lambda] = 0.0;
        let mut outcome = self.iterate_events(t, Stage::Initial).map(|_| ());
        let (mut done, mut step) = (0.0, FIRST_HOMOTOPY_STEP);
        let mut reached = self.registers.clone();
        while outcome.is_ok() && done < 1.0 {
            let next = f64::min(done + step, 1.0);
            self.registers[lambda] = next;
            match self.iterate_events(t, Stage::Initial) {
                Ok(_) => {
                    done = next;
                    step *= 2.0;
                    reached.copy_from_slice(&self.registers);
                }
                Err(failure) => {
                    self.registers.copy_from_slice(&reached);
                    step *= 0.25;
                    if step < SMALLEST_HOMOTOPY_STEP {
                        outcome = Err(failure);
                    }
                }
            }
        }
        self.registers[active] = 0.0;
        outcome?;
        self.iterate_events(t, Stage::Initial).map(|_| ())
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
        self.start_histories(t)?;
        self.start_transported(t)?;
        self.start_sensitivities()?;
        self.iterate_at_start(t)?;
        self.improve_choices()?;
        self.reschedule();
        self.unload(y);
        self.assert_all()?;
        self.log_assertions(t)
    }
}
