//! Environment variables and programs of the operating system, as far as a script may use them.

use super::faults::cannot;
use super::permissions::Permissions;
use crate::bail;
use crate::diag::Fault;
use crate::errors::REFUSED;
use crate::world::Environment;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Environment variables that hold no secrets: folders, languages, the machine, the tools that
/// scripts are written for. Secrets have all names there are.
const HARMLESS: &[&str] = &[
    "APPDATA",
    "COMPUTERNAME",
    "DYMOLA",
    "DYMOLAPATH",
    "DYMOLAWORK",
    "HOME",
    "HOMEDRIVE",
    "HOMEPATH",
    "HOSTNAME",
    "LANG",
    "LANGUAGE",
    "LC_ALL",
    "LC_CTYPE",
    "LC_MESSAGES",
    "LC_NUMERIC",
    "LC_TIME",
    "LOCALAPPDATA",
    "LOGNAME",
    "MODELICAPATH",
    "NUMBER_OF_PROCESSORS",
    "OMDEV",
    "OMP_NUM_THREADS",
    "OPENMODELICAHOME",
    "OPENMODELICALIBRARY",
    "OS",
    "OSTYPE",
    "PATH",
    "PROCESSOR_ARCHITECTURE",
    "PROGRAMFILES",
    "PWD",
    "SHELL",
    "SYSTEMROOT",
    "TEMP",
    "TERM",
    "TMP",
    "TMPDIR",
    "TZ",
    "USER",
    "USERNAME",
    "USERPROFILE",
    "XDG_CACHE_HOME",
    "XDG_CONFIG_HOME",
    "XDG_DATA_HOME",
    "XDG_RUNTIME_DIR",
];

/// The environment variables that scripts set, before those of the process.
#[derive(Debug, Clone, Default)]
pub(crate) struct Process {
    variables: BTreeMap<String, String>,
    /// Names that the user allows besides the harmless ones.
    allowed: BTreeSet<String>,
}

impl Process {
    /// Lets an environment variable be read.
    pub(super) fn allow(&mut self, name: &str) {
        self.allowed.insert(name.to_owned());
    }

    /// The names of the environment variables that may be read, for people.
    pub(super) fn listed(&self) -> String {
        let names = HARMLESS.iter().copied().chain(self.allowed.iter().map(String::as_str));
        names.collect::<Vec<_>>().join(", ")
    }

    /// Sets an environment variable, for the scripts and for the programs that they start.
    pub(super) fn set(&mut self, name: String, content: String) {
        self.variables.insert(name, content);
    }

    /// The content of an environment variable, of the session's own first; `None` if it is not set.
    ///
    /// # Errors
    /// The variable is set and may hold a secret.
    pub(crate) fn variable(
        &self,
        of_system: impl Fn(&str) -> Option<String>,
        permissions: Permissions,
        name: &str,
    ) -> Result<Option<String>, Fault> {
        if let Some(own) = self.variables.get(name) {
            return Ok(Some(own.clone()));
        }
        let content = of_system(name);
        let is_harmless = HARMLESS.iter().any(|known| known.eq_ignore_ascii_case(name));
        if content.is_some() && !is_harmless && !self.allowed.contains(name) && !permissions.system
        {
            bail!(
                REFUSED,
                "the environment variable `{name}` cannot be read: it may hold a secret";
                help: "allow it with `--allow-env={name}`"
            );
        }
        Ok(content)
    }

    /// Runs a command of the operating system; its exit status and what it printed.
    ///
    /// # Errors
    /// It may not be started, or cannot be.
    pub(super) fn run(
        &self,
        world: &mut dyn Environment,
        permissions: Permissions,
        command: &str,
    ) -> Result<(i32, Vec<u8>), Fault> {
        if !permissions.system {
            bail!(
                REFUSED,
                "`{command}` was not started: a script must not start programs";
                help: "allow it with `--allow-system`, or run the command before or after the \
                       script"
            );
        }
        world
            .run_command(command, &self.variables)
            .map_err(|error| cannot("run", Path::new(command), &error))
    }
}
