//! Loops of scripts that change nothing of what their condition reads.

use super::errors::ENDLESS_LOOP;
use crate::diag::{Diagnostic, suggest};
use crate::fault;
use crate::name::Ident;
use crate::syntax::ast::{
    ComponentReference, Expression, ExpressionKind, Statement, StatementKind,
};
use crate::syntax::visit::{Visit, walk_expression};

/// A warning for a loop of a script whose condition is true: where it depends on variables only, and no
/// statement in the loop assigns to one of them, leaves the loop or calls what could change them.
pub(super) fn endless(
    condition: &Expression,
    body: &[&Statement],
    assigned: &[&ComponentReference],
) -> Option<Diagnostic> {
    let mut read = ReadNames { names: Vec::new(), only_variables: true };
    read.expression(condition);
    let changes = |name: &Ident| assigned.iter().any(|target| target.parts[0].name == *name);
    let is_known = read.only_variables && !read.names.is_empty() && !read.names.iter().any(changes);
    if !is_known || !body.iter().all(|statement| only_assigns(statement)) {
        return None;
    }
    let names = read.names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    let meant = assigned.iter().find_map(|target| {
        let written = target.as_ident()?;
        let meant =
            suggest::nearest(written.as_str(), read.names.iter().map(|name| name.as_str()))?;
        Some(format!("`{written}` is assigned in the loop; did you mean `{meant}`?"))
    });
    let fault = fault!(ENDLESS_LOOP, "no statement of this loop changes {names}: it does not end");
    Some(fault.help_if(meant).at(condition.span).warning())
}

/// Whether a statement changes nothing but its targets, and does not lead out of a loop.
fn only_assigns(statement: &Statement) -> bool {
    let (value, is_call) = match &statement.kind {
        StatementKind::Assign { value, .. } | StatementKind::MultiAssign { value, .. } => {
            (value, false)
        }
        StatementKind::Call(call) => (call, true),
        _ => return false,
    };
    let ExpressionKind::Call { function, .. } = &value.kind else { return !is_call };
    let name = function.name().to_string();
    if is_call { name == "print" } else { !name.to_lowercase().ends_with("runscript") }
}

/// The variables that an expression reads.
struct ReadNames {
    names: Vec<Ident>,
    /// Whether it reads nothing else: it calls nothing, and there are no parts of models.
    only_variables: bool,
}

impl Visit for ReadNames {
    fn reference(&mut self, reference: &ComponentReference) {
        self.names.push(reference.parts[0].name);
        self.only_variables &= reference.parts.len() == 1;
    }

    fn expression(&mut self, e: &Expression) {
        self.only_variables &= !matches!(e.kind, ExpressionKind::Call { .. });
        walk_expression(self, e);
    }
}
