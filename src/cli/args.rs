//! The command line's grammar.

use crate::ga::operators;
use crate::results::TUBE_TOLERANCE;
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

/// Arguments of `gapi run`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi run scripts/GAPILib.mos
  gapi run scripts/twin/GAPILib.mos --out twin --threads 1
  gapi run my.mos --transcript my.txt --quiet --strict
  gapi run my.mos --resume              go on after Ctrl-C, a crash or a power cut
  gapi run --parse-only scripts

Exit code: 0 if all went well, 1 if an error happened that the script did not read,
2 for a wrong command line, 130 if interrupted.")]
pub(super) struct RunArgs {
    /// The script (.mos)
    #[arg(value_hint = ValueHint::FilePath, required_unless_present = "parse_only")]
    pub script: Option<PathBuf>,
    /// Folder for results and figures [default: one for each script below `results`]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Replace the results of another problem in that folder
    #[arg(long)]
    pub overwrite: bool,
    /// Threads to use [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Write every statement with its answer to a file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub transcript: Option<PathBuf>,
    /// Go on with a run that was killed, from the checkpoint in the output folder
    #[arg(long)]
    pub resume: bool,
    /// Seconds between two checkpoints
    #[arg(long, value_name = "SECONDS", default_value = "2", value_parser = seconds)]
    pub checkpoint: f64,
    /// A progress bar only, no live view of the run (shown on a terminal after a second)
    #[arg(long)]
    pub plain: bool,
    /// Record what the genetic algorithm did, for `gapi teach`
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub trace: Option<PathBuf>,
    /// Leave out the least squares that end an identification, from its best individual
    #[arg(long)]
    pub no_probe: bool,
    /// Profile likelihoods from there, intervals that are right for strongly curved models, too
    #[arg(long, conflicts_with = "no_probe")]
    pub profile: bool,
    /// Show errors only
    #[arg(long, short)]
    pub quiet: bool,
    /// Show statements and answers as the dialect's tool does
    #[arg(long, conflicts_with = "quiet")]
    pub echo: bool,
    /// Stop at the first error
    #[arg(long, conflicts_with = "lenient")]
    pub strict: bool,
    /// End with exit code 0 whatever happened
    #[arg(long)]
    pub lenient: bool,
    /// Read the scripts in these files and folders without running them
    #[arg(long, value_name = "PATH", num_args = 1.., conflicts_with = "script")]
    pub parse_only: Vec<PathBuf>,
    /// What scripts may do
    #[command(flatten)]
    pub freedom: Freedom,
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

/// Arguments of `gapi new`.
#[derive(Debug, Args)]
#[command(after_help = "\
Columns are matched with variables of the model by their names; ranges of parameters are those of the
model, or a decade around its values. Every guess is a commented line of the file.

Examples:
  gapi new curve.csv --model Curve.mo
  gapi new curve.csv --model models --class CaseStudies.PolarizationCurve --output fit.toml

Exit code: 0 if the file was written, 1 if an error happened, 2 for a wrong command line.")]
pub(super) struct NewArgs {
    /// The measured data (CSV, text of an instrument, MAT, XLSX)
    #[arg(value_hint = ValueHint::FilePath)]
    pub data: PathBuf,
    /// The Modelica file or folder, or a class of a library
    #[arg(long, value_name = "FILE|CLASS", value_hint = ValueHint::AnyPath)]
    pub model: PathBuf,
    /// The class, if the file holds several
    #[arg(long, value_name = "CLASS")]
    pub class: Option<String>,
    /// The problem file to write [default: the name of the data with .toml]
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
}

/// Arguments of `gapi test`.
#[derive(Debug, Args)]
#[command(after_help = "\
A script is compared with the transcript NAME.mos.snap beside it, or with the lines between
`// Result:` and `// endResult` in it. Files that it writes are kept in memory.

Examples:
  gapi test scripts
  gapi test tests/my.mos --accept
  gapi test --review
  gapi test --junit report.xml

Exit code: 0 if all agree, 1 if one does not or has nothing to be compared with, 2 for a wrong
command line.")]
pub(super) struct TestArgs {
    /// Scripts, and folders that hold scripts
    #[arg(default_value = ".", value_hint = ValueHint::AnyPath)]
    pub paths: Vec<PathBuf>,
    /// Write the transcripts anew
    #[arg(long, conflicts_with = "review")]
    pub accept: bool,
    /// Ask for each difference whether the new transcript is right
    #[arg(long)]
    pub review: bool,
    /// Write a report that build servers read
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub junit: Option<PathBuf>,
    /// What scripts may do
    #[command(flatten)]
    pub freedom: Freedom,
}

/// Arguments of `gapi repl`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi repl
  gapi repl --dialect openmodelica --library ~/libraries

`:help` lists the commands of the prompt.")]
pub(super) struct ReplArgs {
    /// Folder for results and figures
    #[arg(long, default_value = "results/repl", value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: PathBuf,
    /// A script to run first
    #[arg(value_hint = ValueHint::FilePath)]
    pub script: Option<PathBuf>,
    /// What scripts may do
    #[command(flatten)]
    pub freedom: Freedom,
}

/// Arguments of `gapi help`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi help simulateModel
  gapi help --compat
  gapi help --compat dymola")]
pub(super) struct HelpArgs {
    /// A command of scripts; without it, all are listed
    pub name: Option<String>,
    /// What other tools' scripts may expect: supported, partial, absent, and the difference
    #[arg(long, value_enum, value_name = "DIALECT", num_args = 0..=1)]
    pub compat: Option<Option<DialectName>>,
    /// The declarations of all commands as a chapter of the guide
    #[arg(long, conflicts_with_all = ["name", "compat"])]
    pub reference: bool,
    /// The operators of the genetic algorithm, their settings and sources; a KIND alone: `crossover`
    #[arg(long, value_name = "KIND", num_args = 0..=1, conflicts_with_all = ["name", "compat", "reference"])]
    pub operators: Option<Option<String>>,
}

/// What follows the options of `gapi identify --help`.
const IDENTIFY_EXAMPLES: &str = "\
Examples:
  gapi identify scripts/problems/polarization.toml
  gapi identify scripts/problems/polarization.toml --out fit1 --threads 2
  gapi identify one.toml two.toml              compare two models of the same data
  gapi identify my.toml --resume               go on after Ctrl-C, a crash or a power cut
  gapi identify my.toml --watch settings.toml  change settings while it runs

A problem file:
  model = \"CaseStudies.PolarizationCurve(i_max = 1.46)\"
  [parameters]
  A = { min = 0.01, max = 0.1 }
  R = { min = 0.01, max = 1, scale = \"log\" }
  [[experiment]]
  data = \"curve.csv\"
  x = \"i\"
  outputs = { V = \"V\" }
  [method]
  crossover = { name = \"sbx\", eta = 5 }
";

/// The examples, and the operators that the tables have.
fn identify_help() -> String {
    let list = |kind: &operators::Kind| {
        let names: Vec<&str> = (kind.entries)().iter().map(|entry| entry.name).collect();
        format!("  {:10} {}\n", kind.name, names.join(", "))
    };
    let operators: String = operators::KINDS.iter().map(list).collect();
    format!(
        "{IDENTIFY_EXAMPLES}\nOperators of [method], or functions in Modelica (gapi help --operators):\n\
         {operators}\n\
         Exit code: 0 if all went well, 1 if an error happened, 2 for a wrong command line, 130 if\n\
         interrupted."
    )
}

/// Arguments of `gapi identify`.
#[derive(Debug, Args)]
#[command(after_help = identify_help())]
pub(super) struct IdentifyArgs {
    /// The problem (.toml)
    #[arg(value_hint = ValueHint::FilePath)]
    pub problem: PathBuf,
    /// Further problems of the same data: the models are compared
    #[arg(value_hint = ValueHint::FilePath)]
    pub others: Vec<PathBuf>,
    /// Folder for results, figures and the checkpoint [default: one for each problem below `results`]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Replace the results of another problem in that folder
    #[arg(long)]
    pub overwrite: bool,
    /// Threads to use [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Go on from the checkpoint in the folder
    #[arg(long, conflicts_with = "fresh")]
    pub resume: bool,
    /// Discard the checkpoint in the folder
    #[arg(long)]
    pub fresh: bool,
    /// End after so many evaluations
    #[arg(long, value_name = "N")]
    pub evaluations: Option<u64>,
    /// Profile likelihoods of the parameters after the fit
    #[arg(long)]
    pub profile: bool,
    /// After the fit, which further measurements would shrink the intervals most
    #[arg(long)]
    pub design: bool,
    /// After the fit, intervals by fits to data drawn anew
    #[arg(long)]
    pub bootstrap: bool,
    /// After the fit, the posterior distribution by Markov chains
    #[arg(long)]
    pub posterior: bool,
    /// First analyse how much each parameter matters: `morris` or `sobol`
    #[arg(long, value_name = "WAY")]
    pub sensitivity: Option<String>,
    /// Base samples of that analysis [default: 20 for morris, 512 for sobol]
    #[arg(long, value_name = "N", requires = "sensitivity", value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub samples: Option<u32>,
    /// A file with settings (name = number) that may change while it runs
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub watch: Option<PathBuf>,
    /// A progress bar only, no live view of the run (shown on a terminal after a second)
    #[arg(long)]
    pub plain: bool,
    /// Show errors only
    #[arg(long, short)]
    pub quiet: bool,
    /// When to stop
    #[command(flatten)]
    pub limits: Limits,
}

/// Arguments of `gapi teach`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi teach scripts/GAPILib.mos
  gapi teach scripts/GAPILib.mos --generation 100 --count 2
  gapi teach scripts/twin/GAPILib.mos --html steps.html
  gapi teach scripts/lessons/07_elites.mos --quiz
  gapi teach scripts/twin/GAPILib.mos --what-if \"F_Mut := 0.5\" --generation 10
  gapi run my.mos --trace my.trace && gapi teach my.trace")]
pub(super) struct TeachArgs {
    /// A script (.mos), which is run first, or a trace that `gapi run --trace` has written
    #[arg(value_name = "SCRIPT|TRACE", value_hint = ValueHint::FilePath)]
    pub input: PathBuf,
    /// Print the steps as text, also on a terminal
    #[arg(long)]
    pub plain: bool,
    /// Ask what will happen before it is told, and count the right answers
    #[arg(long, conflicts_with = "html")]
    pub quiz: bool,
    /// Run once more with this statement carried out at the generation to begin with, and compare
    #[arg(long, value_name = "STATEMENT", conflicts_with_all = ["html", "quiz"])]
    pub what_if: Option<String>,
    /// The generation to begin with
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = at_least_one)]
    pub generation: usize,
    /// How many generations to print as text
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = at_least_one)]
    pub count: usize,
    /// Write a picture of the generation to begin with and the next one (SVG), in place of the text
    #[arg(long, value_name = "FILE", conflicts_with_all = ["html", "quiz", "what_if"], value_hint = ValueHint::FilePath)]
    pub svg: Option<PathBuf>,
    /// Write one page with all steps, for any browser, in place of the text
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub html: Option<PathBuf>,
    /// Folder for the results and the trace of the run [default: one for each script below `results`]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Replace the results of another problem in that folder
    #[arg(long)]
    pub overwrite: bool,
}

/// Arguments of `gapi lesson`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi lesson
  gapi lesson 1

Each lesson is a script of a page, with its text in the comments. It is copied into the folder
`lessons`, shown, and run. Change the copy and give the command again: your copy is run then.")]
pub(super) struct LessonArgs {
    /// The number of the lesson; without it all are listed
    #[arg(value_name = "N")]
    pub number: Option<usize>,
    /// Folder for the copies and what they write
    #[arg(long, default_value = "lessons", value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
}

/// Arguments of `gapi simulate`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi simulate models --model CaseStudies.PolarizationCurve --output curve.csv
  gapi simulate Decay.mo --model Decay --stop-time 5 --intervals 50 --set k=2
  gapi simulate Decay.mo --model Decay --stats --plot x --figure x.svg
  gapi simulate Decay.mo --model Decay --from first.mat --stop-time 10 --output second.mat
  gapi simulate Decay.mo --model Decay --dump eliminate_aliases

What the command line does not say comes from the model's experiment annotation.")]
pub(super) struct SimulateArgs {
    /// Modelica files, or folders with packages, and the class: what is found by name need not be
    /// given
    #[arg(required_unless_present = "model", value_name = "FILE|CLASS", value_hint = ValueHint::AnyPath)]
    pub files: Vec<PathBuf>,
    /// The class to simulate; it may carry a modification: 'M(p = 2)'
    #[arg(long, value_name = "CLASS")]
    pub model: Option<String>,
    /// Start of the simulation in seconds
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    pub start_time: Option<f64>,
    /// End of the simulation in seconds
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    pub stop_time: Option<f64>,
    /// Number of output intervals
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub intervals: Option<u32>,
    /// Relative tolerance
    #[arg(long, value_name = "E")]
    pub tolerance: Option<f64>,
    /// Integration method
    #[arg(long, value_name = "M")]
    pub method: Option<String>,
    /// Give a parameter a value (repeatable)
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = name_and_value)]
    pub set: Vec<(String, f64)>,
    /// Begin with the states and parameters at the end of these results, or at --start-time
    #[arg(long, value_name = "FILE.mat|.csv", value_hint = ValueHint::FilePath)]
    pub from: Option<PathBuf>,
    /// Where the trajectories go; the ending decides the format
    #[arg(long, short, value_name = "FILE.mat|.csv", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
    /// Keep only the variables whose whole names match
    #[arg(long, value_name = "REGEX")]
    pub variable_filter: Option<String>,
    /// Print the system after a pass instead of simulating it
    #[arg(long, value_name = "PASS", value_parser = pass_names())]
    pub dump: Option<String>,
    /// Print what the simulation cost
    #[arg(long)]
    pub stats: bool,
    /// Stop where events would follow each other without end, instead of sliding or resting there
    #[arg(long)]
    pub no_sliding: bool,
    /// Draw a variable over time, in the terminal or as --figure says (repeatable)
    #[arg(long, value_name = "VARIABLE")]
    pub plot: Vec<String>,
    /// Where the drawing of --plot goes: a file that ends in .svg, .png or .pdf
    #[arg(long, value_name = "FILE", requires = "plot", value_hint = ValueHint::FilePath)]
    pub figure: Option<PathBuf>,
    /// When to stop
    #[command(flatten)]
    pub limits: Limits,
}

/// The passes whose system can be shown, the flat model as the first.
fn pass_names() -> clap::builder::PossibleValuesParser {
    let value = |name, what| clap::builder::PossibleValue::new(name).help(what);
    let passes =
        crate::script::models::simulation::PASSES.iter().map(|pass| value(pass.name, pass.what));
    std::iter::once(value("flatten", "the flat model")).chain(passes).collect::<Vec<_>>().into()
}

/// Arguments of `gapi check`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi check models/CaseStudies
  gapi check models --model CaseStudies.PolarizationCurve
  gapi check --library ~/libraries Modelica.Blocks.Examples.PID_Controller")]
pub(super) struct CheckArgs {
    /// Modelica files, or folders with packages; or the class
    #[arg(required_unless_present = "model", value_name = "FILE|CLASS", value_hint = ValueHint::AnyPath)]
    pub files: Vec<PathBuf>,
    /// The class to check as a model
    #[arg(long, value_name = "CLASS")]
    pub model: Option<String>,
    /// When to stop
    #[command(flatten)]
    pub limits: Limits,
}

/// Arguments of `gapi flatten`.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  gapi flatten models --model CaseStudies.PolarizationCurve")]
pub(super) struct FlattenArgs {
    /// Modelica files, or folders with packages, and the class: what is found by name need not be
    /// given
    #[arg(required_unless_present = "model", value_name = "FILE|CLASS", value_hint = ValueHint::AnyPath)]
    pub files: Vec<PathBuf>,
    /// The class to flatten
    #[arg(long, value_name = "CLASS")]
    pub model: Option<String>,
    /// When to stop
    #[command(flatten)]
    pub limits: Limits,
}

/// Arguments of `gapi report`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi report results
  gapi report results --output fit.html

It reads result.json, history.csv and individuals.csv, as `gapi run` and `gapi identify` have
written them; in a folder of several problems those that were written last.

Exit code: 0 if the report was written, 1 if a file is missing or damaged.")]
pub(super) struct ReportArgs {
    /// The folder with the results of `gapi run` or `gapi identify`
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
    /// The page [default: report.html in the folder]
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
}

/// Arguments of `gapi compare`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi compare result.mat reference.csv
  gapi compare result.csv reference.csv --signals comparisonSignals.txt --tolerance 0.001

A signal agrees where it stays inside the tube that a rectangle sweeps along the reference. Half of
its sides are the tolerance times the reference's extent in time and in value.

Exit code: 0 if all signals agree, 1 if one does not or a file cannot be read.")]
pub(super) struct CompareArgs {
    /// The results (.mat or .csv)
    #[arg(value_name = "RESULT", value_hint = ValueHint::FilePath)]
    pub result: PathBuf,
    /// The reference results (.mat or .csv)
    #[arg(value_name = "REFERENCE", value_hint = ValueHint::FilePath)]
    pub reference: PathBuf,
    /// A file that names the signals to compare, one a line [default: all of the reference]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub signals: Option<PathBuf>,
    /// Half width and half height of the tube, relative to the reference's extent
    #[arg(long, value_name = "E", default_value_t = TUBE_TOLERANCE)]
    pub tolerance: f64,
}

/// Arguments of `gapi verify`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi verify --library ~/libraries --references ~/references
  gapi verify Decay.mo --references references --filter Decay --output table.json

A case is a folder of the collection that holds NAME.csv with the folder's own name, and perhaps
comparisonSignals.txt; its path below the collection is the name of the model.

Exit code: 0 if every case that has a reference agrees, 1 otherwise.")]
pub(super) struct VerifyArgs {
    /// Modelica files, or folders with packages, beside those of --library
    #[arg(value_name = "FILE", value_hint = ValueHint::AnyPath)]
    pub files: Vec<PathBuf>,
    /// The collection of reference results
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub references: PathBuf,
    /// Only models whose names contain this text
    #[arg(long, value_name = "TEXT")]
    pub filter: Option<String>,
    /// Half width and half height of the tubes, relative to the reference's extent
    #[arg(long, value_name = "E", default_value_t = TUBE_TOLERANCE)]
    pub tolerance: f64,
    /// Seconds that a case may take
    #[arg(long, value_name = "S", default_value_t = 60.0, value_parser = seconds)]
    pub budget: f64,
    /// Threads to use [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Where the table goes besides (repeatable); the ending decides the format
    #[arg(long, short, value_name = "FILE.json|.csv", value_hint = ValueHint::FilePath)]
    pub output: Vec<PathBuf>,
}

/// Arguments of `gapi explain`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi explain unknown-class
  gapi explain")]
pub(super) struct ExplainArgs {
    /// The code, as it stands in brackets behind `error`; without it, all codes are listed
    pub code: Option<String>,
}

/// Arguments of `gapi completions`.
#[derive(Debug, Args)]
#[command(after_help = "\
Example:
  gapi completions bash > ~/.local/share/bash-completion/completions/gapi")]
pub(super) struct CompletionsArgs {
    /// The shell
    pub shell: clap_complete::Shell,
}

fn at_least_one(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|&number| number > 0).ok_or_else(|| "expected 1, 2, ...".to_owned())
}

fn seconds(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| format!("`{text}` is not a number"))?;
    let is_good = number > 0.0 && number <= 1e9;
    if is_good { Ok(number) } else { Err("expected a positive number".to_owned()) }
}

fn name_and_value(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE")?;
    let value = match value.trim() {
        "true" => 1.0,
        "false" => 0.0,
        number => number.parse().map_err(|_| format!("`{number}` is not a number"))?,
    };
    Ok((name.trim().to_owned(), value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn settings_are_names_with_numbers() {
        assert_eq!(name_and_value("a.b = -1e3"), Ok(("a.b".to_owned(), -1e3)));
        assert_eq!(name_and_value("on=true"), Ok(("on".to_owned(), 1.0)));
        assert!(name_and_value("a").is_err());
        assert!(name_and_value("a=x").is_err());
    }
}
