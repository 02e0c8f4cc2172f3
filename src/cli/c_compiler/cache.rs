//! Shared objects in the user's cache folder, by the digest of what they were made of. Beside each
//! stands its code, which only this user's program can make: any other object is compiled again.

use super::hex;
use crate::cache_folder;
use crate::diag::Fault;
use crate::disk::read_named;
use crate::external::errors::EXTERNAL_COMPILER;
use crate::fault;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// A file could not be made.
pub(super) fn cannot(error: &io::Error) -> Fault {
    fault!(EXTERNAL_COMPILER, "C code cannot be compiled: {error}";
        help: "the cache folder must be writable: `XDG_CACHE_HOME`, or `.cache` in the home folder")
}

const FOLDER: &str = "external";
/// The ending of the file with the code of an object.
const CODE: &str = "code";

/// The folder, created so that no other user can put anything there.
fn made_folder() -> Result<PathBuf, Fault> {
    cache_folder::made(FOLDER).map_err(|error| cannot(&error))
}

/// A folder to compile in, removed afterwards.
pub(super) struct Scratch(PathBuf);

impl Scratch {
    pub(super) fn new() -> Result<Scratch, Fault> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = made_folder()?.join(format!("build-{}-{number}", std::process::id()));
        // Left by a process of the same number that was killed.
        let _ = fs::remove_dir_all(&path);
        fs::create_dir(&path).map_err(|error| cannot(&error))?;
        Ok(Scratch(path))
    }

    pub(super) fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The shared object of a key, if it is as it was written.
pub(super) fn find(key: &str) -> Option<PathBuf> {
    let object = cache_folder::of(FOLDER)?.join(format!("{key}.so"));
    let written = read_named(&object.with_extension(CODE)).ok()?;
    let code = cache_folder::code(key, &read_named(&object).ok()?)?;
    (hex(&code).as_bytes() == written).then_some(object)
}

/// Keeps a shared object under a key.
pub(super) fn keep(key: &str, made: &Path) -> Result<PathBuf, Fault> {
    let object = made_folder()?.join(format!("{key}.so"));
    let bytes = fs::read(made).map_err(|error| cannot(&error))?;
    fs::rename(made, &object).map_err(|error| cannot(&error))?;
    // Without a key the object is compiled again by the next process.
    if let Some(code) = cache_folder::code(key, &bytes) {
        let own = made.with_extension(CODE);
        fs::write(&own, hex(&code)).map_err(|error| cannot(&error))?;
        fs::rename(&own, object.with_extension(CODE)).map_err(|error| cannot(&error))?;
    }
    Ok(object)
}
