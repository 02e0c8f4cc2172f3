//! What a script may do outside of itself.

use super::files::cannot;
use super::policy::{Access, Grant};
use crate::bail;
use crate::diag::Fault;
use crate::script::Session;
use crate::script::errors::REFUSED;
use std::path::Path;

/// What the caller of a script allows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Permissions {
    /// To read files anywhere.
    pub read: bool,
    /// To write and remove files anywhere, those too that the run has not made.
    pub write: bool,
    /// To run programs, and to read environment variables whose names look like those of secrets.
    pub system: bool,
}

/// Words in the names of environment variables that hold secrets.
const SECRETIVE: &[&str] =
    &["AUTH", "COOKIE", "CREDENTIAL", "KEY", "PASS", "PRIVATE", "SECRET", "TOKEN"];

impl Session {
    /// A fault unless a file of this path may be read, written, made or removed.
    pub(in crate::script) fn may(&self, access: Access, path: &Path) -> Result<(), Fault> {
        let verb = if access == Access::Read { "read" } else { "change" };
        self.world.permits(path, access).map_err(|error| cannot(verb, path, &error))
    }

    /// The user has named this file or folder: it may be read, with what is beside it, the package
    /// that it belongs to, and the folders `models` above it, where classes are looked for.
    pub fn grant_input(&mut self, path: &Path) {
        let path = self.world.absolute(path);
        self.world.grant(Grant::Read(&path));
        let folder = if self.world.is_dir(&path) { Some(&*path) } else { path.parent() };
        let Some(folder) = folder else { return };
        let is_package = |folder: &&Path| self.world.exists(&folder.join("package.mo"));
        let packages = folder.ancestors().take_while(is_package).last();
        self.world.grant(Grant::Read(packages.unwrap_or(folder)));
        self.grant_models(folder);
    }

    /// Results may be written into this folder of a model that a script has opened, which is where
    /// Dymola puts them, if the folder may be read.
    pub(in crate::script) fn trust_results(&mut self, folder: &Path) {
        if self.world.permits(folder, Access::Read).is_ok() {
            self.world.grant(Grant::Results(folder));
        }
    }

    /// This file may be written, wherever it is: the user has named it on the command line.
    pub fn permit_file(&mut self, path: &Path) {
        self.world.grant(Grant::Named(path));
    }

    /// The folders `models` in a folder and above it may be read.
    pub fn grant_models(&mut self, folder: &Path) {
        for folder in folder.ancestors() {
            self.world.grant(Grant::Read(&folder.join("models")));
        }
    }

    /// The content of an environment variable, of the session's own first; `None` if it is not set.
    pub(in crate::script) fn environment_variable(
        &self,
        name: &str,
    ) -> Result<Option<String>, Fault> {
        if let Some(own) = self.environment.get(name) {
            return Ok(Some(own.clone()));
        }
        let capitals = name.to_ascii_uppercase();
        let is_secretive = SECRETIVE.iter().any(|word| capitals.contains(word));
        if is_secretive && !self.options.permissions.system {
            bail!(
                REFUSED,
                "the environment variable `{name}` cannot be read: it may hold a secret";
                help: "allow it with `--allow-system`"
            );
        }
        Ok(self.world.env(name))
    }

    /// Runs a command of the operating system and prints what it printed; its exit status.
    pub(in crate::script) fn run_system_command(
        &mut self,
        command: &str,
    ) -> Result<(i32, Vec<u8>), Fault> {
        if !self.options.permissions.system {
            bail!(
                REFUSED,
                "`{command}` was not started: a script must not start programs";
                help: "allow it with `--allow-system`, or run the command before or after the \
                       script"
            );
        }
        let environment = self.environment.clone();
        self.world
            .run_command(command, &environment)
            .map_err(|error| cannot("run", Path::new(command), &error))
    }
}
