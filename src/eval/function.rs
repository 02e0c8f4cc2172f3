//! A function ready to be called: inheritance resolved, names absolute. Data only.

use super::Compiled;
use crate::functions::Builtin;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast;
use crate::value::EnumerationDefinition;
use indexmap::IndexMap;
use std::sync::Arc;

/// A function with every reference resolved: in its expressions a single identifier that names
/// one of its components (or a loop variable) is local; every other name is absolute (no matter
/// whether written with a leading dot) and answered by the [`Host`](super::Host). References to
/// constants of packages are replaced by their values where these are known.
#[derive(Debug, Clone, PartialEq)]
pub struct Function {
    /// Its full name.
    pub name: Name,
    /// Inputs in order.
    pub inputs: Vec<FunctionComponent>,
    /// Outputs in order.
    pub outputs: Vec<FunctionComponent>,
    /// Protected variables in order.
    pub locals: Vec<FunctionComponent>,
    /// What it does.
    pub body: FunctionBody,
    /// The string behind its name.
    pub description: Option<Arc<str>>,
    /// Arguments of its class annotation (`derivative`, `inverse`, `Inline`, …).
    pub annotation: Vec<ast::Argument>,
    /// Whether it is declared `impure` or calls what is.
    pub impure: bool,
    /// Where it is defined.
    pub span: Span,
    /// Made of the rest by the first call.
    pub compiled: Compiled,
}

impl Function {
    /// Whether a call may give any arguments, which are not looked at: a built-in
    /// marked `annotation(variadic = true)`.
    pub(super) fn is_variadic(&self) -> bool {
        self.annotation.iter().any(|argument| match argument {
            ast::Argument::Element(element) => {
                element.name.node.last().is_some_and(|name| name == "variadic")
            }
            ast::Argument::Redeclaration(_) => false,
        })
    }
}

/// What a function does.
#[derive(Debug, Clone, PartialEq)]
pub enum FunctionBody {
    /// Statements of its algorithm section.
    Algorithm(Vec<ast::Statement>),
    /// `external` with language, function and call.
    External(ast::External),
    /// A record's constructor: the inputs are the fields of the single output (MLS §12.6).
    RecordConstructor,
}

/// An input, output or local variable of a function.
#[derive(Debug, Clone, PartialEq)]
pub struct FunctionComponent {
    /// Its name.
    pub name: Ident,
    /// Its element type.
    pub value_type: ValueType,
    /// Its dimensions; [`ast::Subscript::All`] where any size is accepted.
    pub dims: Vec<ast::Subscript>,
    /// Default of an input, initial value of an output or local.
    pub binding: Option<ast::Expression>,
    /// The string behind it.
    pub description: Option<Arc<str>>,
    /// Where it is declared.
    pub span: Span,
}

/// The type of a component of a function.
#[derive(Debug, Clone, PartialEq)]
pub enum ValueType {
    /// `Real` and types derived from it.
    Real,
    /// `Integer`
    Integer,
    /// `Boolean`
    Boolean,
    /// `String`
    String,
    /// An enumeration.
    Enumeration(Arc<EnumerationDefinition>),
    /// A record: its full name and its components, each with its dimensions.
    Record(Name, Arc<IndexMap<Ident, FunctionComponent>>),
    /// A class derived from `ExternalObject` (MLS §12.9.7).
    ExternalObject(Name),
    /// A function given as an argument.
    Function,
    /// The name of a class, not evaluated (built-ins only).
    TypeName,
    /// The name of a variable, not evaluated (built-ins only).
    VariableName,
    /// An expression, not evaluated: its text (built-ins only).
    Expression,
    /// Any value (built-ins only).
    Any,
}

/// What a called name stands for.
#[derive(Clone)]
pub(super) enum Target {
    Function(Arc<Function>),
    Builtin(Arc<Function>),
    /// A function or an operator of the language.
    Language(&'static Builtin),
    Unknown,
}
