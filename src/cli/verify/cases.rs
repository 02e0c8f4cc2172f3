//! The cases of a reference collection, in one of two layouts:
//!
//! - that of the Modelica Association: one folder a model, which holds `comparisonSignals.txt`,
//!   `creation.txt`, or a `.csv` file with the folder's name; the path of the folder below the
//!   collection is the name of the model;
//! - that of BuildingsPy: one file `Library_Examples_Model.txt` a model.

use crate::disk::{list_named, read_named};
use crate::name::{Ident, Name};
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

/// The names of the classes in a class; those at the top level in that without a name.
pub(super) type Classes<'a> = &'a dyn Fn(&Name) -> Vec<Ident>;

impl Case {
    /// Whether the reference has samples of the trajectories, as BuildingsPy writes them.
    pub(super) fn is_sampled(&self) -> bool {
        self.reference.as_ref().is_some_and(|path| path.extension().is_some_and(|e| e == "txt"))
    }
}

/// All cases below a folder whose models' names contain a text, by name. The classes are those
/// that files with underscores may be named after.
pub(super) fn find(root: &Path, filter: Option<&str>, classes: Classes) -> io::Result<Vec<Case>> {
    let mut folders = Folders::default();
    folders.collect(root)?;
    let mut cases = folders.cases;
    for name in list_named(root)? {
        let Some(flat) = name.strip_suffix(".txt") else { continue };
        let path = root.join(&name);
        if let Some(class) = class_of(classes, flat)
            && holds_samples(&path)?
        {
            let (model, reference) = (class.to_string(), Some(path));
            cases.push(Case { model, reference, signals: None });
        }
    }
    cases.retain(|case: &Case| filter.is_none_or(|filter| case.model.contains(filter)));
    cases.sort_by(|a, b| a.model.cmp(&b.model));
    Ok(cases)
}

/// Whether a file of BuildingsPy has trajectories; that of a model which is only exported has none.
fn holds_samples(path: &Path) -> io::Result<bool> {
    let text = read_named(path)?;
    Ok(text.split(|byte| *byte == b'\n').any(|line| line.starts_with(b"time=[")))
}

/// The class whose name has underscores for points.
fn class_of(classes: Classes, flat: &str) -> Option<Name> {
    let roots = classes(&Name::new([])).into_iter();
    let mut open: Vec<(Name, &str)> = roots.map(|root| (Name::from(root), flat)).collect();
    while let Some((name, rest)) = open.pop() {
        let Some(rest) = name.last().and_then(|last| rest.strip_prefix(last.as_str())) else {
            continue;
        };
        if rest.is_empty() {
            return Some(name);
        }
        if let Some(rest) = rest.strip_prefix('_') {
            open.extend(classes(&name).into_iter().map(|child| (name.child(child), rest)));
        }
    }
    None
}

/// The cases in folders below a collection.
#[derive(Default)]
struct Folders {
    cases: Vec<Case>,
    /// The names of the folders from the collection to the one at hand.
    parts: Vec<String>,
    /// Where links on this way lead: a link back is not followed.
    above: Vec<PathBuf>,
}

impl Folders {
    fn collect(&mut self, folder: &Path) -> io::Result<()> {
        self.cases.extend(case(folder, &self.parts));
        let real = folder.canonicalize()?;
        if self.parts.len() == MAX_DEPTH || self.above.contains(&real) {
            return Ok(());
        }
        self.above.push(real);
        for name in list_named(folder)? {
            let path = folder.join(&name);
            if path.is_dir() && !name.starts_with('.') {
                self.parts.push(name);
                self.collect(&path)?;
                self.parts.pop();
            }
        }
        self.above.pop();
        Ok(())
    }
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
    fn files_with_trajectories_are_models() {
        let root = tempfile::tempdir().unwrap();
        let classes = |name: &Name| {
            let inside: &[&str] = match name.to_string().as_str() {
                "" => &["A"],
                "A" => &["B", "B_C"],
                "A.B_C" => &["D", "E"],
                _ => &[],
            };
            inside.iter().map(|name| Ident::new(name)).collect()
        };
        let write = |name: &str, text: &str| fs::write(root.path().join(name), text).unwrap();
        write("A_B_C_D.txt", "x=[1, 2]\ntime=[0, 1]\n");
        write("A_B_C_E.txt", "statistics-fmu-dependencies=\n{\n}\n");
        write("A_B_C_F.txt", "time=[0, 1]\n");
        let found = find(root.path(), None, &classes).unwrap();
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].model, "A.B_C.D");
        assert!(found[0].is_sampled());
    }

    #[cfg(unix)]
    #[test]
    fn links_to_folders_are_followed_but_not_back() {
        let root = tempfile::tempdir().unwrap();
        let (elsewhere, links) = (root.path().join("elsewhere/Decay"), root.path().join("links"));
        fs::create_dir_all(&elsewhere).unwrap();
        fs::create_dir_all(&links).unwrap();
        fs::write(elsewhere.join("Decay.csv"), "time,x\n0,1\n").unwrap();
        let link = std::os::unix::fs::symlink::<&Path, PathBuf>;
        link(&elsewhere, links.join("Decay")).unwrap();
        link(&links, links.join("Back")).unwrap();
        let found = find(&links, None, &|_: &Name| Vec::new()).unwrap();
        let models: Vec<&str> = found.iter().map(|case| &*case.model).collect();
        assert_eq!(models, ["Decay"]);
    }

    #[test]
    fn folders_are_models() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("Lib/Examples/Decay");
        fs::create_dir_all(folder.join(".git/Hidden")).unwrap();
        fs::create_dir_all(root.path().join("Lib/Examples/Growth")).unwrap();
        fs::write(folder.join("Decay.csv"), "time,x\n0,1\n").unwrap();
        fs::write(folder.join(".git/Hidden/Hidden.csv"), "").unwrap();
        fs::write(root.path().join("Lib/Examples/Growth/comparisonSignals.txt"), "x\n").unwrap();
        let none = |_: &Name| Vec::new();
        let found = find(root.path(), None, &none).unwrap();
        let models: Vec<&str> = found.iter().map(|case| &*case.model).collect();
        assert_eq!(models, ["Lib.Examples.Decay", "Lib.Examples.Growth"]);
        assert_eq!(found[0].reference, Some(folder.join("Decay.csv")));
        assert_eq!((&found[0].signals, &found[1].reference), (&None, &None));
        assert_eq!(find(root.path(), Some("Grow"), &none).unwrap(), found[1..]);
        assert!(find(&root.path().join("nowhere"), None, &none).is_err());
    }
}
