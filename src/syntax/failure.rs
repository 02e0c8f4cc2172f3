//! What the grammar could not read, in Modelica words.

use super::errors::SYNTAX_ERROR;
use super::parser::Rule;
use super::scan::Scanned;
use crate::diag::Diagnostic;
use crate::fault;
use crate::source::{SourceId, Span};
use pest::error::{Error, InputLocation};

/// The diagnostic for a text that `rule` did not match.
pub(super) fn explain(
    source: SourceId,
    _rule: Rule,
    scanned: Scanned,
    error: &Error<Rule>,
) -> Diagnostic {
    let at = match error.location {
        InputLocation::Pos(at) => at,
        InputLocation::Span((start, _)) => start,
    };
    if let Some(problem) = scanned.problem
        && problem.from <= at
    {
        return problem.diagnostic;
    }
    fault!(SYNTAX_ERROR, "unexpected text").at(Span::new(source, at, at))
}
