//! Sensitivities across events: the times of events move with the parameters.

use super::execution::{read, run};
use super::instants::{Stage, same_time};
use super::sensitivity_state::Sensitivity;
use super::system::System;
use crate::arithmetic::Register;
use crate::codegen::code::Outputs;
use crate::codegen::sensitivity::SensitivityCode;
use crate::sim::{EventOutcome, Failure};

/// An event whose time moves by more than so many lengths of the simulation when a parameter changes
/// by its own size does not cross zero but touches it: where φ grows with the cube of time and is
/// located to 1e-10 of a step, it moves by some 1e15 of them; with a tenth of the speed, by 10.
const FARTHEST: f64 = 1e6;

impl System {
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
}

fn read_into(code: &Outputs, system: &mut System, out: &mut [f64]) -> Result<(), Failure> {
    read(code, &mut system.registers, out)
}
