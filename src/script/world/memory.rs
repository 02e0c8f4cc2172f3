//! A world in memory: what tests and documentation run scripts in.

use super::{Environment, FileAccess, FileReader, Files, Screen, Stamp};
use crate::access::policy::{Access, Change, Grant, Policy};
use crate::identify::problem::Status;
use crate::runs::view::{Progress, View};
use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

/// What was written to the two streams of a [`MemoryWorld`], readable while a session owns the
/// world.
#[derive(Debug, Clone, Default)]
pub struct Streams(Arc<Mutex<(String, String)>>);

impl Streams {
    fn with<T>(&self, work: impl FnOnce(&mut (String, String)) -> T) -> T {
        match self.0.lock() {
            Ok(mut guard) => work(&mut guard),
            Err(poisoned) => work(&mut poisoned.into_inner()),
        }
    }

    /// Standard output so far.
    pub fn output(&self) -> String {
        self.with(|streams| streams.0.clone())
    }

    /// Standard error so far.
    pub fn errors(&self) -> String {
        self.with(|streams| streams.1.clone())
    }
}

/// A world in memory: files in a map, a clock that stands still, one thread.
///
/// ```
/// use gapilib_script::Session;
/// use gapilib_script::world::MemoryWorld;
///
/// let world = MemoryWorld::new().with_file("double.mos", "y = 2*x");
/// let streams = world.streams();
/// let mut session = Session::new(Box::new(world));
/// session.run_text("input", "x = 21\nRunScript(\"double.mos\")\nprint(String(y))");
/// assert_eq!(streams.output(), "42\n");
/// ```
#[derive(Debug, Clone)]
pub struct MemoryWorld {
    policy: Policy,
    files: BTreeMap<PathBuf, Vec<u8>>,
    variables: BTreeMap<String, String>,
    dirs: BTreeSet<PathBuf>,
    current: PathBuf,
    changes: u64,
    stamps: BTreeMap<PathBuf, u64>,
    streams: Streams,
    /// How many more times the answer is that the run continues.
    patience: Cell<u64>,
    /// What becomes true when the user asks to stop.
    stop: Option<Arc<AtomicBool>>,
    /// What long work has shown that it does, and what it does when the user asks to stop.
    shown: Option<(Shown, String)>,
    /// How many more times the answer is that no pause is requested, and what is typed then.
    pause: (u64, VecDeque<String>),
    /// What was drawn, where anybody looks.
    views: Option<Views>,
}

/// What was shown of long work, in its order.
pub(crate) type Shown = Arc<Mutex<Vec<String>>>;

/// The views that were drawn, readable while a session owns the world.
pub type Views = Arc<Mutex<Vec<View>>>;

impl Default for MemoryWorld {
    fn default() -> MemoryWorld {
        let mut policy = Policy::default();
        policy.grant(Grant::Create(Path::new("")), PathBuf::from("/memory"));
        policy.grant(Grant::Own(Path::new("")), PathBuf::from("/memory/results"));
        MemoryWorld {
            policy,
            files: BTreeMap::new(),
            variables: BTreeMap::new(),
            dirs: [PathBuf::from("/"), PathBuf::from("/memory")].into(),
            current: PathBuf::from("/memory"),
            changes: 0,
            stamps: BTreeMap::new(),
            streams: Streams::default(),
            patience: Cell::new(u64::MAX),
            stop: None,
            shown: None,
            pause: (u64::MAX, VecDeque::new()),
            views: None,
        }
    }
}

impl MemoryWorld {
    /// An empty world with the working directory `/memory`.
    pub fn new() -> MemoryWorld {
        MemoryWorld::default()
    }

    /// The same with one more file.
    #[must_use]
    pub fn with_file(mut self, path: impl AsRef<Path>, bytes: impl AsRef<[u8]>) -> MemoryWorld {
        self.store(path.as_ref(), bytes.as_ref().to_vec());
        self
    }

    /// The same with an environment variable.
    #[must_use]
    pub fn with_variable(mut self, name: &str, content: &str) -> MemoryWorld {
        self.variables.insert(name.to_owned(), content.to_owned());
        self
    }

    /// The same where the user asks to stop after `questions` questions whether he did.
    #[must_use]
    pub fn interrupted_after(mut self, questions: u64) -> MemoryWorld {
        self.patience = Cell::new(questions);
        self
    }

    /// The same where the user asks to stop by setting `flag`.
    #[must_use]
    pub(crate) fn stopped_by(mut self, flag: &Arc<AtomicBool>) -> MemoryWorld {
        self.stop = Some(Arc::clone(flag));
        self
    }

    /// The same where the user asks to stop when such a line is shown; all lines are noted.
    #[cfg(test)]
    #[must_use]
    pub(crate) fn stopped_when(mut self, line: &str, shown: &Shown) -> MemoryWorld {
        self.stop = Some(Arc::default());
        self.shown = Some((Arc::clone(shown), line.to_owned()));
        self
    }

    /// The same where the user pauses after `questions` questions whether he does, and types these
    /// lines then.
    #[must_use]
    pub fn paused_after(mut self, questions: u64, lines: &[&str]) -> MemoryWorld {
        self.pause = (questions, lines.iter().map(|line| (*line).to_owned()).collect());
        self
    }

    /// The same with a live view of the runs; what it shows goes into `views`.
    #[must_use]
    pub fn watched(mut self, views: &Views) -> MemoryWorld {
        self.views = Some(Arc::clone(views));
        self
    }

    /// What is printed to it.
    pub fn streams(&self) -> Streams {
        self.streams.clone()
    }

    fn store(&mut self, path: &Path, bytes: Vec<u8>) {
        let path = self.absolute(path);
        self.changes += 1;
        self.dirs.extend(path.ancestors().skip(1).map(Path::to_path_buf));
        self.stamps.insert(path.clone(), self.changes);
        self.files.insert(path, bytes);
    }
}

fn missing(path: &Path) -> io::Error {
    io::Error::new(io::ErrorKind::NotFound, format!("no such file: {}", path.display()))
}

/// The last names of the paths that lie directly in a directory, sorted.
fn names_in<'a>(dir: &Path, paths: impl Iterator<Item = &'a PathBuf>) -> Vec<String> {
    let inside = paths.filter_map(|path| path.strip_prefix(dir).ok()?.components().next());
    let names: BTreeSet<String> =
        inside.map(|name| name.as_os_str().to_string_lossy().into_owned()).collect();
    names.into_iter().collect()
}

/// The files of a [`MemoryWorld`] at one moment.
#[derive(Debug)]
struct MemoryFiles(BTreeMap<PathBuf, Vec<u8>>);

impl FileReader for MemoryFiles {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.0.get(path).cloned().ok_or_else(|| missing(path))
    }

    fn list_dir(&self, path: &Path) -> io::Result<Vec<String>> {
        let names = names_in(path, self.0.keys());
        if names.is_empty() { Err(missing(path)) } else { Ok(names) }
    }

    fn is_file(&self, path: &Path) -> bool {
        self.0.contains_key(path)
    }
}

impl FileAccess for MemoryWorld {
    fn grant(&mut self, grant: Grant<'_>) {
        let real = grant.path().map_or_else(PathBuf::new, |path| self.absolute(path));
        self.policy.grant(grant, real);
    }

    fn permits(&self, path: &Path, access: Access) -> io::Result<()> {
        let path = self.absolute(path);
        match access {
            // Nothing else is in memory than what belongs to the run.
            Access::Read => Ok(()),
            Access::Write | Access::Folder => {
                Ok(self.policy.may_write(&path, Change::by(access, self.exists(&path)))?)
            }
        }
    }
}

impl Files for MemoryWorld {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.files.get(&self.absolute(path)).cloned().ok_or_else(|| missing(path))
    }

    fn write(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        self.permits(path, Access::Write)?;
        if self.is_dir(path) {
            return Err(io::Error::new(io::ErrorKind::IsADirectory, "is a directory"));
        }
        self.policy.note_made(self.absolute(path));
        self.store(path, bytes.to_vec());
        Ok(())
    }

    fn append(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let known = self.absolute(path);
        if !self.files.contains_key(&known) {
            return self.write(path, bytes);
        }
        self.permits(path, Access::Write)?;
        self.policy.note_made(known.clone());
        self.changes += 1;
        self.stamps.insert(known.clone(), self.changes);
        // In place: the trace of a long run grows to 64 MB by pieces of some kilobytes.
        if let Some(content) = self.files.get_mut(&known) {
            content.extend_from_slice(bytes);
        }
        Ok(())
    }

    fn remove(&mut self, path: &Path) -> io::Result<()> {
        self.permits(path, Access::Write)?;
        let path = self.absolute(path);
        if self.files.remove(&path).is_some() || self.dirs.remove(&path) {
            self.stamps.remove(&path);
            self.policy.note_removed(&path);
            return Ok(());
        }
        Err(missing(&path))
    }

    fn exists(&self, path: &Path) -> bool {
        let path = self.absolute(path);
        self.files.contains_key(&path) || self.dirs.contains(&path)
    }

    fn is_dir(&self, path: &Path) -> bool {
        self.dirs.contains(&self.absolute(path))
    }

    fn stamp(&self, path: &Path) -> Option<Stamp> {
        self.stamps.get(&self.absolute(path)).map(|change| Stamp(0, 0, *change))
    }

    fn list_dir(&self, path: &Path) -> io::Result<Vec<String>> {
        let dir = self.absolute(path);
        match self.dirs.contains(&dir) {
            true => Ok(names_in(&dir, self.files.keys().chain(&self.dirs))),
            false => Err(missing(path)),
        }
    }

    fn reader(&self) -> Arc<dyn FileReader> {
        Arc::new(MemoryFiles(self.files.clone()))
    }

    fn create_dirs(&mut self, path: &Path) -> io::Result<()> {
        let path = self.absolute(path);
        if self.dirs.contains(&path) {
            return Ok(());
        }
        self.permits(&path, Access::Folder)?;
        self.policy.note_made(path.clone());
        self.dirs.extend(path.ancestors().map(Path::to_path_buf));
        Ok(())
    }

    fn current_dir(&self) -> PathBuf {
        self.current.clone()
    }

    fn set_current_dir(&mut self, path: &Path) -> io::Result<()> {
        let path = self.absolute(path);
        if !self.dirs.contains(&path) {
            return Err(missing(&path));
        }
        self.current = path;
        Ok(())
    }

    fn output_dir(&self) -> PathBuf {
        PathBuf::from("/memory/results")
    }
}

impl Environment for MemoryWorld {
    fn env(&self, name: &str) -> Option<String> {
        self.variables.get(name).cloned()
    }

    fn monotonic_seconds(&self) -> f64 {
        0.0
    }

    fn unix_seconds(&self) -> u64 {
        0
    }

    fn is_interrupted(&self) -> bool {
        let left = self.patience.get();
        self.patience.set(left.saturating_sub(1));
        left == 0 || self.stop.as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    fn interrupt_flag(&self) -> Option<Arc<AtomicBool>> {
        self.stop.clone()
    }

    fn threads(&self) -> usize {
        1
    }
}

impl Screen for MemoryWorld {
    fn print(&mut self, text: &str) {
        self.streams.with(|streams| streams.0.push_str(text));
    }

    fn eprint(&mut self, text: &str) {
        self.streams.with(|streams| streams.1.push_str(text));
    }

    fn progress(&mut self, _progress: &Progress) {}

    fn status(&mut self) -> Option<Status> {
        let ((shown, last), stop) = (self.shown.clone()?, self.stop.clone()?);
        Some(Arc::new(move |line: &str| {
            if line == last {
                stop.store(true, Ordering::Relaxed);
            }
            if let Ok(mut shown) = shown.lock() {
                shown.push(line.to_owned());
            }
        }))
    }

    fn is_view_due(&mut self) -> bool {
        self.views.is_some()
    }

    fn show_view(&mut self, view: &View) {
        if let Some(Ok(mut views)) = self.views.as_ref().map(|views| views.lock()) {
            views.push(view.clone());
        }
    }

    fn is_pause_requested(&mut self) -> bool {
        let pauses = self.pause.0 == 0;
        self.pause.0 = if pauses { u64::MAX } else { self.pause.0 - 1 };
        pauses
    }

    fn ask(&mut self, _prompt: &str) -> Option<String> {
        self.pause.1.pop_front()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relative_paths_follow_the_working_directory() {
        let mut world = MemoryWorld::new().with_file("a/b.txt", "1");
        assert_eq!(world.read(Path::new("/memory/a/b.txt")).ok(), Some(b"1".to_vec()));
        assert!(world.set_current_dir(Path::new("a")).is_ok());
        assert!(world.exists(Path::new("../a/./b.txt")));
        assert!(world.set_current_dir(Path::new("missing")).is_err());
        assert_eq!(world.list_dir(Path::new("..")).ok(), Some(vec!["a".to_owned()]));
    }

    #[test]
    fn a_stamp_changes_with_the_content() {
        let mut world = MemoryWorld::new().with_file("x", "1");
        world.grant(Grant::WriteAll);
        let before = world.stamp(Path::new("x"));
        assert!(world.append(Path::new("x"), b"2").is_ok());
        assert_ne!(before, world.stamp(Path::new("x")));
        assert_eq!(world.stamp(Path::new("y")), None);
    }
}
