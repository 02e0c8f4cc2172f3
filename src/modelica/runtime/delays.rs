//! `delay` in a running system: the expressions that it delays are recorded step by step.

use super::execution::run;
use super::state::DelayState;
use crate::codegen::events::CompiledDelay;
use crate::codegen::memory::Memory;
use crate::codegen::program::Program;
use crate::sim::Failure;

impl DelayState {
    /// Whether delays read at `t` what has been recorded.
    pub(super) fn knows_past(&self, t: f64) -> bool {
        let mut pairs = self.histories.iter().zip(&self.delay_times);
        pairs.all(|(history, time)| history.reaches(t - time))
    }

    /// Sets the delayed values at `t`.
    pub(super) fn load_delayed(&self, program: &Program, registers: &mut Memory, t: f64) {
        let delays = &program.events.delays;
        for ((history, delay), time) in self.histories.iter().zip(delays).zip(&self.delay_times) {
            registers[delay.register as usize] = history.value(t - time);
        }
    }

    /// Starts the histories with the values at `t`, all variables being known; whether one of them
    /// began with another value.
    pub(super) fn start_histories(
        &mut self,
        program: &Program,
        registers: &mut Memory,
        t: f64,
    ) -> Result<bool, Failure> {
        let mut changed = false;
        for (at, delay) in program.events.delays.iter().enumerate() {
            let value = delayed_expression(delay, registers)?;
            changed |= self.histories[at].values.front() != Some(&value);
            self.histories[at].start(t, value);
            run(&delay.time.tape, registers)?;
            self.delay_times[at] = registers[delay.time.outputs[0] as usize];
        }
        Ok(changed)
    }

    /// Adds the values at `t`, all registers of states and events being loaded.
    pub(super) fn remember_values(
        &mut self,
        program: &Program,
        registers: &mut Memory,
        t: f64,
    ) -> Result<(), Failure> {
        for (history, delay) in self.histories.iter_mut().zip(&program.events.delays) {
            let value = delayed_expression(delay, registers)?;
            history.push(t, value);
        }
        Ok(())
    }

    /// Goes beyond the jumps that arrive at `t`.
    pub(super) fn advance_histories(
        &mut self,
        program: &Program,
        registers: &mut Memory,
        t: f64,
    ) -> bool {
        let mut any = false;
        for (history, time) in self.histories.iter_mut().zip(&self.delay_times) {
            let before = history.next_jump();
            history.advance(t - time);
            any |= history.next_jump() != before;
        }
        if any {
            self.load_delayed(program, registers, t);
        }
        any
    }

    /// When jumps arrive.
    pub(super) fn arriving_jumps(&self) -> impl Iterator<Item = f64> {
        let pairs = self.histories.iter().zip(&self.delay_times);
        pairs.filter_map(|(history, time)| Some(history.next_jump()? + time))
    }
}

fn delayed_expression(delay: &CompiledDelay, registers: &mut Memory) -> Result<f64, Failure> {
    run(&delay.value.tape, registers)?;
    Ok(registers[delay.value.outputs[0] as usize])
}
