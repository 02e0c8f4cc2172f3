//! What statements consist of: those inside them, what they assign to, and the values.

use super::{ComponentReference, Expression, Statement, StatementKind};

impl Statement {
    /// The statements in its branches, or in its loop.
    pub fn bodies(&self) -> impl Iterator<Item = &[Statement]> {
        let (branches, last): (&[(Expression, Vec<Statement>)], &[Statement]) = match &self.kind {
            StatementKind::If { branches, otherwise } => (branches, otherwise),
            StatementKind::When { branches } => (branches, &[]),
            StatementKind::For { body, .. } | StatementKind::While { body, .. } => (&[], body),
            _ => (&[], &[]),
        };
        branches.iter().map(|(_, body)| body.as_slice()).chain([last])
    }

    /// What it assigns to by itself.
    pub fn targets(&self) -> impl Iterator<Item = &ComponentReference> {
        let (one, several): (_, &[Option<ComponentReference>]) = match &self.kind {
            StatementKind::Assign { target, .. } => (Some(target), &[]),
            StatementKind::MultiAssign { targets, .. } => (None, targets),
            _ => (None, &[]),
        };
        one.into_iter().chain(several.iter().flatten())
    }

    /// The value that it assigns, or the call that it is.
    pub fn value(&self) -> Option<&Expression> {
        match &self.kind {
            StatementKind::Assign { value, .. }
            | StatementKind::MultiAssign { value, .. }
            | StatementKind::Call(value) => Some(value),
            _ => None,
        }
    }

    fn is_simple(&self) -> bool {
        !matches!(
            self.kind,
            StatementKind::If { .. }
                | StatementKind::When { .. }
                | StatementKind::For { .. }
                | StatementKind::While { .. }
        )
    }
}

/// The statements that are not loops or branches, in these too.
pub fn simple_statements(statements: &[Statement]) -> Vec<&Statement> {
    let mut all = Vec::new();
    for statement in statements {
        match statement.is_simple() {
            true => all.push(statement),
            false => statement.bodies().for_each(|body| all.extend(simple_statements(body))),
        }
    }
    all
}

/// What statements assign to, in loops and branches too.
pub fn targets(statements: &[Statement]) -> Vec<&ComponentReference> {
    simple_statements(statements).into_iter().flat_map(Statement::targets).collect()
}
