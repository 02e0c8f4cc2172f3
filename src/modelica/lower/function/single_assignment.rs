//! Local variables with one value: what is assigned to them is known wherever it is a number.

use crate::name::Ident;
use crate::syntax::ast::{Statement, StatementKind, targets};
use rustc_hash::FxHashMap;

/// The variables that one statement assigns to as a whole, which is executed exactly once: it is in
/// no branch and in no loop, and nothing returns before it.
pub(super) fn assigned_once(statements: &[Statement]) -> Vec<Ident> {
    let mut counts: FxHashMap<Ident, usize> = FxHashMap::default();
    for target in targets(statements) {
        *counts.entry(target.parts[0].name).or_default() += 1;
    }
    let plain = statements.iter().take_while(|s| !may_return(s)).filter_map(|s| match &s.kind {
        StatementKind::Assign { target, .. } => target.as_ident(),
        _ => None,
    });
    plain.filter(|name| counts.get(name) == Some(&1)).collect()
}

fn may_return(statement: &Statement) -> bool {
    matches!(statement.kind, StatementKind::Return)
        || statement.bodies().any(|body| body.iter().any(may_return))
}
