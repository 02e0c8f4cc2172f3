//! The unknowns of the integrator in the registers of a system, with everything that is read at
//! their time; and where loops are solved inside, their solution.

use super::instants::Stage;
use super::system::System;
use super::transports::PASSES;
use crate::sim::Failure;

impl System {
    pub(super) fn load(&mut self, t: f64, y: &[f64]) {
        self.loops.is_solved = false;
        self.registers[0] = t;
        let registers = &mut self.registers[..];
        for (variable, value) in self.program.continuous.unknowns.iter().zip(y) {
            registers[variable.0 as usize] = *value;
        }
        if !self.delays.histories.is_empty() {
            self.delays.load_delayed(&self.program, &mut self.registers, t);
        }
        self.delays.load_transported(&self.program, &mut self.registers, t, false);
        if self.sensitivity.is_some() {
            self.load_derivatives(y);
        }
    }

    /// Loads y, and solves for the iteration variables that it does not hold.
    pub(super) fn load_solved(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        if self.has_inner_loops() {
            return self.load_with_loops(t, y);
        }
        self.load(t, y);
        Ok(())
    }

    /// Loads y, and solves for all iteration variables, unless the registers hold the solution there: what is
    /// asked at a point is asked one thing after the other.
    pub(super) fn load_with_loops(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        if self.loops.is_solved && self.is_loaded(t, y) {
            return Ok(());
        }
        self.load(t, y);
        self.solve(Stage::Continuous)?;
        self.agree_with_transported(t)?;
        self.note_solution(t, y);
        // What delays and pipes read at a point changes with what they record, derivatives with y.
        self.loops.is_solved = !self.program.has_past() && self.sensitivity.is_none();
        Ok(())
    }

    /// Solves for iteration variables until they agree with the values that depend on them.
    pub(super) fn agree_with_transported(&mut self, t: f64) -> Result<(), Failure> {
        for _ in 0..PASSES {
            if !self.delays.load_transported(&self.program, &mut self.registers, t, false) {
                return Ok(());
            }
            self.solve(Stage::Continuous)?;
        }
        Ok(())
    }

    pub(super) fn unload(&self, y: &mut [f64]) {
        for (variable, value) in self.program.continuous.unknowns.iter().zip(y.iter_mut()) {
            *value = self.registers[variable.0 as usize];
        }
        if self.sensitivity.is_some() {
            self.unload_derivatives(y);
        }
    }
}
