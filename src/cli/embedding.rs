//! Sessions for programs that embed this one: the real disk and its rules, with a screen of their
//! own.
//!
//! ```
//! use gapilib_cli::embedding::Embedding;
//! use gapilib_script::world::MemoryWorld;
//! use std::sync::Arc;
//!
//! // Any screen will do; that of a world in memory keeps what is printed.
//! let screen = MemoryWorld::new();
//! let printed = screen.streams();
//! let embedding = Embedding { cache: false, ..Embedding::default() };
//! let mut session = embedding.session(Box::new(screen), Arc::default())?;
//! assert_eq!(session.run_text("input", "print(String(6*7))").code, 0);
//! assert_eq!(printed.output(), "42\n");
//! # Ok::<(), std::io::Error>(())
//! ```

use super::Cli;
use super::lock::Lock;
use super::options::{ALL_LIBRARIES, Colour, Global};
use super::output::{Output, REPL_RESULTS};
use super::world::SystemWorld;
use super::{dispatch, session};
use crate::script::Session;
use crate::script::world::Screen;
use clap::Parser;
use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// What sessions may do, and with what they work.
#[derive(Debug, Clone)]
pub struct Embedding {
    /// Folders with packages that are loaded by name, besides those of `MODELICAPATH`.
    pub libraries: Vec<PathBuf>,
    /// Threads; `None` for all cores.
    pub threads: Option<usize>,
    /// Folders that scripts and models may read besides those they always may.
    pub read: Vec<PathBuf>,
    /// Whether scripts may replace and remove files that they have not made.
    pub write: bool,
    /// Whether libraries may bring functions in C.
    pub external: bool,
    /// Whether translated models are kept for later processes.
    pub cache: bool,
}

impl Default for Embedding {
    /// No libraries, all cores, no permissions, translated models kept.
    fn default() -> Embedding {
        Embedding {
            libraries: Vec::new(),
            threads: None,
            read: Vec::new(),
            write: false,
            external: false,
            cache: true,
        }
    }
}

impl Embedding {
    fn global(&self) -> Global {
        Global {
            color: Colour::Never,
            library: self.libraries.clone(),
            no_cache: !self.cache,
            allow_read: self.read.clone(),
            allow_write: self.write,
            allow_external: self.external.then(|| ALL_LIBRARIES.to_owned()).into_iter().collect(),
            deny_read: Vec::new(),
            allow_env: Vec::new(),
            show_permissions: false,
        }
    }

    /// A session for statements and models one after the other; what it writes without a folder goes
    /// into `results/repl`. `stop` becomes true when the user asks to stop.
    ///
    /// # Errors
    ///
    /// The working directory cannot be read.
    pub fn session(&self, screen: Box<dyn Screen>, stop: Arc<AtomicBool>) -> io::Result<Session> {
        let world = SystemWorld::with_screen(screen, stop, Path::new(REPL_RESULTS), self.threads)?;
        world.own_default_output();
        Ok(session::open(&self.global(), world))
    }

    /// A session for one run of the command `gapi run` or `gapi identify` on a file: its results go
    /// into `out`, by default the folder that the command takes, which says whose they are and is
    /// locked meanwhile.
    ///
    /// # Errors
    ///
    /// The folder holds the results of another problem and `overwrite` was not asked; it is in use;
    /// the working directory cannot be read.
    pub fn session_for(
        &self,
        (command, file): (&str, &Path),
        (out, overwrite): (Option<&Path>, bool),
        (screen, stop): (Box<dyn Screen>, Arc<AtomicBool>),
    ) -> io::Result<Session> {
        let output = Output::of(command, file, out, overwrite).map_err(io::Error::other)?;
        let world = SystemWorld::on_screen(screen, stop, output, self.threads)?;
        Ok(session::open(&self.global(), world))
    }
}

/// The folder for the results of one task in a session that has many; other runs are kept out of it
/// while this lives.
#[derive(Debug)]
pub struct ResultsFolder {
    /// Where it lies, absolute.
    pub path: PathBuf,
    _lock: Lock,
}

impl ResultsFolder {
    /// Makes the folder, which says that it holds the results of `command` on `input`.
    ///
    /// # Errors
    ///
    /// It holds the results of another problem and `overwrite` was not asked; it is in use, or
    /// cannot be written.
    pub fn claim(
        (command, input): (&str, &Path),
        folder: &Path,
        overwrite: bool,
    ) -> io::Result<ResultsFolder> {
        let output = Output::of(command, input, Some(folder), overwrite);
        let output = output.map_err(io::Error::other)?;
        let lock = output.claim(None)?;
        Ok(ResultsFolder { path: output.folder, _lock: lock })
    }
}

/// Runs the command line with these arguments, the name of the program as the first, and gives its
/// exit code; for launchers that are not a separate process.
pub fn command(arguments: Vec<OsString>) -> u8 {
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        Err(error) => return super::terminal::print_usage(&error),
    };
    let ended = super::on_large_stack(move || dispatch(&cli));
    (0..=u8::MAX).find(|code| ExitCode::from(*code) == ended).unwrap_or(1)
}
