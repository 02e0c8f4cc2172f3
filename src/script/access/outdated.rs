//! Files that are older than a script believes.

use std::collections::BTreeMap;
use std::path::PathBuf;

/// Files that commands of this run were to write and did not, with the reason.
#[derive(Debug, Default)]
pub struct Outdated(pub(super) BTreeMap<PathBuf, String>);
