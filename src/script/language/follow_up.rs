//! One cause, one error: what cannot be done because an earlier statement failed is noted once.

use crate::diag::{Diagnostic, Fault};
use crate::errors::FOLLOW_UP;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::RUN_COMMAND;
use crate::syntax::ast::{
    Expression, ExpressionKind, InteractiveKind, InteractiveStatement, Statement,
    simple_statements, targets,
};
use std::collections::HashSet;

/// Variables that have no value because their statement failed.
#[derive(Debug, Default)]
pub(crate) struct FollowUps {
    missing: HashSet<Ident>,
    /// A script that was not run to its end ran others: anything may be missing.
    anything: bool,
    reported: bool,
}

impl FollowUps {
    /// Why `name` has no value, if it would have one had an earlier statement not failed.
    pub(crate) fn note(&self, name: Ident, span: Span) -> Option<Diagnostic> {
        if !self.anything && !self.missing.contains(&name) {
            return None;
        }
        let message = format!(
            "`{name}` has no value because an earlier statement failed; this statement and other \
             dependent statements are skipped"
        );
        Some(Fault::new(FOLLOW_UP, message).at(span).note())
    }

    /// A statement gave the variable a value after all.
    pub(crate) fn found(&mut self, name: Ident) {
        if !self.missing.is_empty() {
            self.missing.remove(&name);
        }
    }

    /// Whether this is the first follow-up, the only one that is reported.
    pub(crate) fn is_first(&mut self) -> bool {
        !std::mem::replace(&mut self.reported, true)
    }

    /// The statement was executed, but not to its end: the scripts that it runs noted themselves
    /// what they did not do.
    pub(crate) fn failed(&mut self, statement: &InteractiveStatement) {
        let anything = self.anything;
        self.not_done(std::slice::from_ref(statement));
        self.anything = anything;
    }

    /// A script that was asked for was not run at all.
    pub(crate) fn script_not_run(&mut self) {
        self.anything = true;
    }

    /// These statements were not executed.
    pub(crate) fn not_done(&mut self, statements: &[InteractiveStatement]) {
        for statement in statements {
            match &statement.kind {
                InteractiveKind::Statement(statement) => {
                    let statements = std::slice::from_ref(statement);
                    let named = targets(statements).into_iter();
                    let names = named.filter(|target| target.parts.len() == 1);
                    self.missing.extend(names.map(|target| target.parts[0].name));
                    let values = simple_statements(statements).into_iter();
                    values.filter_map(Statement::value).for_each(|value| self.expression(value));
                }
                InteractiveKind::Expression(expression) => self.expression(expression),
                InteractiveKind::Declaration(clause) => {
                    self.missing.extend(clause.components.iter().map(|c| c.name.node));
                }
                InteractiveKind::Command { name, .. } => {
                    self.anything |= &*name.node == RUN_COMMAND;
                }
                InteractiveKind::Class(_) | InteractiveKind::Import(_) => {}
            }
        }
    }

    fn expression(&mut self, expression: &Expression) {
        self.anything |= runs_script(expression);
    }
}

/// Whether an expression is a call that runs a script.
pub(super) fn runs_script(expression: &Expression) -> bool {
    let ExpressionKind::Call { function, .. } = &expression.kind else { return false };
    let parts = function.parts.last();
    parts.is_some_and(|part| part.name.as_str().eq_ignore_ascii_case("RunScript"))
}
