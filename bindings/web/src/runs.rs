//! Runs of scripts.

use crate::protocol::text;
use crate::steps;
use crate::world::LiveWorld;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use gapilib::world::{Files, MemoryWorld, World};
use gapilib::{Options, Permissions, RunStatus, Session, Transcript};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Where the trace of a recorded run lies in its world.
const TRACE: &str = "/memory/results/run.trace";

/// A run that is asked for.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Run {
    /// The script that is run: one of the files.
    script: PathBuf,
    /// The files, by their paths from the working directory, in base64.
    files: BTreeMap<PathBuf, String>,
    /// Whether the script may change files that it has not made.
    #[serde(default)]
    write: bool,
    /// Whether somebody watches: there is a clock, the program's own models are there, the host gets
    /// events, and the steps are recorded.
    #[serde(default)]
    live: bool,
    /// Statements that change the run from a generation on.
    #[serde(default)]
    changes: Vec<Change>,
    /// Statements that the user has typed in the generations of a run that is computed again: one
    /// that is refused changes nothing.
    #[serde(default)]
    typed: Vec<Change>,
    /// Whether this is what would have been: it is shown beside the run that was recorded before.
    #[serde(default)]
    compare: bool,
    /// The generation that the run ends with as if the user had stopped it then.
    #[serde(default)]
    last: Option<u64>,
}

/// A statement that is executed when a generation is simulated.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Change {
    /// The generation, from 1.
    pub(crate) generation: usize,
    /// The statement.
    pub(crate) statement: String,
}

/// What came of it.
#[derive(Serialize)]
pub(crate) struct Answer {
    /// The exit code of `gapi run`.
    exit_code: u8,
    /// Whether the user has stopped the run.
    stopped: bool,
    /// Standard output.
    output: String,
    /// Standard error: the diagnostics as a terminal without colours shows them.
    errors: String,
    /// Statements and answers interleaved.
    transcript: String,
    /// The files that are new or changed, in base64; paths as in the request where they lie below
    /// the working directory.
    files: BTreeMap<String, String>,
}

type Contents = BTreeMap<PathBuf, Vec<u8>>;

/// Runs the script.
pub(crate) fn answered(mut run: Run) -> Result<Answer, String> {
    let given = decoded(std::mem::take(&mut run.files))?;
    let memory =
        given.iter().fold(MemoryWorld::new(), |world, (path, bytes)| world.with_file(path, bytes));
    let streams = memory.streams();
    let start = memory.current_dir();
    let world: Box<dyn World> = match run.live {
        true => Box::new(LiveWorld::new(memory, run.last, std::mem::take(&mut run.typed))),
        false => Box::new(memory),
    };
    let permissions = Permissions { write: run.write, ..Permissions::default() };
    let options = Options { permissions, ..Options::default() };
    let mut session = Session::new(world).with_options(options);
    session.output.transcript = Some(Transcript::default());
    prepare(&mut session, &run)?;
    let RunStatus { code, interrupted, .. } = session.run_file(&run.script);
    let transcript = session.output.transcript.take().unwrap_or_default();
    if run.live {
        keep_steps(&mut session, &run, code == 0 || interrupted);
    }
    let mut files = BTreeMap::new();
    collect(&*session.world, Path::new("/"), &mut files).map_err(text)?;
    let given: BTreeMap<PathBuf, &Vec<u8>> =
        given.iter().map(|(path, bytes)| (absolute(&start, path), bytes)).collect();
    let changed = files.iter().filter(|(path, bytes)| given.get(*path) != Some(bytes));
    let named = |path: &Path| path.strip_prefix(&start).unwrap_or(path).display().to_string();
    Ok(Answer {
        exit_code: code,
        stopped: interrupted,
        output: streams.output(),
        errors: streams.errors(),
        transcript: transcript.to_string(),
        files: changed.map(|(path, bytes)| (named(path), BASE64.encode(bytes))).collect(),
    })
}

/// Prepares the recording of the steps, and the changes.
fn prepare(session: &mut Session, run: &Run) -> Result<(), String> {
    if run.live {
        session.world.permit_file(Path::new(TRACE));
        session.trace_to(Path::new(TRACE)).map_err(|fault| fault.message)?;
    }
    for Change { generation, statement } in &run.changes {
        session.branch_at(*generation, statement).map_err(|wrong| wrong.message.clone())?;
    }
    Ok(())
}

/// Takes the trace out of the world: the page of the steps is made of it when it is asked for. What
/// a run would have been is no result where it has failed; the comparison before it stays.
fn keep_steps(session: &mut Session, run: &Run, has_ended: bool) {
    let trace = session.world.read(Path::new(TRACE)).unwrap_or_default();
    let result = session.world.read(&session.world.output_dir().join("result.json")).ok();
    let result = result.and_then(|bytes| String::from_utf8(bytes).ok());
    let removed = session.world.remove(Path::new(TRACE));
    debug_assert!(removed.is_ok(), "the trace is the run's own");
    if run.compare && !has_ended {
        return;
    }
    steps::keep(trace, result, run.compare.then(|| run.changes.last().cloned()).flatten());
}

fn decoded(files: BTreeMap<PathBuf, String>) -> Result<Contents, String> {
    let decoded = |(path, content): (PathBuf, String)| match BASE64.decode(content) {
        Ok(bytes) => Ok((path, bytes)),
        Err(error) => Err(format!("{}: {error}", path.display())),
    };
    files.into_iter().map(decoded).collect()
}

fn absolute(start: &Path, path: &Path) -> PathBuf {
    gapilib::world::normalized(&start.join(path))
}

/// All files below a folder of a world.
fn collect(world: &dyn World, folder: &Path, found: &mut Contents) -> std::io::Result<()> {
    for name in world.list_dir(folder)? {
        let path = folder.join(name);
        match world.is_dir(&path) {
            true => collect(world, &path, found)?,
            false => drop(found.insert(path.clone(), world.read(&path)?)),
        }
    }
    Ok(())
}
