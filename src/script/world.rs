//! The only door to the outside: files, texts on the terminal, clocks, the interrupt key.
//!
//! Nothing below `cli/` touches the system in any other way, so a script runs in a [`MemoryWorld`]
//! exactly as it runs on a disk.

use super::access::policy::{Access, Grant, Policy};
use super::runs::view::View;
use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fmt;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};

/// How far a long piece of work is: data for whoever draws it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Progress {
    /// What is being done, such as `generation`.
    pub label: String,
    /// Units done.
    pub done: u64,
    /// Units in all; 0 where not known.
    pub total: u64,
    /// The best value so far, smaller is better.
    pub best: Option<f64>,
    /// What failed so far.
    pub failures: u64,
}

/// A stamp of a file's state: another stamp means that the content may have changed. When it was
/// changed, its size, and how often the world itself has changed files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stamp(pub u64, pub u64, pub u64);

/// The files of a world, for reading alone: what a library keeps to read its classes when they are
/// needed, from any thread. Paths are absolute.
pub trait Files: fmt::Debug + Send + Sync {
    /// The bytes of a file.
    fn read(&self, path: &Path) -> io::Result<Vec<u8>>;
    /// Names of the entries of a directory, sorted.
    fn list_dir(&self, path: &Path) -> io::Result<Vec<String>>;
    /// Whether there is a file of this path that is no directory.
    fn is_file(&self, path: &Path) -> bool;
}

/// Writes the content of a file.
pub type Content<'a> = &'a mut dyn FnMut(&mut dyn io::Write) -> io::Result<()>;

/// Everything that a script can do to the world and learn from it. Paths may be relative to
/// [`World::current_dir`].
pub trait World {
    /// Allows something from here on: whoever starts the run does, never a script.
    fn grant(&mut self, grant: Grant<'_>);
    /// Whether a path may be read or written.
    ///
    /// # Errors
    /// What refuses it; see [`refusal_of`](super::access::policy::refusal_of).
    fn permits(&self, path: &Path, access: Access) -> io::Result<()>;
    /// The bytes of a file.
    fn read(&self, path: &Path) -> io::Result<Vec<u8>>;
    /// Writes a file anew.
    fn write(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()>;
    /// Writes a file anew as `content` writes it: whoever has a disk keeps none of it in memory.
    fn write_with(&mut self, path: &Path, content: Content<'_>) -> io::Result<()> {
        let mut bytes = Vec::new();
        content(&mut bytes)?;
        self.write(path, &bytes)
    }
    /// Writes behind the end of a file, which is made if there is none.
    fn append(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()>;
    /// Makes what a file holds safe against a power cut.
    fn sync(&mut self, _path: &Path) -> io::Result<()> {
        Ok(())
    }
    /// Removes a file or an empty directory.
    fn remove(&mut self, path: &Path) -> io::Result<()>;
    /// Whether a file or directory of this path exists.
    fn exists(&self, path: &Path) -> bool;
    /// Whether it is a directory.
    fn is_dir(&self, path: &Path) -> bool;
    /// Whether it is a symbolic link.
    fn is_link(&self, _path: &Path) -> bool {
        false
    }
    /// A stamp of a file, `None` if there is none.
    fn stamp(&self, path: &Path) -> Option<Stamp>;
    /// Names of the entries of a directory, sorted.
    fn list_dir(&self, path: &Path) -> io::Result<Vec<String>>;
    /// The files as they are, or as they are now.
    fn files(&self) -> Arc<dyn Files>;
    /// Makes a directory and the ones it lies in.
    fn create_dirs(&mut self, path: &Path) -> io::Result<()>;
    /// The working directory, absolute.
    fn current_dir(&self) -> PathBuf;
    /// Changes the working directory.
    fn set_current_dir(&mut self, path: &Path) -> io::Result<()>;
    /// An environment variable that scripts may see.
    fn env(&self, name: &str) -> Option<String>;
    /// Text for standard output; no line end is added.
    fn print(&mut self, text: &str);
    /// Text for standard error (diagnostics); no line end is added.
    fn eprint(&mut self, text: &str);
    /// Seconds since an arbitrary moment, never decreasing.
    fn monotonic_seconds(&self) -> f64;
    /// Seconds since an arbitrary moment for work that cannot ask the world, if there is a clock.
    fn clock(&self) -> Option<fn() -> f64> {
        None
    }
    /// Seconds since 1970-01-01 00:00 UTC. Nothing that must be reproducible may depend on it.
    fn unix_seconds(&self) -> u64;
    /// The number of this process, 0 where there is none.
    fn process_id(&self) -> u32 {
        0
    }
    /// Whether the user asked to stop.
    fn interrupted(&self) -> bool;
    /// What becomes true when the user asks to stop, for work that cannot ask the world.
    fn interrupt_flag(&self) -> Option<Arc<AtomicBool>> {
        None
    }
    /// What becomes true when the user asks to stop or so many seconds have passed; `None` where
    /// there is no clock that could.
    fn flag_after(&self, _seconds: f64) -> Option<Arc<AtomicBool>> {
        None
    }
    /// Why the run has to stop although nobody asked, such as a limit of time.
    fn stop_reason(&self) -> Option<String> {
        None
    }
    /// Runs a command of the operating system with these environment variables besides its own;
    /// its exit status and what it printed.
    fn run_command(
        &mut self,
        _command: &str,
        _environment: &BTreeMap<String, String>,
    ) -> io::Result<(i32, Vec<u8>)> {
        Err(io::Error::new(
            io::ErrorKind::Unsupported,
            "there is no operating system in this environment",
        ))
    }
    /// Number of threads to use, at least 1.
    fn threads(&self) -> usize;
    /// Where plots and reports go.
    fn output_dir(&self) -> PathBuf;
    /// Shows how far a long piece of work is.
    fn progress(&mut self, progress: &Progress);
    /// Whether a view of the run would be drawn now: asked often, so that none is made in vain.
    fn wants_view(&mut self) -> bool {
        false
    }
    /// Draws the run as it is now.
    fn show_view(&mut self, _view: &View) {}
    /// The run has ended: what was drawn goes away.
    fn end_view(&mut self) {}
    /// Whether the user wants the run to pause; true once for each time.
    fn wants_pause(&mut self) -> bool {
        false
    }
    /// A line that the user types during a pause; `None` when nothing more comes.
    fn ask(&mut self, _prompt: &str) -> Option<String> {
        None
    }
    /// Whether diagnostics may be coloured.
    fn colour(&self) -> bool {
        false
    }

    /// Copies a file over another.
    fn copy(&mut self, from: &Path, to: &Path) -> io::Result<()> {
        let bytes = self.read(from)?;
        self.write(to, &bytes)
    }

    /// The absolute form of a path: joined to the working directory, `.` and `..` resolved in the
    /// text.
    fn absolute(&self, path: &Path) -> PathBuf {
        normalized(&self.current_dir().join(path))
    }
}

/// A path with `.` and `..` resolved in the text.
pub fn normalized(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => match out.components().next_back() {
                Some(Component::Normal(_)) => {
                    out.pop();
                }
                Some(Component::RootDir | Component::Prefix(_)) => {}
                _ => out.push(component),
            },
            _ => out.push(component),
        }
    }
    out
}

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
#[derive(Debug, Clone)]
pub struct MemoryWorld {
    policy: Policy,
    files: BTreeMap<PathBuf, Vec<u8>>,
    dirs: BTreeSet<PathBuf>,
    current: PathBuf,
    changes: u64,
    stamps: BTreeMap<PathBuf, u64>,
    streams: Streams,
    /// How many more times the answer is that nobody asked to stop.
    patience: Cell<u64>,
    /// How many more times the answer is that nobody asks to pause, and what is typed then.
    pause: (u64, VecDeque<String>),
    /// What was drawn, where anybody looks.
    views: Option<Views>,
}

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
            dirs: [PathBuf::from("/"), PathBuf::from("/memory")].into(),
            current: PathBuf::from("/memory"),
            changes: 0,
            stamps: BTreeMap::new(),
            streams: Streams::default(),
            patience: Cell::new(u64::MAX),
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

    /// The same where the user asks to stop after `questions` questions whether he did.
    #[must_use]
    pub fn interrupted_after(mut self, questions: u64) -> MemoryWorld {
        self.patience = Cell::new(questions);
        self
    }

    /// The same where the user pauses after `questions` questions whether he does, and types these
    /// lines then.
    #[must_use]
    pub fn paused_after(mut self, questions: u64, lines: &[&str]) -> MemoryWorld {
        self.pause = (questions, lines.iter().map(|line| (*line).to_owned()).collect());
        self
    }

    /// The same where somebody looks at the runs; what he sees goes into `views`.
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

impl Files for MemoryFiles {
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

impl World for MemoryWorld {
    fn grant(&mut self, grant: Grant<'_>) {
        let real = grant.path().map_or_else(PathBuf::new, |path| self.absolute(path));
        self.policy.grant(grant, real);
    }

    fn permits(&self, path: &Path, access: Access) -> io::Result<()> {
        let path = self.absolute(path);
        match access {
            // Nothing else is in memory than what belongs to the run.
            Access::Read => Ok(()),
            Access::Write => Ok(self.policy.may_write(&path, self.exists(&path))?),
        }
    }

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
        let mut all = self.read(path).unwrap_or_default();
        all.extend_from_slice(bytes);
        self.write(path, &all)
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

    fn files(&self) -> Arc<dyn Files> {
        Arc::new(MemoryFiles(self.files.clone()))
    }

    fn create_dirs(&mut self, path: &Path) -> io::Result<()> {
        let path = self.absolute(path);
        if self.dirs.contains(&path) {
            return Ok(());
        }
        self.permits(&path, Access::Write)?;
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

    fn env(&self, _name: &str) -> Option<String> {
        None
    }

    fn print(&mut self, text: &str) {
        self.streams.with(|streams| streams.0.push_str(text));
    }

    fn eprint(&mut self, text: &str) {
        self.streams.with(|streams| streams.1.push_str(text));
    }

    fn monotonic_seconds(&self) -> f64 {
        0.0
    }

    fn unix_seconds(&self) -> u64 {
        0
    }

    fn interrupted(&self) -> bool {
        let left = self.patience.get();
        self.patience.set(left.saturating_sub(1));
        left == 0
    }

    fn threads(&self) -> usize {
        1
    }

    fn output_dir(&self) -> PathBuf {
        PathBuf::from("/memory/results")
    }

    fn progress(&mut self, _progress: &Progress) {}

    fn wants_view(&mut self) -> bool {
        self.views.is_some()
    }

    fn show_view(&mut self, view: &View) {
        if let Some(Ok(mut views)) = self.views.as_ref().map(|views| views.lock()) {
            views.push(view.clone());
        }
    }

    fn wants_pause(&mut self) -> bool {
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

    #[test]
    fn dots_above_the_root_stay() {
        assert_eq!(normalized(Path::new("a/../../b")), PathBuf::from("../b"));
        assert_eq!(normalized(Path::new("/a/./b/../c")), PathBuf::from("/a/c"));
    }
}
