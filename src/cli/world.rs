//! The world of a real run: disk, clock, environment, terminal, Ctrl-C.

use super::limits::Stopping;
use super::output::Output;
use super::terminal::Terminal;
use crate::models;
use crate::script::view::View;
use crate::script::world::{Files, Progress, Stamp, World, normalized};
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// The operating system as scripts see it. The working directory is the session's own, so that
/// `cd` in a script changes nothing outside it.
pub(super) struct SystemWorld {
    terminal: Terminal,
    current: PathBuf,
    output: PathBuf,
    threads: usize,
    started: Instant,
    stopping: Stopping,
    /// How often it has written a file.
    changes: u64,
    /// The folder for the results, as long as nothing was written into it.
    unclaimed: Option<Output>,
}

impl SystemWorld {
    /// A world that writes its results below `output` and computes with `threads` threads.
    pub(super) fn new(
        terminal: Terminal,
        output: &Path,
        threads: Option<usize>,
    ) -> io::Result<Self> {
        let current = std::env::current_dir()?;
        let available = std::thread::available_parallelism().map_or(1, usize::from);
        Ok(SystemWorld {
            output: current.join(output),
            current,
            stopping: Stopping { flag: terminal.interrupt(), ..Stopping::default() },
            terminal,
            threads: threads.unwrap_or(available).max(1),
            started: Instant::now(),
            changes: 0,
            unclaimed: None,
        })
    }

    /// A world whose folder for results says whose they are when the first is written.
    pub(super) fn for_results(
        terminal: Terminal,
        output: Output,
        threads: Option<usize>,
    ) -> io::Result<Self> {
        let world = SystemWorld::new(terminal, &output.folder, threads)?;
        Ok(SystemWorld { unclaimed: Some(output), ..world })
    }

    /// Before a file is written.
    fn claim(&mut self, path: &Path) {
        self.changes += 1;
        if path.starts_with(&self.output)
            && let Some(output) = self.unclaimed.take()
        {
            // What cannot be written shows with the file itself.
            let _ = output.claim();
        }
    }

    /// What stops the run when it is set, and why it was.
    pub(super) fn stopping(&self) -> Stopping {
        self.stopping.clone()
    }

    /// Makes Ctrl-C ask the run to stop; a second one ends the process at once.
    pub(super) fn catch_interrupts(&self) {
        let flag = Arc::clone(&self.stopping.flag);
        let caught = ctrlc::set_handler(move || {
            if flag.swap(true, Ordering::SeqCst) {
                #[allow(clippy::exit, reason = "the user asked twice")]
                std::process::exit(130);
            }
        });
        // Without a handler Ctrl-C ends the process as it always did.
        drop(caught);
    }

    fn at(&self, path: &Path) -> PathBuf {
        self.current.join(path)
    }
}

/// The disk, and the models in the program.
#[derive(Debug)]
struct Disk;

impl Files for Disk {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        match models::read(path) {
            Some(bytes) => Ok(bytes.to_vec()),
            None => fs::read(path),
        }
    }

    fn list_dir(&self, path: &Path) -> io::Result<Vec<String>> {
        if let Some(names) = models::list(path) {
            return Ok(names);
        }
        let mut names = Vec::new();
        for entry in fs::read_dir(path)? {
            names.push(entry?.file_name().to_string_lossy().into_owned());
        }
        names.sort();
        Ok(names)
    }

    fn is_file(&self, path: &Path) -> bool {
        models::read(path).is_some() || path.is_file()
    }
}

impl World for SystemWorld {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        Disk.read(&self.at(path))
    }

    fn write(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let path = self.at(path);
        self.claim(&path);
        write_atomically(&path, bytes)
    }

    fn append(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let path = self.at(path);
        self.claim(&path);
        let mut file = fs::OpenOptions::new().append(true).create(true).open(path)?;
        file.write_all(bytes)
    }

    fn remove(&mut self, path: &Path) -> io::Result<()> {
        let path = self.at(path);
        let is_folder = path.is_dir() && !path.is_symlink();
        if is_folder { fs::remove_dir(path) } else { fs::remove_file(path) }
    }

    fn is_link(&self, path: &Path) -> bool {
        self.at(path).is_symlink()
    }

    fn exists(&self, path: &Path) -> bool {
        models::read(path).is_some() || models::list(path).is_some() || self.at(path).exists()
    }

    fn is_dir(&self, path: &Path) -> bool {
        models::list(path).is_some() || self.at(path).is_dir()
    }

    fn stamp(&self, path: &Path) -> Option<Stamp> {
        let metadata = fs::metadata(self.at(path)).ok()?;
        let modified = metadata.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
        // Two writes of one size within a tick of the disk's clock look the same to the disk.
        Some(Stamp(modified.as_nanos() as u64, metadata.len(), self.changes))
    }

    fn list_dir(&self, path: &Path) -> io::Result<Vec<String>> {
        Disk.list_dir(&self.at(path))
    }

    fn files(&self) -> Arc<dyn Files> {
        Arc::new(Disk)
    }

    fn create_dirs(&mut self, path: &Path) -> io::Result<()> {
        fs::create_dir_all(self.at(path))
    }

    fn current_dir(&self) -> PathBuf {
        self.current.clone()
    }

    fn set_current_dir(&mut self, path: &Path) -> io::Result<()> {
        let wanted = self.absolute(path);
        if !wanted.is_dir() {
            return Err(io::Error::new(io::ErrorKind::NotFound, "no such directory"));
        }
        self.current = wanted;
        Ok(())
    }

    fn env(&self, name: &str) -> Option<String> {
        std::env::var(name).ok()
    }

    fn print(&mut self, text: &str) {
        self.terminal.print(text);
    }

    fn eprint(&mut self, text: &str) {
        self.terminal.eprint(text);
    }

    fn monotonic_seconds(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
    }

    fn clock(&self) -> Option<fn() -> f64> {
        static STARTED: LazyLock<Instant> = LazyLock::new(Instant::now);
        Some(|| STARTED.elapsed().as_secs_f64())
    }

    fn unix_seconds(&self) -> u64 {
        SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs())
    }

    fn process_id(&self) -> u32 {
        std::process::id()
    }

    fn interrupted(&self) -> bool {
        let is_asked = self.stopping.flag.load(Ordering::Relaxed);
        if is_asked {
            self.stopping.noticed.store(true, Ordering::Relaxed);
        }
        is_asked
    }

    fn interrupt_flag(&self) -> Option<Arc<AtomicBool>> {
        Some(Arc::clone(&self.stopping.flag))
    }

    fn stop_reason(&self) -> Option<String> {
        self.stopping.reason.lock().ok()?.clone()
    }

    fn run_command(
        &mut self,
        command: &str,
        environment: &BTreeMap<String, String>,
    ) -> io::Result<(i32, Vec<u8>)> {
        let (shell, flag) = if cfg!(windows) { ("cmd", "/C") } else { ("sh", "-c") };
        let output = std::process::Command::new(shell)
            .args([flag, command])
            .current_dir(&self.current)
            .envs(environment)
            .stderr(std::process::Stdio::inherit())
            .output()?;
        Ok((output.status.code().unwrap_or(-1), output.stdout))
    }

    fn threads(&self) -> usize {
        self.threads
    }

    fn output_dir(&self) -> PathBuf {
        self.output.clone()
    }

    fn progress(&mut self, progress: &Progress) {
        self.terminal.progress(progress);
    }

    fn wants_view(&mut self) -> bool {
        self.terminal.wants_view()
    }

    fn show_view(&mut self, view: &View) {
        self.terminal.show_view(view);
    }

    fn end_view(&mut self) {
        self.terminal.end_view();
    }

    fn wants_pause(&mut self) -> bool {
        self.terminal.wants_pause()
    }

    fn ask(&mut self, prompt: &str) -> Option<String> {
        self.terminal.ask(prompt)
    }

    fn resolved(&self, path: &Path) -> PathBuf {
        followed(&self.absolute(path), MAX_LINKS)
    }

    fn colour(&self) -> bool {
        self.terminal.colour()
    }
}

/// Links that lead to links; as many as operating systems follow.
const MAX_LINKS: usize = 40;

/// The path with its links followed, those too that lead to nothing yet.
fn followed(path: &Path, links: usize) -> PathBuf {
    for known in path.ancestors() {
        let rest = path.strip_prefix(known).unwrap_or(Path::new(""));
        if let Ok(real) = known.canonicalize() {
            return real.join(rest);
        }
        if let (Ok(target), Some(folder)) = (std::fs::read_link(known), known.parent())
            && links > 0
        {
            return followed(&normalized(&folder.join(target).join(rest)), links - 1);
        }
    }
    path.to_path_buf()
}

/// Writes beside the file and renames, so that an interrupted write leaves the old file whole.
pub(super) fn write_atomically(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let Some(name) = path.file_name() else {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "not a file name"));
    };
    if fs::symlink_metadata(path).is_ok_and(|metadata| !metadata.is_file()) {
        // A device, a pipe or a link: replacing it would not be what was asked.
        return fs::write(path, bytes);
    }
    let mut temporary_name = name.to_owned();
    temporary_name.push(format!(".{}.tmp", std::process::id()));
    let temporary = path.with_file_name(temporary_name);
    let written = fs::write(&temporary, bytes).and_then(|()| fs::rename(&temporary, path));
    if written.is_err() {
        // The error of the write is the one to report.
        let _ = fs::remove_file(&temporary);
    }
    written
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_nothing_behind() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let missing = folder.path().join("no such folder").join("file");
        assert!(write_atomically(&missing, b"x").is_err());
        let path = folder.path().join("file");
        write_atomically(&path, b"one").expect("a writable folder");
        write_atomically(&path, b"two").expect("a writable folder");
        assert_eq!(fs::read(&path).expect("the file"), b"two");
        assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_where_they_lead_to_nothing_too() {
        let folder = tempfile::tempdir().expect("a folder");
        let root = folder.path().canonicalize().expect("an absolute path");
        std::fs::create_dir(root.join("inside")).expect("made");
        let link = |target: &str, name: &str| {
            std::os::unix::fs::symlink(target, root.join("inside").join(name)).expect("a link");
        };
        link("..", "up");
        link("../missing", "dangling");
        link("round", "round");
        let resolved = |path: &str| followed(&root.join("inside").join(path), MAX_LINKS);
        assert_eq!(resolved("new/file.txt"), root.join("inside/new/file.txt"));
        assert_eq!(resolved("up/file.txt"), root.join("file.txt"));
        assert_eq!(resolved("dangling"), root.join("missing"));
        assert_eq!(resolved("round").file_name(), Some("round".as_ref()));
    }
}
