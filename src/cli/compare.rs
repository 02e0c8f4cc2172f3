//! `gapi compare`: results against reference results.

use super::options::Global;
use super::session;
use crate::diag::{Diagnostic, Fault};
use crate::results::{self, Agreement, Compared, ResultTable};
use crate::script::Session;
use crate::script::access::policy::Grant;
use crate::source::Span;
use clap::{Args, ValueHint};
use std::path::Path;
use std::path::PathBuf;
use std::process::ExitCode;

/// Arguments of `gapi compare`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi compare result.mat reference.csv
  gapi compare result.csv reference.csv --signals comparisonSignals.txt --tolerance 0.001

A signal agrees where it stays inside the tube that a rectangle sweeps along the reference. The \
                        half sides of the rectangle are the tolerance times the reference's \
                        range in time and in value.

Exit code: 0 if all signals agree, 1 if one does not or a file cannot be read.")]
pub(super) struct CompareArgs {
    /// The results (.mat or .csv)
    #[arg(value_name = "RESULT", value_hint = ValueHint::FilePath)]
    pub result: PathBuf,
    /// The reference results (.mat or .csv)
    #[arg(value_name = "REFERENCE", value_hint = ValueHint::FilePath)]
    pub reference: PathBuf,
    /// A file with the signals to compare, one per line [default: all of the reference]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub signals: Option<PathBuf>,
    /// Half-width and half-height of the tube, relative to the range of the reference
    #[arg(long, value_name = "E", default_value_t = crate::results::TUBE_TOLERANCE)]
    pub tolerance: f64,
}

/// Compares signal by signal; succeeds if all agree.
pub(super) fn compare(arguments: &CompareArgs, global: &Global) -> ExitCode {
    let mut session = match session::with_files(global, &[]) {
        Ok((session, _)) => session,
        Err(code) => return code,
    };
    let inputs = [Some(&arguments.result), Some(&arguments.reference), arguments.signals.as_ref()];
    for file in inputs.into_iter().flatten() {
        session.world.grant(Grant::Read(file));
    }
    match run(&mut session, arguments) {
        Ok(compared) => {
            session.print(&table(&compared));
            let all_agree = compared.iter().all(Compared::agrees);
            if all_agree { ExitCode::SUCCESS } else { ExitCode::FAILURE }
        }
        Err(error) => session::failed(&mut session, vec![error]),
    }
}

fn run(session: &mut Session, arguments: &CompareArgs) -> Result<Vec<Compared>, Diagnostic> {
    let result = read_results(session, &arguments.result)?;
    let reference = read_results(session, &arguments.reference)?;
    let list = arguments.signals.as_deref().map(|path| session.world.read_text(path)).transpose();
    let list = list.map_err(|fault| fault.at(Span::NONE))?;
    let signals = results::signals_to_compare(&reference, list.as_deref());
    results::compare(&result, &reference, &signals, arguments.tolerance)
        .map_err(|fault| fault.at(Span::NONE))
}

fn read_results(session: &Session, path: &Path) -> Result<ResultTable, Diagnostic> {
    let read = || {
        let format = results::format_of_file(&path.to_string_lossy())?;
        format.read(&session.world.read_bytes(path)?)
    };
    read().map_err(|fault: Fault| {
        fault.help(format!("the file is `{}`", path.display())).at(Span::NONE)
    })
}

/// One line a signal, and how many agree.
fn table(compared: &[Compared]) -> String {
    let width = compared.iter().map(|one| one.signal.chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    for one in compared {
        let verdict = verdict(&one.agreement);
        text.push_str(&format!("{:width$}  {verdict}\n", one.signal));
    }
    let agreed = compared.iter().filter(|one| one.agrees()).count();
    text.push_str(&format!("{agreed} of {} signals agree\n", compared.len()));
    text
}

/// A verdict in words.
pub(super) fn verdict(agreement: &Agreement) -> String {
    match agreement {
        Agreement::Inside => "agrees".to_owned(),
        Agreement::Outside { worst, distance } => format!(
            "differs at {} s: {} is outside [{}, {}] by {} half heights of the tube",
            six_digits(worst.time),
            six_digits(worst.value),
            six_digits(worst.lower),
            six_digits(worst.upper),
            six_digits(*distance)
        ),
        Agreement::Incomplete { covered: Some((first, last)) } => {
            format!("incomplete: the result covers only {first} s to {last} s")
        }
        Agreement::Incomplete { covered: None } => {
            "incomplete: the result has no time points".to_owned()
        }
        Agreement::Missing => "missing from the result".to_owned(),
    }
}

/// Six significant digits, without an exponent where that is shorter.
fn six_digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    let (plain, exponent) = (format!("{rounded}"), format!("{rounded:e}"));
    if plain.len() <= exponent.len() + 3 { plain } else { exponent }
}
