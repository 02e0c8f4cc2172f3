//! Where the shipped files are.

use gapilib::world::MemoryWorld;
use gapilib::{RunStatus, Session};
use std::path::{Path, PathBuf};

/// A path of the project.
pub(crate) fn project(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// All files below a folder of the project with this ending, sorted.
pub(crate) fn files(folder: &str, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    collect(&project(folder), ending, &mut found);
    found.sort();
    assert!(!found.is_empty(), "no .{ending} below {folder}");
    found
}

fn collect(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, ending, found);
        } else if path.extension().is_some_and(|extension| extension == ending) {
            found.push(path);
        }
    }
}

/// A world in memory that holds the shipped scripts, data and models in its working directory.
pub(crate) fn world() -> MemoryWorld {
    ["scripts", "models"].into_iter().fold(MemoryWorld::new(), |mut world, folder| {
        let mut found = Vec::new();
        for ending in ["mos", "mat", "csv", "mo", "order"] {
            collect(&project(folder), ending, &mut found);
        }
        for path in found {
            let name = path.strip_prefix(project("")).unwrap().to_owned();
            world = world.with_file(name, std::fs::read(&path).unwrap());
        }
        world
    })
}

/// What a script did.
pub(crate) struct Run {
    /// The session afterwards.
    pub(crate) session: Session,
    /// How it ended.
    pub(crate) status: RunStatus,
    /// What it wrote to standard error.
    pub(crate) errors: String,
}

impl Run {
    /// The codes of the errors, in order.
    pub(crate) fn codes(&self) -> Vec<&str> {
        let code = |line: &'_ str| Some(line.strip_prefix("error[")?.split_once(']')?.0.len());
        let lines = self.errors.lines();
        lines.filter_map(|line| code(line).map(|length| &line[6..6 + length])).collect()
    }
}

/// Runs a script in the world of the shipped files, in which it gets this name.
pub(crate) fn run(name: &str, script: &str) -> Run {
    run_in(world().with_file(name, script), name)
}

/// Runs a script of this world.
pub(crate) fn run_in(world: MemoryWorld, name: &str) -> Run {
    let streams = world.streams();
    let mut session = Session::new(Box::new(world));
    let status = session.run_file(Path::new(name));
    Run { session, status, errors: streams.errors() }
}
