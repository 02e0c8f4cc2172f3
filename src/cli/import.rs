//! `gapi import`: models in SBML and problems in PEtab as files of this program.

use super::options::Global;
use super::{output, session};
use crate::diag::{Diagnostic, Fault};
use crate::registry::BAD_OPTION;
use crate::script::Session;
use crate::script::access::faults::cannot;
use crate::script::access::policy::Grant;
use crate::source::Span;
use clap::{Args, ValueHint};
use gapilib_exchange::{Refusal, petab, sbml};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Arguments of `gapi import`.
#[derive(Debug, Args)]
#[command(after_help = "\
Reads models in SBML (levels 2 and 3) and problems in PEtab (versions 1 and 2). A model becomes a Modelica \
                        file; a problem becomes a Modelica file, a problem file and tables of data, which \
                        `gapi identify` runs. What is not supported is an error at its place.

Examples:
  gapi import model.xml
  gapi import Boehm_JProteomeRes2014.yaml --out boehm
  gapi identify boehm/Boehm_JProteomeRes2014.toml

Exit code: 0 if the files were written, 1 on an error, 2 for an invalid command line.")]
pub(super) struct ImportArgs {
    /// The SBML file (.xml, .sbml) or the PEtab problem (.yaml)
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
    /// The folder to write to [default: the name of the file without its extension]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: Option<PathBuf>,
    /// Replace files that are there with another content
    #[arg(long)]
    pub overwrite: bool,
}

/// Writes the files.
pub(super) fn import(arguments: &ImportArgs, global: &Global) -> ExitCode {
    let mut session = match session::with_files(global, &[]) {
        Ok((session, _)) => session,
        Err(code) => return code,
    };
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.file));
    match imported(&mut session, &arguments.file, &folder, arguments.overwrite) {
        Ok(main) => {
            session.print(&format!("written to {}\n{}\n", folder.display(), next(&main)));
            ExitCode::SUCCESS
        }
        Err(errors) => session::failed(&mut session, errors),
    }
}

/// What can be done with the main file.
fn next(main: &Path) -> String {
    let command =
        if main.extension().is_some_and(|e| e == "toml") { "identify" } else { "simulate" };
    format!("run: gapi {command} {}", main.display())
}

/// Whether a file is a problem in PEtab, by its extension.
pub(super) fn is_petab(file: &Path) -> bool {
    file.extension().is_some_and(|extension| extension == "yaml" || extension == "yml")
}

/// The folder for what is imported from a file, in the working folder.
fn default_folder(file: &Path) -> PathBuf {
    file.file_stem().map_or_else(|| PathBuf::from("imported"), PathBuf::from)
}

/// Imports a problem into a part of its results, which each run makes again; the path of the problem file.
///
/// # Errors
///
/// What is wrong with the file, or not supported.
pub(super) fn for_run(
    session: &mut Session,
    file: &Path,
    folder: &Path,
) -> Result<PathBuf, Vec<Diagnostic>> {
    let path = imported(session, file, folder, true)?;
    session.print(&format!("imported to {}\n", output::shown(folder).display()));
    Ok(path)
}

/// Imports a file into a folder; the path of the problem file or of the model.
///
/// # Errors
///
/// What is wrong with the file, or not supported; files that are there with another content.
fn imported(
    session: &mut Session,
    file: &Path,
    folder: &Path,
    overwrite: bool,
) -> Result<PathBuf, Vec<Diagnostic>> {
    session.world.grant_input(file);
    let text = read(file).map_err(one)?;
    let files = match is_petab(file) {
        true => problem(session, file, &text)?,
        false => {
            let model = sbml::import(&text);
            let model = model.map_err(|refusal| vec![placed(session, file, &text, refusal)])?;
            vec![(format!("{}.mo", model.name), model.text)]
        }
    };
    super::export::write(&files, folder, overwrite)?;
    session.world.grant(Grant::Read(folder));
    Ok(files.first().map_or_else(PathBuf::new, |(name, _)| folder.join(name)))
}

fn one(fault: Fault) -> Vec<Diagnostic> {
    vec![fault.at(Span::NONE)]
}

fn read(path: &Path) -> Result<String, Fault> {
    let bytes = fs::read(path).map_err(|error| cannot("read", path, &error))?;
    String::from_utf8(bytes).map_err(|_| {
        let message = format!("`{}` is not UTF-8", path.display());
        Fault::new(BAD_OPTION, message).help("save it as UTF-8")
    })
}

/// The files of a problem in PEtab.
fn problem(
    session: &mut Session,
    file: &Path,
    text: &str,
) -> Result<Vec<(String, String)>, Vec<Diagnostic>> {
    let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let beside = |name: &str| file.with_file_name(name);
    let mut reading = |name: &str| read(&beside(name));
    let found = petab::import(&name, text, &mut reading);
    let own = found.map_err(|refusal| match refusal.file.as_str() {
        "" => vec![placed(session, file, text, refusal)],
        other => {
            let other = beside(other);
            let text = read(&other).unwrap_or_default();
            vec![placed(session, &other, &text, refusal)]
        }
    })?;
    own.notes.iter().for_each(|note| session.print(&format!("{note}\n")));
    Ok(own.files)
}

/// A refusal at its place in the text of its file.
fn placed(session: &mut Session, file: &Path, text: &str, refusal: Refusal) -> Diagnostic {
    let source = session.sources.add(file.display().to_string(), text);
    refusal.fault.at(Span::new(source, refusal.place.start, refusal.place.end))
}
