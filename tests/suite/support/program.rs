//! The program as a user starts it.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

/// A straight line.
pub(crate) const LINE: &str = "model Line input Real x; parameter Real a = 1; parameter Real b = 1; \
                               output Real y; equation y = a + b*x; end Line;\n";

/// A working directory with these files.
pub(crate) fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

pub(crate) fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gapi"));
    command.args(arguments).current_dir(folder).env_remove("NO_COLOR").env_remove("MODELICAPATH");
    command
}

/// Whether a run succeeded, and all that it wrote.
pub(crate) fn written(folder: &Path, arguments: &[&str]) -> (bool, String) {
    let Output { status, stdout, stderr } = command(folder, arguments).output().unwrap();
    let text = [stdout, stderr].map(|bytes| String::from_utf8(bytes).unwrap()).concat();
    (status.success(), text)
}

/// What a run left: exit code, standard output, standard error.
pub(crate) fn gapi(folder: &TempDir, arguments: &[&str]) -> (i32, String, String) {
    let Output { status, stdout, stderr } = command(folder.path(), arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (status.code().expect("ended by itself"), text(stdout), text(stderr))
}
