//! Where a script is searched for by the name that another one or the user gives.

use crate::access::SessionWorld;
use crate::access::faults::{escape_help, shown};
use crate::access::policy::Access;
use crate::diag::{Fault, suggest};
use crate::errors::SCRIPT_NOT_FOUND;
use crate::world::normalized;
use std::path::{Path, PathBuf};

/// A search for one script: in a folder, that of the calling script, then in the working directory.
pub(super) struct ScriptSearch<'s> {
    world: &'s SessionWorld,
    folder: &'s Path,
    /// The name as it was given.
    written: &'s str,
    /// The path that it means.
    name: PathBuf,
}

impl<'s> ScriptSearch<'s> {
    pub(super) fn new(
        world: &'s SessionWorld,
        folder: &'s Path,
        written: &'s str,
    ) -> ScriptSearch<'s> {
        let name = world.expanded(Path::new(written));
        ScriptSearch { world, folder, written, name }
    }

    /// The script of exactly this name, with or without the ending.
    pub(super) fn exact(&self) -> Option<PathBuf> {
        let is_file = |path: &PathBuf| self.world.sees(path) && !self.world.is_dir(path);
        self.candidates().into_iter().find(is_file)
    }

    /// The script of this name, letter case not counted in any part of its path.
    pub(super) fn in_other_case(&self) -> Option<PathBuf> {
        self.candidates().iter().find_map(|path| self.other_case(path))
    }

    /// The fault of a script that is nowhere.
    pub(super) fn missing(&self) -> Fault {
        // Whether there is a file that may not be read stays unknown.
        let mut places = self.candidates().into_iter();
        if let Some(refused) = places.find_map(|place| self.world.may(Access::Read, &place).err()) {
            return refused;
        }
        let folders = [self.world.absolute(self.folder), self.world.current_dir()];
        let written = Path::new(self.written);
        let message = format!("there is no script `{}`", shown(written));
        let fault = Fault::new(SCRIPT_NOT_FOUND, message).help_if(escape_help(written));
        let [own, working] = folders.each_ref().map(|folder| folder.display());
        let is_one = normalized(&folders[0]) == normalized(&folders[1]);
        let searched = match written.is_absolute() {
            true => "an absolute path is not searched for elsewhere".to_owned(),
            false if is_one => format!("searched in the working directory `{working}`"),
            false => format!("searched in `{own}` and in the working directory `{working}`"),
        };
        fault.help_if(self.similar(&folders[0].join(&self.name))).help(searched)
    }

    /// Where a script of this name may lie, in the order of precedence.
    fn candidates(&self) -> [PathBuf; 4] {
        let mut with_ending = self.name.clone().into_os_string();
        with_ending.push(".mos");
        let (own, working) = (self.world.absolute(self.folder), self.world.current_dir());
        let path =
            |folder: &Path, name: &Path| normalized(&self.world.absolute(&folder.join(name)));
        let with_ending = Path::new(&with_ending);
        [
            path(&own, &self.name),
            path(&own, with_ending),
            path(&working, &self.name),
            path(&working, with_ending),
        ]
    }

    fn similar(&self, path: &Path) -> Option<String> {
        let nearby = self.world.list_dir(path.parent()?).ok()?;
        let scripts: Vec<&str> = nearby.iter().filter_map(|e| e.strip_suffix(".mos")).collect();
        suggest::did_you_mean(&path.file_stem()?.to_string_lossy(), scripts)
    }

    /// The file of this path, letter case not counted in any of its parts.
    fn other_case(&self, path: &Path) -> Option<PathBuf> {
        let mut found = PathBuf::new();
        for component in normalized(&self.world.absolute(path)).components() {
            let exact = found.join(component);
            if self.world.exists(&exact) {
                found = exact;
                continue;
            }
            let name = component.as_os_str().to_string_lossy().into_owned();
            let entries = self.world.list_dir(&found).ok()?;
            found.push(entries.iter().find(|entry| entry.eq_ignore_ascii_case(&name))?);
        }
        (self.world.sees(&found) && !self.world.is_dir(&found)).then_some(found)
    }
}
