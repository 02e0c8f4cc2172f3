//! The layout of Modelica classes and scripts: indentation, blanks, blank lines and line breaks. No
//! token, string or comment is changed, added or moved.
//!
//! The text is worked on, not its tree: `structure` finds the lexemes that begin a line, and how
//! deep they are; `spacing` says how many blanks are between two lexemes of a line; `layout` puts
//! the lines together; `breaking` divides those that are too long. Breaks that the author made
//! inside a declaration, an equation or a statement are kept with their relative indentation, so that
//! a text in the usual style hardly changes. Afterwards the lexemes before and after are compared.

mod breaking;
pub mod diff;
mod layout;
mod spacing;
mod structure;

use crate::diag::Diagnostic;
use crate::source::SourceId;
use crate::syntax::{self, Lexeme};
use layout::Layout;

/// Columns of a line above which argument lists are broken.
pub const WIDTH: usize = 120;

/// Columns of a level of indentation.
const INDENT: usize = 2;

/// What a text is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    /// A `.mo` file: classes.
    Modelica,
    /// A `.mos` file: statements, closed by `;` or line ends.
    Script,
}

/// Why a text has no formatted version.
#[derive(Debug, Clone, PartialEq)]
pub enum Failure {
    /// It cannot be read.
    Syntax(Diagnostic),
    /// Its lexemes would change: a fault of this program.
    Changed,
}

impl Language {
    /// The language of a file, by the ending of its name.
    pub fn of_name(name: &str) -> Option<Language> {
        match name.rsplit_once('.')?.1 {
            "mo" => Some(Language::Modelica),
            "mos" => Some(Language::Script),
            _ => None,
        }
    }

    fn is_script(self) -> bool {
        self == Language::Script
    }
}

/// A text with its lexemes.
struct Lexed<'t> {
    text: &'t str,
    lexemes: Vec<Lexeme>,
}

impl Lexed<'_> {
    fn str(&self, at: usize) -> &str {
        &self.text[self.lexemes[at].range()]
    }

    /// The nearest token before a lexeme, comments aside.
    fn token_before(&self, at: usize) -> Option<usize> {
        (0..at).rev().find(|at| !self.lexemes[*at].is_comment())
    }

    /// Line ends between a lexeme and the one before it.
    fn line_ends_before(&self, at: usize) -> usize {
        let start = if at == 0 { 0 } else { self.lexemes[at - 1].end };
        self.text[start..self.lexemes[at].start].matches('\n').count()
    }
}

/// The text in the usual layout.
///
/// ```
/// use gapilib_modelica::format::{Language, format};
/// use gapilib_base::source::SourceId;
///
/// let text = "model M Real x ( start=1 ) ; equation der (x)=-x; // decay\nend M;";
/// assert_eq!(
///     format(SourceId::NONE, text, Language::Modelica).unwrap(),
///     "model M\n  Real x(start=1);\nequation\n  der(x) = -x; // decay\nend M;\n"
/// );
/// ```
///
/// # Errors
/// A text that cannot be read.
pub fn format(source: SourceId, text: &str, language: Language) -> Result<String, Failure> {
    let read = match language {
        Language::Modelica => syntax::parse_stored_definition(source, text).map(drop),
        Language::Script => syntax::parse_script(source, text).map(drop),
    };
    read.map_err(Failure::Syntax)?;
    let lexemes = |text| syntax::lexemes(source, text, language.is_script());
    let before = Lexed { text, lexemes: lexemes(text).map_err(Failure::Syntax)? };
    let line_end =
        if text.matches("\r\n").count() * 2 > text.matches('\n').count() { "\r\n" } else { "\n" };
    let formatted = laid_out(&before, language, line_end);
    let after =
        Lexed { text: &formatted, lexemes: lexemes(&formatted).map_err(|_| Failure::Changed)? };
    if same_lexemes(&before, &after) { Ok(formatted) } else { Err(Failure::Changed) }
}

/// The text with its lines indented and its blanks in order.
fn laid_out(lexed: &Lexed<'_>, language: Language, line_end: &str) -> String {
    let layout = Layout::of(lexed, language);
    let mut text = String::with_capacity(lexed.text.len());
    for line in breaking::broken(&layout, layout.lines()) {
        if line.blank {
            text.push_str(line_end);
        }
        text.extend(std::iter::repeat_n(' ', line.indent));
        for at in line.lexemes.clone() {
            if at > line.lexemes.start {
                text.extend(std::iter::repeat_n(' ', layout.blanks[at]));
            }
            text.push_str(lexed.str(at));
        }
        text.push_str(line_end);
    }
    text
}

/// Whether two sources consist of the same tokens and comments, and statements end at the same
/// ones.
fn same_lexemes(one: &Lexed<'_>, other: &Lexed<'_>) -> bool {
    let same = |at: usize| {
        let (left, right) = (&one.lexemes[at], &other.lexemes[at]);
        left.kind == right.kind
            && left.ends_line == right.ends_line
            && left.in_expression == right.in_expression
            && one.str(at) == other.str(at)
    };
    one.lexemes.len() == other.lexemes.len() && (0..one.lexemes.len()).all(same)
}

#[cfg(test)]
mod tests;
