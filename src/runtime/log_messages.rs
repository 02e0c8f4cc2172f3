//! What a model tells while it is simulated: warnings, and texts that it prints (MLS §8.3.7). Only
//! systems that somebody listens to look after them.

use super::execution::run;
use super::simulation_log::{LogMessage, Recorded, SimulationLog};
use super::system::System;
use crate::bytecode::Journal;
use crate::codegen::Program;
use crate::codegen::code::LogAssertion;
use crate::lower::{Assertion, Level, Part};
use crate::sim;
use crate::source::Span;
use crate::value::Value;
use crate::value::format::text;

impl System {
    /// From now on what the model tells is kept.
    pub fn listen(&mut self) {
        self.log = Some(SimulationLog::default());
    }

    /// What the model would have written in the last simulation, if somebody listened to it.
    pub fn journal(&self) -> &Journal {
        self.registers.calls.journal()
    }

    /// Functions that used or returned variables before they were assigned in the last simulation,
    /// for which zero was taken, and where.
    pub fn defaults(&self) -> Vec<(String, Span)> {
        let functions = &self.program.sorted().dae.functions;
        let all = self.registers.calls.defaults().iter();
        all.map(|failure| functions.default_taken(failure)).collect()
    }

    /// What the model has told in the last simulation, and how much more there was.
    pub fn log_messages(&self) -> (Vec<LogMessage>, u64) {
        let Some(log) = &self.log else { return (Vec::new(), 0) };
        let messages = log.recorded.iter().filter_map(|one| message(&self.program, one));
        (messages.collect(), log.omitted)
    }

    pub(super) fn forget_notices(&mut self) {
        if let Some(log) = &mut self.log {
            let active = vec![false; self.program.log_assertions.len()];
            *log = SimulationLog { active, ..SimulationLog::default() };
        }
    }

    /// The warnings that begin to hold now.
    pub(super) fn log_assertions(&mut self, t: f64) -> Result<(), sim::Failure> {
        let Some(mut log) = self.log.take() else { return Ok(()) };
        let program = self.program.clone();
        let done = program.log_assertions.iter().enumerate().try_for_each(|(at, assertion)| {
            let values = self.message_numbers(assertion)?;
            let holds = values.is_some();
            if let Some(values) = values.filter(|_| !log.active.get(at).is_some_and(|a| *a)) {
                log.record(t, assertion.assertion, values);
            }
            if let Some(active) = log.active.get_mut(at) {
                *active = holds;
            }
            Ok(())
        });
        self.log = Some(log);
        done
    }

    /// What is told at an event.
    pub(super) fn log_assertions_at_event(&mut self, t: f64) -> Result<(), sim::Failure> {
        let Some(mut log) = self.log.take() else { return Ok(()) };
        let program = self.program.clone();
        let done = program.events.log_assertions.iter().try_for_each(|assertion| {
            if let Some(values) = self.message_numbers(assertion)? {
                log.record(t, assertion.assertion, values);
            }
            Ok(())
        });
        self.log = Some(log);
        done
    }

    /// The numbers of a text whose condition does not hold.
    fn message_numbers(
        &mut self,
        assertion: &LogAssertion,
    ) -> Result<Option<Vec<f64>>, sim::Failure> {
        run(&assertion.code.tape, &mut self.registers)?;
        let mut values = assertion.code.outputs.iter().map(|at| self.registers[*at as usize]);
        let holds = values.next() != Some(0.0);
        Ok((!holds).then(|| values.collect()))
    }
}

fn message(program: &Program, recorded: &Recorded) -> Option<LogMessage> {
    let dae = &program.sorted().dae;
    let mut all = dae.assertions.iter().chain(&dae.events.assertions);
    let Assertion { parts, level, span, .. } = all.nth(recorded.assertion as usize)?;
    if *level == Level::Effect {
        return None;
    }
    let mut values = recorded.values.iter().copied();
    let mut words = String::new();
    for part in parts {
        let value = match part {
            Part::Text(known) => {
                words += known;
                continue;
            }
            Part::Number(_) => Value::Real(values.next()?),
            Part::Boolean(_) => Value::Boolean(values.next()? != 0.0),
        };
        words += &text(&value, DIGITS, 0, true).ok()?;
    }
    let is_warning = *level == Level::Warning;
    Some(LogMessage { time: recorded.time, text: words, is_warning, span: *span })
}

/// As `String` writes Reals (MLS §3.7.1).
const DIGITS: i64 = 6;
