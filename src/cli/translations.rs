//! Translated models in the user's cache folder.
//!
//! A file is written beside its place and moved there when it is whole; its code stands first, which
//! only this user's program can make. What has another code is translated again.
//! Its name is that of the model with the version of this program, so that another version finds
//! nothing. Beyond [`MOST`] bytes what was not used for longest is removed.

use super::cache_folder::{self, LENGTH};
use super::disk::read_named;
use crate::script::world::Store;
use sha2::{Digest, Sha256};
use std::fmt::Write;
use std::fs::{self, File};
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::SystemTime;

/// Bytes that all models take at most.
const MOST: u64 = 1 << 30;
/// Bytes from which keeping a model pays: it took about 0.05 s to translate.
const SMALL: usize = 1 << 16;
/// Seconds after which a file that is being written belongs to a process that is gone.
const FORGOTTEN: u64 = 3600;

/// The models of the user.
#[derive(Debug)]
struct Translations {
    /// What tells this program from another version.
    version: String,
}

/// The models of the user, if there is a place for them.
pub(super) fn of_the_user() -> Option<Arc<dyn Store>> {
    cache_folder::base()?;
    Some(Arc::new(Translations { version: version()? }))
}

const FOLDER: &str = "models";

/// The version of this program; one that is being worked on has another one after every build.
fn version() -> Option<String> {
    let program = fs::metadata(std::env::current_exe().ok()?).ok()?;
    let built = program.modified().ok()?.duration_since(SystemTime::UNIX_EPOCH).ok()?;
    let name = env!("CARGO_PKG_VERSION");
    Some(format!("{name} {} {} {}", std::env::consts::ARCH, program.len(), built.as_nanos()))
}

impl Translations {
    fn file_name(&self, name: &str) -> String {
        let digest = Sha256::digest(format!("{name} {}", self.version));
        digest.iter().fold(String::new(), |mut text, byte| {
            _ = write!(text, "{byte:02x}");
            text
        }) + ".model"
    }

    fn write(&self, name: &str, bytes: &[u8]) -> std::io::Result<()> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let folder = cache_folder::made(FOLDER)?;
        let file_name = self.file_name(name);
        let code = cache_folder::code(&file_name, bytes).ok_or(std::io::ErrorKind::NotFound)?;
        make_room(&folder, bytes.len() as u64);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let beside = folder.join(format!("{}-{number}.part", std::process::id()));
        let mut file = File::create(&beside)?;
        let written = file.write_all(&code).and_then(|()| file.write_all(bytes));
        drop(file);
        let moved = written.and_then(|()| fs::rename(&beside, folder.join(file_name)));
        if moved.is_err() {
            _ = fs::remove_file(&beside);
        }
        moved
    }
}

impl Store for Translations {
    fn find(&self, name: &str) -> Option<Vec<u8>> {
        let file_name = self.file_name(name);
        let path = cache_folder::of(FOLDER)?.join(&file_name);
        let mut bytes = read_named(&path).ok()?;
        let content = bytes.get(LENGTH..)?;
        if cache_folder::code(&file_name, content)?[..] != bytes[..LENGTH] {
            _ = fs::remove_file(&path);
            return None;
        }
        // When it was used last.
        let used = File::options().append(true).open(&path);
        _ = used.and_then(|file| file.set_modified(SystemTime::now()));
        bytes.drain(..LENGTH);
        Some(bytes)
    }

    fn keep(&self, name: &str, bytes: &[u8]) {
        if bytes.len() >= SMALL && bytes.len() as u64 <= MOST / 4 {
            // A disk that is full or read-only keeps nothing.
            _ = self.write(name, bytes);
        }
    }
}

/// Removes what was not used for longest until there is room for so many bytes, and what processes
/// left that were killed.
fn make_room(folder: &Path, needed: u64) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    let mut known: Vec<(SystemTime, u64, PathBuf)> = Vec::new();
    for entry in entries.flatten() {
        let path = entry.path();
        let Ok(metadata) = entry.metadata() else { continue };
        let Ok(used) = metadata.modified() else { continue };
        if path.extension().is_some_and(|extension| extension == "model") {
            known.push((used, metadata.len(), path));
        } else if path.extension().is_some_and(|extension| extension == "part")
            && used.elapsed().is_ok_and(|age| age.as_secs() > FORGOTTEN)
        {
            _ = fs::remove_file(path);
        }
    }
    known.sort();
    let mut taken: u64 = known.iter().map(|(_, length, _)| length).sum();
    for (_, length, path) in known {
        if taken + needed <= MOST {
            break;
        }
        taken -= length;
        _ = fs::remove_file(path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    /// A file of this size, of which nothing is on the disk, used last so many seconds ago.
    fn file(folder: &Path, name: &str, size: u64, age: u64) -> PathBuf {
        let path = folder.join(name);
        let file = File::create(&path).expect("made");
        file.set_len(size).expect("set");
        file.set_modified(SystemTime::now() - Duration::from_secs(age)).expect("set");
        path
    }

    #[test]
    fn what_was_not_used_for_longest_goes_first() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let part = MOST / 4;
        let files = ["a", "b", "c", "d"].map(|name| format!("{name}.model"));
        let models: Vec<PathBuf> =
            (0..4).map(|k| file(folder.path(), &files[k], part, [50, 400, 10, 300][k])).collect();
        let kept = || models.iter().map(|path| path.exists()).collect::<Vec<bool>>();
        make_room(folder.path(), 0);
        assert_eq!(kept(), [true; 4]);
        make_room(folder.path(), 1);
        assert_eq!(kept(), [true, false, true, true]);
        make_room(folder.path(), 2 * part + 1);
        assert_eq!(kept(), [false, false, true, false]);
    }

    #[test]
    fn only_old_parts_of_killed_processes_are_removed() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let old = file(folder.path(), "1-0.part", 9, FORGOTTEN + 60);
        let young = file(folder.path(), "2-0.part", 9, FORGOTTEN - 60);
        let other = file(folder.path(), "notes.txt", 9, FORGOTTEN + 60);
        make_room(folder.path(), MOST);
        assert!(!old.exists() && young.exists() && other.exists());
        // Without a folder there is nothing to do.
        make_room(&folder.path().join("absent"), MOST);
    }
}
