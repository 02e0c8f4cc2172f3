//! The log of a simulation: warnings, and messages that the model prints (MLS §8.3.7). Only systems
//! with a listener keep it.

use super::assertions::UNKNOWN;
use super::execution::run;
use super::simulation_log::{LogMessage, SimulationLog};
use super::system::System;
use crate::bytecode::Journal;
use crate::codegen::code::LogAssertion;
use crate::codegen::errors::{ASSERTION_FAILED, DOMAIN_ERROR};
use crate::diag::Diagnostic;
use crate::lower::{Assertion, Level, warning_of};
use crate::sim::{self, SimError, SimErrorKind};

impl System {
    /// A parameter or constant that is zero and that an equation divides by.
    fn zero_divisor(&self, origin: u32) -> Option<&str> {
        let dae = &self.program.sorted().dae;
        let equation = dae.equations.get(origin as usize)?;
        let divisors = dae.pool.divisors(&[equation.left, equation.right]);
        let names = self.program.variables().iter().enumerate();
        let mut zeros = names.filter(|(at, known)| {
            divisors.contains(&known.variable) && self.value(*at) == Some(0.0)
        });
        zeros.next().map(|(_, zero)| &*zero.name)
    }

    /// From now on what the model tells is kept.
    pub fn listen(&mut self) {
        self.messages.log = Some(SimulationLog::default());
    }

    /// What the model would have written in the last simulation, if there was a listener.
    pub fn journal(&self) -> &Journal {
        self.registers.calls.journal()
    }

    /// Warnings of functions that were called in the last simulation.
    pub fn notices(&self) -> Vec<Diagnostic> {
        let functions = &self.program.sorted().dae.functions;
        let all = self.registers.calls.notices().iter();
        all.map(|notice| warning_of(functions, notice)).collect()
    }

    /// The log messages of the last simulation, and how many more there were.
    pub fn log_messages(&self) -> (&[LogMessage], u64) {
        let log = self.messages.log.as_ref();
        log.map_or((&[][..], 0), |log| (&log.recorded, log.omitted))
    }

    pub(super) fn forget_notices(&mut self) {
        if let Some(log) = &mut self.messages.log {
            let active = vec![false; self.program.log_assertions.len()];
            *log = SimulationLog { active, ..SimulationLog::default() };
        }
        self.forget_warnings_of_others();
    }

    /// The warnings that begin to hold now.
    pub(super) fn log_assertions(&mut self, t: f64) -> Result<(), sim::Failure> {
        let Some(mut log) = self.messages.log.take() else { return Ok(()) };
        let program = self.program.clone();
        let done = program.log_assertions.iter().enumerate().try_for_each(|(at, assertion)| {
            let fails = self.fails(assertion)?;
            if fails && !log.active.get(at).is_some_and(|active| *active) {
                self.record(assertion, t, &mut log)?;
            }
            if let Some(active) = log.active.get_mut(at) {
                *active = fails;
            }
            Ok(())
        });
        self.messages.log = Some(log);
        done
    }

    /// The log messages of an event.
    pub(super) fn log_assertions_at_event(&mut self, t: f64) -> Result<(), sim::Failure> {
        let Some(mut log) = self.messages.log.take() else { return Ok(()) };
        let program = self.program.clone();
        let done = program.events.log_assertions.iter().try_for_each(|assertion| {
            match self.fails(assertion)? {
                true => self.record(assertion, t, &mut log),
                false => Ok(()),
            }
        });
        self.messages.log = Some(log);
        done
    }

    fn fails(&mut self, assertion: &LogAssertion) -> Result<bool, sim::Failure> {
        run(&assertion.condition.tape, &mut self.registers)?;
        let holds = assertion.condition.outputs.iter().map(|at| self.registers[*at as usize]);
        Ok(holds.eq([0.0]))
    }

    /// Records the text of an assertion; makes the calls of one that writes.
    fn record(
        &mut self,
        assertion: &LogAssertion,
        t: f64,
        log: &mut SimulationLog,
    ) -> Result<(), sim::Failure> {
        let LogAssertion { assertion: number, values, .. } = assertion;
        let program = self.program.clone();
        let Some(Assertion { level, span, .. }) = program.sorted().dae.assertion(*number) else {
            return Ok(());
        };
        if *level == Level::Effect {
            return run(&values.tape, &mut self.registers);
        }
        let text = self.message_of(*number, values);
        let warning = (*level == Level::Warning).then_some(ASSERTION_FAILED);
        log.record(LogMessage { time: t, text, warning, span: *span });
        Ok(())
    }

    /// What a failure says with the values in its text, where there are some, and with the variable
    /// that has none.
    pub(super) fn with_values(&self, said: Diagnostic, error: &SimError) -> Diagnostic {
        let (SimErrorKind::Evaluation(failure) | SimErrorKind::Initialization(failure)) =
            error.kind
        else {
            return said;
        };
        if let sim::Failure::Domain { origin, operation } = failure
            && said.code == DOMAIN_ERROR
        {
            let when = format!("at t = {}", error.time);
            let said = said.reworded(self.program.failed_value(origin, operation, &when));
            return match self.zero_divisor(origin) {
                Some(name) => {
                    said.help(format!("the divisor `{name}` is 0: give it another value"))
                }
                None => said,
            };
        }
        let dae = &self.program.sorted().dae;
        let strings = match failure {
            sim::Failure::Assertion { assertion } => {
                let text =
                    self.messages.failed_message.as_ref().filter(|(known, _)| *known == assertion);
                dae.assertion(assertion).map(|a| &*a.message).zip(text.map(|(_, text)| &**text))
            }
            sim::Failure::Function { .. } => {
                let last = self.registers.calls.failure;
                let last = last.filter(|last| failure == sim::Failure::from(last));
                let known = last.and_then(|last| dae.functions.message(&last));
                known.zip(Some(self.registers.calls.message()))
            }
            _ => None,
        };
        match strings.filter(|(known, _)| known.contains(UNKNOWN)) {
            Some((known, text)) => {
                let message = said.message.replacen(known, text, 1);
                said.reworded(message)
            }
            None => said,
        }
    }
}
