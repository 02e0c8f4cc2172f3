//! Loops in algorithms of models that are unrolled while names are resolved (MLS §11.2.2).

use crate::diag::Diagnostic;
use crate::flatten::expressions::local::Local;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::syntax::ast::{Expression, ExpressionKind, Statement, StatementKind};
use crate::syntax::visit::Visit;

impl Instantiation<'_> {
    /// The iterations of a loop in an algorithm of a model one after another: its variable may choose
    /// among components, which only a number can. `None` where iterations are not known, or one may be
    /// the last.
    pub(super) fn iterations_of_statement(
        &mut self,
        statement: &Statement,
        context: ScopeId,
        local: &Local,
    ) -> Option<Result<Vec<Statement>, Diagnostic>> {
        let StatementKind::For { indices, body } = &statement.kind else { return None };
        if !self.classes.is_in_model(context) || body.iter().any(breaks) {
            return None;
        }
        let visit = |uses: &mut dyn Visit| body.iter().for_each(|inner| uses.statement(inner));
        let indices = self.with_ranges(indices, context, local, &visit).ok()?;
        let mut iterations = Vec::new();
        self.iterations(&indices, context, local, &mut iterations).ok()?;
        let mut all = Vec::new();
        for iteration in iterations {
            match self.statements(body, context, &iteration) {
                Ok(statements) => all.extend(statements),
                Err(error) => return Some(Err(error)),
            }
        }
        Some(Ok(all))
    }

    /// Whether a resolved statement is a loop over Strings or records, which are not numbers that a loop
    /// variable could hold.
    pub(super) fn runs_over_values(&self, statement: &Statement, local: &Local) -> bool {
        let StatementKind::For { indices, .. } = &statement.kind else { return false };
        let is_string = |e: &Expression| matches!(e.kind, ExpressionKind::String(_));
        let of_values = |range: &Expression| match &range.kind {
            ExpressionKind::Array(elements) if elements.first().is_some_and(is_string) => true,
            _ => self.elements_of_records(range, local).is_some(),
        };
        indices.iter().any(|index| index.range.as_ref().is_some_and(of_values))
    }
}

/// Whether a statement may leave the loop around it.
fn breaks(statement: &Statement) -> bool {
    match &statement.kind {
        StatementKind::Break | StatementKind::Return => true,
        StatementKind::If { branches, otherwise } => {
            branches.iter().any(|(_, body)| body.iter().any(breaks)) || otherwise.iter().any(breaks)
        }
        _ => false,
    }
}
