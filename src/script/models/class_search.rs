//! Where top-level classes are searched for by their names.

use super::classes::Classes;
use super::versions::numbers;
use crate::access::SessionWorld;
use crate::access::policy::{Access, Refusal, refusal_of};
use crate::diag::Fault;
use crate::errors::FILE_ERROR;
use crate::fault;
use crate::name::Ident;
use crate::packages;
use crate::syntax::{self, Outline};
use crate::world::normalized;
use std::path::{Path, PathBuf};

/// A search for classes in files; none of them is loaded.
pub(super) struct ClassSearch<'s> {
    /// The files.
    pub world: &'s SessionWorld,
    /// The folders and versions that were asked for.
    pub classes: &'s Classes,
}

impl ClassSearch<'_> {
    /// Where the top-level class of this name is: in the library folders, the working directory,
    /// a folder `models` beside the scripts being run or above them, or in the program. A package
    /// whose own folder was named comes first, then a folder of the version that was asked for, and
    /// one with the name in other case last.
    pub(super) fn find(&self, name: Ident) -> Option<PathBuf> {
        if let Some(named) = self.classes.named_packages().get(&name) {
            return Some(named.clone());
        }
        let folders = self.folders();
        let exact = self.classes.versions.get(&name).and_then(|version| {
            let required = format!("{name} {version}");
            folders.iter().find_map(|folder| self.version_in(folder, &required))
        });
        let name = name.as_str();
        exact
            .or_else(|| folders.iter().find_map(|folder| self.class_in(folder, name)))
            .or_else(|| folders.iter().find_map(|folder| self.in_other_case(folder, name)))
    }

    /// Whether there is a folder of this version of a library.
    pub(super) fn has_version(&self, library: Ident, version: &str) -> bool {
        let named = format!("{library} {version}");
        self.folders().iter().any(|folder| self.version_in(folder, &named).is_some())
    }

    /// Warnings about folders `models` in which a class would be found and is not looked for.
    pub(super) fn passed_over(&self, name: Ident) -> Vec<Fault> {
        let why = |folder: &Path| {
            let refused = self.world.permits(folder, Access::Read).err()?;
            let refusal = refusal_of(&refused)?;
            matches!(refusal, Refusal::Link | Refusal::Owner).then_some(refusal)
        };
        let warning = |folder: &PathBuf| {
            let refusal = why(folder).filter(|_| self.class_in(folder, name.as_str()).is_some())?;
            Some(fault!(FILE_ERROR, "`{name}` is not taken from `{}`: {refusal}", folder.display();
                help: "if you trust this library, give its folder with `--library`"))
        };
        self.models_folders().iter().filter_map(warning).collect()
    }

    fn folders(&self) -> Vec<PathBuf> {
        let may_read = |folder: &PathBuf| self.world.permits(folder, Access::Read).is_ok();
        let own = self.classes.directories().iter().cloned().chain([self.world.current_dir()]);
        let models = self.models_folders().into_iter().filter(may_read);
        let all = own.chain(models).chain([PathBuf::from(packages::FOLDER)]);
        all.map(|folder| normalized(&folder)).collect()
    }

    /// The folders `models` beside the scripts being run and the working directory, or above them.
    fn models_folders(&self) -> Vec<PathBuf> {
        let current = self.world.current_dir();
        let frames = self.world.folders().flat_map(Path::ancestors);
        frames.chain(current.ancestors()).map(|folder| folder.join("models")).collect()
    }

    /// The folder `Name 1.2.3`, also with more after it: `Name 1.2.3+build.4`.
    fn version_in(&self, folder: &Path, required: &str) -> Option<PathBuf> {
        let entries = self.world.list_dir(folder).ok()?;
        let fits = |entry: &&String| {
            entry
                .strip_prefix(required)
                .is_some_and(|rest| !rest.starts_with(char::is_alphanumeric))
        };
        let found = entries.iter().find(fits)?;
        Some(folder.join(found))
    }

    fn class_in(&self, folder: &Path, name: &str) -> Option<PathBuf> {
        let package = folder.join(name);
        if self.world.exists(&package.join("package.mo")) {
            return Some(package);
        }
        let file = folder.join(format!("{name}.mo"));
        if self.world.exists(&file) {
            return Some(file);
        }
        let prefix = format!("{name} ");
        let entries = self.world.list_dir(folder).ok()?;
        let versions = entries.iter().filter(|entry| entry.starts_with(&prefix));
        let newest = versions.max_by_key(|entry| numbers(&entry[prefix.len()..]))?;
        Some(folder.join(newest))
    }

    fn in_other_case(&self, folder: &Path, name: &str) -> Option<PathBuf> {
        let entries = self.world.list_dir(folder).ok()?;
        let mut same = entries.iter().filter(|entry| entry.eq_ignore_ascii_case(name));
        let found = same.find(|entry| self.world.exists(&folder.join(entry).join("package.mo")));
        found.map(|entry| folder.join(entry))
    }
}

/// The name of the package that a folder holds.
pub(super) fn package_in(world: &SessionWorld, folder: &Path) -> Option<Ident> {
    let bytes = world.bytes_of(&folder.join("package.mo")).ok()?;
    let (text, _) = syntax::decode(&bytes);
    let package = Outline::of(&text)?.classes.into_iter().next()?;
    Some(Ident::new(&text[package.name]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::MemoryWorld;

    #[test]
    fn the_newest_version_is_found_unless_another_one_was_asked_for() {
        let world = MemoryWorld::new()
            .with_file("libraries/Pumps 1.2/package.mo", "package Pumps end Pumps;")
            .with_file("libraries/Pumps 1.10/package.mo", "package Pumps end Pumps;");
        let world = SessionWorld::new(Box::new(world));
        let mut classes = Classes::default();
        let folder = world.absolute(Path::new("libraries"));
        classes.add_directory(folder.clone());
        let pumps = Ident::new("Pumps");
        let find = |classes: &Classes| ClassSearch { world: &world, classes }.find(pumps);
        assert_eq!(find(&classes), Some(folder.join("Pumps 1.10")));
        assert_eq!(package_in(&world, &folder.join("Pumps 1.10")), Some(pumps));
        classes.versions.insert(pumps, "1.2".to_owned());
        assert_eq!(find(&classes), Some(folder.join("Pumps 1.2")));
        assert!(!ClassSearch { world: &world, classes: &classes }.has_version(pumps, "1.3"));
    }
}
