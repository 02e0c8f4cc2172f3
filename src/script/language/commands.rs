//! Commands at the place of their call: what they answer, and how they fail.

use crate::Session;
use crate::builtins::{BuiltinId, Failure};
use crate::diag::{Diagnostic, Fault};
use crate::errors::SCRIPT_ERROR;
use crate::eval::Function;
use crate::source::Span;
use crate::value::Value;
use std::sync::Arc;

impl Session {
    /// Runs the command of this header.
    pub(super) fn run_command(
        &mut self,
        header: &Arc<Function>,
        arguments: Vec<Value>,
        span: Span,
    ) -> Result<Vec<Value>, Diagnostic> {
        let Some(id) = BuiltinId::of(header) else {
            unreachable!("`callee` gives out headers of the table only")
        };
        let around = self.execution.begin_call(span);
        let before = self.output.messages.next_number();
        let result = id.run(self, arguments);
        self.execution.end_call(around);
        if let Ok(answer) = &result {
            self.statuses.answered(answer, before..self.output.messages.next_number());
        }
        if result.as_ref().is_ok_and(is_success) {
            self.output.messages.note_success();
        }
        match result {
            Ok(Value::Tuple(values)) => Ok(values),
            Ok(value) => Ok(vec![value]),
            Err(failure) => Err(self.last_of(failure, span)),
        }
    }

    /// The last diagnostic of a command that failed; the others are reported.
    pub(super) fn last_of(&mut self, failure: Failure, span: Span) -> Diagnostic {
        match failure {
            Failure::Here(fault) => fault.at(span),
            Failure::Elsewhere(mut diagnostics) => {
                let last = diagnostics.pop();
                // What has no place of its own was found by this call.
                diagnostics.into_iter().for_each(|diagnostic| self.report(diagnostic.or_at(span)));
                let last = last.map(|diagnostic| diagnostic.or_at(span));
                last.unwrap_or_else(|| Fault::new(SCRIPT_ERROR, "failed").at(span))
            }
        }
    }
}

/// Whether a command says that it succeeded.
fn is_success(answer: &Value) -> bool {
    let first = match answer {
        Value::Tuple(values) => values.first(),
        value => Some(value),
    };
    first == Some(&Value::Boolean(true))
}
