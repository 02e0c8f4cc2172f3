//! The cases of a reference collection, in one of two layouts:
//!
//! - that of the Modelica Association: one folder a model, which holds `comparisonSignals.txt`,
//!   `creation.txt`, or a `.csv` file with the folder's name; the path of the folder below the
//!   collection is the name of the model;
//! - that of BuildingsPy: one file `Library_Examples_Model.txt` a model.

use crate::cli::disk::list_named;
use crate::flatten::Library;
use crate::name::Name;
use std::io;
use std::path::{Path, PathBuf};

/// Folders deeper than this are not looked at.
const MAX_DEPTH: usize = 20;

/// A model and its reference.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Case {
    /// The class.
    pub model: String,
    /// The reference results, if the collection holds them.
    pub reference: Option<PathBuf>,
    /// The list of the signals to compare.
    pub signals: Option<PathBuf>,
}

impl Case {
    /// Whether the reference has samples of the trajectories, as BuildingsPy writes them.
    pub(super) fn is_sampled(&self) -> bool {
        self.reference.as_ref().is_some_and(|path| path.extension().is_some_and(|e| e == "txt"))
    }
}

/// All cases below a folder whose models' names contain a text, by name. The library has the models
/// that files with underscores are named after.
pub(super) fn find(root: &Path, filter: Option<&str>, library: &Library) -> io::Result<Vec<Case>> {
    let mut cases = Vec::new();
    collect(root, &mut Vec::new(), &mut cases)?;
    for name in list_named(root)? {
        let Some(flat) = name.strip_suffix(".txt") else { continue };
        if let Some(class) = class_of(library, flat) {
            let (model, reference) = (class.to_string(), Some(root.join(&name)));
            cases.push(Case { model, reference, signals: None });
        }
    }
    cases.retain(|case: &Case| filter.is_none_or(|filter| case.model.contains(filter)));
    cases.sort_by(|a, b| a.model.cmp(&b.model));
    Ok(cases)
}

/// The class whose name has underscores for points.
fn class_of(library: &Library, flat: &str) -> Option<Name> {
    let mut open: Vec<(Name, &str)> =
        library.roots().map(|root| (Name::from(root), flat)).collect();
    while let Some((name, rest)) = open.pop() {
        let Some(rest) = name.last().and_then(|last| rest.strip_prefix(last.as_str())) else {
            continue;
        };
        if rest.is_empty() {
            return Some(name);
        }
        if let Some(rest) = rest.strip_prefix('_') {
            open.extend(library.children(&name).into_iter().map(|child| (name.child(child), rest)));
        }
    }
    None
}

fn collect(folder: &Path, parts: &mut Vec<String>, cases: &mut Vec<Case>) -> io::Result<()> {
    cases.extend(case(folder, parts));
    if parts.len() == MAX_DEPTH {
        return Ok(());
    }
    for name in list_named(folder)? {
        let path = folder.join(&name);
        if path.is_dir() && !path.is_symlink() && !name.starts_with('.') {
            parts.push(name);
            collect(&path, parts, cases)?;
            parts.pop();
        }
    }
    Ok(())
}

fn case(folder: &Path, parts: &[String]) -> Option<Case> {
    let existing = |name: &str| Some(folder.join(name)).filter(|path| path.is_file());
    let reference = existing(&format!("{}.csv", parts.last()?));
    let signals = existing("comparisonSignals.txt");
    let is_case = reference.is_some() || signals.is_some() || existing("creation.txt").is_some();
    is_case.then(|| Case { model: parts.join("."), reference, signals })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn folders_are_models() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("Lib/Examples/Decay");
        fs::create_dir_all(folder.join(".git/Hidden")).unwrap();
        fs::create_dir_all(root.path().join("Lib/Examples/Growth")).unwrap();
        fs::write(folder.join("Decay.csv"), "time,x\n0,1\n").unwrap();
        fs::write(folder.join(".git/Hidden/Hidden.csv"), "").unwrap();
        fs::write(root.path().join("Lib/Examples/Growth/comparisonSignals.txt"), "x\n").unwrap();
        let library = Library::new();
        let found = find(root.path(), None, &library).unwrap();
        let models: Vec<&str> = found.iter().map(|case| &*case.model).collect();
        assert_eq!(models, ["Lib.Examples.Decay", "Lib.Examples.Growth"]);
        assert_eq!(found[0].reference, Some(folder.join("Decay.csv")));
        assert_eq!((&found[0].signals, &found[1].reference), (&None, &None));
        assert_eq!(find(root.path(), Some("Grow"), &library).unwrap(), found[1..]);
        assert!(find(&root.path().join("nowhere"), None, &library).is_err());
    }
}
