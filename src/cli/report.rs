//! `gapi report`: draws the report of a run again from its files.

use super::options::Global;
use super::output::Output;
use super::terminal::Terminal;
use super::world::SystemWorld;
use super::{output, session, terminal};
use crate::diag::Fault;
use crate::script::Session;
use crate::script::access::faults::cannot;
use crate::script::access::policy::Grant;
use crate::script::runs::problem::{read_shards, solve};
use crate::source::Span;
use clap::{Args, ValueHint};
use gapilib_identify::problem::Solution;
use std::path::Path;
use std::path::PathBuf;
use std::process::ExitCode;

/// Arguments of `gapi report`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi report results
  gapi report results --output fit.html
  gapi report --merge s1 s2 s3 --out study     the report of all shards

It reads result.json, history.csv and individuals.csv, as written by `gapi run` and `gapi \
                        identify`; if the folder holds several results, the most recent one.

Exit code: 0 if the report was written, 1 if a file is missing or damaged.")]
pub(super) struct ReportArgs {
    /// The folder with the results of `gapi run` or `gapi identify`
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    #[arg(required_unless_present = "merge", conflicts_with = "merge")]
    pub folder: Option<PathBuf>,
    /// Merge the shards in these folders, as written by `gapi identify --shard`
    #[arg(long, value_name = "DIR", num_args = 1.., value_hint = ValueHint::DirPath)]
    pub merge: Vec<PathBuf>,
    /// Folder for the merged results [default: that of the problem in `results`]
    #[arg(long, value_name = "DIR", requires = "merge", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// The page [default: report.html in the folder]
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    #[arg(conflicts_with = "merge")]
    pub output: Option<PathBuf>,
}

/// Reads the folder and writes the page.
pub(super) fn report(arguments: &ReportArgs, global: &Global) -> ExitCode {
    let Some(folder) = &arguments.folder else { return merge(arguments, global) };
    let mut session = match session::with_files(global, &[]) {
        Ok((session, _)) => session,
        Err(code) => return code,
    };
    match draw(&mut session, folder, arguments.output.as_deref()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(fault) => session::failed(&mut session, vec![fault.at(Span::NONE)]),
    }
}

/// Runs the problem of the shards with what they have computed.
fn merge(arguments: &ReportArgs, global: &Global) -> ExitCode {
    let read = session::with_files(global, &[]).and_then(|(mut session, _)| {
        read_shards(&mut session, &arguments.merge)
            .map_err(|fault| session::failed(&mut session, vec![fault.at(Span::NONE)]))
    });
    let (problem, options) = match read {
        Ok(read) => read,
        Err(code) => return code,
    };
    let refused = |message: String| {
        terminal::eprint(&format!("error: {message}\n"));
        ExitCode::from(2)
    };
    let output = Output::of("gapi identify", &problem, arguments.out.as_deref(), false);
    let world = output.and_then(|output| {
        let world = SystemWorld::for_results(Terminal::new(global.color, false), output, None);
        world.map_err(|error| error.to_string())
    });
    let world = match world {
        Ok(world) => world,
        Err(message) => return refused(message),
    };
    world.catch_interrupts();
    let mut session = session::open(global, world);
    match solve(&mut session, &problem, &options) {
        Ok(_) if session.is_interrupted() => session::stopped(&mut session),
        Ok(_) => ExitCode::SUCCESS,
        Err(errors) => session::failed(&mut session, errors),
    }
}

fn draw(session: &mut Session, folder: &Path, page: Option<&Path>) -> Result<(), Fault> {
    let folder = output::latest_of(folder);
    // The page in the folder of the results is no more than the rest of it.
    session.world.grant(Grant::Own(&folder));
    let read = |name: &str| session.world.read_text(&folder.join(name));
    let (json, history) = (read("result.json")?, read("history.csv")?);
    let solution = Solution::read(&json, &history, &read("individuals.csv")?)?;
    page.into_iter().for_each(|page| session.world.permit_file(page));
    let page = page.map_or_else(|| folder.join("report.html"), Path::to_owned);
    session.print(&solution.text());
    write(session, &page, &solution)?;
    session.print(&format!("\n  written to {}\n", page.display()));
    Ok(())
}

fn write(session: &mut Session, page: &Path, solution: &Solution) -> Result<(), Fault> {
    let written = session.world.write(page, solution.html().as_bytes());
    written.map_err(|error| cannot("write", page, &error))
}
