//! Functional mock-up units: they run in processes of their own, which are this program with a command
//! that the help does not show. A unit that crashes or does not return ends its process alone.

mod process;
mod sources;
mod worker;

pub(super) use worker::{FmuWorkerArgs, worker};

use crate::disk::real_path;
use crate::fmi::Archive;
use crate::fmi::import::{Host, Process, Start};
use crate::script::access::policy::ExternalCode;
use process::WorkerProcess;
use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicU32, Ordering};

/// The processes of this machine, for the units that the user allows.
pub(super) struct LocalHost {
    allowed: ExternalCode,
}

impl LocalHost {
    /// A host for these units.
    pub(super) fn new(allowed: ExternalCode) -> LocalHost {
        LocalHost { allowed }
    }
}

impl Host for LocalHost {
    fn permits(&self, file: &Path) -> bool {
        self.allowed.permits_file(&real_path(file))
    }

    fn install(&self, archive: &Archive) -> Result<Box<dyn Start>, String> {
        let cannot = |error: io::Error| format!("it cannot be unpacked: {error}");
        let folder = Folder::new().map_err(cannot)?;
        for (path, content) in archive.files() {
            let path = folder.0.join(path);
            let unpacked = path.parent().map_or(Ok(()), fs::create_dir_all);
            unpacked.and_then(|()| fs::write(&path, content)).map_err(cannot)?;
        }
        sources::compile(archive, &folder.0)?;
        Ok(Box::new(LocalStart { folder }))
    }
}

/// A folder of this process, removed at its end.
struct Folder(PathBuf);

impl Folder {
    fn new() -> io::Result<Folder> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("gapi-fmu-{}-{number}", std::process::id());
        let path = std::env::temp_dir().join(name);
        // Left by a process of the same number that was killed.
        let _ = fs::remove_dir_all(&path);
        let mut builder = fs::DirBuilder::new();
        #[cfg(unix)]
        std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
        builder.create(&path)?;
        Ok(Folder(path))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// An unpacked unit.
struct LocalStart {
    folder: Folder,
}

impl Start for LocalStart {
    fn start(&self) -> Result<Box<dyn Process>, String> {
        let mut command = program();
        command.arg("fmu-worker").arg(&self.folder.0);
        // It belongs to this process, not to the job that a launcher has started this one in.
        command.env(super::launcher::SWITCH, "0");
        Ok(Box::new(WorkerProcess::start(command)?))
    }
}

/// This program: where another one embeds it, the one of Python, or else `gapi` where the system finds
/// it.
pub(super) fn program() -> Command {
    let own = std::env::current_exe().unwrap_or_default();
    if is_called(&own, "python") {
        // The packages of a virtual environment are found by the link that was started, not by what it leads to.
        let started = std::env::args_os().next().map(PathBuf::from);
        let started = started.filter(|started| is_called(started, "python"));
        let mut command = Command::new(started.unwrap_or(own));
        command.args(["-m", "gapilib"]);
        return command;
    }
    let is_own = is_called(&own, "gapi");
    Command::new(if is_own { own.into_os_string() } else { OsString::from("gapi") })
}

fn is_called(program: &Path, name: &str) -> bool {
    let stem = program.file_stem().map(|stem| stem.to_string_lossy().to_lowercase());
    stem.is_some_and(|stem| stem.starts_with(name))
}

/// The folder for what a unit writes beside its own files.
fn working_folder(folder: &Path) -> PathBuf {
    folder.join(format!("worker-{}", std::process::id()))
}
