//! `gapi new`: a first problem file from a data file and a model.

use super::options::Global;
use super::session;
use crate::diag::{Diagnostic, Fault};
use crate::registry::BAD_OPTION;
use crate::script::Session;
use crate::script::access::faults::cannot;
use crate::script::access::policy::Grant;
use crate::script::runs::problem::{Draft, DraftOptions, Question, draft};
use crate::source::Span;
use clap::{Args, ValueHint};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Arguments of `gapi new`.
#[derive(Debug, Args)]
#[command(after_help = "\
Columns are matched with model variables by name, unit, description and start value; parameter ranges are \
                        those of the model, or one decade around its values. Every guess is marked by a comment.

Examples:
  gapi new curve.csv --model Curve.mo
  gapi new curve.csv --model models --class CaseStudies.PolarizationCurve --output fit.toml
  gapi new measured.csv --model Pump.fmu

Exit code: 0 if the file was written, 1 on an error, 2 for an invalid command line, 130 if interrupted.")]
pub(super) struct NewArgs {
    /// The measured data (CSV, text file of an instrument, MAT, XLSX)
    #[arg(value_hint = ValueHint::FilePath)]
    pub data: PathBuf,
    /// The Modelica file or folder, a functional mock-up unit (FMU), or a library class
    #[arg(long, value_name = "FILE|CLASS", value_hint = ValueHint::AnyPath)]
    pub model: PathBuf,
    /// The class, if the file contains several
    #[arg(long, value_name = "CLASS")]
    pub class: Option<String>,
    /// The problem file to write [default: the name of the data file with .toml]
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
}

/// Writes the problem file.
pub(super) fn new(arguments: &NewArgs, global: &Global) -> ExitCode {
    let mut session = match session::with_files(global, &[]) {
        Ok((session, _)) => session,
        Err(code) => return code,
    };
    let output = output(arguments);
    // A link that leads nowhere is there, too.
    if session.world.exists(&output) || session.world.is_link(&output) {
        let fault = Fault::new(BAD_OPTION, format!("`{}` already exists", output.display()))
            .help("choose another name with `--output`, or remove it");
        return session::failed(&mut session, vec![fault.at(Span::NONE)]);
    }
    session.world.grant(Grant::Named(&output));
    session.world.grant_input(&arguments.data);
    session.world.grant_input(&arguments.model);
    let options = options(arguments, &output);
    let drafted =
        draft(&mut session, &options).and_then(|draft| answered(&mut session, options, draft));
    if session.is_interrupted() {
        // The question was not answered: a file with a guess is not what the user asked for.
        return session::stopped(&mut session);
    }
    match drafted.and_then(|draft| write(&mut session, &output, draft)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(errors) => session::failed(&mut session, errors),
    }
}

/// The file that was asked for, else the data's name with another ending, in the working directory.
fn output(arguments: &NewArgs) -> PathBuf {
    let name = || arguments.data.with_extension("toml").file_name().map(PathBuf::from);
    arguments.output.clone().or_else(name).unwrap_or_else(|| PathBuf::from("problem.toml"))
}

/// Paths in a problem file are relative to it: as given where it lies in the working directory.
fn options(arguments: &NewArgs, output: &Path) -> DraftOptions {
    let is_here = output.parent().is_none_or(|folder| folder.as_os_str().is_empty());
    let path = |path: &Path| {
        let kept = || Some(path.to_path_buf());
        let full = if is_here { kept() } else { std::path::absolute(path).ok() };
        full.unwrap_or_else(|| path.to_path_buf()).to_string_lossy().into_owned()
    };
    let is_file = arguments.model.exists();
    DraftOptions {
        data: path(&arguments.data),
        models: if is_file { path(&arguments.model) } else { String::new() },
        output: None,
        class: match (&arguments.class, is_file) {
            (Some(class), _) => class.clone(),
            (None, true) => String::new(),
            (None, false) => arguments.model.to_string_lossy().into_owned(),
        },
    }
}

/// On a terminal, asks what is open, and drafts again with the answer. Elsewhere the draft says what is
/// a guess.
fn answered(
    session: &mut Session,
    options: DraftOptions,
    draft: Draft,
) -> Result<Draft, Vec<Diagnostic>> {
    let Some(question) = draft.question.as_ref().filter(|_| std::io::stdin().is_terminal()) else {
        return Ok(draft);
    };
    let Question { column, candidates } = question;
    let choices: String =
        candidates.iter().enumerate().map(|(k, name)| format!("  {}  {name}\n", k + 1)).collect();
    session.print(&format!("Which variable does the column `{column}` hold?\n{choices}"));
    let prompt = format!("1 to {} [1]: ", candidates.len());
    let chosen = loop {
        let Some(answer) = session.world.ask(&prompt) else { return Ok(draft) };
        let number = match answer.trim() {
            "" => Ok(1),
            answer => answer.parse::<usize>(),
        };
        let chosen = number.ok().and_then(|number| candidates.get(number.checked_sub(1)?));
        if let Some(chosen) =
            chosen.or_else(|| candidates.iter().find(|name| *name == answer.trim()))
        {
            break chosen.clone();
        }
    };
    self::draft(session, &DraftOptions { output: Some(chosen), ..options })
}

fn write(session: &mut Session, output: &Path, draft: Draft) -> Result<(), Vec<Diagnostic>> {
    let written = session.world.write(output, draft.text.as_bytes());
    written.map_err(|error| vec![cannot("write", output, &error).at(Span::NONE)])?;
    let name = output.display();
    session.print(&format!("written to {name}\n"));
    match draft.incomplete {
        None => session
            .print(&format!("check it, correct the ranges, then run: gapi identify {name}\n")),
        Some(why) => session.print(&format!("it cannot run yet: {why}\n")),
    }
    Ok(())
}
