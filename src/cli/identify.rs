//! `gapi identify`: solves a problem that is written in a file.

use super::options::{Global, Limits};
use super::output::Output;
use super::terminal::{self, Terminal};
use super::world::SystemWorld;
use super::{import, limits, session};
use crate::ga::operators;
use crate::script::access::policy::Grant;
use crate::script::runs::problem::{Division, RunOptions, solve};
use clap::{Args, ValueHint};
use gapilib_identify::problem::{Shard, Solution};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// The folder in the results for the files that a problem in PEtab becomes.
const IMPORTED: &str = "imported";
/// What follows the options of `gapi identify --help`.
const IDENTIFY_EXAMPLES: &str = "\
Examples:
  gapi identify scripts/problems/polarization.toml
  gapi identify scripts/problems/polarization.toml --out fit1 --threads 2
  gapi identify one.toml two.toml              compare two models of the same data
  gapi identify my.toml --resume               resume after Ctrl-C, a crash or a power failure
  gapi identify my.toml --watch settings.toml  change settings while it runs
  gapi identify petab.yaml                     import a problem in PEtab into its results, and run it
  gapi identify my.toml --bootstrap --shard 3/16 --out s3   one part of a large study

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
    let list = |kind: &operators::OperatorKind| {
        let names: Vec<&str> = (kind.entries)().iter().map(|entry| entry.name).collect();
        format!("  {:10} {}\n", kind.name, names.join(", "))
    };
    let operators: String = operators::KINDS.iter().map(list).collect();
    format!(
        "{IDENTIFY_EXAMPLES}\nOperators of [method], or functions in Modelica (gapi help --operators):\n\
         {operators}\n\
         Exit code: 0 on success, 1 on an error, 2 for an invalid command line, 130 if\n\
         interrupted."
    )
}

/// Arguments of `gapi identify`.
#[derive(Debug, Args)]
#[command(after_help = identify_help())]
pub(super) struct IdentifyArgs {
    /// The problem file (.toml), or a problem in PEtab (.yaml), which is imported first
    #[arg(value_hint = ValueHint::FilePath)]
    pub problem: PathBuf,
    /// Further problem files on the same data, whose models are compared
    #[arg(value_hint = ValueHint::FilePath)]
    pub others: Vec<PathBuf>,
    /// Folder for results, figures and the checkpoint [default: one per problem in `results`]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Overwrite the results of another problem in that folder
    #[arg(long)]
    pub overwrite: bool,
    /// Number of threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Resume from the checkpoint in the folder
    #[arg(long, conflicts_with = "fresh")]
    pub resume: bool,
    /// Discard the checkpoint in the folder
    #[arg(long)]
    pub fresh: bool,
    /// Stop after this number of evaluations
    #[arg(long, value_name = "N", value_parser = super::numbers::whole_number)]
    pub evaluations: Option<u64>,
    /// Run N searches with different seeds and keep the best result
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub searches: Option<u32>,
    /// Compute profile likelihoods of the parameters after the fit
    #[arg(long)]
    pub profile: bool,
    /// After the fit, suggest the additional measurements that would narrow the intervals most (optimal design)
    #[arg(long)]
    pub design: bool,
    /// After the fit, compute intervals by fits to resampled data (bootstrap)
    #[arg(long)]
    pub bootstrap: bool,
    /// After the fit, compute the posterior distribution by Markov chain Monte Carlo
    #[arg(long)]
    pub posterior: bool,
    /// Global sensitivity analysis before the fit: `morris` or `sobol`
    #[arg(long, value_name = "WAY")]
    pub sensitivity: Option<String>,
    /// Base samples of that analysis [default: 20 for morris, 512 for sobol]
    #[arg(long, value_name = "N", requires = "sensitivity", value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub samples: Option<u32>,
    /// Compute shard K of N of a study (searches, bootstrap, profiles, chains); `gapi report --merge` makes the report of all
    #[arg(long, value_name = "K/N", value_parser = shard, conflicts_with_all = ["others", "watch"])]
    pub shard: Option<Shard>,
    /// Read settings (name = number) from this file whenever it changes
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub watch: Option<PathBuf>,
    /// Show a progress bar instead of the live view (which otherwise appears after one second on a terminal)
    #[arg(long)]
    pub plain: bool,
    /// Show only errors
    #[arg(long, short)]
    pub quiet: bool,
    /// Limits
    #[command(flatten)]
    pub limits: Limits,
}

/// `3/16`
fn shard(text: &str) -> Result<Shard, String> {
    let parts = text.split_once('/').map(|(k, n)| (k.trim().parse(), n.trim().parse()));
    match parts {
        Some((Ok(number), Ok(count))) if (1..=count).contains(&number) => {
            Ok(Shard { number, count })
        }
        _ => Err("expected a number of a shard and how many there are, such as 3/16".to_owned()),
    }
}

/// How a run ended.
pub(super) enum Ended {
    Solved(Box<Solution>),
    Not(ExitCode),
}

/// Solves the problem.
pub(super) fn identify(arguments: &IdentifyArgs, global: &Global) -> ExitCode {
    match solve_one(arguments, global, (&arguments.problem, Path::new("")), Instant::now()) {
        Ended::Solved(_) => ExitCode::SUCCESS,
        Ended::Not(code) => code,
    }
}

/// How the problem is run.
fn run_options(arguments: &IdentifyArgs) -> RunOptions {
    RunOptions {
        resume: arguments.resume,
        fresh: arguments.fresh,
        watch: arguments.watch.clone(),
        folder: PathBuf::new(),
        profile: arguments.profile,
        design: arguments.design,
        bootstrap: arguments.bootstrap,
        posterior: arguments.posterior,
        sensitivity: arguments.sensitivity.clone(),
        samples: arguments.samples.unwrap_or(0) as usize,
        evaluations: arguments.evaluations,
        searches: arguments.searches.map(|count| count as usize),
        division: arguments.shard.map_or(Division::Whole, Division::Shard),
    }
}

/// Solves one problem into its folder below `results`, or into `folder` within the given one.
/// The limit of time counts from `started`.
pub(super) fn solve_one(
    arguments: &IdentifyArgs,
    global: &Global,
    (problem, folder): (&Path, &Path),
    started: Instant,
) -> Ended {
    let mut terminal = Terminal::new(global.color, arguments.quiet);
    if arguments.plain {
        terminal.forbid_view();
    }
    let folder = arguments.out.as_ref().map(|out| out.join(folder));
    let output = Output::of("gapi identify", problem, folder.as_deref(), arguments.overwrite);
    let output = match output {
        Ok(output) => output,
        Err(message) => {
            terminal::eprint(&format!("error: {message}\n"));
            return Ended::Not(ExitCode::from(2));
        }
    };
    let of_petab = output.folder.join(IMPORTED);
    let threads = arguments.threads.map(usize::from);
    let world = match SystemWorld::for_results(terminal, output, threads) {
        Ok(world) => world,
        Err(error) => {
            terminal::eprint(&format!("error: {error}\n"));
            return Ended::Not(ExitCode::FAILURE);
        }
    };
    world.catch_interrupts();
    let _watch = match limits::watch(&arguments.limits, started, world.stopping()) {
        Ok(watch) => watch,
        Err(code) => return Ended::Not(code),
    };
    let _unheard = limits::end_unheard(world.stopping());
    let mut session = session::open(global, world);
    let options = run_options(arguments);
    let imported;
    let problem = match import::is_petab(problem) {
        false => problem,
        true => {
            match import::for_run(&mut session, problem, &of_petab) {
                Ok(path) => imported = path,
                Err(errors) => return Ended::Not(session::failed(&mut session, errors)),
            }
            &imported
        }
    };
    session.world.grant_input(problem);
    if let Some(file) = &arguments.watch {
        session.world.grant(Grant::Read(file));
    }
    if session::lists_permissions(&mut session, global) {
        return Ended::Not(ExitCode::SUCCESS);
    }
    match solve(&mut session, problem, &options) {
        Ok(_) if session.is_interrupted() => Ended::Not(session::stopped(&mut session)),
        Ok(solution) => Ended::Solved(Box::new(solution)),
        Err(errors) => Ended::Not(session::failed(&mut session, errors)),
    }
}
