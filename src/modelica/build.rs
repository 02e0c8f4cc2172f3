//! Names the sources of the compiler: programs as bytes are read by what is built from the same ones.

use std::hash::{DefaultHasher, Hasher};
use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let root =
        env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).ok_or(io::ErrorKind::NotFound)?;
    println!("cargo::rerun-if-changed={}", root.display());
    let mut files = Vec::new();
    collect(&root, &mut files)?;
    files.sort();
    let mut sources = DefaultHasher::new();
    for file in files {
        sources.write(file.strip_prefix(&root).unwrap_or(&file).to_string_lossy().as_bytes());
        // A checkout may end lines in another way.
        let text = fs::read_to_string(&file)?;
        text.lines().for_each(|line| sources.write(line.as_bytes()));
    }
    println!("cargo::rustc-env=GAPILIB_SOURCES={:016x}", sources.finish());
    Ok(())
}

/// The Rust files below a folder.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        match path.is_dir() {
            true if path.ends_with("target") => {}
            true => collect(&path, files)?,
            false if path.extension().is_some_and(|extension| extension == "rs") => {
                files.push(path)
            }
            false => {}
        }
    }
    Ok(())
}
