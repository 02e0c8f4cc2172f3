//! Sensitivities of a running system: at its start, between events, and across them.

use super::execution::{read, run};
use super::instants::{Stage, same_time};
use super::sensitivity_state::Sensitivity;
use super::system::System;
use crate::codegen::code::Outputs;
use crate::codegen::instruction::Register;
use crate::codegen::sensitivity::SensitivityCode;
use crate::sim::{EventOutcome, Failure};
use std::sync::Arc;

/// An event whose time moves by more than so many lengths of the simulation when a parameter changes
/// by its own size does not cross zero but touches it: where φ grows with the cube of time and is
/// located to 1e-10 of a step, it moves by some 1e15 of them; with a tenth of the speed, by 10.
const FARTHEST: f64 = 1e6;

impl System {
    /// Carries sensitivities from the next initialization on, or none any more. The code must be
    /// made for the program and for the variables that the system observes.
    pub fn differentiate(&mut self, code: Option<&Arc<SensitivityCode>>) {
        self.restore_program();
        self.sensitivity = code.map(|code| {
            if self.registers.len() < code.registers.len() {
                self.registers.extend(&code.registers);
            }
            let n = self.program.sorted.states.len();
            Box::new(Sensitivity {
                code: code.clone(),
                cause: None,
                span: f64::INFINITY,
                is_smooth: true,
                before: vec![0.0; n],
                after: vec![0.0; n],
                space: code.rhs.space(&self.program.continuous.pattern),
                refusal: None,
            })
        });
    }

    /// Why the last simulation had no sensitivities, in words that follow on "because".
    pub fn sensitivity_refusal(&self) -> Option<&'static str> {
        self.sensitivity.as_ref()?.refusal
    }

    /// Copies the derivatives after y, if it holds any, to their registers.
    pub(super) fn load_derivatives(&mut self, y: &[f64]) {
        let Some(sensitivity) = &self.sensitivity else { return };
        let n = y.len() / (sensitivity.code.n_directions() + 1);
        if n != self.n_held() {
            return;
        }
        for (column, s) in y[n..].chunks_exact(n.max(1)).enumerate() {
            for (kept, s) in sensitivity.code.unknowns.iter().zip(s) {
                self.registers.registers[kept.registers[column] as usize] = *s;
            }
        }
    }

    /// Copies the derivatives after y from their registers.
    pub(super) fn unload_derivatives(&self, y: &mut [f64]) {
        let Some(sensitivity) = &self.sensitivity else { return };
        let n = self.n_held();
        for (column, s) in y[n..].chunks_exact_mut(n.max(1)).enumerate() {
            for (kept, s) in sensitivity.code.unknowns.iter().zip(s) {
                *s = self.registers[kept.registers[column] as usize];
            }
        }
    }

    /// Writes the derivatives of the right-hand side along all columns, everything loaded.
    pub(super) fn right_sides_along(&mut self, out: &mut [f64]) -> Result<(), Failure> {
        let Some(sensitivity) = &mut self.sensitivity else { return Ok(()) };
        let Sensitivity { code, space, .. } = &mut **sensitivity;
        let continuous = &self.program.continuous;
        read(&continuous.jacobian, &mut self.registers, &mut space.jacobian)?;
        read(&code.rhs.code, &mut self.registers, &mut space.entries)?;
        let registers = &self.registers.registers;
        code.rhs.write(&continuous.pattern, &code.unknowns, registers, space, out);
        Ok(())
    }

    /// Derivatives of the solution of the initial system.
    pub(super) fn start_sensitivities(&mut self) -> Result<(), Failure> {
        let Some(sensitivity) = &mut self.sensitivity else { return Ok(()) };
        (sensitivity.cause, sensitivity.refusal) = (None, None);
        let code = sensitivity.code.clone();
        for register in &code.cleared {
            self.registers[*register as usize] = 0.0;
        }
        run(&code.constants, &mut self.registers)?;
        run(&code.initial, &mut self.registers)
    }

    /// What leads to the next event.
    pub(super) fn note_cause(&mut self, crossing: Option<usize>, span: f64) {
        if let Some(sensitivity) = &mut self.sensitivity {
            (sensitivity.cause, sensitivity.span) = (Some(crossing), span);
        }
    }

    /// Before an event: its time gets derivatives, and those of the states become total.
    pub(super) fn enter_event(&mut self, t: f64) -> Result<(), Failure> {
        let Some(mut sensitivity) = self.sensitivity.take() else { return Ok(()) };
        let entered = self.differentiate_time(t, &mut sensitivity);
        self.sensitivity = Some(sensitivity);
        entered
    }

    fn differentiate_time(&mut self, t: f64, own: &mut Sensitivity) -> Result<(), Failure> {
        let code = own.code.clone();
        match own.cause.take() {
            Some(Some(crossing)) => {
                self.solve(Stage::Continuous)?;
                own.is_smooth = self.time_of_crossing(crossing, &code, own.span)?;
            }
            Some(None) => {
                run(&code.rescheduled, &mut self.registers)?;
                own.is_smooth = self.time_of_switch(t, &code);
            }
            None => {}
        }
        if code.time.iter().all(|time| self.registers[*time as usize] == 0.0) {
            return Ok(());
        }
        self.solve(Stage::Continuous)?;
        read_into(&code.speeds, self, &mut own.before)?;
        self.shift_states(&code, &own.before, 1.0);
        Ok(())
    }

    /// s += sign · ẋ dτ
    fn shift_states(&mut self, code: &SensitivityCode, speeds: &[f64], sign: f64) {
        for (kept, speed) in code.unknowns.iter().zip(speeds) {
            for (register, time) in kept.registers.iter().zip(&code.time) {
                self.registers[*register as usize] += sign * speed * self.registers[*time as usize];
            }
        }
    }

    /// Derivatives of the time at which a crossing function is zero; whether there are any: a
    /// function that does not pass zero at some speed has no time that moves with the parameters.
    fn time_of_crossing(
        &mut self,
        crossing: usize,
        code: &SensitivityCode,
        span: f64,
    ) -> Result<bool, Failure> {
        let relations = code.n_crossing_relations;
        let function = match crossing.checked_sub(relations) {
            // A rounding has two.
            Some(rounding) => relations + rounding / 2,
            None => crossing,
        };
        run(&code.crossings.tape, &mut self.registers)?;
        let m = code.n_directions();
        let row = &code.crossings.outputs[function * (m + 1)..][..m + 1];
        let speed = self.registers[row[m] as usize];
        let mut is_smooth = true;
        for (column, (register, derivative)) in code.time.iter().zip(row).enumerate() {
            let value = self.registers[*derivative as usize];
            let time = if value == 0.0 { 0.0 } else { -value / speed };
            let magnitude = self.magnitude_of_parameter(code.parameters[column]);
            let is_usable = (time * magnitude).abs() <= FARTHEST * span;
            is_smooth &= is_usable;
            self.registers[*register as usize] = if is_usable { time } else { 0.0 };
        }
        Ok(is_smooth)
    }

    /// Derivatives of the time of an event that parameters set; whether all that happens then
    /// agrees on them.
    fn time_of_switch(&mut self, t: f64, code: &SensitivityCode) -> bool {
        let switches = self.relations.switches.iter().zip(&code.switches);
        let switches = switches.filter_map(|(time, of)| Some(((*time)?, of.as_deref()?)));
        let roundings = self.jumps_of_roundings().zip(&code.roundings);
        let roundings = roundings.filter_map(|(time, of)| Some((time?, of.as_deref()?)));
        let mut found: Option<&[Register]> = None;
        let mut agree = true;
        let value = |register: &Register| self.registers[*register as usize];
        for (_, of) in switches.chain(roundings).filter(|(time, _)| same_time(*time, t)) {
            match found {
                None => found = Some(of),
                Some(first) => agree &= first.iter().zip(of).all(|(a, b)| value(a) == value(b)),
            }
        }
        let zero = |of: &[Register]| of.iter().all(|register| value(register) == 0.0);
        let sampled = self.events.clocks.iter().any(|clock| same_time(clock.time(), t));
        agree &= !sampled || found.is_none_or(zero);
        for (column, time) in code.time.iter().enumerate() {
            let of = found.filter(|_| agree).map(|found| found[column]);
            self.registers.registers[*time as usize] =
                of.map_or(0.0, |of| self.registers.registers[of as usize]);
        }
        agree
    }

    /// Derivatives of what the equations of the event at hand have set.
    pub(super) fn carry_through_event(&mut self) -> Result<(), Failure> {
        let Some(sensitivity) = &self.sensitivity else { return Ok(()) };
        let code = sensitivity.code.clone();
        run(&code.event, &mut self.registers)
    }

    /// Derivatives of a state that a `reinit` has set.
    pub(super) fn carry_through_reinit(&mut self, reinit: usize, negated: bool) {
        let Some(sensitivity) = &self.sensitivity else { return };
        let code = sensitivity.code.clone();
        let state = self.program.events.reinitialized[reinit].0;
        let Some(kept) = code.unknowns.iter().find(|kept| kept.variable == state) else { return };
        for (register, value) in kept.registers.iter().zip(&code.reinits[reinit]) {
            let value = self.registers[*value as usize];
            self.registers[*register as usize] = if negated { -value } else { value };
        }
    }

    /// The derivatives of previous values become those of the values.
    pub(super) fn carry_to_previous(&mut self) {
        let Some(sensitivity) = &self.sensitivity else { return };
        let code = sensitivity.code.clone();
        for (from, to) in code.previous.iter().flatten() {
            for (from, to) in from.iter().zip(to) {
                self.registers[*to as usize] = self.registers[*from as usize];
            }
        }
    }

    /// After an event: derivatives at a given time again.
    pub(super) fn leave_event(&mut self, outcome: EventOutcome) -> Result<(), Failure> {
        let Some(mut sensitivity) = self.sensitivity.take() else { return Ok(()) };
        let left = self.derivatives_after(outcome, &mut sensitivity);
        self.sensitivity = Some(sensitivity);
        left
    }

    fn derivatives_after(
        &mut self,
        outcome: EventOutcome,
        own: &mut Sensitivity,
    ) -> Result<(), Failure> {
        if !own.is_smooth && outcome != (EventOutcome::Continue { y_changed: false }) {
            own.refusal = Some("the time of an event does not depend smoothly on the parameters");
            return Err(Failure::Singular { block: 0 });
        }
        let code = own.code.clone();
        if code.time.iter().any(|time| self.registers[*time as usize] != 0.0) {
            read_into(&code.speeds, self, &mut own.after)?;
            self.shift_states(&code, &own.after, -1.0);
        }
        if outcome != EventOutcome::Again {
            code.time.iter().for_each(|time| self.registers[*time as usize] = 0.0);
        }
        self.differentiate_algebraic()
    }

    /// Derivatives of the algebraic unknowns, those of the states given.
    pub(super) fn differentiate_algebraic(&mut self) -> Result<(), Failure> {
        let Some(sensitivity) = &self.sensitivity else { return Ok(()) };
        if self.program.continuous.iteration.is_empty() {
            return Ok(());
        }
        let code = sensitivity.code.clone();
        run(&code.algebraic, &mut self.registers)
    }

    /// Whether there are derivatives to carry.
    pub(super) fn has_directions(&self) -> bool {
        self.sensitivity.as_ref().is_some_and(|own| own.code.n_directions() > 0)
    }

    /// Number of unknowns that the integrator holds.
    fn n_held(&self) -> usize {
        self.program.sorted.states.len() + self.n_held_iteration()
    }

    /// Magnitudes of the parameters, positive.
    pub(super) fn magnitudes_of_parameters(&self, out: &mut [f64]) {
        let Some(sensitivity) = &self.sensitivity else { return };
        for (out, at) in out.iter_mut().zip(&sensitivity.code.parameters) {
            *out = self.magnitude_of_parameter(*at);
        }
    }

    fn magnitude_of_parameter(&self, at: usize) -> f64 {
        let variable = self.program.parameters()[at].variable;
        let value = self.registers[variable.0 as usize].abs();
        if value.is_finite() && value > 0.0 { value } else { 1.0 }
    }
}

fn read_into(code: &Outputs, system: &mut System, out: &mut [f64]) -> Result<(), Failure> {
    read(code, &mut system.registers, out)
}
