//! Calls that were made before: a medium is asked for the same state at the same point again and
//! again, and each answer may take thousands of statements.

use crate::eval::Function;
use crate::lower::build::Builder;
use crate::lower::dae::Assertion;
use crate::lower::expressions::Lowered;
use crate::symbolic::Expr;
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// Calls with what they came to, by the function's address, which stays as the function is kept.
pub(in crate::lower) type Repeated = FxHashMap<(usize, Vec<Lowered<Expr>>), Outcome>;

/// What a call came to.
pub(in crate::lower) struct Outcome {
    _function: Arc<Function>,
    results: Vec<Lowered<Expr>>,
    assertions: Vec<Assertion>,
    /// Statements that it needs to come to this within another call; `None` if it does not.
    statements: Option<usize>,
    /// Whether it comes to this where it is in no other call.
    outermost: bool,
}

/// How much a model had before a call.
pub(super) struct Before {
    counts: [usize; 5],
    assertions: usize,
    inlined: usize,
}

fn counts(builder: &Builder<'_>) -> [usize; 5] {
    let dae = &builder.dae;
    let calls = builder.impure_calls as usize;
    [dae.variables.len(), dae.relations.len(), dae.warnings.len(), calls, builder.written.len()]
}

impl Before {
    pub(super) fn new(builder: &Builder<'_>) -> Before {
        let assertions = builder.dae.assertions.len();
        Before { counts: counts(builder), assertions, inlined: builder.inlined }
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
    let known = builder.repeated.get(&key(function, arguments.to_vec()))?;
    let outermost = builder.calls == 0;
    let statements = known.statements.filter(|statements| *statements < builder.inlined);
    if statements.is_none() && !(outermost && known.outermost) {
        return None;
    }
    builder.inlined -= statements.unwrap_or(0);
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
    let has_room = builder.inlined > 0;
    let outcome = Outcome {
        _function: function.clone(),
        results: results.to_vec(),
        assertions: builder.dae.assertions[before.assertions..].to_vec(),
        statements: before.inlined.checked_sub(builder.inlined).filter(|_| has_room),
        outermost: builder.calls == 0,
    };
    builder.repeated.insert(key(function, arguments), outcome);
}
