//! The initial system (MLS §8.6) from start values, by `homotopy`, and in the branches that relations
//! choose.

use super::execution::run;
use super::instants::{Change, Stage};
use super::singular_systems::loops_of;
use super::system::System;
use crate::codegen::code::CompiledLoop;
use crate::codegen::program::Program;
use crate::lower::Homotopy;
use crate::sim::Failure;

/// Parts of the way from simplified to actual expressions.
const FIRST_HOMOTOPY_STEP: f64 = 0.1;
const SMALLEST_HOMOTOPY_STEP: f64 = 1e-5;
/// Loops with more iteration variables are large. That of HeatExchangerSimulation of the standard
/// library has 226 and is solved without `homotopy`: with all branches before, it has not begun after
/// 90 s. In small loops branches cost little, and the way of `homotopy` chooses among solutions.
const LARGE: usize = 50;

/// The registers that a start begins from: unknowns of loops, relations.
pub(super) fn places(program: &Program) -> impl Iterator<Item = usize> + '_ {
    let unknowns = loops_of(&program.initial_steps).flat_map(|torn| torn.unknowns.iter().copied());
    let relations = program.switching.relations.iter().map(|relation| relation.register);
    unknowns.chain(relations).map(|register| register as usize)
}

impl System {
    /// Everything as it is before the initial system is solved.
    pub(super) fn take_start_values(&mut self, t: f64) -> Result<(), Failure> {
        self.loops.is_solved = false;
        let program = self.program.clone();
        self.registers[0] = t;
        for variable in program.observed.iter().chain(&program.values.solved) {
            self.registers[variable.0 as usize] = 0.0;
        }
        for relation in &program.switching.relations {
            self.registers[relation.register as usize] = 0.0;
        }
        self.evaluate_parameters()?;
        for (_, tape) in &program.values.starts {
            run(tape, &mut self.registers)?;
        }
        self.prefer_present_values();
        self.take_start_values_of_events();
        self.inputs.start(&self.program, &mut self.registers, t);
        self.relations.has_changed.fill(false);
        self.relations.held.fill(false);
        self.relations.is_idle.fill(false);
        self.relations.uncertainty.fill(0.0);
        self.relations.tolerated.fill(0.0);
        self.update_relations(t, Change::All);
        self.relations.has_changed.fill(false);
        for (choice, selection) in self.loops.choices.iter_mut().zip(&program.selections) {
            choice.reset(selection, &mut self.registers);
        }
        Ok(())
    }

    /// Previous values and signals as they are before the initial system is solved.
    pub(super) fn take_start_values_of_events(&mut self) {
        let program = self.program.clone();
        self.events.sampled = false;
        for previous in &program.events.previous {
            self.registers[previous.register as usize] = self.registers[previous.of.0 as usize];
        }
        for signal in program.events.samples.iter().chain(&program.events.terminal) {
            self.registers[signal.0 as usize] = 0.0;
        }
        if let Some(initial) = program.events.initial {
            self.registers[initial.0 as usize] = 1.0;
        }
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
}
