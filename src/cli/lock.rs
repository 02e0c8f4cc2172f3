//! One run at a time writes into an output folder: an advisory lock of the system, which a process
//! that dies leaves behind unlocked.

use super::disk;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read as _, Seek as _, Write as _};
use std::path::Path;

/// The file that is locked.
pub(super) const FILE: &str = "run.lock";

/// The lock on an output folder, released when it is dropped.
#[derive(Debug)]
pub(super) struct Lock(File);

impl Drop for Lock {
    fn drop(&mut self) {
        // Equal runs leave equal files: who had it is of no use any more.
        let _ = self.0.set_len(0);
        // A process that is being started holds the file, too, until it begins its program: closing
        // alone would leave it locked so long.
        let _ = self.0.unlock();
    }
}

impl Lock {
    /// Locks a folder, and removes what a killed run has left half written in it.
    ///
    /// # Errors
    ///
    /// Another run holds the lock; the file cannot be written.
    pub(super) fn of(folder: &Path) -> io::Result<Lock> {
        let path = folder.join(FILE);
        if fs::symlink_metadata(&path).is_ok_and(|found| !found.is_file()) {
            return Err(io::Error::other(format!("`{}` is not a file", path.display())));
        }
        let mut file =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(locked(&mut file, folder)),
            // Some file systems have no locks; they are used as before.
            Err(TryLockError::Error(_)) => return Ok(Lock(file)),
        }
        file.set_len(0)?;
        file.rewind()?;
        writeln!(file, "process {}", std::process::id())?;
        disk::remove_temporary_files(folder);
        Ok(Lock(file))
    }
}

fn locked(file: &mut File, folder: &Path) -> io::Error {
    let mut holder = String::new();
    // Without its name the message still says what is wrong.
    let _ = file.read_to_string(&mut holder);
    let holder = match holder.trim() {
        "" => String::new(),
        holder => format!(" ({holder})"),
    };
    io::Error::new(
        io::ErrorKind::ResourceBusy,
        format!(
            "another run{holder} is writing to `{}`; wait until it finishes, or choose another \
             folder with `--out`",
            folder.display()
        ),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_second_run_is_told_who_holds_the_folder() {
        let folder = tempfile::tempdir().expect("a folder");
        let first = Lock::of(folder.path()).expect("free");
        let refused = Lock::of(folder.path()).expect_err("locked").to_string();
        assert!(refused.contains(&format!("process {}", std::process::id())), "{refused}");
        drop(first);
        Lock::of(folder.path()).expect("free again");
    }

    #[test]
    fn what_killed_runs_left_is_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let left = folder.path().join("result.json.0123456789abcdef.tmp");
        let kept = folder.path().join("notes.tmp");
        for file in [&left, &kept] {
            fs::write(file, "half").expect("written");
        }
        drop(Lock::of(folder.path()).expect("free"));
        assert!(!left.exists() && kept.exists());
    }
}
