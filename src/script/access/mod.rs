//! What scripts and models may read, write and remove: files, permissions, the policy, and the world of
//! a session, which is the outside as its scripts may use it.

pub mod faults;
mod files;
mod grants;
mod outdated;
pub mod permissions;
pub mod policy;
pub(crate) mod process;

use self::outdated::Outdated;
use self::permissions::Permissions;
use self::process::Process;
use crate::diag::Fault;
use crate::world::World;
use std::collections::BTreeMap;
use std::ops::{Deref, DerefMut};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The outside, with what the session adds to it: files in memory, environment variables that scripts
/// set, folders from which relative paths start, and notes about files that were not written.
pub struct SessionWorld {
    world: Box<dyn World>,
    /// Files in memory, by absolute paths: they take the place of those on the disk.
    given: BTreeMap<PathBuf, Arc<[u8]>>,
    outdated: Outdated,
    process: Process,
    permissions: Permissions,
    starts: PathStarts,
}

impl Deref for SessionWorld {
    type Target = dyn World;

    fn deref(&self) -> &(dyn World + 'static) {
        &*self.world
    }
}

impl DerefMut for SessionWorld {
    fn deref_mut(&mut self) -> &mut (dyn World + 'static) {
        &mut *self.world
    }
}

/// Where relative paths start, beside the working directory.
#[derive(Debug, Default)]
struct PathStarts {
    /// The folders of the scripts that are being run, outermost first.
    folders: Vec<PathBuf>,
    /// The folder of the problem file that is being read.
    problem: Option<PathBuf>,
}

impl PathStarts {
    /// Where relative paths start, in words; `working`: the working directory.
    fn in_words(&self, working: &Path) -> String {
        let working = working.display();
        match (&self.problem, self.folders.is_empty()) {
            (Some(folder), true) if folder.as_os_str().is_empty() => {
                format!("relative paths start from the folder of the problem file, `{working}`")
            }
            (Some(folder), true) => format!(
                "relative paths start from the folder of the problem file, `{}`",
                folder.display()
            ),
            (None, true) => format!("relative paths start from the working directory `{working}`"),
            (_, false) => format!(
                "relative paths start from the working directory `{working}` or the script's folder"
            ),
        }
    }
}

impl SessionWorld {
    pub(crate) fn new(world: Box<dyn World>) -> SessionWorld {
        SessionWorld {
            world,
            given: BTreeMap::new(),
            outdated: Outdated::default(),
            process: Process::default(),
            permissions: Permissions::default(),
            starts: PathStarts::default(),
        }
    }

    /// What the caller of the scripts allows them.
    pub(crate) fn permitted(&self) -> Permissions {
        self.permissions
    }

    /// A script that lies in this folder begins.
    pub(crate) fn enter(&mut self, folder: PathBuf) {
        self.starts.folders.push(folder);
    }

    /// The innermost script ends.
    pub(crate) fn leave(&mut self) {
        self.starts.folders.pop();
    }

    /// The folders of the scripts that are being run, innermost first.
    pub(crate) fn folders(&self) -> impl Iterator<Item = &Path> {
        self.starts.folders.iter().rev().map(PathBuf::as_path)
    }

    /// A problem file that lies in this folder is read from here on, or none; what was read before.
    pub(crate) fn read_problem(&mut self, folder: Option<PathBuf>) -> Option<PathBuf> {
        std::mem::replace(&mut self.starts.problem, folder)
    }

    /// The environment variables that scripts set, and those that they may read.
    pub(crate) fn process(&self) -> &Process {
        &self.process
    }

    /// Sets an environment variable, for the scripts and for the programs that they start.
    pub(crate) fn set_environment_variable(&mut self, name: String, content: String) {
        self.process.set(name, content);
    }

    /// Runs a command of the operating system; its exit status and what it printed.
    ///
    /// # Errors
    /// It may not be started, or cannot be.
    pub(crate) fn run_program(&mut self, command: &str) -> Result<(i32, Vec<u8>), Fault> {
        self.process.run(&mut *self.world, self.permissions, command)
    }
}
