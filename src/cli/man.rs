//! `gapi man`: the manual pages of the program and its commands.

use super::terminal;
use crate::script::access::faults::cannot;
use clap::Args;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Arguments of `gapi man`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  gapi man | man -l -
  gapi man --out ~/.local/share/man/man1

Exit code: 0 on success, 1 on an error, 2 for an invalid command line.")]
pub(super) struct ManArgs {
    /// Write the pages of all commands to this folder; without it, the one of `gapi` is printed
    #[arg(long, value_name = "DIR", value_hint = clap::ValueHint::DirPath)]
    pub out: Option<PathBuf>,
}

/// Prints the page of the program, or writes those of all commands.
pub(super) fn man(arguments: &ManArgs, gapi: clap::Command) -> ExitCode {
    let written = match &arguments.out {
        Some(folder) => write_all(folder, gapi),
        None => page(gapi).map(|page| terminal::print(&page)),
    };
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let folder = arguments.out.as_deref().unwrap_or(Path::new("."));
            let message = cannot("write to", folder, &error).message;
            terminal::eprint(&format!("error: the manual pages are not written: {message}\n"));
            ExitCode::FAILURE
        }
    }
}

fn page(command: clap::Command) -> std::io::Result<String> {
    let mut page = Vec::new();
    clap_mangen::Man::new(command).render(&mut page)?;
    Ok(String::from_utf8_lossy(&page).into_owned())
}

/// A page `gapi.1`, and one `gapi-run.1` for each command.
fn write_all(folder: &Path, gapi: clap::Command) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    clap_mangen::generate_to(gapi, folder)
}
