//! Files and folders that a session may use, as the user names them.

use super::faults::{cannot, escape_help, shown};
use super::policy::{Access, Grant};
use crate::diag::Fault;
use crate::fault;
use crate::script::Session;
use crate::script::errors::FILE_ERROR;
use std::path::Path;

impl Session {
    /// A fault unless a file of this path may be read, written, made or removed.
    pub(in crate::script) fn may(&self, access: Access, path: &Path) -> Result<(), Fault> {
        let verb = if access == Access::Read { "read" } else { "change" };
        if access == Access::Write
            && let Some(help) = escape_help(path)
        {
            return Err(fault!(
                FILE_ERROR,
                "cannot write `{}`: no file is named so on purpose",
                shown(path)
            )
            .help(help));
        }
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

    /// The content of an environment variable; `None` if it is not set.
    pub(in crate::script) fn environment_variable(
        &self,
        name: &str,
    ) -> Result<Option<String>, Fault> {
        self.process.variable(|name| self.world.env(name), self.options.permissions, name)
    }
}
