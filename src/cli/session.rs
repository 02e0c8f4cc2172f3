//! A session for the commands that work on models, and how they report what is wrong.

use super::options::{ALL_LIBRARIES, EVERYWHERE, Global};
use super::terminal::{self, Terminal};
use super::world::SystemWorld;
use super::{cache_folder, translations};
use crate::diag::{Diagnostic, Fault, suggest};
use crate::name::Name;
use crate::script::Session;
use crate::script::access::policy::Grant;
use crate::script::errors::LIMIT_REACHED;
use crate::script::world::World;
use crate::source::Span;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// A session in the system's world with the user's library folders.
pub(super) fn open(global: &Global, world: impl World + 'static) -> Session {
    let mut session = Session::new(Box::new(world));
    for folder in library_folders(global) {
        session.world.grant(Grant::Read(&folder));
        // What lies in a package is not at the top level.
        if !offer_neighbours(&mut session, &folder) {
            session.add_library_dir(&folder);
        }
    }
    let current = session.world.current_dir();
    session.world.grant_models(&current);
    for folder in cache_folder::closed() {
        session.world.grant(Grant::Deny(&folder));
    }
    grant_asked(&mut session, global);
    if !global.no_cache {
        session.storage = translations::of_the_user();
    }
    session
}

/// Makes what lies beside the folder of a package loadable by name: libraries that come together
/// use each other (`Modelica` needs `ModelicaServices`). Whether the folder is one of a package.
fn offer_neighbours(session: &mut Session, package: &Path) -> bool {
    if !package.join("package.mo").is_file() {
        return false;
    }
    let package = session.world.absolute(package);
    let Some(folder) = package.parent() else { return false };
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.join("package.mo").is_file() || path.extension().is_some_and(|e| e == "mo") {
            session.world.grant(Grant::Found(&path));
        }
    }
    session.add_library_dir(folder);
    session.add_package_dir(&package);
    true
}

/// What the options allow and exclude.
fn grant_asked(session: &mut Session, global: &Global) {
    for folder in &global.allow_read {
        match folder == Path::new(EVERYWHERE) {
            true => session.world.grant(Grant::ReadAll),
            false => session.world.grant(Grant::Read(folder)),
        }
    }
    if global.allow_write {
        session.world.grant(Grant::WriteAll);
    }
    for library in &global.allow_external {
        let is_path = Path::new(library).components().count() > 1;
        match library.as_str() {
            ALL_LIBRARIES => session.world.grant(Grant::ExternalCode(None)),
            path if is_path => session.world.grant(Grant::ExternalFile(Path::new(path))),
            name => session.world.grant(Grant::ExternalCode(Some(name))),
        }
    }
    for folder in &global.deny_read {
        session.world.grant(Grant::Deny(folder));
    }
    for name in &global.allow_env {
        session.world.allow_variable(name);
    }
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
    with_files_in(world(global)?, global, files)
}

/// The world of a command that has no folder of results.
pub(super) fn world(global: &Global) -> Result<SystemWorld, ExitCode> {
    let world = SystemWorld::new(Terminal::new(global.color, false), "results".as_ref(), None);
    world.map_err(|error| {
        terminal::eprint(&format!("error: {error}\n"));
        ExitCode::FAILURE
    })
}

pub(super) fn with_files_in(
    world: SystemWorld,
    global: &Global,
    files: &[PathBuf],
) -> Result<(Session, Vec<Name>), ExitCode> {
    let mut session = open(global, world);
    let (mut names, mut errors) = (Vec::new(), Vec::new());
    for file in files {
        session.world.grant_input(file);
        offer_neighbours(&mut session, file);
        match session.load_path(file) {
            Ok(loaded) => names.extend(loaded),
            Err(wrong) => errors.extend(wrong),
        }
    }
    if errors.is_empty() { Ok((session, names)) } else { Err(failed(&mut session, errors)) }
}

/// The class that is meant and the files: the class is what `--model` names, or else the argument
/// that is not a file and reads as the name of a class.
pub(super) fn class_and_files(
    model: Option<&String>,
    files: &[PathBuf],
) -> (Option<String>, Vec<PathBuf>) {
    let mut files = files.to_vec();
    let named = match model {
        Some(_) => None,
        None => files.iter().position(|file| !file.exists() && is_class(&file.to_string_lossy())),
    };
    let named = named.map(|at| files.remove(at).to_string_lossy().into_owned());
    (model.cloned().or(named), files)
}

/// A session in which these files are loaded, and the class that is meant.
pub(super) fn with_class(
    world: SystemWorld,
    global: &Global,
    model: Option<&String>,
    files: &[PathBuf],
) -> Result<(Session, String), ExitCode> {
    let (class, files) = class_and_files(model, files);
    let (session, names) = with_files_in(world, global, &files)?;
    // The only class of the files need not be named.
    let only = if let [only] = &names[..] { Some(only.to_string()) } else { None };
    let class = class.or(only).ok_or_else(|| {
        let names: Vec<String> = names.iter().map(Name::to_string).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let known = match names.as_slice() {
            [] => String::new(),
            names => format!(": the files define {}", suggest::listed(names)),
        };
        terminal::eprint(&format!(
            "error: which class?\n = help: write its name, or `--model CLASS`{known}\n"
        ));
        ExitCode::from(2)
    })?;
    Ok((session, class))
}

/// Whether a text reads as `Package.Class` or `Class(modification)`, not as the name of a file.
pub(super) fn is_class(text: &str) -> bool {
    let name = text.split('(').next().unwrap_or_default();
    let is_identifier = |part: &str| {
        part.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
            && part.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
    };
    let ending = name.rsplit('.').next().unwrap_or_default();
    name.split('.').all(is_identifier) && !["fmu", "mo", "mos"].contains(&ending)
}

/// Lists what scripts and models may do, if that is asked for: then nothing else is done.
pub(super) fn lists_permissions(session: &mut Session, global: &Global) -> bool {
    if global.show_permissions {
        let text = session.world.listed_permissions();
        session.print(&text);
    }
    global.show_permissions
}

/// Shows what is wrong.
pub(super) fn failed(session: &mut Session, errors: Vec<Diagnostic>) -> ExitCode {
    errors.into_iter().for_each(|error| session.report(error));
    ExitCode::FAILURE
}

/// How a run ends that was stopped: by a limit, which is an error, or by the user.
pub(super) fn stopped(session: &mut Session) -> ExitCode {
    match session.world.stop_reason() {
        Some(reason) => failed(session, vec![Fault::new(LIMIT_REACHED, reason).at(Span::NONE)]),
        None => ExitCode::from(130),
    }
}
