//! The command line's grammar.

use super::check::{CheckArgs, FlattenArgs};
use super::compare::CompareArgs;
use super::completions::CompletionsArgs;
#[cfg(feature = "lsp")]
use super::connection::LspArgs;
use super::estimate::EstimateArgs;
use super::explain::ExplainArgs;
use super::export::ExportArgs;
use super::export_fmu::ExportFmuArgs;
use super::fmt::FmtArgs;
use super::fmu::FmuWorkerArgs;
use super::help::HelpArgs;
use super::identify::IdentifyArgs;
use super::import::ImportArgs;
use super::journal::JournalArgs;
use super::lesson::LessonArgs;
use super::linearize::LinearizeArgs;
use super::man::ManArgs;
#[cfg(feature = "lsp")]
use super::mcp::McpArgs;
use super::new::NewArgs;
use super::options::Global;
use super::repl::ReplArgs;
use super::report::ReportArgs;
use super::run::RunArgs;
use super::simulate::SimulateArgs;
use super::teach::TeachArgs;
use super::test::TestArgs;
use super::verify::VerifyArgs;
use clap::builder::styling::{AnsiColor, Styles};
use clap::{Parser, Subcommand};

const STYLES: Styles = Styles::styled()
    .header(AnsiColor::Green.on_default().bold())
    .usage(AnsiColor::Green.on_default().bold())
    .literal(AnsiColor::Cyan.on_default().bold())
    .placeholder(AnsiColor::Cyan.on_default());

const EXAMPLES: &str = "\
Examples:
  gapi run scripts/GAPILib.mos                 identify a measured polarization curve
  gapi run scripts/GAPILib.mos --out fit1      the same, with the results in the folder fit1
  gapi check models --model CaseStudies.PolarizationCurve
  gapi simulate models --model CaseStudies.PolarizationCurve --set R=0.3 --output curve.csv
  gapi explain unknown-class                   what a diagnostic's code means";

/// Identifies the parameters of Modelica models from measured data, by GAPILib
/// scripts or problem files; also simulates, checks and formats models.
#[derive(Debug, Parser)]
#[command(name = "gapi", version, styles = STYLES, after_help = EXAMPLES)]
#[command(propagate_version = true, subcommand_required = true, arg_required_else_help = true)]
#[command(disable_help_subcommand = true)]
pub(super) struct Cli {
    /// The command to run
    #[command(subcommand)]
    pub command: Command,
    /// Options common to all commands
    #[command(flatten)]
    pub global: Global,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Run a script
    Run(RunArgs),
    /// Step through the genetic algorithm of a script
    Teach(TeachArgs),
    /// Learn how the genetic algorithm works, in 18 short exercises
    Lesson(LessonArgs),
    /// Estimate the parameters of a problem file
    Identify(IdentifyArgs),
    /// Estimate the states of a model with process noise from measurements
    Estimate(EstimateArgs),
    /// Draft a problem file from a data file and a model
    New(NewArgs),
    /// Import a model in SBML or a problem in PEtab
    Import(ImportArgs),
    /// Export a problem file to another format
    Export(ExportArgs),
    /// Run scripts and compare their output with recorded transcripts
    Test(TestArgs),
    /// Execute statements interactively
    Repl(ReplArgs),
    /// Show the documentation of a script command, or the compatibility table
    Help(HelpArgs),
    /// Simulate a model
    Simulate(SimulateArgs),
    /// Show poles, zeros and frequency responses of a model at a point of its simulation
    Linearize(LinearizeArgs),
    /// Export a model as a functional mock-up unit (FMU)
    ExportFmu(ExportFmuArgs),
    /// Check every class of Modelica files, and models including their causalization (BLT)
    Check(CheckArgs),
    /// Print a model as flat Modelica
    Flatten(FlattenArgs),
    /// Format Modelica files and scripts
    Fmt(FmtArgs),
    /// Start a language server (LSP) for an editor
    #[cfg(feature = "lsp")]
    Lsp(LspArgs),
    /// Offer check, simulation and identification to an assistant (MCP)
    #[cfg(feature = "lsp")]
    Mcp(McpArgs),
    /// Recreate the report of an identification from its files
    Report(ReportArgs),
    /// Show what a checkpoint, a shard or a trace contains
    Journal(JournalArgs),
    /// Compare results with reference results
    Compare(CompareArgs),
    /// Check a library against a collection of reference results
    Verify(VerifyArgs),
    /// Explain a diagnostic code
    Explain(ExplainArgs),
    /// Print shell completions
    Completions(CompletionsArgs),
    /// Print or write manual pages
    Man(ManArgs),
    /// Simulate a functional mock-up unit for another process
    #[command(hide = true)]
    FmuWorker(FmuWorkerArgs),
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn every_command_has_examples_and_says_its_exit_codes() {
        for command in Cli::command().get_subcommands().filter(|own| !own.is_hide_set()) {
            let name = command.get_name();
            let after = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            assert!(after.contains(&format!("\n  gapi {name}")), "{name}: {after}");
            assert!(after.contains("\nExit code: 0 "), "{name}: {after}");
            assert!(command.get_about().is_some(), "{name}");
            for argument in command.get_arguments() {
                assert!(argument.get_help().is_some(), "{name}: {argument}");
            }
        }
    }

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }
}
