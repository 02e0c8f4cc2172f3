//! What a translation depends on beside the files that it reads.

use super::reads::digest;
use crate::Session;
use std::fmt::Write;

/// The name under which a model is kept.
pub(super) fn name(session: &Session, problem: &str) -> String {
    let mut text = format!("{problem}\n{:?}\n", session.classes.history.digest());
    let _ = writeln!(text, "{:?}", session.world.current_dir());
    let _ = writeln!(text, "{:?}", session.world.folders().collect::<Vec<_>>());
    let _ = writeln!(text, "{:?}", session.classes.directories());
    let _ = writeln!(text, "{:?}", session.classes.named_packages());
    let _ = writeln!(text, "{:?}", session.classes.versions);
    let _ = writeln!(text, "{}", session.classes.library.is_strict());
    digest(text.as_bytes()).iter().fold(String::new(), |mut name, byte| {
        let _ = write!(name, "{byte:02x}");
        name
    })
}
