//! Which scripts are tested, and what is wrong where there is nothing to test.

use crate::parsing::ELSEWHERE;
use crate::script::language::parsing::{Reading, read};
use crate::script::language::workspace::matches;
use crate::source::SourceMap;
use crate::{disk, named};
use std::path::{Component, Path, PathBuf};

/// The ending of a transcript, after the name of its script.
const TRANSCRIPT: &str = ".snap";
/// The file by which the folder of the results of a run is known.
const ORIGIN: &str = "origin.json";

/// A script, or a place where one is missing.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Found {
    pub path: PathBuf,
    /// Why there is nothing to test.
    pub problem: Option<String>,
}

/// Where the transcript of a script is.
pub(super) fn transcript_of(script: &Path) -> PathBuf {
    let mut name = script.as_os_str().to_owned();
    name.push(TRANSCRIPT);
    PathBuf::from(name)
}

/// The scripts that are named, those that match a pattern, and those below folders, sorted by path.
pub(super) fn collected(paths: &[PathBuf]) -> Vec<Found> {
    let mut found = Vec::new();
    for path in paths {
        let missing =
            |problem: &str| Found { path: path.clone(), problem: Some(problem.to_owned()) };
        if path.is_dir() {
            let before = found.len();
            below(path, &mut found);
            if found.len() == before {
                found.push(missing("there is no script (.mos) in this folder"));
            }
        } else if path.exists() {
            found.push(Found { path: path.clone(), problem: None });
        } else if is_pattern(path) {
            let scripts = matching(path);
            if scripts.is_empty() {
                found.push(missing("no file matches this pattern"));
            }
            found.extend(scripts.into_iter().map(|path| Found { path, problem: None }));
        } else {
            found.push(missing("there is no such file or folder"));
        }
    }
    found.sort_by(|one, other| one.path.cmp(&other.path));
    found.dedup();
    found
}

/// Scripts below a folder, and transcripts whose scripts are gone. Files that runs have written are
/// not tests, nor are tables of numbers, which have the ending of scripts.
fn below(folder: &Path, found: &mut Vec<Found>) {
    let Ok(names) = disk::list_named(folder) else { return };
    if names.iter().any(|name| name == ORIGIN) {
        return;
    }
    for name in names {
        let path = folder.join(&name);
        if path.is_dir() {
            if !path.is_symlink() {
                below(&path, found);
            }
        } else if name.ends_with(".mos") && !disk::is_file_in(folder, &path) {
            found.push(Found { path, problem: Some(ELSEWHERE.to_owned()) });
        } else if name.ends_with(".mos") && !is_table(&path) {
            found.push(Found { path, problem: None });
        } else if let Some(script) = name.strip_suffix(TRANSCRIPT)
            && script.ends_with(".mos")
            && !folder.join(script).exists()
        {
            let problem = format!("a transcript without its script `{script}`: remove it");
            found.push(Found { path, problem: Some(problem) });
        }
    }
}

fn is_table(path: &Path) -> bool {
    let Ok(bytes) = named::read(path) else { return false };
    matches!(read(&mut SourceMap::default(), "", &bytes), Reading::Data)
}

fn is_pattern(path: &Path) -> bool {
    path.to_string_lossy().contains(['*', '?'])
}

/// The files that match a pattern, for shells that leave patterns to the program.
fn matching(pattern: &Path) -> Vec<PathBuf> {
    let mut found = vec![PathBuf::new()];
    for component in pattern.components() {
        let part = component.as_os_str().to_string_lossy().into_owned();
        found =
            found.into_iter().flat_map(|folder| matching_in(&folder, component, &part)).collect();
    }
    found.retain(|path| path.is_file());
    found
}

fn matching_in(folder: &Path, component: Component<'_>, part: &str) -> Vec<PathBuf> {
    if !part.contains(['*', '?']) {
        return vec![folder.join(component)];
    }
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let names = disk::list_named(here).unwrap_or_default();
    let matching = names.iter().filter(|name| matches(part.as_bytes(), name.as_bytes()));
    matching.map(|name| folder.join(name)).collect()
}
