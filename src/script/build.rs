//! Puts the packages of `models` and the lessons of `scripts/lessons` into the program: writes the
//! tables that `packages.rs` and `lessons/shipped.rs` read. `shipped` has links to both folders, which
//! `cargo package` follows.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    embed("shipped/models", "models.rs")?;
    embed("shipped/lessons", "lessons.rs")
}

/// Writes a table of the files below a folder of the crate: their paths below it, and their bytes.
fn embed(folder: &str, table_name: &str) -> io::Result<()> {
    let variable = |name| env::var_os(name).map(PathBuf::from).ok_or(io::ErrorKind::NotFound);
    let root = variable("CARGO_MANIFEST_DIR")?.join(folder);
    // Cargo does not follow a link to what has changed.
    println!("cargo::rerun-if-changed={}", fs::canonicalize(&root)?.display());
    let mut files = Vec::new();
    collect(&root, &mut files)?;
    files.sort();
    let mut table = String::from("&[\n");
    for file in &files {
        let parts = file.strip_prefix(&root).unwrap_or(file).iter();
        let name: Vec<_> = parts.map(|part| part.to_string_lossy()).collect();
        let name = name.join("/");
        // Where the project is now, not where it was when this ran: it may be moved.
        let path = format!("/{folder}/{name}");
        let _ = writeln!(
            table,
            "({name:?}, include_bytes!(concat!(env!(\"CARGO_MANIFEST_DIR\"), {path:?}))),"
        );
    }
    table.push(']');
    fs::write(variable("OUT_DIR")?.join(table_name), table)
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
