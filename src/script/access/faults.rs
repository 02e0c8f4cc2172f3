//! Faults of files that cannot be used, and what to do about them.

use super::policy::{Access, Refusal, refusal_of};
use crate::diag::Fault;
use crate::script::errors::{FILE_ERROR, REFUSED};
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
        _ => error.to_string().to_lowercase(),
    };
    Fault::new(FILE_ERROR, format!("cannot {verb} `{}`: {reason}", path.display()))
}

/// The fault of a file that the policy does not let us use.
fn refused(refusal: Refusal, path: &Path) -> Fault {
    let verb = if refusal.is_of() == Access::Read { "read" } else { "changed" };
    let verb = if refusal == Refusal::System { "opened" } else { verb };
    let message = format!("`{}` cannot be {verb}: {}", path.display(), refusal.reason());
    Fault::new(REFUSED, message).help_if(refusal.help().map(str::to_owned))
}

/// A path without `file://` and Windows' separators.
pub fn plain(path: &str) -> String {
    path.strip_prefix("file://").unwrap_or(path).replace('\\', "/")
}
