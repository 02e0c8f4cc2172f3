//! Requests and answers.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use gapilib::script::world::{MemoryWorld, World};
use gapilib::script::{Options, Permissions, RunStatus, Session, Transcript};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What `gapilib.js` can ask.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Request {
    /// The script that is run: one of the files.
    script: PathBuf,
    /// The files, by their paths from the working directory, in base64.
    files: BTreeMap<PathBuf, String>,
    /// Whether the script may change files that it has not made.
    #[serde(default)]
    write: bool,
}

/// What it is told.
#[derive(Serialize)]
struct Answer {
    /// The exit code of `gapi run`.
    exit_code: u8,
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

/// Answers a request; an error of the request itself is `{"refused": MESSAGE}`.
pub(crate) fn answer(request: &[u8]) -> Vec<u8> {
    let answer = read(request).and_then(|(request, files)| answered(&request, &files));
    let written = answer.and_then(|answer| serde_json::to_vec(&answer).map_err(text));
    written.unwrap_or_else(|message| {
        serde_json::json!({ "refused": message }).to_string().into_bytes()
    })
}

fn text(error: impl ToString) -> String {
    error.to_string()
}

type Contents = BTreeMap<PathBuf, Vec<u8>>;

fn read(request: &[u8]) -> Result<(Request, Contents), String> {
    let mut request: Request = serde_json::from_slice(request).map_err(text)?;
    let decoded = |(path, content): (PathBuf, String)| match BASE64.decode(content) {
        Ok(bytes) => Ok((path, bytes)),
        Err(error) => Err(format!("{}: {error}", path.display())),
    };
    let files = std::mem::take(&mut request.files);
    let files = files.into_iter().map(decoded).collect::<Result<_, _>>()?;
    Ok((request, files))
}

fn answered(request: &Request, given: &Contents) -> Result<Answer, String> {
    let world =
        given.iter().fold(MemoryWorld::new(), |world, (path, bytes)| world.with_file(path, bytes));
    let streams = world.streams();
    let permissions = Permissions { write: request.write, ..Permissions::default() };
    let options = Options { permissions, ..Options::default() };
    let mut session = Session::new(Box::new(world)).with_options(options);
    session.output.transcript = Some(Transcript::default());
    let start = session.world.current_dir();
    let RunStatus { code, .. } = session.run_file(&request.script);
    let transcript = session.output.transcript.take().unwrap_or_default();
    let mut files = BTreeMap::new();
    collect(&*session.world, Path::new("/"), &mut files).map_err(text)?;
    let given: BTreeMap<PathBuf, &Vec<u8>> =
        given.iter().map(|(path, bytes)| (absolute(&start, path), bytes)).collect();
    let changed = files.iter().filter(|(path, bytes)| given.get(*path) != Some(bytes));
    let named = |path: &Path| path.strip_prefix(&start).unwrap_or(path).display().to_string();
    Ok(Answer {
        exit_code: code,
        output: streams.output(),
        errors: streams.errors(),
        transcript: transcript.to_string(),
        files: changed.map(|(path, bytes)| (named(path), BASE64.encode(bytes))).collect(),
    })
}

fn absolute(start: &Path, path: &Path) -> PathBuf {
    gapilib::script::world::normalized(&start.join(path))
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
