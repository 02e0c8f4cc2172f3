//! Scripts: what stands at the top level of a `.mos` file.

use super::{ClassDefinition, ComponentClause, Expression, Import, Statement};
use crate::source::{Span, Spanned};
use std::sync::Arc;

/// A whole script.
#[derive(Debug, Clone, PartialEq)]
pub struct Script {
    /// Its statements, in order.
    pub statements: Vec<InteractiveStatement>,
    /// The whole text.
    pub span: Span,
}

/// One statement at the top level of a script.
#[derive(Debug, Clone, PartialEq)]
pub struct InteractiveStatement {
    /// What it is.
    pub kind: InteractiveKind,
    /// Whether a semicolon ends it (a dialect may echo the value of one without).
    pub semicolon: bool,
    /// The statement without its terminator.
    pub span: Span,
}

/// The forms of interactive statements.
#[derive(Debug, Clone, PartialEq)]
pub enum InteractiveKind {
    /// Assignment (with `:=` or `=`), call, `if`, `for`, `while`, …
    Statement(Statement),
    /// An expression whose value is shown. A lone call is a [`InteractiveKind::Expression`] too.
    Expression(Expression),
    /// `Real x = 1;`, `parameter Real p = 2;`
    Declaration(Box<ComponentClause>),
    /// A class or function definition.
    Class(Arc<ClassDefinition>),
    /// `import …`
    Import(Box<Import>),
    /// A bare command: `clear`, `cd ..`, `exit`, `clearlog`, `@other.mos`.
    Command {
        /// Its name.
        name: Spanned<Arc<str>>,
        /// The rest of the line, trimmed; may be empty.
        argument: Spanned<Arc<str>>,
    },
}
