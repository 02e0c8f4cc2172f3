//! One run at a time writes into an output folder: an advisory lock of the system, which the system
//! releases when a process dies.

use super::disk;
use crate::script::access::policy::{Refusal, refusal_of};
use std::fs::{File, TryLockError};
use std::io::{self, Write as _};
use std::path::Path;
use std::time::{Duration, Instant};

/// The file that is locked.
pub(super) const FILE: &str = "run.lock";

/// How long a lock is waited for, and how long between two attempts.
const PATIENCE: Duration = Duration::from_secs(1);
const PAUSE: Duration = Duration::from_millis(20);

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
    /// Locks a folder, whose path has no links, and removes what a killed run has left half written
    /// in it.
    ///
    /// # Errors
    ///
    /// Another run holds the lock; the file cannot be written; it is a link, or has another name.
    pub(super) fn of(folder: &Path) -> io::Result<Lock> {
        let path = folder.join(FILE);
        let mut file = opened(&path)?;
        match tried(&file) {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(locked(folder)),
            // Some file systems have no locks; they are used as before.
            Err(TryLockError::Error(_)) => return Ok(Lock(file)),
        }
        file.set_len(0)?;
        writeln!(file, "process {}", std::process::id())?;
        disk::remove_temporary_files(folder);
        Ok(Lock(file))
    }
}

/// Locks the file; a process that is ending may hold it for a moment.
fn tried(file: &File) -> Result<(), TryLockError> {
    let begun = Instant::now();
    loop {
        match file.try_lock() {
            Err(TryLockError::WouldBlock) if begun.elapsed() < PATIENCE => {
                std::thread::sleep(PAUSE);
            }
            tried => return tried,
        }
    }
}

/// Opens the file that is locked, which belongs to the program alone: writing into one that has
/// another name would change a file of the user.
fn opened(path: &Path) -> io::Result<File> {
    disk::open_own(path).map_err(|error| {
        let why = match refusal_of(&error) {
            Some(Refusal::System) => "it is not a file",
            Some(refusal) => refusal.reason(),
            None => return error,
        };
        let shown = path.display();
        let message =
            format!("`{shown}` cannot be used: {why}; remove it, or choose another folder");
        io::Error::other(message)
    })
}

fn locked(folder: &Path) -> io::Error {
    // Without its name the message still says what is wrong.
    let holder = disk::read_named(&folder.join(FILE)).unwrap_or_default();
    let holder = String::from_utf8_lossy(&holder);
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
    use std::fs;

    #[test]
    fn the_second_run_learns_which_process_has_locked_the_folder() {
        let folder = tempfile::tempdir().expect("a folder");
        let first = Lock::of(folder.path()).expect("free");
        let refused = Lock::of(folder.path()).expect_err("locked").to_string();
        assert!(refused.contains(&format!("process {}", std::process::id())), "{refused}");
        drop(first);
        Lock::of(folder.path()).expect("free again");
    }

    /// As a process that writes its last checkpoint when the next one resumes.
    #[test]
    fn a_lock_that_is_given_back_soon_is_waited_for() {
        let folder = tempfile::tempdir().expect("a folder");
        let first = Lock::of(folder.path()).expect("free");
        std::thread::scope(|scope| {
            scope.spawn(|| {
                std::thread::sleep(Duration::from_millis(100));
                drop(first);
            });
            Lock::of(folder.path()).expect("free in time");
        });
    }

    #[test]
    #[cfg(unix)]
    fn a_lock_that_is_another_file_is_not_written() {
        let folder = tempfile::tempdir().expect("a folder");
        let (mine, lock) = (folder.path().join("mine"), folder.path().join(FILE));
        fs::write(&mine, "mine").expect("written");
        fs::hard_link(&mine, &lock).expect("a hard link");
        let refused = Lock::of(folder.path()).expect_err("shared").to_string();
        assert!(refused.contains("second name"), "{refused}");
        for target in [Path::new("mine"), Path::new("missing"), Path::new("/dev/zero")] {
            fs::remove_file(&lock).expect("removed");
            std::os::unix::fs::symlink(target, &lock).expect("a link");
            let refused = Lock::of(folder.path()).expect_err("a link").to_string();
            assert!(refused.contains("not a file"), "{refused}");
        }
        fs::remove_file(&lock).expect("removed");
        assert!(std::process::Command::new("mkfifo").arg(&lock).status().expect("run").success());
        assert!(Lock::of(folder.path()).is_err());
        assert_eq!(fs::read(&mine).expect("there"), b"mine");
        assert!(!folder.path().join("missing").exists());
    }

    #[test]
    fn what_killed_runs_left_is_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let left = folder.path().join("result.json.0123456789abcdef.gapi-tmp");
        let kept = folder.path().join("notes.tmp");
        for file in [&left, &kept] {
            fs::write(file, "half").expect("written");
        }
        drop(Lock::of(folder.path()).expect("free"));
        assert!(!left.exists() && kept.exists());
    }
}
