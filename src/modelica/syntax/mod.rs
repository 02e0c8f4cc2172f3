//! Text to syntax tree and back: Modelica classes and scripts.
//!
//! A text is scanned (comments blanked, line ends of scripts marked, brackets and `end`s matched),
//! read by the pest grammar in `grammar/`, and lowered to the tree in [`ast`]. The first error
//! stops the reading and is the one [`Diagnostic`] returned: an error in a bracket or an `end` is
//! reported in preference to what the grammar makes of it later.
//!
//! A file of a library is read lazily: [`Outline`] finds its classes, and the body of a class is
//! scanned, parsed and lowered when its [`Sections`] are first read.

pub mod ast;
mod decode;
pub mod errors;
mod failure;
pub(crate) mod foreign;
mod grammar;
pub mod graphics;
pub(crate) mod keywords;
mod lazy;
mod lower;
mod outline;
mod parser;
mod place;
pub mod print;
mod reading;
mod scan;
mod script_parts;
pub mod visit;

pub use ast::Sections;
pub use decode::decode;
pub use keywords::{is_keyword, keywords};
pub use outline::{Outline, OutlinedClass};
pub use scan::{Lexeme, LexemeKind};
pub use script_parts::ScriptParts;

use crate::diag::Diagnostic;
use crate::name::Name;
use crate::source::{SourceId, Span};
use ast::{Argument, Expression, Script, StoredDefinition};
use parser::{Pieces, Rule};
use place::TextOrigin;
use scan::Dialect;
use std::sync::Arc;

/// The command of scripts that runs another one: `@script.mos`.
pub const RUN_COMMAND: &str = "@";

/// Reads a `.mo` file (MLS §A.2.1).
///
/// ```
/// use gapilib_base::source::SourceId;
/// use gapilib_modelica::syntax;
///
/// let text = "model Decay Real x(start=1); equation der(x) = -x; end Decay;";
/// let file = syntax::parse_stored_definition(SourceId::NONE, text)?;
/// assert_eq!(file.classes[0].name.node, "Decay");
/// let error = syntax::parse_stored_definition(SourceId::NONE, "model M Real x end M;");
/// assert_eq!(error.unwrap_err().code.slug, "missing-semicolon");
/// # Ok::<(), gapilib_base::diag::Diagnostic>(())
/// ```
pub fn parse_stored_definition(
    source: SourceId,
    text: &str,
) -> Result<StoredDefinition, Diagnostic> {
    let rule = Rule::stored_definition;
    parser::parse(
        &TextOrigin::in_source(source),
        text,
        rule,
        Dialect::Modelica,
        lower::stored_definition,
    )
}

/// Reads a `.mo` file lazily: the heads of its classes now, the sections of each when they are
/// first read. What cannot be read then is reported by `Sections::error`.
///
/// ```
/// use gapilib_modelica::syntax::ast::ClassSpecifier;
/// use gapilib_base::source::SourceId;
/// use gapilib_modelica::syntax;
///
/// let text = "package P model M Real x end M; end P;";
/// let file = syntax::parse_stored_definition_lazily(SourceId::NONE, &text.into())?;
/// let ClassSpecifier::Long(package) = &file.classes[0].specifier else { panic!("P is long") };
/// assert!(!package.sections.is_read());
/// assert_eq!(package.sections.len(), 1);
/// assert_eq!(package.sections.error(), None);
/// # Ok::<(), gapilib_base::diag::Diagnostic>(())
/// ```
///
/// # Errors
/// A syntax error outside the bodies of the classes, or one that hides where they end.
pub fn parse_stored_definition_lazily(
    source: SourceId,
    text: &Arc<str>,
) -> Result<StoredDefinition, Diagnostic> {
    reading::stored_definition(source, text)
}

/// Reads a `.mo` file and reports all errors, as far as its classes can be separated: the first
/// error of each class.
///
/// # Errors
/// Syntax errors, in the order of the text.
pub fn parse_all_of_stored_definition(
    source: SourceId,
    text: &str,
) -> Result<StoredDefinition, Vec<Diagnostic>> {
    parse_stored_definition(source, text).map_err(|first| {
        let lazy = reading::stored_definition(source, &text.into());
        let mut errors: Vec<Diagnostic> = lazy.map_or(Vec::new(), |file| {
            file.classes.iter().flat_map(|class| reading::errors(class)).collect()
        });
        errors.sort_by_key(|error| error.span().start);
        if errors.is_empty() { vec![first] } else { errors }
    })
}

/// Reads a `.mos` file: interactive statements, closed by `;` or line ends.
///
/// ```
/// use gapilib_base::source::SourceMap;
/// use gapilib_modelica::syntax;
///
/// let text = "cd ..\nfor i in 1:3 loop\n  x = i\nend for\nf(x) // shown\n";
/// let source = SourceMap::default().add("example.mos", text);
/// let script = syntax::parse_script(source, text)?;
/// assert_eq!(script.statements.len(), 3);
/// assert_eq!(
///     syntax::print::script(&script),
///     "cd ..\nfor i in 1:3 loop\n  x := i;\nend for\nf(x)\n"
/// );
/// # Ok::<(), gapilib_base::diag::Diagnostic>(())
/// ```
pub fn parse_script(source: SourceId, text: &str) -> Result<Script, Diagnostic> {
    let lower = |_, nodes: parser::Nodes<'_>| lower::script(nodes);
    let (_, parts) = Pieces::read(source, text, Rule::script, Dialect::Script, lower)?;
    let mut statements = Vec::with_capacity(parts.iter().map(|part| part.statements.len()).sum());
    parts.into_iter().for_each(|part| statements.extend(part.statements));
    Ok(Script { statements, span: Span::new(source, 0, text.len()) })
}

/// The tokens and comments of a `.mo` file, or of a script, in the order of the text.
///
/// ```
/// use gapilib_base::source::SourceId;
/// use gapilib_modelica::syntax;
///
/// let text = "x = 1 // one\ny.z := 2";
/// let lexemes = syntax::lexemes(SourceId::NONE, text, true)?;
/// let words: Vec<&str> = lexemes.iter().map(|one| &text[one.range()]).collect();
/// assert_eq!(words, ["x", "=", "1", "// one", "y", ".", "z", ":=", "2"]);
/// assert!(lexemes[4].ends_line);
/// # Ok::<(), gapilib_base::diag::Diagnostic>(())
/// ```
///
/// # Errors
/// A string or comment without end, a bracket or `end` without its partner, a foreign character.
pub fn lexemes(source: SourceId, text: &str, is_script: bool) -> Result<Vec<Lexeme>, Diagnostic> {
    let dialect = if is_script { Dialect::Script } else { Dialect::Modelica };
    scan::lexemes(source, text, dialect)
}

/// The signs in a script that may have been meant to begin a statement, and continue the one of the line
/// before: without a blank after them, on a line that is not indented deeper than the statement.
///
/// ```
/// use gapilib_base::source::SourceId;
/// use gapilib_modelica::syntax;
///
/// let signs = |text| syntax::continuing_signs(SourceId::NONE, text).len();
/// assert_eq!((signs("a = 4\n-1"), signs("a = 4;\n-1"), signs("a = (4\n-1)")), (1, 0, 0));
/// assert_eq!((signs("a = 4\n  -1"), signs("a = 4\n- 1"), signs("a = 4 -\n1")), (0, 0, 0));
/// ```
pub fn continuing_signs(source: SourceId, text: &str) -> Vec<Span> {
    // Few scripts have such a line at all: the others are not read a second time.
    let has_sign = |line: &str| line.trim_start().starts_with(['+', '-']);
    if !text.lines().any(has_sign) {
        return Vec::new();
    }
    let lexemes = lexemes(source, text, true).unwrap_or_default();
    let indentation = |at: usize| {
        let line = text[..at].rfind('\n').map_or(0, |end| end + 1);
        text[line..].len() - text[line..].trim_start_matches([' ', '\t']).len()
    };
    let (mut found, mut begin, mut is_over) = (Vec::new(), 0, true);
    for pair in lexemes.windows(2) {
        let [sign, operand] = pair else { continue };
        if is_over || sign.ends_line {
            begin = sign.start;
        }
        is_over = sign.kind == LexemeKind::Semicolon;
        let is_near = sign.end == operand.start;
        if sign.continues && is_near && indentation(sign.start) <= indentation(begin) {
            found.push(Span::new(source, sign.start, operand.end));
        }
    }
    found
}

/// Reads an expression.
///
/// ```
/// use gapilib_base::source::SourceId;
/// use gapilib_modelica::syntax;
///
/// let tree = syntax::parse_expression(SourceId::NONE, "-(a+b)*{1,2.0}[1]");
/// assert!(tree.is_err());
/// let tree = syntax::parse_expression(SourceId::NONE, "-(a+b)*({1,2.0})[1]")?;
/// assert_eq!(syntax::print::expression(&tree), "-(a + b) * ({1, 2.0})[1]");
/// # Ok::<(), gapilib_base::diag::Diagnostic>(())
/// ```
///
/// It is the whole text, such as the value of a command-line option.
pub fn parse_expression(source: SourceId, text: &str) -> Result<Expression, Diagnostic> {
    let rule = Rule::lone_expression;
    parser::parse(
        &TextOrigin::in_source(source),
        text,
        rule,
        Dialect::Fragment,
        lower::lone_expression,
    )
}

/// Reads a class name with an optional modification, `M(redeclare package P = Q, p = 2)`: the
/// problem of `simulateModel`.
pub fn parse_class_with_modification(
    source: SourceId,
    text: &str,
) -> Result<(Name, Vec<Argument>), Diagnostic> {
    let rule = Rule::class_with_modification;
    parser::parse(
        &TextOrigin::in_source(source),
        text,
        rule,
        Dialect::Fragment,
        lower::class_with_modification,
    )
}

#[cfg(test)]
mod tests;
