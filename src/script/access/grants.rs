//! Files and folders that a session may use: the one place that derives them from what the user has
//! named and from the current folder.
//!
//! What the user names on the command line is granted where it leads. What is found beside or above it
//! is granted as [`Grant::Found`]: no link leads elsewhere. What files of others name, such as a
//! problem or a script, is not granted at all: it must lie in what is granted already.

use super::SessionWorld;
use super::faults::{cannot, escape_help, shown};
use super::permissions::Permissions;
use super::policy::{Access, Grant};
use crate::diag::Fault;
use crate::errors::FILE_ERROR;
use crate::fault;
use std::path::Path;

impl SessionWorld {
    /// What the caller of the scripts allows them from here on.
    pub(crate) fn permit(&mut self, permissions: Permissions) {
        self.permissions = permissions;
        if permissions.read {
            self.world.grant(Grant::ReadAll);
        }
        if permissions.write {
            self.world.grant(Grant::WriteAll);
        }
    }

    /// A fault unless a file of this path may be read, written, made or removed.
    pub(crate) fn may(&self, access: Access, path: &Path) -> Result<(), Fault> {
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

    /// The user has named this script: new files may be made in its folder.
    pub fn grant_script(&mut self, path: &Path) {
        self.grant_input(path);
        if let Some(folder) = self.world.absolute(path).parent() {
            self.world.grant(Grant::Create(folder));
        }
    }

    /// Results may be written into this folder of a model that a script has opened, which is where
    /// Dymola puts them, if the folder may be read.
    pub(crate) fn trust_results(&mut self, folder: &Path) {
        if self.world.permits(folder, Access::Read).is_ok() {
            self.world.grant(Grant::Results(folder));
        }
    }

    /// This file may be written, wherever it is: the user has named it on the command line.
    pub fn permit_file(&mut self, path: &Path) {
        self.world.grant(Grant::Named(path));
    }

    /// The folders `models` in a folder and above it may be read, where no link leads elsewhere and
    /// no other user has put them there.
    pub fn grant_models(&mut self, folder: &Path) {
        for folder in folder.ancestors() {
            self.world.grant(Grant::Found(&folder.join("models")));
        }
    }

    /// What scripts and models may do, as a table for people.
    pub fn listed_permissions(&self) -> String {
        let is_free = self.permissions.system;
        let variables = if is_free { "all".to_owned() } else { self.process.listed() };
        let programs = if is_free { "all" } else { "none" };
        let mut rows = self.world.permissions();
        rows.push(("start programs".to_owned(), programs.to_owned()));
        rows.push(("environment variables".to_owned(), variables));
        let width = rows.iter().map(|(meaning, _)| meaning.chars().count()).max().unwrap_or(0);
        let row = |(meaning, subject): &(String, String)| format!("{meaning:width$}  {subject}\n");
        rows.iter().map(row).collect()
    }

    /// The user lets scripts and models read this environment variable.
    pub fn allow_variable(&mut self, name: &str) {
        self.process.allow(name);
    }

    /// The content of an environment variable; `None` if it is not set.
    pub(crate) fn environment_variable(&self, name: &str) -> Result<Option<String>, Fault> {
        self.process.variable(|name| self.world.env(name), self.permissions, name)
    }
}
