//! Every system call by which a run writes, failing one after the other: the creation of a temporary
//! file, each write into it, its sync, the renaming, appending to a journal, making folders and
//! removing. Afterwards the results are complete, or a resume completes them to the same bytes.
//!
//! The world in memory of `tests/suite/tools/faults.rs` fails whole operations; here each falls apart
//! into its calls, on a real folder.
//!
//! Reference: the way SQLite is tested (I/O error and crash tests).

use super::steps::failing::{Failure, PLAN, Plan, has_crashed};
use super::*;
use crate::budget::memory_requests;
use crate::script::runs::problem::{RunOptions, solve};
use crate::script::runs::view::Progress;
use crate::script::world::{Environment, FileAccess, Files, MemoryWorld, Screen, Stamp};
use crate::script::{Journaling, Options, Session};
use std::cell::Cell;
use std::sync::Arc;

const MODEL: &str = "model Growth
  parameter Real a = 1;
  parameter Real b = 1;
  output Real y = a*time + b*time^2;
  annotation(experiment(StopTime = 3));
end Growth;
";
const PROBLEM: &str = "model = \"Growth\"
files = [\"Growth.mo\"]
[parameters]
a = { min = 0, max = 9 }
b = { min = 0, max = 9 }
[method]
name = \"gapilib2006\"
[stop]
generations = 4
[checkpoint]
generations = 1
[[experiment]]
data = \"d.csv\"
x = \"time\"
outputs = { y = \"y\" }
";
const SCRIPT: &str = "openModel(\"Growth.mo\");
pop = {{0.5, 0.5}, {1.5, 1.0}, {2.5, 1.5}, {3.5, 2.0}};
for k in 1:3 loop
  sim := Eval(\"\", \"Growth\", {0.5, 1.0, 2.0, 3.0}, pop, {\"a\", \"b\"}, \"time\", \"y\");
  fit := Fit(sim, {1.1, 3.2, 9.9, 21.0});
  pop := 0.9*pop + 0.2*ones(4, 2);
end for;
";

/// The disk in a folder; all else in memory, and a clock that advances at every read.
struct DiskWorld {
    disk: Arc<Disk>,
    root: PathBuf,
    rest: MemoryWorld,
    clock: Cell<f64>,
}

impl DiskWorld {
    fn new(root: &Path) -> DiskWorld {
        let (disk, rest) = (Disk::default(), MemoryWorld::new());
        disk.grant(Grant::Create(root));
        disk.grant(Grant::Own(&root.join("results")));
        remove_temporary_files(&root.join("results"));
        DiskWorld { disk: Arc::new(disk), root: root.to_owned(), rest, clock: Cell::new(0.0) }
    }

    fn at(&self, path: &Path) -> PathBuf {
        self.root.join(path)
    }
}

impl FileAccess for DiskWorld {
    fn grant(&mut self, grant: Grant<'_>) {
        let path = grant.path().map(|path| self.at(path)).unwrap_or_default();
        self.disk.grant(grant.with_path(&path));
    }

    fn permits(&self, path: &Path, access: Access) -> io::Result<()> {
        self.disk.permits(&self.at(path), access)
    }
}

impl Files for DiskWorld {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.disk.read(&self.at(path))
    }

    fn write(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        self.disk.write(&self.at(path), bytes)
    }

    fn write_with(&mut self, path: &Path, content: Content<'_>) -> io::Result<()> {
        self.disk.write_with(&self.at(path), content)
    }

    fn append(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        self.disk.append(&self.at(path), bytes)
    }

    fn sync(&mut self, path: &Path) -> io::Result<()> {
        self.disk.sync(&self.at(path))
    }

    fn remove(&mut self, path: &Path) -> io::Result<()> {
        self.disk.remove(&self.at(path))
    }

    fn create_dirs(&mut self, path: &Path) -> io::Result<()> {
        self.disk.create_folders(&self.at(path))
    }

    fn exists(&self, path: &Path) -> bool {
        packages::read(path).is_some() || packages::list(path).is_some() || self.at(path).exists()
    }

    fn is_dir(&self, path: &Path) -> bool {
        packages::list(path).is_some() || self.at(path).is_dir()
    }

    fn stamp(&self, _: &Path) -> Option<Stamp> {
        None
    }

    fn list_dir(&self, path: &Path) -> io::Result<Vec<String>> {
        self.disk.list_dir(&self.at(path))
    }

    fn reader(&self) -> Arc<dyn FileReader> {
        self.disk.clone()
    }

    fn current_dir(&self) -> PathBuf {
        self.root.clone()
    }

    fn set_current_dir(&mut self, _: &Path) -> io::Result<()> {
        Ok(())
    }

    fn output_dir(&self) -> PathBuf {
        self.root.join("results")
    }
}

impl Environment for DiskWorld {
    fn is_interrupted(&self) -> bool {
        // The process is no more: it ends as soon as it asks.
        has_crashed()
    }
    fn monotonic_seconds(&self) -> f64 {
        self.clock.set(self.clock.get() + 1.0);
        self.clock.get()
    }
    fn threads(&self) -> usize {
        1
    }
    fn env(&self, _: &str) -> Option<String> {
        None
    }
    fn unix_seconds(&self) -> u64 {
        self.rest.unix_seconds()
    }
}

impl Screen for DiskWorld {
    fn print(&mut self, text: &str) {
        self.rest.print(text);
    }
    fn eprint(&mut self, text: &str) {
        self.rest.eprint(text);
    }
    fn progress(&mut self, _: &Progress) {}
}

/// What reads, computes and writes more than a little.
const LARGE_SCRIPT: &str = "openModel(\"Growth.mo\");
simulateModel(\"Growth\", resultFile = \"first\");
simulateModel(\"Growth\", resultFile = \"second\");
x := ones(300, 300);
y := 2*x;
s := readFile(\"d.csv\");
";

type Job = fn(DiskWorld, bool) -> bool;

fn identify(world: DiskWorld, resume: bool) -> bool {
    let mut session = Session::new(Box::new(world));
    let options = RunOptions { resume, ..RunOptions::default() };
    let solved = solve(&mut session, Path::new("p.toml"), &options);
    for error in solved.as_ref().err().into_iter().flatten() {
        session.world.eprint(&error.message);
    }
    solved.is_ok()
}

fn run(world: DiskWorld, resume: bool) -> bool {
    let journaling = if resume { Journaling::Resume(1.0) } else { Journaling::Fresh(1.0) };
    let options = Options { journaling, ..Options::default() };
    let mut session = Session::new(Box::new(world)).with_options(options);
    session.run_text("job.mos", SCRIPT).code == 0
}

#[test]
fn only_what_has_to_be_safe_waits_for_the_disk() {
    let place = Place::new();
    let steps = |work: fn(&mut DiskWorld) -> io::Result<()>| {
        PLAN.set(Plan::default());
        let mut world = DiskWorld::new(&place.root);
        work(&mut world).expect("written");
        PLAN.replace(Plan::default()).done
    };
    // The first file that is made begins the record of files.
    steps(|world| world.write(Path::new("first.txt"), b"content"));
    let safe = steps(|world| world.write(Path::new("safe.txt"), b"content"));
    let buffered = steps(|world| {
        world.write_with(Path::new("buffered.txt"), &mut |to| to.write_all(b"content"))
    });
    assert_eq!(safe, buffered + 1, "one step makes the content safe");
}

/// A folder of a run, and what happened there.
struct Place {
    _folder: tempfile::TempDir,
    root: PathBuf,
}

impl Place {
    fn new() -> Place {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let root = folder.path().canonicalize().expect("an absolute path");
        let data = "time,y\n0.5,1.1\n1,3.2\n2,9.9\n3,21\n";
        for (name, text) in [("Growth.mo", MODEL), ("p.toml", PROBLEM), ("d.csv", data)] {
            fs::write(root.join(name), text).expect("written");
        }
        Place { _folder: folder, root }
    }

    /// Runs a job; whether it ended without an error, what it said, and the steps that it took.
    fn drive(
        &self,
        job: Job,
        fail_at: Option<(usize, Failure)>,
        resume: bool,
    ) -> (bool, String, usize) {
        PLAN.set(Plan { done: 0, fail_at });
        let world = DiskWorld::new(&self.root);
        let streams = world.rest.streams();
        let succeeded = job(world, resume);
        let steps = PLAN.replace(Plan::default()).done;
        (succeeded, streams.output() + &streams.errors(), steps)
    }

    /// The results by their names, without the time that they took.
    fn results(&self) -> Vec<(String, Vec<u8>)> {
        let entries = fs::read_dir(self.root.join("results")).into_iter().flatten().flatten();
        let mut found: Vec<_> = entries
            .map(|entry| entry.path())
            .filter(|path| path.is_file())
            .map(|path| (path.file_name().unwrap_or_default().to_string_lossy().into_owned(), path))
            .filter(|(name, _)| name != "timing.json")
            .map(|(name, path)| (name, fs::read(path).expect("readable")))
            .collect();
        found.sort();
        found
    }
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

type Contents = Vec<(String, Vec<u8>)>;

/// Journals and temporary files, and the results proper.
fn apart(files: Contents) -> (Contents, Contents) {
    let is_temporary = |name: &str| name.ends_with(".journal") || name.ends_with(".gapi-tmp");
    files.into_iter().partition(|(name, _)| is_temporary(name))
}

/// Drives a job through every failing step; how many there are.
#[allow(clippy::print_stdout, reason = "the number is asked for with --nocapture")]
fn every_step(job: Job, failure: Failure) -> usize {
    let whole = Place::new();
    let (succeeded, text, steps) = whole.drive(job, None, false);
    assert!(succeeded, "{text}");
    let expected = whole.results();
    assert!(expected.iter().any(|(name, _)| name == "result.json"), "{text}");
    for at in 1..=steps {
        let name = format!("{failure:?} at step {at} of {steps}");
        let place = Place::new();
        let (succeeded, text, _) = place.drive(job, Some((at, failure)), false);
        if failure == Failure::Fault && succeeded {
            let (left, found) = apart(place.results());
            same(&found, &apart(expected.clone()).1, &name, &text);
            if left.iter().all(|(name, _)| name == "finished.journal") {
                continue;
            }
            // They could not be removed; resumed, the run ends where it was.
        } else if failure == Failure::Fault {
            assert!(text.contains("no space left"), "{name}: {text}");
        }
        let (succeeded, text, _) = place.drive(job, None, true);
        assert!(succeeded, "{name}: {text}");
        same(&place.results(), &expected, &name, &text);
    }
    println!("{failure:?}: {steps} steps");
    steps
}

#[test]
fn identify_survives_every_failing_call() {
    assert!(every_step(identify, Failure::Fault) > 30);
}

#[test]
fn identify_survives_an_end_at_every_call() {
    assert!(every_step(identify, Failure::Crash) > 30);
}

#[test]
fn run_survives_every_failing_call() {
    assert!(every_step(run, Failure::Fault) > 20);
}

#[test]
fn run_survives_an_end_at_every_call() {
    assert!(every_step(run, Failure::Crash) > 20);
}

#[test]
fn a_request_for_memory_that_fails_is_an_error() {
    let large: Job =
        |world, _| Session::new(Box::new(world)).run_text("l.mos", LARGE_SCRIPT).code == 0;
    for (job, resumes, least) in [(large, false, 4), (identify as Job, true, 3)] {
        let whole = Place::new();
        let ((succeeded, text, _), requests) =
            memory_requests::failing_at(0, || whole.drive(job, None, false));
        assert!(succeeded && requests >= least, "{requests}: {text}");
        for at in 1..=requests {
            let place = Place::new();
            let ((succeeded, text, _), _) =
                memory_requests::failing_at(at, || place.drive(job, None, false));
            // What is only kept for later may be missing in silence.
            let is_said = text.contains("memory");
            assert!(succeeded != is_said, "request {at} of {requests}: {text}");
            let (succeeded, text, _) = place.drive(job, None, resumes && !succeeded);
            assert!(succeeded, "after request {at}: {text}");
            // The record of files has a line for each time that a file was made.
            let [found, expected] = [&place, &whole].map(|place| {
                let files = place.results().into_iter();
                files.filter(|(name, _)| name != "files_made.txt").collect::<Contents>()
            });
            same(&found, &expected, &format!("request {at}"), &text);
        }
    }
}
