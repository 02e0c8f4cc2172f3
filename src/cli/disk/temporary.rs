//! The files in which something is written before it takes its name.

use std::ffi::{OsStr, OsString};
use std::fs::Metadata;
use std::hash::{BuildHasher, RandomState};
use std::time::Duration;

/// The end of their names.
const ENDING: &str = ".gapi-tmp";
/// Digits of the random number before it.
const DIGITS: usize = 16;
/// Characters of the name that they begin with, at most: file systems allow 255 bytes.
const LONGEST: usize = 50;
/// A younger one may be that of a process that has not locked it yet.
const YOUNG: Duration = Duration::from_secs(60);

/// A name beside this one that cannot be predicted.
pub(super) fn temporary_name(name: &OsStr) -> OsString {
    let begin: String = name.to_string_lossy().chars().take(LONGEST).collect();
    let number = RandomState::new().hash_one(std::process::id());
    format!("{begin}.{number:0DIGITS$x}{ENDING}").into()
}

/// Whether a name is one of these.
pub(super) fn is_temporary(name: &OsStr) -> bool {
    let name = name.to_string_lossy();
    let random = name.strip_suffix(ENDING).and_then(|name| name.rsplit_once('.'));
    random.is_some_and(|(_, random)| {
        random.len() == DIGITS && random.bytes().all(|byte| byte.is_ascii_hexdigit())
    })
}

/// Whether a file was not written for a while.
pub(super) fn is_old(found: &Metadata) -> bool {
    let age = found.modified().ok().and_then(|written| written.elapsed().ok());
    age.is_some_and(|age| age > YOUNG)
}
