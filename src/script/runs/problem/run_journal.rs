//! The journal of a run in the folder of its results: begun, or read where the run resumes.

use super::RunOptions;
use crate::Session;
use crate::bail;
use crate::diag::Fault;
use crate::identify::problem::{self as solving, Origins, Run};
use crate::registry::BAD_OPTION;
use crate::runs::checkpoint::{self, Checkpoint, keep_old};
use std::path::{Path, PathBuf};

/// Where the journals of a problem's runs lie, and what they depend on.
pub(super) struct Journalled<'a> {
    pub(super) folder: &'a Path,
    pub(super) origins: &'a Origins,
    /// Questions and seconds between two checkpoints.
    pub(super) every: (Option<u64>, f64),
}

/// Reads the checkpoint of an earlier run, or begins one.
pub(super) fn open(
    session: &mut Session,
    run: &mut Run,
    (path, known): (&Path, Option<&[u8]>),
    files: &Journalled<'_>,
    options: &RunOptions,
) -> Result<Checkpoint, Fault> {
    let origins = files.origins;
    let exists = session.world.exists(path);
    let asks = exists && !options.resume && !options.fresh;
    let left = if asks { changed_since(session, path, origins)? } else { None };
    if asks && left.is_none() {
        bail!(
            BAD_OPTION,
            "`{}` contains an earlier run that did not finish", path.display();
            help: "continue it with `--resume`, or discard it with `--fresh`"
        );
    }
    let mut bytes = solving::header(origins);
    let finished = finished(path);
    let known = match known {
        Some(journal) => Some(journal.to_vec()),
        None if options.resume => left_journal(session, [path, &finished])?,
        None => None,
    };
    if let Some(old) = known {
        let journal = solving::decode(&old).filter(|journal| journal.origins().is_some());
        let Some(journal) = journal else {
            return Err(checkpoint::refused(path, &old).help("start again with `--fresh`"));
        };
        let changed = journal.origins().map_or_else(Vec::new, |old| origins.changed_since(old));
        if !changed.is_empty() {
            bail!(
                BAD_OPTION,
                "`{}` cannot be resumed: these have changed since: \
                 {}", path.display(), solving::listed(&changed);
                help: "undo the changes, or start again with `--fresh`"
            );
        }
        let (whole, lost) = (journal.whole, journal.lost);
        run.resume(&journal.records())?;
        let lost = match lost {
            0 => String::new(),
            lost => format!("; {lost} damaged or incomplete bytes at its end are recomputed"),
        };
        let text = format!(
            "resumed after {} generations, {} evaluations{lost}\n",
            run.generations(),
            run.evaluations()
        );
        session.print(&text);
        bytes = old[..whole].to_vec();
    }
    if exists && !options.resume {
        set_aside(session, path, left)?;
    }
    session.world.write_safely(path, &bytes)?;
    discard(session, &finished);
    Ok(Checkpoint::new(path.to_owned(), files.every, run.seconds).after(bytes))
}

/// Keeps the journal of an earlier run that is not continued; `changed` says why it could not be.
fn set_aside(session: &mut Session, path: &Path, changed: Option<String>) -> Result<(), Fault> {
    let kept = keep_old(session, path)?;
    if let Some(changed) = changed {
        session.print(&format!(
            "an earlier run did not finish, and these have changed since: {changed}; its checkpoint \
             is kept in `{}`\n",
            kept.display()
        ));
    }
    Ok(())
}

/// What has changed since a run that did not finish, so that it cannot be continued; none where it
/// can.
fn changed_since(
    session: &mut Session,
    path: &Path,
    origins: &Origins,
) -> Result<Option<String>, Fault> {
    let bytes = session.world.read_bytes(path)?;
    let journal = solving::decode(&bytes);
    let before = journal.as_ref().and_then(|journal| journal.origins());
    let changed = before.map_or_else(Vec::new, |before| origins.changed_since(before));
    Ok((!changed.is_empty()).then(|| solving::listed(&changed)))
}

/// The journal that an earlier run has left, for a run that resumes; without one it says that it begins.
fn left_journal(session: &mut Session, paths: [&Path; 2]) -> Result<Option<Vec<u8>>, Fault> {
    match paths.into_iter().find(|path| session.world.exists(path)) {
        Some(journal) => session.world.read_bytes(journal).map(Some),
        None => {
            let folder = paths[0].parent().unwrap_or(paths[0]).display();
            session.print(&format!(
                "there is no checkpoint in `{folder}`: the run starts from the beginning\n"
            ));
            Ok(None)
        }
    }
}

/// The journal of a search that ended at a limit: `finished.journal` for `run.journal`.
pub(super) fn finished(journal: &Path) -> PathBuf {
    let name = journal.file_name().unwrap_or_default().to_string_lossy();
    journal.with_file_name(name.replacen("run", "finished", 1))
}

/// A file of an earlier run that this one does not write.
pub(super) fn discard(session: &mut Session, path: &Path) {
    if session.world.exists(path) {
        // What cannot be removed is not read by `gapi report` either.
        let _ = session.world.remove(path);
    }
}
