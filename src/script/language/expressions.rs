//! Expressions and statements of scripts, evaluated among the variables of the session.

use crate::Session;
use crate::diag::Diagnostic;
use crate::eval::{self, Scope};
use crate::syntax;
use crate::syntax::ast::{Expression, Statement};
use crate::value::Value;

impl Session {
    /// The value of an expression; `name` is shown in diagnostics.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn value_of(&mut self, name: &str, text: &str) -> Result<Value, Diagnostic> {
        let source = self.sources.add(name, text);
        let expression = syntax::parse_expression(source, text)?;
        self.evaluate(&expression)
    }

    /// The value of an expression among the script's variables.
    pub fn evaluate(&mut self, expression: &Expression) -> Result<Value, Diagnostic> {
        self.with_scope(|scope, session| eval::evaluate(expression, scope, session))
    }

    pub(super) fn execute(&mut self, statement: &Statement) -> Result<(), Diagnostic> {
        let statements = std::slice::from_ref(statement);
        self.with_scope(|scope, session| eval::execute(statements, scope, session))?;
        Ok(())
    }

    pub(super) fn with_scope<T>(&mut self, work: impl FnOnce(&mut Scope, &mut Session) -> T) -> T {
        let mut scope = std::mem::take(&mut self.workspace.variables);
        let result = work(&mut scope, self);
        self.workspace.variables = scope;
        result
    }
}
