//! `gapi report`: draws the report of a run again from its files.

use super::options::Global;
use super::{output, session};
use crate::diag::Fault;
use crate::identify::problem::Solution;
use crate::script::Session;
use crate::script::access::policy::Grant;
use crate::source::Span;
use clap::{Args, ValueHint};
use std::path::Path;
use std::path::PathBuf;
use std::process::ExitCode;

/// Arguments of `gapi report`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi report results
  gapi report results --output fit.html

It reads result.json, history.csv and individuals.csv, as written by `gapi run` and `gapi \
                        identify`; in a folder with several problems, the files written last.

Exit code: 0 if the report was written, 1 if a file is missing or damaged.")]
pub(super) struct ReportArgs {
    /// The folder with the results of `gapi run` or `gapi identify`
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
    /// The page [default: report.html in the folder]
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
}

/// Reads the folder and writes the page.
pub(super) fn report(arguments: &ReportArgs, global: &Global) -> ExitCode {
    let mut session = match session::with_files(global, &[]) {
        Ok((session, _)) => session,
        Err(code) => return code,
    };
    match draw(&mut session, arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(fault) => session::failed(&mut session, vec![fault.at(Span::NONE)]),
    }
}

fn draw(session: &mut Session, arguments: &ReportArgs) -> Result<(), Fault> {
    let folder = output::latest_of(&arguments.folder);
    session.world.grant(Grant::Read(&folder));
    let read = |name: &str| session.read_text(&folder.join(name));
    let (json, history) = (read("result.json")?, read("history.csv")?);
    let solution = Solution::read(&json, &history, &read("individuals.csv")?)?;
    let page = arguments.output.clone().unwrap_or_else(|| folder.join("report.html"));
    session.world.grant(Grant::Named(&page));
    session.print(&solution.text());
    write(session, &page, &solution)?;
    session.print(&format!("\n  written to {}\n", page.display()));
    Ok(())
}

fn write(session: &mut Session, page: &Path, solution: &Solution) -> Result<(), Fault> {
    let written = session.world.write(page, solution.html().as_bytes());
    written.map_err(|error| {
        let message = format!("`{}` cannot be written: {error}", page.display());
        Fault::new(crate::registry::BAD_OPTION, message)
    })
}
