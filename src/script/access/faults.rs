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
        io::ErrorKind::NotFound if verb == "write" => {
            "its folder does not exist; make it first".to_owned()
        }
        io::ErrorKind::NotFound => "it does not exist".to_owned(),
        io::ErrorKind::PermissionDenied => "permission denied".to_owned(),
        io::ErrorKind::IsADirectory => "it is a directory".to_owned(),
        io::ErrorKind::NotADirectory => "a part of its path is not a directory".to_owned(),
        _ => begun_small(&error.to_string()),
    };
    let fault = Fault::new(FILE_ERROR, format!("cannot {verb} `{}`: {reason}", shown(path)));
    fault.help_if(escape_help(path)).help_if(drive_help(path))
}

/// What a path with a letter of a drive means on other systems.
pub(crate) fn drive_help(path: &Path) -> Option<String> {
    let text = path.to_string_lossy();
    let mut letters = text.chars();
    let is_drive = letters.next().is_some_and(|letter| letter.is_ascii_alphabetic())
        && letters.next() == Some(':')
        && letters.next().is_some_and(|sign| sign == '/' || sign == '\\');
    (is_drive && !cfg!(windows)).then(|| {
        format!(
            "this system has no drive `{}`; give the path as it is here, or one relative to the \
             working directory",
            &text[..2]
        )
    })
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
    Fault::new(REFUSED, message).help_if(refusal.help(path))
}

/// A path without `file://` and Windows' separators.
pub fn plain(path: &str) -> String {
    path.strip_prefix("file://").unwrap_or(path).replace('\\', "/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_are_said_in_the_words_of_files() {
        for (kind, reason) in [
            (io::ErrorKind::NotFound, "it does not exist"),
            (io::ErrorKind::PermissionDenied, "permission denied"),
            (io::ErrorKind::IsADirectory, "it is a directory"),
            (io::ErrorKind::NotADirectory, "a part of its path is not a directory"),
        ] {
            let fault = cannot("read", Path::new("d/x"), &kind.into());
            assert_eq!(fault.message, format!("cannot read `d/x`: {reason}"));
        }
        let other = io::Error::other("No space left");
        let fault = cannot("write", Path::new("x"), &other);
        assert_eq!(fault.message, "cannot write `x`: no space left");
        let fault = cannot("write", Path::new("x"), &Refusal::Reserved.into());
        assert_eq!(fault.message, "`x` cannot be changed: the program keeps its own records in it");
    }

    /// As `"C:\bin"` becomes in Modelica.
    #[test]
    fn control_characters_of_paths_are_shown_as_they_were_written() {
        for (letter, character) in
            [("a", 7), ("b", 8), ("t", 9), ("n", 10), ("v", 11), ("f", 12), ("r", 13u8)]
        {
            let path = format!("C:{}x", char::from(character));
            assert_eq!(shown(Path::new(&path)), format!("C:\\{letter}x"));
            let help = escape_help(Path::new(&path)).expect("what to do");
            assert!(help.starts_with(&format!("`\\{letter}` in a string is a")), "{help}");
        }
        assert_eq!(escape_help(Path::new("C:/bin")), None);
    }
}
