//! `gapi export`: a problem as files of other programs.

use super::options::Global;
use super::session;
use crate::diag::{Diagnostic, Fault};
use crate::registry::BAD_OPTION;
use crate::script::access::faults::cannot;
use crate::script::runs::problem::petab;
use crate::source::Span;
use clap::{Args, ValueHint};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Arguments of `gapi export`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi export tank.toml --petab tank
  gapi identify tank/problem.yaml

Writes the tables of PEtab (version 2) and the model in Modelica. What PEtab cannot say is an error at its
place in the problem file.

Exit code: 0 if the files were written, 1 on an error, 2 for an invalid command line.")]
pub(super) struct ExportArgs {
    /// The problem file (.toml)
    #[arg(value_hint = ValueHint::FilePath)]
    pub problem: PathBuf,
    /// The folder for the files of PEtab
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub petab: PathBuf,
    /// Replace files that are there with another content
    #[arg(long)]
    pub overwrite: bool,
}

/// Writes the files.
pub(super) fn export(arguments: &ExportArgs, global: &Global) -> ExitCode {
    let mut session = match session::with_files(global, &[]) {
        Ok((session, _)) => session,
        Err(code) => return code,
    };
    session.world.grant_input(&arguments.problem);
    let made = petab(&mut session, &arguments.problem)
        .and_then(|files| write(&files, &arguments.petab, arguments.overwrite));
    match made {
        Ok(()) => {
            let problem = arguments.petab.join("problem.yaml");
            session.print(&format!(
                "written to {}\nrun: gapi identify {}\n",
                arguments.petab.display(),
                problem.display()
            ));
            ExitCode::SUCCESS
        }
        Err(errors) => session::failed(&mut session, errors),
    }
}

/// Writes files into a folder.
///
/// # Errors
///
/// Files that are there with another content.
pub(super) fn write(
    files: &[(String, String)],
    folder: &Path,
    overwrite: bool,
) -> Result<(), Vec<Diagnostic>> {
    let one = |fault: Fault| vec![fault.at(Span::NONE)];
    let paths: Vec<PathBuf> = files.iter().map(|(name, _)| folder.join(name)).collect();
    for (path, (_, content)) in paths.iter().zip(files) {
        let differs = path.exists() && fs::read(path).ok().as_deref() != Some(content.as_bytes());
        if differs && !overwrite {
            let message = format!("`{}` is there with another content", path.display());
            let help = "choose another folder, or add `--overwrite`";
            return Err(one(Fault::new(BAD_OPTION, message).help(help)));
        }
    }
    fs::create_dir_all(folder).map_err(|error| one(cannot("create", folder, &error)))?;
    for (path, (_, content)) in paths.iter().zip(files) {
        fs::write(path, content).map_err(|error| one(cannot("write", path, &error)))?;
    }
    Ok(())
}
