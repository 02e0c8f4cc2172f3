//! Rerunning others' collections of models: folders of Modelica files that are not part of the
//! project, each named by an environment variable.
//!
//! `GAPILIB_FILTER=text` takes only the cases whose names contain the text and prints what is wrong
//! with each; `GAPILIB_BUDGET=seconds` changes the time a case may take; `GAPILIB_UPDATE_LEDGER=1`
//! writes the ledger anew.

mod corpus;
mod ledger;
mod pool;
mod reference;
mod verdict;

pub(crate) use corpus::{Corpus, File};
pub(crate) use ledger::Ledger;
pub(crate) use pool::{Ended, judge_all};
pub(crate) use reference::Reference;
pub(crate) use verdict::{Failure, Progress, Stage, run};

use std::path::PathBuf;

/// The folder that an environment variable names; `None`, said aloud, without it.
pub(crate) fn folder(variable: &str) -> Option<PathBuf> {
    let found = std::env::var_os(variable).map(PathBuf::from);
    if found.is_none() {
        say(&format!("skipped: `{variable}` does not name a folder"));
    }
    found
}

/// Whether a case is asked for, by `GAPILIB_FILTER`.
pub(crate) fn is_asked_for(name: &str) -> bool {
    filter().is_none_or(|filter| name.contains(&filter))
}

/// The text that the names of all cases wanted contain.
pub(crate) fn filter() -> Option<String> {
    std::env::var("GAPILIB_FILTER").ok().filter(|filter| !filter.is_empty())
}

/// Writes a line that `--nocapture` shows.
#[allow(clippy::print_stdout)]
pub(crate) fn say(line: &str) {
    println!("{line}");
}
