//! A session for the commands that work on models, and how they tell what is wrong.

use super::args::Global;
use super::terminal::{self, Terminal};
use super::world::SystemWorld;
use crate::diag::Diagnostic;
use crate::name::Name;
use crate::script::Session;
use crate::script::world::World;
use std::path::PathBuf;
use std::process::ExitCode;

/// A session in the system's world with the user's library folders.
pub(super) fn open(global: &Global, world: impl World + 'static) -> Session {
    let mut session = Session::new(Box::new(world));
    for folder in library_folders(global) {
        session.add_library_dir(&folder);
    }
    session
}

/// `--library` first, then `MODELICAPATH`.
fn library_folders(global: &Global) -> Vec<PathBuf> {
    let mut folders = global.library.clone();
    if let Some(path) = std::env::var_os("MODELICAPATH") {
        folders.extend(std::env::split_paths(&path).filter(|p| !p.as_os_str().is_empty()));
    }
    folders
}

/// A session in which these files and folders are loaded, and the names of their classes.
pub(super) fn with_files(
    global: &Global,
    files: &[PathBuf],
) -> Result<(Session, Vec<Name>), ExitCode> {
    let world = SystemWorld::new(Terminal::new(global.color, false), "results".as_ref(), None);
    let world = world.map_err(|error| {
        terminal::eprint(&format!("error: the working directory cannot be read: {error}\n"));
        ExitCode::FAILURE
    })?;
    let mut session = open(global, world);
    let (mut names, mut errors) = (Vec::new(), Vec::new());
    for file in files {
        match session.load_path(file) {
            Ok(loaded) => names.extend(loaded),
            Err(wrong) => errors.extend(wrong),
        }
    }
    if errors.is_empty() { Ok((session, names)) } else { Err(failed(&mut session, errors)) }
}

/// Shows what is wrong.
pub(super) fn failed(session: &mut Session, errors: Vec<Diagnostic>) -> ExitCode {
    errors.into_iter().for_each(|error| session.report(error));
    ExitCode::FAILURE
}
