//! Environment variables and programs of the operating system, as far as a script may use them.

use super::faults::cannot;
use super::permissions::Permissions;
use crate::bail;
use crate::diag::Fault;
use crate::script::errors::REFUSED;
use crate::script::world::Environment;
use std::collections::BTreeMap;
use std::path::Path;

/// Words in the names of environment variables that hold secrets.
const SECRETIVE: &[&str] =
    &["AUTH", "COOKIE", "CREDENTIAL", "KEY", "PASS", "PRIVATE", "SECRET", "TOKEN"];

/// The environment variables that scripts set, before those of the process.
#[derive(Debug, Clone, Default)]
pub struct Process {
    variables: BTreeMap<String, String>,
}

impl Process {
    /// Sets an environment variable, for the scripts and for the programs that they start.
    pub fn set(&mut self, name: String, content: String) {
        self.variables.insert(name, content);
    }

    /// The content of an environment variable, of the session's own first; `None` if it is not set.
    ///
    /// # Errors
    /// The variable may hold a secret.
    pub fn variable(
        &self,
        of_system: impl Fn(&str) -> Option<String>,
        permissions: Permissions,
        name: &str,
    ) -> Result<Option<String>, Fault> {
        if let Some(own) = self.variables.get(name) {
            return Ok(Some(own.clone()));
        }
        let capitals = name.to_ascii_uppercase();
        let is_secretive = SECRETIVE.iter().any(|word| capitals.contains(word));
        if is_secretive && !permissions.system {
            bail!(
                REFUSED,
                "the environment variable `{name}` cannot be read: it may hold a secret";
                help: "allow it with `--allow-system`"
            );
        }
        Ok(of_system(name))
    }

    /// Runs a command of the operating system; its exit status and what it printed.
    ///
    /// # Errors
    /// It may not be started, or cannot be.
    pub fn run(
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
