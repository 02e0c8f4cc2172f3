//! Options that several commands share.

use crate::script::{Dialect, Options, Permissions};
use clap::{Args, ValueEnum, ValueHint};
use std::path::PathBuf;

/// Settings of every command.
#[derive(Debug, Args, Clone)]
pub(super) struct Global {
    /// When to use colours
    #[arg(long, value_enum, default_value_t = Colour::Auto, global = true, value_name = "WHEN")]
    pub color: Colour,
    /// A folder with Modelica packages to load by name (repeatable; also MODELICAPATH)
    #[arg(long, global = true, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub library: Vec<PathBuf>,
    /// Neither use nor write the cache of translated models
    /// [the folder `gapi` of the user's cache]
    #[arg(long, global = true, env = "GAPI_NO_CACHE", hide_env = true)]
    #[arg(value_parser = clap::builder::FalseyValueParser::new())]
    pub(crate) no_cache: bool,
    /// Allow scripts and models to read files in this folder; without DIR, everywhere (repeatable)
    #[arg(long, global = true, value_name = "DIR", num_args = 0..=1, require_equals = true)]
    #[arg(default_missing_value = EVERYWHERE, value_hint = ValueHint::DirPath, help_heading = ALLOWED)]
    pub allow_read: Vec<PathBuf>,
    /// Allow scripts and models to write everywhere, and to replace and remove files that they did
    /// not create
    #[arg(long, global = true, help_heading = ALLOWED)]
    pub allow_write: bool,
    /// Exclude this folder from what scripts and models read and write, whatever else is allowed
    /// (repeatable)
    #[arg(long, global = true, value_name = "DIR", value_hint = ValueHint::DirPath)]
    #[arg(help_heading = ALLOWED)]
    pub(crate) deny_read: Vec<PathBuf>,
    /// Allow scripts and models to read this environment variable, besides those that hold no
    /// secrets (repeatable)
    #[arg(long, global = true, value_name = "NAME", help_heading = ALLOWED)]
    pub(crate) allow_env: Vec<String>,
    /// Allow this library to bring functions in C, or this functional mock-up unit (FMU) to run: its path, or
    /// the name of its file in any folder; without LIBRARY, all (repeatable): they can do whatever you
    /// can do
    #[arg(long, global = true, value_name = "LIBRARY", num_args = 0..=1, require_equals = true)]
    #[arg(default_missing_value = ALL_LIBRARIES, help_heading = ALLOWED)]
    pub allow_external: Vec<String>,
    /// List the permissions of scripts and models, and do nothing else. Without the options above, they
    /// can read the folder of the script, the working folder and libraries, and write to the output
    /// folder and to new files
    #[arg(long, global = true, help_heading = ALLOWED)]
    pub(crate) show_permissions: bool,
}

/// `--allow-read` without a folder.
pub(super) const EVERYWHERE: &str = "/";

/// `--allow-external` without a library.
pub(super) const ALL_LIBRARIES: &str = "*";

/// The heading of the permissions.
const ALLOWED: &str = "Permissions";

/// When to use colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Colour {
    /// On a terminal, unless NO_COLOR is set
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

/// How scripts are read, and what they may do.
#[derive(Debug, Args, Clone)]
pub(super) struct Freedom {
    /// The dialect of scripts [default: detected from the script]
    #[arg(long, value_enum, value_name = "NAME")]
    pub dialect: Option<DialectName>,
    /// Allow scripts to run programs and to read all environment variables
    #[arg(long, help_heading = ALLOWED)]
    pub allow_system: bool,
    /// Limits
    #[command(flatten)]
    pub limits: Limits,
}

/// What a command may take.
#[derive(Debug, Args, Clone, Default)]
pub(super) struct Limits {
    /// Stop after this number of seconds
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub(crate) time_limit: Option<f64>,
    /// Stop when the program uses more memory (MiB); Linux only [default: three quarters of the
    /// memory of the machine or its control group]
    #[arg(long, value_name = "MIB", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) memory_limit: Option<u32>,
    /// Evaluate models without machine code: slower, with identical results
    #[arg(long)]
    pub interpret: bool,
    /// Maximum number of instructions of one function call, in millions [default: 1000]
    #[arg(long, value_name = "MILLIONS", value_parser = clap::value_parser!(u32).range(1..))]
    pub instruction_limit: Option<u32>,
}

/// A dialect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum DialectName {
    /// Dymola's
    Dymola,
    /// OpenModelica's
    Openmodelica,
}

impl Freedom {
    /// What the session's options say of it.
    pub(super) fn options(&self) -> Options {
        let dialect = self.dialect.map(|name| match name {
            DialectName::Dymola => Dialect::Dymola,
            DialectName::Openmodelica => Dialect::OpenModelica,
        });
        let permissions = Permissions { system: self.allow_system, ..Permissions::default() };
        Options { dialect, permissions, ..Options::default() }
    }
}

pub(super) fn at_least_one(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|&number| number > 0).ok_or_else(|| "expected 1, 2, ...".to_owned())
}

pub(super) fn seconds(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| format!("`{text}` is not a number"))?;
    let is_good = number > 0.0 && number <= 1e9;
    if is_good { Ok(number) } else { Err("expected a positive number".to_owned()) }
}
