//! Scripts of a folder, run in a world in memory.

use gapilib::world::MemoryWorld;
use gapilib::{Options, Session, Transcript};
use std::fs;
use std::path::Path;

/// A world whose working directory holds the files of a folder, snapshots left out.
pub(crate) fn world_of(folder: &Path) -> MemoryWorld {
    let mut world = MemoryWorld::new()
        .with_variable("SECRET", "a secret")
        .with_variable("SECRET_TOKEN", "a secret");
    let mut folders = vec![folder.to_path_buf()];
    while let Some(current) = folders.pop() {
        for entry in fs::read_dir(&current).expect("a readable folder") {
            let path = entry.expect("a readable entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_none_or(|extension| extension != "snap") {
                let bytes = fs::read(&path).expect("a readable file");
                world = world.with_file(path.strip_prefix(folder).expect("inside"), bytes);
            }
        }
    }
    world
}

/// Runs a script of a folder and returns the transcript, with the exit code as its last line.
pub(crate) fn transcript_of(path: &Path, options: Options) -> String {
    let folder = path.parent().expect("a script lies in a folder");
    let name = path.file_name().expect("a script has a name");
    let mut session = Session::new(Box::new(world_of(folder))).with_options(options);
    session.output.transcript = Some(Transcript::default());
    let status = session.run_file(Path::new(name));
    let transcript = session.output.transcript.take().unwrap_or_default();
    format!("{transcript}[exit code {}]\n", status.code)
}
