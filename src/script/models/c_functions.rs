//! Functions in C that libraries bring along (MLS §12.9): which are compiled together, where their
//! files are, and whether the user allows them.

use crate::diag::Fault;
use crate::external::Entry;
use crate::external::c::{CCompiler, Declaration, Request, Unit, entry, source};
use crate::external::errors::EXTERNAL_REFUSED;
use crate::fault;
use crate::world::FileReader;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Folders of a library for the system that this program runs on (MLS §13.5.4), the most special
/// first.
const PLATFORM: &str = if cfg!(target_os = "macos") {
    "darwin64"
} else if cfg!(windows) {
    "win64"
} else if cfg!(target_arch = "aarch64") {
    "aarch64-linux"
} else {
    "linux64"
};

/// Where the standard library has its functions in C, which code of others calls.
const STANDARD_SOURCES: &str = "modelica://Modelica/Resources/C-Sources";

/// Where a name of a file or folder, a path or a URI, leads.
type Find<'a> = &'a dyn Fn(&str) -> Option<PathBuf>;

/// The requested function, compiled and loaded.
///
/// # Errors
/// The user has not allowed it, or it cannot be compiled.
pub(super) fn compiled(
    request: &Request,
    compiler: Option<&dyn CCompiler>,
    files: &dyn FileReader,
    find: Find<'_>,
) -> Result<&'static Entry, Fault> {
    let is_allowed = |declaration: &&Declaration| {
        compiler.is_some_and(|compiler| compiler.permits(&declaration.class))
    };
    let mut all = std::iter::once(request.requested()).chain(&request.declarations);
    if let Some(one) = all.find(|one| !is_allowed(one)) {
        return Err(refused(one, files, find));
    }
    let Some(compiler) = compiler else { return Err(refused(request.requested(), files, find)) };
    let library = compiler.load(&unit(&request.declarations, files, find))?;
    Ok(entry(request, &library))
}

fn unit(declarations: &[Declaration], files: &dyn FileReader, find: Find<'_>) -> Unit {
    let standard_sources = find(STANDARD_SOURCES);
    let mut unit = Unit { source: source(declarations), standard_sources, ..Unit::default() };
    let mut seen = BTreeSet::new();
    let mut new = |path: &PathBuf| seen.insert(path.clone());
    for declaration in declarations {
        let folders = include_folders(declaration, files, find).into_iter();
        unit.include_directories.extend(folders.filter(&mut new));
        for library in &declaration.libraries {
            let name = find(library).filter(|path| files.is_file(path));
            let name = name.map_or(library.clone(), |path| path.display().to_string());
            if !unit.libraries.contains(&name) {
                unit.libraries.push(name);
            }
        }
        if let Some(folder) = find(&declaration.library_directory) {
            let folders = [folder.join(PLATFORM), folder];
            unit.library_directories.extend(folders.into_iter().filter(&mut new));
        }
    }
    unit
}

/// Where the files are that a declaration includes: in its folder for them, and, as in libraries from
/// before there was one, in that of the package.
fn include_folders(
    declaration: &Declaration,
    files: &dyn FileReader,
    find: Find<'_>,
) -> Vec<PathBuf> {
    let own = find(&declaration.include_directory);
    let package = declaration.class.split('.').next().unwrap_or_default();
    let package = find(&format!("modelica://{package}/"));
    let is_there = |folder: &Option<PathBuf>, name: &str| {
        folder.as_ref().is_some_and(|folder| files.is_file(&folder.join(name)))
    };
    let is_old =
        declaration.included().any(|name| !is_there(&own, name) && is_there(&package, name));
    own.into_iter().chain(package.filter(|_| is_old)).collect()
}

/// Names the function and every file of the library that would be compiled or linked for it.
fn refused(declaration: &Declaration, files: &dyn FileReader, find: Find<'_>) -> Fault {
    let folders = include_folders(declaration, files, find);
    let mut named: Vec<String> = declaration
        .included()
        .flat_map(|name| folders.iter().map(move |folder| folder.join(name)))
        .filter(|path| files.is_file(path))
        .map(|path| format!("`{}`", path.display()))
        .collect();
    let linked = |library: &String| match find(library).filter(|path| files.is_file(path)) {
        Some(path) => format!("the library `{}`", path.display()),
        None => format!("the library `{library}`"),
    };
    named.extend(declaration.libraries.iter().map(linked));
    if named.is_empty() {
        named.push("its annotation `Include`".to_owned());
    }
    fault!(
        EXTERNAL_REFUSED,
        "`{}` calls the C function `{}` from {}, and C code is not compiled and run without \
         permission",
        declaration.class,
        declaration.function,
        named.join(", ");
        help: "if you trust this library, allow it with `--allow-external={}`: the code can do \
               whatever you can do on this machine",
        declaration.class.split('.').next().unwrap_or_default()
    )
}
