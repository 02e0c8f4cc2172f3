//! Faults of files that cannot be used, and what to do about them.

use super::policy::{Access, Refusal, refusal_of};
use crate::diag::Fault;
use crate::errors::{FILE_ERROR, REFUSED};
use std::io;
use std::path::Path;

/// The fault of a file that the system does not let us use.
pub fn cannot(verb: &str, path: &Path, error: &io::Error) -> Fault {
    if let Some(refusal) = refusal_of(error) {
        return refused(refusal, path);
    }
    let reason = match error.kind() {
        io::ErrorKind::NotFound => "it does not exist".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        io::ErrorKind::IsADirectory => "it is a directory".to_owned(),
        io::ErrorKind::NotADirectory => "a part of its path is not a directory".to_owned(),
        _ => begun_small(&error.to_string()),
    };
    let fault = Fault::new(FILE_ERROR, format!("cannot {verb} `{}`: {reason}", shown(path)));
    fault.help_if(escape_help(path))
}

/// Words with a small first letter: sizes in them keep their units.
fn begun_small(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().map(|first| first.to_lowercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

/// A path as people read it: control characters as escapes.
pub fn shown(path: &Path) -> String {
    let text = path.display().to_string();
    let escaped = |c: char| escape_of(c).map_or_else(|| c.to_string(), |(escape, _)| escape.into());
    text.chars().map(escaped).collect()
}

/// What to do about a path that has a control character, as `"..\bin"` has in Modelica.
pub(crate) fn escape_help(path: &Path) -> Option<String> {
    let text = path.to_string_lossy();
    let (escape, name) = text.chars().find_map(escape_of)?;
    Some(format!("`{escape}` in a string is {name}: write `/` or `\\\\` between folders"))
}

/// The escape of MLS §2.4.6 that stands for a control character, and the character's name.
fn escape_of(c: char) -> Option<(&'static str, &'static str)> {
    Some(match c {
        '\u{07}' => ("\\a", "a bell"),
        '\u{08}' => ("\\b", "a backspace"),
        '\t' => ("\\t", "a tab"),
        '\n' => ("\\n", "a line break"),
        '\u{0b}' => ("\\v", "a vertical tab"),
        '\u{0c}' => ("\\f", "a form feed"),
        '\r' => ("\\r", "a carriage return"),
        _ => return None,
    })
}

/// The fault of a file that the policy does not let us use.
fn refused(refusal: Refusal, path: &Path) -> Fault {
    let verb = if refusal.is_of() == Access::Read { "read" } else { "changed" };
    let is_closed = matches!(refusal, Refusal::System | Refusal::Denied);
    let verb = if is_closed { "opened" } else { verb };
    let message = format!("`{}` cannot be {verb}: {}", path.display(), refusal.reason());
    Fault::new(REFUSED, message).help_if(refusal.help().map(str::to_owned))
}

/// A path without `file://` and Windows' separators.
pub fn plain(path: &str) -> String {
    path.strip_prefix("file://").unwrap_or(path).replace('\\', "/")
}
