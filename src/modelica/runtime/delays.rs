//! `delay` in a running system: the expressions that it delays are recorded step by step.

use super::execution::run;
use super::system::System;
use crate::codegen::events::CompiledDelay;
use crate::sim::Failure;

impl System {
    /// Whether values of the past are needed.
    pub(super) fn has_past(&self) -> bool {
        self.program.has_past()
    }

    /// Whether delays read at `t` what has been recorded.
    pub fn knows_past(&self, t: f64) -> bool {
        let mut pairs = self.delays.histories.iter().zip(&self.delays.delay_times);
        pairs.all(|(history, time)| history.reaches(t - time))
    }

    /// Sets the delayed values at `t`.
    pub(super) fn load_delayed(&mut self, t: f64) {
        let delays = &self.program.events.delays;
        for ((history, delay), time) in
            self.delays.histories.iter().zip(delays).zip(&self.delays.delay_times)
        {
            self.registers[delay.register as usize] = history.value(t - time);
        }
    }

    /// Starts the histories with the values at `t`, all variables being known; whether one of them
    /// began with another value.
    pub(super) fn start_histories(&mut self, t: f64) -> Result<bool, Failure> {
        let program = self.program.clone();
        let mut changed = false;
        for (at, delay) in program.events.delays.iter().enumerate() {
            let value = self.delayed_expression(delay)?;
            changed |= self.delays.histories[at].values.front() != Some(&value);
            self.delays.histories[at].start(t, value);
            run(&delay.time.tape, &mut self.registers)?;
            self.delays.delay_times[at] = self.registers[delay.time.outputs[0] as usize];
        }
        Ok(changed)
    }

    /// Adds the values at `t`, all registers of states and events being loaded.
    pub(super) fn remember_values(&mut self, t: f64) -> Result<(), Failure> {
        let program = self.program.clone();
        for (at, delay) in program.events.delays.iter().enumerate() {
            let value = self.delayed_expression(delay)?;
            self.delays.histories[at].push(t, value);
        }
        Ok(())
    }

    /// Goes beyond the jumps that arrive at `t`.
    pub(super) fn advance_histories(&mut self, t: f64) -> bool {
        let mut any = false;
        for (history, time) in self.delays.histories.iter_mut().zip(&self.delays.delay_times) {
            let before = history.next_jump();
            history.advance(t - time);
            any |= history.next_jump() != before;
        }
        if any {
            self.load_delayed(t);
        }
        any
    }

    /// When jumps arrive.
    pub(super) fn arriving_jumps(&self) -> impl Iterator<Item = f64> {
        let pairs = self.delays.histories.iter().zip(&self.delays.delay_times);
        pairs.filter_map(|(history, time)| Some(history.next_jump()? + time))
    }

    fn delayed_expression(&mut self, delay: &CompiledDelay) -> Result<f64, Failure> {
        run(&delay.value.tape, &mut self.registers)?;
        Ok(self.registers[delay.value.outputs[0] as usize])
    }
}
