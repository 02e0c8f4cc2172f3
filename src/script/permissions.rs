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
    /// To run programs, and to read environment variables whose names look like those of secrets.
    pub system: bool,
}

/// Words in the names of environment variables that hold secrets.
const SECRETIVE: &[&str] =
    &["AUTH", "COOKIE", "CREDENTIAL", "KEY", "PASS", "PRIVATE", "SECRET", "TOKEN"];

impl Session {
    /// A fault unless a file of this path may be written, made or removed.
    pub(super) fn may_change(&self, path: &Path) -> Result<(), Fault> {
        let wanted = self.world.resolved(path);
        let output = self.world.resolved(&self.world.output_dir());
        let is_inside = |folder: &PathBuf| wanted.starts_with(folder);
        if self.options.permissions.write
            || self.trusted.iter().any(is_inside)
            || self.is_result_of_opened(&wanted)
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

    /// Whether it is a file of results or data in a folder whose model a script has opened and gone
    /// to, which is where Dymola puts them.
    fn is_result_of_opened(&self, wanted: &Path) -> bool {
        let ending = wanted.extension().and_then(|ending| ending.to_str());
        let is_result = ending.is_some_and(|ending| matches!(ending, "mat" | "csv" | "txt"));
        let folder = wanted.parent();
        is_result && self.result_folders.iter().any(|known| Some(known.as_path()) == folder)
    }

    /// Results may be written into this folder.
    pub(super) fn trust_results(&mut self, folder: &Path) {
        let folder = self.world.resolved(folder);
        if !self.result_folders.contains(&folder) {
            self.result_folders.push(folder);
        }
    }

    /// This file may be written, wherever it is: the user has named it on the command line.
    pub fn permit_file(&mut self, path: &Path) {
        self.trust(path);
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
        let capitals = name.to_ascii_uppercase();
        let is_secretive = SECRETIVE.iter().any(|word| capitals.contains(word));
        if is_secretive && !self.options.permissions.system {
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
