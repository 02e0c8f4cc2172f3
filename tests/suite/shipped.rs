//! Where the shipped files are.

use gapilib::script::world::MemoryWorld;
use gapilib::script::{RunStatus, Session};
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

/// A session in that world, with one more script, which has been run.
pub(crate) fn run(name: &str, script: &str) -> (Session, RunStatus) {
    let mut session = Session::new(Box::new(world().with_file(name, script)));
    let status = session.run_file(Path::new(name));
    (session, status)
}
