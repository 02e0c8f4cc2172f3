//! Text to syntax tree and back: Modelica classes and scripts.
//!
//! A text is scanned (comments blanked, line ends of scripts marked, brackets and `end`s matched),
//! read by the pest grammar in `grammar/`, and lowered to the tree in [`ast`]. The first error
//! stops the reading and is the one [`Diagnostic`] returned: an error in a bracket or an `end` is
//! reported in preference to what the grammar makes of it later.

pub mod ast;
mod decode;
pub mod errors;
mod failure;
mod lower;
mod parser;
pub mod print;
mod scan;
pub mod visit;

pub use decode::decode;

use crate::diag::Diagnostic;
use crate::name::Name;
use crate::source::SourceId;
use ast::{Argument, Expression, Script, StoredDefinition};
use parser::Rule;
use scan::Dialect;

/// Reads a `.mo` file (MLS §A.2.1).
///
/// ```
/// use gapilib::{source::SourceId, syntax};
///
/// let text = "model Decay Real x(start=1); equation der(x) = -x; end Decay;";
/// let file = syntax::parse_stored_definition(SourceId::NONE, text)?;
/// assert_eq!(file.classes[0].name.node, "Decay");
/// let error = syntax::parse_stored_definition(SourceId::NONE, "model M Real x end M;");
/// assert_eq!(error.unwrap_err().code.slug, "missing-semicolon");
/// # Ok::<(), gapilib::diag::Diagnostic>(())
/// ```
pub fn parse_stored_definition(
    source: SourceId,
    text: &str,
) -> Result<StoredDefinition, Diagnostic> {
    let rule = Rule::stored_definition;
    parser::parse(source, text, rule, Dialect::Modelica, lower::stored_definition)
}

/// Reads a `.mos` file: interactive statements, closed by `;` or line ends.
///
/// ```
/// use gapilib::{source::SourceMap, syntax};
///
/// let text = "cd ..\nfor i in 1:3 loop\n  x = i\nend for\nf(x) // shown\n";
/// let source = SourceMap::default().add("example.mos", text);
/// let script = syntax::parse_script(source, text)?;
/// assert_eq!(script.statements.len(), 3);
/// assert_eq!(
///     syntax::print::script(&script),
///     "cd ..\nfor i in 1:3 loop\n  x := i;\nend for\nf(x)\n"
/// );
/// # Ok::<(), gapilib::diag::Diagnostic>(())
/// ```
pub fn parse_script(source: SourceId, text: &str) -> Result<Script, Diagnostic> {
    parser::parse(source, text, Rule::script, Dialect::Script, lower::script)
}

/// Reads an expression.
///
/// ```
/// use gapilib::{source::SourceId, syntax};
///
/// let tree = syntax::parse_expression(SourceId::NONE, "-(a+b)*{1,2.0}[1]");
/// assert!(tree.is_err());
/// let tree = syntax::parse_expression(SourceId::NONE, "-(a+b)*({1,2.0})[1]")?;
/// assert_eq!(syntax::print::expression(&tree), "-(a + b) * ({1, 2.0})[1]");
/// # Ok::<(), gapilib::diag::Diagnostic>(())
/// ```
///
/// It is the whole text, such as the value of a command-line option.
pub fn parse_expression(source: SourceId, text: &str) -> Result<Expression, Diagnostic> {
    let rule = Rule::lone_expression;
    parser::parse(source, text, rule, Dialect::Fragment, lower::lone_expression)
}

/// Reads a class name with an optional modification, `M(redeclare package P = Q, p = 2)`: the
/// problem of `simulateModel`.
pub fn parse_class_with_modification(
    source: SourceId,
    text: &str,
) -> Result<(Name, Vec<Argument>), Diagnostic> {
    let rule = Rule::class_with_modification;
    parser::parse(source, text, rule, Dialect::Fragment, lower::class_with_modification)
}

#[cfg(test)]
mod tests;
