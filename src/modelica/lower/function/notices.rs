//! What a machine noticed while it ran functions, as warnings.

use crate::bytecode::{Failure, Functions, Reason};
use crate::diag::{Diagnostic, Fault};
use crate::eval::errors::{ASSERTION_FAILED, ASSIGN_BEFORE, NO_VALUE_YET};

/// The warning of one of [`Machine::notices`](crate::bytecode::Machine::notices).
pub(crate) fn warning_of(functions: &Functions, notice: &(u32, Failure)) -> Diagnostic {
    let (words, span) = functions.notice(notice);
    let fault = match notice.1.reason {
        Reason::Assertion => Fault::new(ASSERTION_FAILED, words),
        _ => Fault::new(NO_VALUE_YET, words).help(ASSIGN_BEFORE),
    };
    fault.at(span).warning()
}
