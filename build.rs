//! Puts the packages of `models/` into the program: writes the table that `src/models.rs` reads.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=models");
    let folder = |variable| env::var_os(variable).map(PathBuf::from).ok_or(io::ErrorKind::NotFound);
    let models = folder("CARGO_MANIFEST_DIR")?.join("models");
    let mut files = Vec::new();
    collect(&models, &mut files)?;
    files.sort();
    let mut table = String::from("&[\n");
    for file in &files {
        let parts = file.strip_prefix(&models).unwrap_or(file).iter();
        let name: Vec<_> = parts.map(|part| part.to_string_lossy()).collect();
        let name = name.join("/");
        // Where the project is now, not where it was when this ran: it may be moved.
        let path = format!("/models/{name}");
        let _ = writeln!(
            table,
            "({name:?}, include_bytes!(concat!(env!(\"CARGO_MANIFEST_DIR\"), {path:?}))),"
        );
    }
    table.push(']');
    fs::write(folder("OUT_DIR")?.join("models.rs"), table)
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, files)?;
        } else {
            files.push(path);
        }
    }
    Ok(())
}
