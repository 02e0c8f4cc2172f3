//! `gapi run --parse-only`: which scripts can be read.

use crate::script::access::faults::cannot;
use crate::script::language::parsing;
use crate::script::language::parsing::Reading;
use crate::source::SourceMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::{disk, terminal};

/// What is said of an entry that is not read.
pub(super) const ELSEWHERE: &str = "is not a file of this folder: name it to read it all the same";

/// Reads all scripts in these files and folders; exit code 1 if one is rejected.
pub(super) fn parse_only(paths: &[PathBuf]) -> ExitCode {
    let (mut accepted, mut rejected, mut data) = (0, 0, 0);
    for path in scripts(paths) {
        let bytes = match super::named::read(&path) {
            Ok(bytes) => bytes,
            Err(error) => {
                rejected += 1;
                let message = cannot("read", &path, &error).message;
                terminal::eprint(&format!("error: {message}\n"));
                continue;
            }
        };
        let mut sources = SourceMap::default();
        match parsing::read(&mut sources, &path.to_string_lossy(), &bytes) {
            Reading::Script(_) => accepted += 1,
            Reading::Data => data += 1,
            Reading::Rejected(error) => {
                rejected += 1;
                terminal::eprint(&terminal::rendered(&error, &sources));
            }
        }
    }
    terminal::print(&format!(
        "{accepted} accepted, {rejected} rejected, {data} recognized as data\n"
    ));
    if rejected > 0 { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

/// The scripts among these files and below these folders, sorted; a file that is named is one.
pub(super) fn scripts(paths: &[PathBuf]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for path in paths {
        match path.is_dir() {
            true => collect(path, &mut found),
            false => found.push(path.clone()),
        }
    }
    found.sort();
    found.dedup();
    found
}

fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
    let Ok(names) = disk::list_named(folder) else { return };
    for path in names.iter().map(|name| folder.join(name)) {
        let is_script = path.extension().is_some_and(|extension| extension == "mos");
        if path.is_dir() && !path.is_symlink() {
            collect(&path, found);
        } else if is_script && disk::is_file_in(folder, &path) {
            found.push(path);
        } else if is_script {
            terminal::eprint(&format!("warning: `{}` {ELSEWHERE}\n", path.display()));
        }
    }
}
