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
pub fn parse_stored_definition(
    source: SourceId,
    text: &str,
) -> Result<StoredDefinition, Diagnostic> {
    let rule = Rule::stored_definition;
    parser::parse(source, text, rule, Dialect::Modelica, lower::stored_definition)
}

/// Reads a `.mos` file: interactive statements, closed by `;` or line ends.
pub fn parse_script(source: SourceId, text: &str) -> Result<Script, Diagnostic> {
    parser::parse(source, text, Rule::script, Dialect::Script, lower::script)
}

/// Reads an expression that is the whole text, such as the value of a command-line option.
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
