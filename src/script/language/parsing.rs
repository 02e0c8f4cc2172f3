//! Scripts read without being run.

use crate::diag::Diagnostic;
use crate::source::SourceMap;
use crate::syntax::{self, ast::Script, errors::NOT_A_SCRIPT};

/// What a file turned out to be.
#[derive(Debug)]
pub enum Reading {
    /// A script.
    Script(Script),
    /// A table of numbers.
    Data,
    /// Neither: why it is no script.
    Rejected(Diagnostic),
}

/// The text of a file, UTF-8 or else Latin-1, and whether it is UTF-8.
pub fn text(bytes: &[u8]) -> (String, bool) {
    let (text, warning) = syntax::decode(bytes);
    (text, warning.is_none())
}

/// Reads a script from the bytes of a file, which is entered among the sources.
pub fn read(sources: &mut SourceMap, name: &str, bytes: &[u8]) -> Reading {
    let (text, _) = text(bytes);
    let source = sources.add(name, text.as_str());
    match syntax::parse_script(source, &text) {
        Ok(script) => Reading::Script(script),
        Err(error) if error.code == NOT_A_SCRIPT => Reading::Data,
        Err(error) => Reading::Rejected(error),
    }
}
