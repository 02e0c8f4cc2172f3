//! What a script may do outside of itself.

use super::Session;
use super::errors::REFUSED;
use crate::bail;
use crate::diag::Fault;
use std::path::{Path, PathBuf};

/// What the caller of a script allows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Permissions {
    /// To write and remove files anywhere, not only below the directory where the run began, the
    /// folder of the script and the output folder.
    pub write: bool,
    /// To run programs, and to read environment variables that may hold secrets.
    pub system: bool,
}

/// Environment variables that tell no secrets.
const HARMLESS: &[&str] = &[
    "DYMOLA",
    "DYMOLAPATH",
    "HOME",
    "LANG",
    "MODELICALIBRARY",
    "MODELICAPATH",
    "OPENMODELICAHOME",
    "OPENMODELICALIBRARY",
    "OS",
    "PWD",
    "TEMP",
    "TMP",
    "TMPDIR",
    "USERPROFILE",
];

impl Session {
    /// A fault unless a file of this path may be written, made or removed.
    pub(super) fn may_change(&self, path: &Path) -> Result<(), Fault> {
        let wanted = self.world.resolved(path);
        let output = self.world.resolved(&self.world.output_dir());
        let is_inside = |folder: &PathBuf| wanted.starts_with(folder);
        if self.options.permissions.write
            || self.trusted.iter().any(is_inside)
            || is_inside(&output)
        {
            return Ok(());
        }
        bail!(
            REFUSED,
            "`{}` is not changed: it lies outside of the directory where the run began",
            path.display();
            help: "allow it with `--allow-write`"
        )
    }

    /// Files below this folder may be written and removed.
    pub(super) fn trust(&mut self, folder: &Path) {
        let folder = self.world.resolved(folder);
        if !self.trusted.contains(&folder) {
            self.trusted.push(folder);
        }
    }

    /// The content of an environment variable, of the session's own first; `None` if it is not set.
    pub(super) fn environment_variable(&self, name: &str) -> Result<Option<String>, Fault> {
        if let Some(own) = self.environment.get(name) {
            return Ok(Some(own.clone()));
        }
        if !self.options.permissions.system && !HARMLESS.contains(&name) {
            bail!(
                REFUSED,
                "the environment variable `{name}` is not read: it might hold a secret";
                help: "allow it with `--allow-system`"
            );
        }
        Ok(self.world.env(name))
    }

    /// Runs a command of the operating system and prints what it printed; its exit status.
    pub(super) fn run_system_command(&mut self, command: &str) -> Result<(i32, Vec<u8>), Fault> {
        if !self.options.permissions.system {
            bail!(
                REFUSED,
                "`{command}` is not run: a script may not start programs";
                help: "allow it with `--allow-system`, or do it before or after the script"
            );
        }
        let environment = self.environment.clone();
        self.world
            .run_command(command, &environment)
            .map_err(|error| super::files::cannot("run", Path::new(command), &error))
    }
}
