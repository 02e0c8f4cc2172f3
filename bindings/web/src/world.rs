//! The world of a run that somebody watches: the files are in memory, those of the program's own
//! models included; events are sent to the host, and the host is asked for the user's commands.

use crate::host::{self, Command};
use crate::runs::Change;
use gapilib::internals::packages;
use gapilib::internals::script::access::policy::{Access, Grant};
use gapilib::internals::script::runs::view::{Fitted, Progress, Spread, View};
use gapilib::world::{Environment, FileAccess, FileReader, Files, MemoryWorld, Screen, Stamp};
use serde_json::json;
use std::cell::Cell;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Seconds between two looks for messages: a press of a button is answered at once, and the looks
/// take less than a hundredth of the time.
const LOOK_EVERY: f64 = 0.03;
/// Seconds between two pictures of the run, which take some milliseconds each to draw.
const SHOW_EVERY: f64 = 0.1;
/// Of these generations each has a picture.
const SHOW_FIRST: u64 = 60;
/// The clock is read once in so many questions whether to stop: loops ask millions of times.
const CLOCK_EVERY: u32 = 16;

/// The world.
pub(crate) struct LiveWorld {
    memory: MemoryWorld,
    asked: Cell<u32>,
    looked: Cell<f64>,
    stops: Cell<bool>,
    changes: Cell<bool>,
    shown: f64,
    generation: u64,
    /// How many there will be; 0 where that is not known.
    total: u64,
    /// The generation that the run ends with, if the user has stopped it before.
    last: Option<u64>,
    /// What the user types in generations to come, where the engine cannot ask him meanwhile.
    typed: Vec<Change>,
}

impl LiveWorld {
    /// A world with these files.
    pub(crate) fn new(memory: MemoryWorld, last: Option<u64>, typed: Vec<Change>) -> LiveWorld {
        LiveWorld {
            memory,
            asked: Cell::new(0),
            looked: Cell::new(host::monotonic()),
            stops: Cell::new(false),
            changes: Cell::new(false),
            shown: f64::NEG_INFINITY,
            generation: 0,
            total: 0,
            last,
            typed,
        }
    }

    /// Whether something is to be typed in this generation.
    fn is_due(&self) -> bool {
        self.typed.iter().any(|change| change.generation as u64 == self.generation)
    }

    /// Looks for messages where that was long ago.
    fn look(&self) {
        let now = host::monotonic();
        if now - self.looked.get() < LOOK_EVERY {
            return;
        }
        match host::poll() {
            Command::Stop => self.stops.set(true),
            Command::Change => self.changes.set(true),
            Command::Continue => {}
        }
        // The user may have paused the run meanwhile.
        self.looked.set(host::monotonic());
    }
}

impl Screen for LiveWorld {
    fn print(&mut self, text: &str) {
        self.memory.print(text);
        host::send(&json!({ "print": text }));
    }

    fn eprint(&mut self, text: &str) {
        self.memory.eprint(text);
        host::send(&json!({ "eprint": text }));
    }

    fn progress(&mut self, progress: &Progress) {
        // The one at hand is counted when it is rated.
        self.generation = progress.done + 1;
        self.total = progress.total;
    }

    fn is_view_due(&mut self) -> bool {
        // One can go back to each of the first ones, and the last is the one that remains.
        let is_wanted = self.generation <= SHOW_FIRST || self.generation == self.total;
        is_wanted || host::monotonic() - self.shown >= SHOW_EVERY
    }

    fn show_view(&mut self, view: &View) {
        self.shown = host::monotonic();
        host::send(&json!({ "view": described(view) }));
    }

    fn is_pause_requested(&mut self) -> bool {
        self.look();
        self.changes.replace(false) || self.is_due()
    }

    fn begin_pause(&mut self, _help: &str) {}

    fn ask(&mut self, _prompt: &str) -> Option<String> {
        let is_due = |change: &mut Change| change.generation as u64 == self.generation;
        let planned = self.typed.extract_if(.., is_due).next();
        planned.map(|change| change.statement).or_else(host::next_line)
    }

    fn changed(&mut self, line: &str, outcome: Result<(), &str>) {
        let change = json!({
            "generation": self.generation, "statement": line.trim(), "refused": outcome.err(),
        });
        host::send(&json!({ "typed": change }));
    }
}

fn described(view: &View) -> serde_json::Value {
    let Progress { label, done, total, best, failures, main_cause } = &view.progress;
    let spread = |Spread { name, unit, value, best, generation }: &Spread| json!({ "name": name, "unit": unit, "value": value, "best": best, "generation": generation });
    let fitted = |Fitted { y_title, x_title, x, measured, simulated }: &Fitted| json!({ "y_name": y_title, "x_name": x_title, "x": x, "measured": measured, "simulated": simulated });
    json!({
        "title": view.title,
        "progress": { "label": label, "done": done, "total": total, "best": best, "failures": failures, "main_cause": main_cause },
        "best": view.best,
        "spreads": view.spreads.iter().map(spread).collect::<Vec<_>>(),
        "fitted": view.fitted.iter().map(fitted).collect::<Vec<_>>(),
    })
}

impl Environment for LiveWorld {
    fn env(&self, name: &str) -> Option<String> {
        self.memory.env(name)
    }

    fn monotonic_seconds(&self) -> f64 {
        host::monotonic()
    }

    fn unix_seconds(&self) -> u64 {
        host::unix() as u64
    }

    fn is_interrupted(&self) -> bool {
        self.asked.set(self.asked.get().wrapping_add(1));
        if self.asked.get().is_multiple_of(CLOCK_EVERY) {
            self.look();
        }
        self.stops.get() || self.last.is_some_and(|last| self.generation >= last)
    }

    fn threads(&self) -> usize {
        1
    }
}

/// Files in memory, and the program's own models.
#[derive(Debug)]
struct Reader(Arc<dyn FileReader>);

impl FileReader for Reader {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        packages::read(path).map_or_else(|| self.0.read(path), |bytes| Ok(bytes.to_vec()))
    }

    fn list_dir(&self, path: &Path) -> io::Result<Vec<String>> {
        packages::list(path).map_or_else(|| self.0.list_dir(path), Ok)
    }

    fn is_file(&self, path: &Path) -> bool {
        packages::read(path).is_some() || self.0.is_file(path)
    }
}

impl FileAccess for LiveWorld {
    fn grant(&mut self, grant: Grant<'_>) {
        self.memory.grant(grant);
    }

    fn permits(&self, path: &Path, access: Access) -> io::Result<()> {
        self.memory.permits(path, access)
    }
}

impl Files for LiveWorld {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        packages::read(path).map_or_else(|| self.memory.read(path), |bytes| Ok(bytes.to_vec()))
    }

    fn write(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        self.memory.write(path, bytes)
    }

    fn append(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        self.memory.append(path, bytes)
    }

    fn remove(&mut self, path: &Path) -> io::Result<()> {
        self.memory.remove(path)
    }

    fn exists(&self, path: &Path) -> bool {
        packages::read(path).is_some() || packages::list(path).is_some() || self.memory.exists(path)
    }

    fn is_dir(&self, path: &Path) -> bool {
        packages::list(path).is_some() || self.memory.is_dir(path)
    }

    fn stamp(&self, path: &Path) -> Option<Stamp> {
        self.memory.stamp(path)
    }

    fn list_dir(&self, path: &Path) -> io::Result<Vec<String>> {
        packages::list(path).map_or_else(|| self.memory.list_dir(path), Ok)
    }

    fn reader(&self) -> Arc<dyn FileReader> {
        Arc::new(Reader(self.memory.reader()))
    }

    fn create_dirs(&mut self, path: &Path) -> io::Result<()> {
        self.memory.create_dirs(path)
    }

    fn current_dir(&self) -> PathBuf {
        self.memory.current_dir()
    }

    fn set_current_dir(&mut self, path: &Path) -> io::Result<()> {
        self.memory.set_current_dir(path)
    }

    fn output_dir(&self) -> PathBuf {
        self.memory.output_dir()
    }
}
