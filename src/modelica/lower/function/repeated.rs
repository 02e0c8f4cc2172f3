//! Calls that were made before: a medium is asked for the same state at the same point again and
//! again, and each answer may take thousands of statements.

use super::results::Outcome;
use crate::eval::Function;
use crate::lower::builder::Builder;
use crate::lower::expressions::Lowered;
use crate::symbolic::Expr;
use std::sync::Arc;

/// How much a model had before a call.
pub(in crate::lower) struct Before {
    counts: [usize; 5],
    assertions: usize,
    inlined: usize,
    /// How many operators were around it in which references mean variables.
    raw: usize,
}

fn counts(builder: &Builder<'_>) -> [usize; 5] {
    let dae = &builder.dae;
    let calls = builder.calls.impure as usize;
    [
        dae.variables.len(),
        dae.relations.len(),
        dae.warnings.len(),
        calls,
        builder.calls.written.len(),
    ]
}

impl Before {
    pub(in crate::lower) fn new(builder: &Builder<'_>) -> Before {
        let assertions = builder.dae.assertions.len();
        let (inlined, raw) = (builder.calls.inlined, builder.execution.raw);
        Before { counts: counts(builder), assertions, inlined, raw }
    }

    /// Takes back what an attempt said that has failed.
    pub(in crate::lower) fn restore(&self, builder: &mut Builder<'_>) {
        let [_, _, warnings, _, written] = self.counts;
        builder.dae.assertions.truncate(self.assertions);
        builder.dae.warnings.truncate(warnings);
        builder.calls.written.truncate(written);
        builder.execution.raw = self.raw;
    }
}

fn key(function: &Arc<Function>, arguments: Vec<Lowered<Expr>>) -> (usize, Vec<Lowered<Expr>>) {
    (Arc::as_ptr(function).addr(), arguments)
}

/// The results of a call that was made before, if it would come to the same now.
pub(super) fn repeat(
    builder: &mut Builder<'_>,
    function: &Arc<Function>,
    arguments: &[Lowered<Expr>],
) -> Option<Vec<Lowered<Expr>>> {
    let known = builder.calls.results.get(&key(function, arguments.to_vec()))?;
    let outermost = builder.calls.depth == 0;
    let statements = known.statements.filter(|statements| *statements < builder.calls.inlined);
    if statements.is_none() && !(outermost && known.outermost) {
        return None;
    }
    builder.calls.inlined -= statements.unwrap_or(0);
    builder.dae.assertions.extend(known.assertions.iter().cloned());
    Some(known.results.clone())
}

/// Keeps what a call came to, if that is but its results and assertions.
pub(super) fn remember(
    builder: &mut Builder<'_>,
    function: &Arc<Function>,
    arguments: Vec<Lowered<Expr>>,
    before: &Before,
    results: &[Lowered<Expr>],
) {
    if counts(builder) != before.counts {
        return;
    }
    let has_room = builder.calls.inlined > 0;
    let outcome = Outcome {
        _function: function.clone(),
        results: results.to_vec(),
        assertions: builder.dae.assertions[before.assertions..].to_vec(),
        statements: before.inlined.checked_sub(builder.calls.inlined).filter(|_| has_room),
        outermost: builder.calls.depth == 0,
    };
    builder.calls.results.insert(key(function, arguments), outcome);
}
