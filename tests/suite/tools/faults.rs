//! Every point at which the file system can fail, one after the other: afterwards the result is
//! complete, or a resume completes it to the same bytes.
//!
//! Two kinds of failure. A *fault* is one call that fails (a full disk, a share that is away), with
//! half of an append written; the run goes on and decides itself. A *crash* is the end of the
//! process at that call: nothing happens behind it, and an append may have got half of its bytes to
//! the disk. Writes are all or nothing in both, as the world promises; that its implementation on
//! disks keeps the promise is tested where it stands (`src/cli/disk`).
//!
//! Reference: the way SQLite is tested (I/O error and crash tests).

use gapilib::internals::script::access::policy::{Access, Grant};
use gapilib::internals::script::runs::problem::{RunOptions, solve};
use gapilib::internals::script::runs::view::Progress;
use gapilib::internals::script::runs::view::View;
use gapilib::world::{Environment, FileAccess, FileReader, Files, MemoryWorld, Screen, Stamp};
use gapilib::{Journaling, Options, Session};
use std::cell::RefCell;
use std::io;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

const MODEL: &str = "model Growth
  parameter Real a = 1;
  parameter Real b = 1;
  output Real y = a*time + b*time^2;
  annotation(experiment(StopTime = 3));
end Growth;
";
const DATA: &str = "time,y\n0.5,1.1\n1,3.2\n2,9.9\n3,21\n";
const PROBLEM: &str = "model = \"Growth\"
files = [\"Growth.mo\"]
[parameters]
a = { min = 0, max = 9 }
b = { min = 0, max = 9 }
[method]
name = \"gapilib2006\"
[stop]
generations = 6
[checkpoint]
seconds = 1
[[experiment]]
data = \"d.csv\"
x = \"time\"
outputs = { y = \"y\" }
";
const SCRIPT: &str = "openModel(\"Growth.mo\");
pop = {{0.5, 0.5}, {1.5, 1.0}, {2.5, 1.5}, {3.5, 2.0}};
for k in 1:5 loop
  sim := Eval(\"\", \"Growth\", {0.5, 1.0, 2.0, 3.0}, pop, {\"a\", \"b\"}, \"time\", \"y\");
  fit := Fit(sim, {1.1, 3.2, 9.9, 21.0});
  pop := 0.9*pop + 0.2*ones(4, 2);
end for;
";

/// What happens at the n-th call that changes files.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Failure {
    Fault,
    Crash,
}

#[derive(Debug, Default)]
struct Calls {
    done: usize,
    fail_at: Option<(usize, Failure)>,
    seconds: f64,
    /// The world at the moment of the crash.
    frozen: Option<MemoryWorld>,
}

/// A world in memory whose n-th change fails, and whose clock goes on at every look.
struct FaultyWorld {
    inner: Rc<RefCell<MemoryWorld>>,
    calls: Rc<RefCell<Calls>>,
}

fn full() -> io::Error {
    io::Error::new(io::ErrorKind::StorageFull, "no space left on device")
}

impl FaultyWorld {
    /// Whether this change fails; a crash freezes the world, `torn` being what it has left.
    fn fails(&mut self, torn: impl FnOnce(&mut MemoryWorld)) -> bool {
        let mut calls = self.calls.borrow_mut();
        if calls.frozen.is_some() {
            return true;
        }
        calls.done += 1;
        let Some((_, failure)) = calls.fail_at.filter(|(at, _)| *at == calls.done) else {
            return false;
        };
        torn(&mut self.inner.borrow_mut());
        if failure == Failure::Crash {
            calls.frozen = Some(self.inner.borrow().clone());
        }
        true
    }
}

impl FileAccess for FaultyWorld {
    fn grant(&mut self, grant: Grant<'_>) {
        self.inner.borrow_mut().grant(grant);
    }

    fn permits(&self, path: &Path, access: Access) -> io::Result<()> {
        self.inner.borrow().permits(path, access)
    }
}

impl Files for FaultyWorld {
    fn write(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        if self.fails(|_| {}) { Err(full()) } else { self.inner.borrow_mut().write(path, bytes) }
    }

    fn append(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let half = &bytes[..bytes.len() / 2];
        if self.fails(|world| world.append(path, half).unwrap_or_default()) {
            return Err(full());
        }
        self.inner.borrow_mut().append(path, bytes)
    }

    fn sync(&mut self, path: &Path) -> io::Result<()> {
        if self.fails(|_| {}) { Err(full()) } else { self.inner.borrow_mut().sync(path) }
    }

    fn remove(&mut self, path: &Path) -> io::Result<()> {
        if self.fails(|_| {}) { Err(full()) } else { self.inner.borrow_mut().remove(path) }
    }

    fn create_dirs(&mut self, path: &Path) -> io::Result<()> {
        if self.fails(|_| {}) { Err(full()) } else { self.inner.borrow_mut().create_dirs(path) }
    }

    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.inner.borrow().read(path)
    }

    fn exists(&self, path: &Path) -> bool {
        self.inner.borrow().exists(path)
    }

    fn is_dir(&self, path: &Path) -> bool {
        self.inner.borrow().is_dir(path)
    }

    fn stamp(&self, path: &Path) -> Option<Stamp> {
        self.inner.borrow().stamp(path)
    }

    fn list_dir(&self, path: &Path) -> io::Result<Vec<String>> {
        self.inner.borrow().list_dir(path)
    }

    fn reader(&self) -> Arc<dyn FileReader> {
        self.inner.borrow().reader()
    }

    fn current_dir(&self) -> PathBuf {
        self.inner.borrow().current_dir()
    }

    fn set_current_dir(&mut self, path: &Path) -> io::Result<()> {
        self.inner.borrow_mut().set_current_dir(path)
    }

    fn output_dir(&self) -> PathBuf {
        self.inner.borrow().output_dir()
    }
}

impl Environment for FaultyWorld {
    fn is_interrupted(&self) -> bool {
        // The process is no more: it ends as soon as it asks.
        self.calls.borrow().frozen.is_some()
    }
    fn monotonic_seconds(&self) -> f64 {
        let mut calls = self.calls.borrow_mut();
        calls.seconds += 1.0;
        calls.seconds
    }
    fn env(&self, name: &str) -> Option<String> {
        self.inner.borrow().env(name)
    }
    fn unix_seconds(&self) -> u64 {
        self.inner.borrow().unix_seconds()
    }
    fn threads(&self) -> usize {
        1
    }
}

impl Screen for FaultyWorld {
    fn print(&mut self, text: &str) {
        self.inner.borrow_mut().print(text);
    }
    fn eprint(&mut self, text: &str) {
        self.inner.borrow_mut().eprint(text);
    }
    fn progress(&mut self, progress: &Progress) {
        self.inner.borrow_mut().progress(progress);
    }
    fn show_view(&mut self, view: &View) {
        self.inner.borrow_mut().show_view(view);
    }
}

/// A run in such a world.
struct Run {
    /// Whether it ended without an error.
    succeeded: bool,
    /// What it printed.
    text: String,
    /// The files at its end, or at the crash.
    left: MemoryWorld,
    /// Changes that it tried.
    changes: usize,
}

type Job = fn(FaultyWorld, bool) -> bool;

fn identify(world: FaultyWorld, resume: bool) -> bool {
    let mut session = Session::new(Box::new(world));
    let options = RunOptions { resume, ..RunOptions::default() };
    let solved = solve(&mut session, Path::new("p.toml"), &options);
    for error in solved.as_ref().err().into_iter().flatten() {
        session.world.eprint(&error.message);
    }
    solved.is_ok()
}

fn run(world: FaultyWorld, resume: bool) -> bool {
    let journaling = if resume { Journaling::Resume(1.0) } else { Journaling::Fresh(1.0) };
    let options = Options { journaling, ..Options::default() };
    let mut session = Session::new(Box::new(world)).with_options(options);
    session.run_text("job.mos", SCRIPT).code == 0
}

fn start() -> MemoryWorld {
    let files = [("Growth.mo", MODEL), ("d.csv", DATA), ("p.toml", PROBLEM)];
    files.iter().fold(MemoryWorld::new(), |world, (name, text)| world.with_file(name, text))
}

/// The results that a world holds, by their names, without the time that they took.
fn results(world: &MemoryWorld) -> Vec<(String, Vec<u8>)> {
    let folder = world.output_dir();
    let names = world.list_dir(&folder).unwrap_or_default().into_iter();
    let file = |name: String| world.read(&folder.join(&name)).ok().map(|bytes| (name, bytes));
    names.filter(|name| name != "timing.json").filter_map(file).collect()
}

/// The next process in the same folder.
fn next(left: &MemoryWorld) -> MemoryWorld {
    let folder = left.output_dir();
    let kept = results(left).into_iter();
    kept.fold(start(), |world, (name, bytes)| world.with_file(folder.join(name), bytes))
}

fn drive(job: Job, world: MemoryWorld, fail_at: Option<(usize, Failure)>, resume: bool) -> Run {
    let streams = world.streams();
    let calls = Rc::new(RefCell::new(Calls { fail_at, ..Calls::default() }));
    let inner = Rc::new(RefCell::new(world));
    let succeeded = job(FaultyWorld { inner: Rc::clone(&inner), calls: Rc::clone(&calls) }, resume);
    let mut calls = calls.borrow_mut();
    let left = calls.frozen.take().unwrap_or_else(|| inner.borrow().clone());
    Run { succeeded, text: streams.output() + &streams.errors(), left, changes: calls.done }
}

type Contents = Vec<(String, Vec<u8>)>;

/// Journals, and the results proper.
fn apart(files: Contents) -> (Contents, Contents) {
    files.into_iter().partition(|(name, _)| name.ends_with(".journal"))
}

/// Drives a job through every failure point; how many there are.
fn every_point(job: Job, failure: Failure) -> usize {
    let whole = drive(job, start(), None, false);
    assert!(whole.succeeded, "{}", whole.text);
    let expected = results(&whole.left);
    assert!(expected.iter().any(|(name, _)| name == "result.json"), "{expected:?}");
    for at in 1..=whole.changes {
        let place = format!("{failure:?} at change {at} of {}", whole.changes);
        let failed = drive(job, start(), Some((at, failure)), false);
        if failed.succeeded && failure == Failure::Fault {
            let (journals, found) = apart(results(&failed.left));
            same(&found, &apart(expected.clone()).1, &place, &failed.text);
            if journals.iter().all(|(name, _)| name == "finished.journal") {
                continue;
            }
            // It could not be removed; resumed, the run ends where it was.
        } else if failure == Failure::Fault {
            assert!(failed.text.contains("no space left"), "{place}: {}", failed.text);
        }
        let resumed = drive(job, next(&failed.left), None, true);
        assert!(resumed.succeeded, "{place}: {}", resumed.text);
        same(&results(&resumed.left), &expected, &place, &resumed.text);
    }
    whole.changes
}

fn same(found: &[(String, Vec<u8>)], expected: &[(String, Vec<u8>)], place: &str, text: &str) {
    let names = |files: &[(String, Vec<u8>)]| {
        files.iter().map(|(name, _)| name.clone()).collect::<Vec<String>>()
    };
    assert_eq!(names(found), names(expected), "{place}: {text}");
    for ((name, found), (_, expected)) in found.iter().zip(expected) {
        assert!(found == expected, "{place}: {name} differs\n{text}");
    }
}

#[test]
fn identify_survives_every_fault() {
    assert!(every_point(identify, Failure::Fault) > 20);
}

#[test]
fn identify_survives_every_crash() {
    assert!(every_point(identify, Failure::Crash) > 20);
}

#[test]
fn run_survives_every_fault() {
    assert!(every_point(run, Failure::Fault) > 20);
}

#[test]
fn run_survives_every_crash() {
    assert!(every_point(run, Failure::Crash) > 20);
}
