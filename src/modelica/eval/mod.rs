//! Evaluates syntax trees to values: expressions (MLS ch. 3, 10), statements (MLS ch. 11) and
//! functions written in Modelica (MLS ch. 12). Who answers calls and names that are not local is
//! the [`Host`].
//!
//! The variables are in a [`Scope`]. Elements are read and overwritten in place; a variable, an
//! element or an output without a value is a fault, never a zero.

mod argument;
pub mod c_function;
mod call;
mod component;
mod declaration;
mod depth;
mod element_types;
mod endless_loop;
pub mod errors;
mod execution;
mod expression;
mod external;
mod function;
mod host;
mod iteration;
mod reference;
mod scalar;
mod scalar_expression;
mod scope;
mod special;
mod statement;
mod types;
mod variable;
mod vectorization;

#[cfg(test)]
pub(crate) mod tests;

pub use call::Arguments;
pub use declaration::{Given, declare};
pub use depth::with_stack;
pub use function::{Function, FunctionBody, FunctionComponent, ValueType};
pub use host::{Callee, Host, RunCompiled, ScriptHost};
pub use scope::Scope;

use crate::diag::Diagnostic;
pub use crate::execute::Flow;
use crate::execute::{self, Domain as _};
use crate::source::Span;
use crate::syntax::ast;
use crate::value::Value;
use std::sync::Arc;

/// Statements of a script are not executed because of an error: see [`ScriptHost::lose`] and
/// [`ScriptHost::begin_command`].
pub fn leave_out(
    statements: &[ast::Statement],
    scope: &mut Scope,
    host: &mut dyn Host,
    error: &Diagnostic,
) {
    Evaluator { scope, host }.leave_out(statements, error);
}

/// The value of an expression. A call of a function with no output or with several gives a
/// [`Value::Tuple`].
///
/// ```
/// use gapilib_base::diag::{Diagnostic, Fault};
/// use gapilib_modelica::eval::{Callee, Host, Scope, evaluate};
/// use gapilib_base::name::{Ident, Name};
/// use gapilib_base::source::SourceId;
/// use gapilib_modelica::syntax::{ast::ComponentReference, parse_expression};
/// use gapilib_modelica::value::Value;
///
/// /// Knows nothing beyond what evaluation knows by itself.
/// struct Alone;
///
/// impl Host for Alone {
///     fn callee(&mut self, _: &Name) -> Result<Option<Callee>, Diagnostic> {
///         Ok(None)
///     }
///     fn variable(&mut self, _: &ComponentReference) -> Result<Option<Value>, Diagnostic> {
///         Ok(None)
///     }
/// }
///
/// let mut scope = Scope::script();
/// scope.set(Ident::new("v"), Value::reals(vec![3.0, 4.0]))?;
/// let norm = parse_expression(SourceId::NONE, "sqrt(v*v)")?;
/// assert_eq!(evaluate(&norm, &mut scope, &mut Alone)?, Value::Real(5.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn evaluate(
    expression: &ast::Expression,
    scope: &mut Scope,
    host: &mut dyn Host,
) -> Result<Value, Diagnostic> {
    let _entry = depth::Entry::new();
    let mut values = Evaluator { scope, host }.outputs(expression)?;
    Ok(match values.len() {
        1 => values.remove(0),
        _ => Value::Tuple(values),
    })
}

/// Executes statements in order.
pub fn execute(
    statements: &[ast::Statement],
    scope: &mut Scope,
    host: &mut dyn Host,
) -> Result<Flow, Diagnostic> {
    let _entry = depth::Entry::new();
    execute::statements(&mut Evaluator { scope, host }, statements)
}

/// Calls a function with these arguments and returns its outputs. `span` is where the call is
/// written.
pub fn call_function(
    function: &Arc<Function>,
    arguments: Arguments,
    span: Span,
    host: &mut dyn Host,
) -> Result<Vec<Value>, Diagnostic> {
    let _entry = depth::Entry::new();
    let mut scope = Scope::script();
    Evaluator { scope: &mut scope, host }.call_with(function, arguments, span)
}

/// The sizes that declared dimensions stand for; `None` where any size is accepted.
pub fn evaluate_dimensions(
    dims: &[ast::Subscript],
    scope: &mut Scope,
    host: &mut dyn Host,
) -> Result<Vec<Option<usize>>, Diagnostic> {
    let _entry = depth::Entry::new();
    Evaluator { scope, host }.dimensions(dims)
}

/// Evaluates and executes in one scope.
struct Evaluator<'a> {
    scope: &'a mut Scope,
    host: &'a mut dyn Host,
}
