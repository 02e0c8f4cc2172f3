//! The command line's grammar.

use super::check::{CheckArgs, FlattenArgs};
use super::compare::CompareArgs;
use super::completions::CompletionsArgs;
use super::explain::ExplainArgs;
use super::help::HelpArgs;
use super::identify::IdentifyArgs;
use super::lesson::LessonArgs;
use super::new::NewArgs;
use super::repl::ReplArgs;
use super::report::ReportArgs;
use super::run::RunArgs;
use super::simulate::SimulateArgs;
use super::teach::TeachArgs;
use super::test::TestArgs;
use super::verify::VerifyArgs;
use crate::script::{Dialect, Options, Permissions};
use clap::builder::styling::{AnsiColor, Styles};
use clap::{Args, Parser, Subcommand, ValueEnum, ValueHint};
use std::path::PathBuf;

const STYLES: Styles = Styles::styled()
    .header(AnsiColor::Green.on_default().bold())
    .usage(AnsiColor::Green.on_default().bold())
    .literal(AnsiColor::Cyan.on_default().bold())
    .placeholder(AnsiColor::Cyan.on_default());

const EXAMPLES: &str = "\
Examples:
  gapi run scripts/GAPILib.mos                 identify a measured polarization curve
  gapi run scripts/GAPILib.mos --out fit1      the same, results in the folder fit1
  gapi check models --model CaseStudies.PolarizationCurve
  gapi simulate models --model CaseStudies.PolarizationCurve --set R=0.3 --output curve.csv
  gapi explain unknown-class                   what a diagnostic's code means";

/// Runs GAPILib scripts: identifies the parameters of Modelica models from measured data with a
/// genetic algorithm.
#[derive(Debug, Parser)]
#[command(name = "gapi", version, styles = STYLES, after_help = EXAMPLES)]
#[command(propagate_version = true, subcommand_required = true, arg_required_else_help = true)]
#[command(disable_help_subcommand = true)]
pub(super) struct Cli {
    /// What to do
    #[command(subcommand)]
    pub command: Command,
    /// Settings of every command
    #[command(flatten)]
    pub global: Global,
}

/// Settings of every command.
#[derive(Debug, Args)]
pub(super) struct Global {
    /// When to use colours
    #[arg(long, value_enum, default_value_t = Colour::Auto, global = true, value_name = "WHEN")]
    pub color: Colour,
    /// A folder with Modelica packages, loadable by name (repeatable; also MODELICAPATH)
    #[arg(long, global = true, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub library: Vec<PathBuf>,
    /// Let scripts and models read files in this folder; without DIR, everywhere (repeatable)
    #[arg(long, global = true, value_name = "DIR", num_args = 0..=1, require_equals = true)]
    #[arg(default_missing_value = EVERYWHERE, value_hint = ValueHint::DirPath, help_heading = ALLOWED)]
    pub allow_read: Vec<PathBuf>,
    /// Let scripts and models write everywhere, and replace and remove files that they have not made
    #[arg(long, global = true, help_heading = ALLOWED)]
    pub allow_write: bool,
}

/// `--allow-read` without a folder.
pub(super) const EVERYWHERE: &str = "/";

/// The heading of the permissions, with what holds without them.
const ALLOWED: &str = "What scripts and models may do. They read the folder of the script, the \
working folder and libraries, and write the output folder and new files";

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

/// The commands.
#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Run a script
    Run(RunArgs),
    /// Watch the genetic algorithm of a script step by step
    Teach(TeachArgs),
    /// Learn how the genetic algorithm works, in twelve short lessons
    Lesson(LessonArgs),
    /// Identify parameters as a problem file says
    Identify(IdentifyArgs),
    /// Write a first problem file from a data file and a model
    New(NewArgs),
    /// Run scripts and compare what they answer with what is recorded
    Test(TestArgs),
    /// Type statements and see their answers
    Repl(ReplArgs),
    /// Explain a command of scripts, or print the ledger of compatibility
    Help(HelpArgs),
    /// Simulate a model
    Simulate(SimulateArgs),
    /// Check Modelica files, or one model down to its sorted equations
    Check(CheckArgs),
    /// Print a model as flat Modelica
    Flatten(FlattenArgs),
    /// Draw the report of an identification again from its files
    Report(ReportArgs),
    /// Compare results with reference results
    Compare(CompareArgs),
    /// Check a library against a collection of reference results
    Verify(VerifyArgs),
    /// Explain a diagnostic's code
    Explain(ExplainArgs),
    /// Print shell completions
    Completions(CompletionsArgs),
}

/// How scripts are read, and what they may do.
#[derive(Debug, Args, Clone)]
pub(super) struct Freedom {
    /// Whose habits scripts follow [default: recognised from the script]
    #[arg(long, value_enum, value_name = "NAME")]
    pub dialect: Option<DialectName>,
    /// Let scripts run programs and read all environment variables
    #[arg(long, help_heading = ALLOWED)]
    pub allow_system: bool,
    /// When to stop
    #[command(flatten)]
    pub limits: Limits,
}

/// What a command may take.
#[derive(Debug, Args, Clone)]
pub(super) struct Limits {
    /// Stop after so many seconds
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub time_limit: Option<f64>,
    /// Stop when the program takes more memory (MiB); Linux only [default: three quarters of what
    /// the machine or its control group has]
    #[arg(long, value_name = "MIB", value_parser = clap::value_parser!(u32).range(1..))]
    pub memory_limit: Option<u32>,
    /// Evaluate models without machine code: slower, with the same digits
    #[arg(long)]
    pub interpret: bool,
    /// Most instructions that one call of a function may take, in millions [default: 20]
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

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
