//! Assertions of a running system: whether they hold, and the messages of those that do not.

use super::execution::{read, run};
use super::system::System;
use crate::codegen::code::{Assertions, LogAssertion, Outputs};
use crate::lower::StringPart;
use crate::sim::Failure;
use crate::value::format::written;

/// Stands for a value that there is not.
pub(super) const UNKNOWN: &str = "…";

impl System {
    /// A domain failure where an assertion does not hold is the assertion's.
    pub(super) fn refine(&mut self, failure: Failure) -> Failure {
        match failure {
            Failure::Domain { .. } | Failure::Function { .. } => self.violated().unwrap_or(failure),
            other => other,
        }
    }

    /// The first assertion that does not hold, of those that can be evaluated.
    fn violated(&mut self) -> Option<Failure> {
        let mut failures =
            (0..self.program.assertions.each.len()).filter_map(|at| self.assert(at).err());
        failures.find(|failure| matches!(failure, Failure::Assertion { .. }))
    }

    /// Evaluates all assertions, one by one where they do not all hold.
    pub(super) fn assert_all(&mut self) -> Result<(), Failure> {
        let Assertions { each, conditions } = &self.program.assertions;
        let n = each.len();
        let mut hold = std::mem::take(&mut self.messages.hold);
        hold.resize(n, 0.0);
        let are_known = read(conditions, &mut self.registers, &mut hold).is_ok();
        let all_hold = are_known && hold.iter().all(|condition| *condition != 0.0);
        self.messages.hold = hold;
        if all_hold { Ok(()) } else { (0..n).try_for_each(|at| self.assert(at)) }
    }

    /// Evaluates an assertion.
    fn assert(&mut self, at: usize) -> Result<(), Failure> {
        let assertion = &self.program.assertions.each[at];
        let mut holds = [0.0];
        read(&assertion.condition, &mut self.registers, &mut holds)?;
        if holds != [0.0] {
            return Ok(());
        }
        let program = self.program.clone();
        let LogAssertion { assertion, values, .. } = &program.assertions.each[at];
        Err(self.failed_assertion(*assertion, values))
    }

    /// Checks the assertions of when-clauses, and at the start those of initial sections.
    pub(super) fn assert_at_event(&mut self) -> Result<(), Failure> {
        let program = self.program.clone();
        let events = &program.events;
        run(&events.assertions.tape, &mut self.registers)?;
        let value = |register: &u32| self.registers[*register as usize];
        match events.assertions.outputs.iter().position(|a| value(a) == 0.0) {
            Some(failed) => {
                let (assertion, values) = &events.asserted[failed];
                Err(self.failed_assertion(*assertion, values))
            }
            None => Ok(()),
        }
    }

    /// An assertion that does not hold, whose text is kept with its values as they are.
    pub(super) fn failed_assertion(&mut self, assertion: u32, values: &Outputs) -> Failure {
        self.messages.failed_message = Some((assertion, self.message_of(assertion, values)));
        Failure::Assertion { assertion }
    }

    /// The text of an assertion with its values as they are; `…` for those that there are not.
    pub(super) fn message_of(&mut self, assertion: u32, values: &Outputs) -> String {
        let program = self.program.clone();
        let Some(assertion) = program.sorted().dae.assertion(assertion) else {
            return String::new();
        };
        let are_known = run(&values.tape, &mut self.registers).is_ok();
        let mut outputs = values.outputs.iter().map(|at| self.registers[*at as usize]);
        let mut words = String::new();
        for part in &assertion.parts {
            let row: Vec<f64> = outputs.by_ref().take(part.scalars().len()).collect();
            let text = match part {
                StringPart::Text(known) => Some(known.clone()),
                _ if !are_known => None,
                StringPart::Numbered(_) => self.registers.calls.text(row[0]),
                StringPart::Written(_, format) => written(&row, format.as_deref()).ok(),
            };
            words += text.as_deref().unwrap_or(UNKNOWN);
        }
        words
    }
}
