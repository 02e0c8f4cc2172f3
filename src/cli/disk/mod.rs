//! The disk: the one place that opens the files of scripts, models and results.
//!
//! A path is resolved once into a [`Place`], the [`Policy`] judges where it leads, and the place is
//! opened: what is opened is what was judged.

#[cfg(unix)]
mod place;
#[cfg(not(unix))]
#[path = "portable.rs"]
mod place;
mod record;
mod steps;
mod temporary;

use crate::packages;
use crate::script::access::policy::{
    Access, Change, ExternalCode, Grant, Policy, RECORD, Refusal, is_of_system,
};
use crate::script::world::{Content, FileReader};
use place::Place;
use record::{Lines, Record};
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use steps::{Stepwise, step};

/// The disk with what the user allows, and the models in the program. Paths are absolute.
#[derive(Debug, Default)]
pub(super) struct Disk {
    state: Mutex<State>,
}

/// Whether a file has to be on the disk before its name leads to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Safety {
    /// After a power cut the name leads to the old content or to the new one.
    OnDisk,
    /// After a power cut the new content may be lost.
    Buffered,
}

/// A path that cannot be resolved.
#[derive(Debug)]
struct Unresolved {
    /// The real path of the entry where it ends: what is there is known to those who may know that.
    at: PathBuf,
    error: io::Error,
}

impl From<Unresolved> for io::Error {
    fn from(unresolved: Unresolved) -> io::Error {
        unresolved.error
    }
}

#[derive(Debug, Default)]
struct State {
    policy: Policy,
    /// What the user has named to be read or written, as it was written: pipes and devices have no
    /// real path.
    named: BTreeSet<(Access, PathBuf)>,
    /// Links among them that lead out of the folders where they lie: a stranger may have made them.
    links: BTreeSet<PathBuf>,
    /// Owners of what the user has named: what is found there may belong to them.
    owners: BTreeSet<u32>,
    /// Folders in which what killed processes have left was removed.
    cleaned: BTreeSet<PathBuf>,
    /// What was made outside of the first output folder; read when it is first needed.
    record: Option<Record>,
}

impl State {
    /// Whether something lies where it was found and belongs to whom the user trusts there.
    fn is_as_found(&self, path: &Path, found: &Place) -> Result<(), Refusal> {
        let folder = path.parent().and_then(|folder| Place::of(folder, true).ok());
        if !folder.is_some_and(|folder| found.real.starts_with(&folder.real)) {
            return Err(Refusal::Link);
        }
        let is_trusted =
            |owner| [place::user(), SUPERUSER].contains(&owner) || self.owners.contains(&owner);
        if found.owner.is_none_or(is_trusted) { Ok(()) } else { Err(Refusal::Owner) }
    }
}

/// Whom the files of the system belong to.
const SUPERUSER: u32 = 0;

impl Disk {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Allows something from here on.
    pub(super) fn grant(&self, grant: Grant<'_>) {
        let path = grant.path().unwrap_or(Path::new("/"));
        let place = Place::of(path, true).ok();
        let mut state = self.state();
        match grant {
            Grant::Named(_) if leads_elsewhere(path) => {
                state.links.insert(path.to_owned());
                return;
            }
            Grant::Named(_) => drop(state.named.insert((Access::Write, path.to_owned()))),
            Grant::Read(_) => drop(state.named.insert((Access::Read, path.to_owned()))),
            _ => {}
        }
        match (grant, &place) {
            (Grant::Read(_) | Grant::Create(_), Some(named)) => state.owners.extend(named.owner),
            (Grant::Found(_), Some(found)) => {
                if let Err(why) = state.is_as_found(path, found) {
                    return state.policy.pass_over(found.real.clone(), why);
                }
            }
            _ => {}
        }
        // What cannot be resolved is not opened either.
        let real = place.map_or_else(|| path.to_owned(), |place| place.real);
        state.policy.grant(grant, real);
    }

    /// The functions in C that may be compiled and called.
    pub(super) fn external_code(&self) -> ExternalCode {
        self.state().policy.external_code().clone()
    }

    /// What is allowed and excluded, for people; folders that do not exist are left out.
    pub(super) fn permissions(&self) -> Vec<(String, String)> {
        let state = self.state();
        let is_shown = |(meaning, path): &(String, PathBuf)| {
            !meaning.starts_with("read") || path.exists() || meaning.contains("remove")
        };
        let rows = state.policy.listed().into_iter().filter(is_shown);
        let rows = rows.map(|(meaning, path)| (meaning, path.display().to_string()));
        let functions = state.policy.external_code().listed();
        rows.chain([("functions in C".to_owned(), functions)]).collect()
    }

    /// Whether a folder is an output folder.
    pub(super) fn owns(&self, real: &Path) -> bool {
        self.state().policy.own_folders().any(|own| own == real)
    }

    /// # Errors
    /// The path is refused, or cannot be resolved.
    pub(super) fn permits(&self, path: &Path, access: Access) -> io::Result<()> {
        match access {
            Access::Read if packages::read(path).is_some() || packages::list(path).is_some() => {
                Ok(())
            }
            Access::Read if self.is_named_device(access, path) => Ok(()),
            Access::Write if self.is_named_device(access, path) => Ok(()),
            Access::Read => self.to_read(path).map(|_| ()),
            Access::Write | Access::Folder => self.to_change(path, access, true).map(|_| ()),
        }
    }

    /// Resolves a path. Why that is not possible tells what is there: to those who may know.
    fn resolve(
        &self,
        path: &Path,
        follows: bool,
        may: impl Fn(&Policy, &Path) -> Result<(), Refusal>,
    ) -> io::Result<Place> {
        Place::of(path, follows).map_err(|unresolved| {
            match may(&self.state().policy, &unresolved.at) {
                Ok(()) => unresolved.into(),
                Err(refusal) => refusal.into(),
            }
        })
    }

    fn to_read(&self, path: &Path) -> io::Result<Place> {
        let place = self.resolve(path, true, Policy::may_read)?;
        let read = self.state().policy.may_read(&place.real);
        Ok(read.map(|()| place)?)
    }

    fn to_write(&self, path: &Path) -> io::Result<Place> {
        self.to_change(path, Access::Write, true)
    }

    /// Resolves a path that is going to be written; a link at its end is followed if `follows`.
    fn to_change(&self, path: &Path, access: Access, follows: bool) -> io::Result<Place> {
        let may = |policy: &Policy, at: &Path| policy.may_write(at, Change::NewFolder);
        let place = self.resolve(path, follows, may)?;
        if self.state().links.contains(path) {
            return Err(Refusal::NamedLink.into());
        }
        let change = Change::by(access, place.exists());
        let mut written = self.state().policy.may_write(&place.real, change);
        if written == Err(Refusal::Existing) {
            self.know_record();
            written = self.state().policy.may_write(&place.real, change);
        }
        Ok(written.map(|()| place)?)
    }

    /// Reads what earlier runs have made.
    fn know_record(&self) {
        let mut state = self.state();
        if state.record.is_some() {
            return;
        }
        let own = state.policy.own_folders().next().map(|own| own.join(RECORD));
        let bytes = own.and_then(|file| unlinked(&file).ok()?.read().ok());
        let record = Record::read(&String::from_utf8_lossy(&bytes.unwrap_or_default()));
        record.unchanged().for_each(|path| state.policy.note_recorded(path.to_owned()));
        state.record = Some(record);
    }

    /// Notes a file that takes a name outside of the output folders.
    fn note_made(&self, real: &Path, file: &File) -> io::Result<()> {
        self.know_record();
        let mut state = self.state();
        let own = state.policy.own_folders().next().map(Path::to_owned);
        if state.policy.own_folder_of(real).is_some() {
            return Ok(());
        }
        state.policy.note_made(real.to_owned());
        let Some(record) = &mut state.record else { return Ok(()) };
        match (own, record.note(real, file)?) {
            (Some(own), Some(lines)) => written_down(&own, lines),
            _ => Ok(()),
        }
    }

    /// Whether the user has named a pipe or a device: it is used as it is.
    fn is_named_device(&self, access: Access, path: &Path) -> bool {
        self.state().named.contains(&(access, path.to_owned()))
            && fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir())
    }

    /// The first bytes of a file.
    pub(super) fn read_start(&self, path: &Path, most: usize) -> io::Result<Vec<u8>> {
        self.to_read(path)?.read_start(most as u64)
    }

    /// Rewrites a file, all of it or nothing, safe against a power cut.
    pub(super) fn write(&self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        self.write_as(path, &mut |file| file.write_all(bytes), Safety::OnDisk)
    }

    /// The same as `content` writes it; the system decides when it reaches the disk.
    pub(super) fn write_with(&self, path: &Path, content: Content<'_>) -> io::Result<()> {
        self.write_as(path, content, Safety::Buffered)
    }

    fn write_as(&self, path: &Path, content: Content<'_>, safety: Safety) -> io::Result<()> {
        if self.is_named_device(Access::Write, path) {
            return filled(&fs::OpenOptions::new().write(true).open(path)?, content);
        }
        let place = self.to_write(path)?;
        self.clean(&place);
        place.write(content, safety, |file| self.note_made(&place.real, file))
    }

    /// Removes what killed processes have left where a file is going to be written, once.
    fn clean(&self, place: &Place) {
        let Some(folder) = place.real.parent() else { return };
        if self.state().cleaned.insert(folder.to_owned()) {
            // What cannot be removed does no harm.
            let _ = place.remove_abandoned();
        }
    }

    /// Opens a file to append to it.
    pub(super) fn append(&self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        if self.is_named_device(Access::Write, path) {
            return fs::OpenOptions::new().append(true).open(path)?.write_all(bytes);
        }
        let place = self.to_write(path)?;
        let shared = self.state().policy.writes_all();
        let file = place.open_to_append(shared)?;
        if !place.exists() {
            self.note_made(&place.real, &file)?;
        }
        Stepwise(&file).write_all(bytes)
    }

    /// Makes what a file holds safe against a power cut.
    pub(super) fn sync(&self, path: &Path) -> io::Result<()> {
        let file = self.to_write(path)?.open_to_append(true)?;
        step(|| ())?;
        file.sync_data()
    }

    /// Removes a file, an empty folder, or a link itself.
    pub(super) fn remove(&self, path: &Path) -> io::Result<()> {
        let place = self.to_change(path, Access::Write, false)?;
        place.remove()?;
        self.state().policy.note_removed(&place.real);
        Ok(())
    }

    /// Makes a folder and those it lies in.
    pub(super) fn create_folders(&self, path: &Path) -> io::Result<()> {
        // One that may not be read is as if it were not there.
        if self.to_read(path).is_ok_and(|place| place.is_folder()) {
            return Ok(());
        }
        let new = self.to_change(path, Access::Folder, true)?.create_folders()?;
        let mut state = self.state();
        new.into_iter().for_each(|folder| state.policy.note_made(folder));
        Ok(())
    }
}

/// Writes the record in the output folder, which is made if it is missing.
fn written_down(own: &Path, lines: Lines) -> io::Result<()> {
    create_own_folders(own)?;
    let record = own.join(RECORD);
    match lines {
        Lines::Further(line) => Stepwise(&open_own(&record)?).write_all(line.as_bytes()),
        Lines::All(lines) => write_own(&record, lines.as_bytes()),
    }
}

impl FileReader for Disk {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        if let Some(bytes) = packages::read(path) {
            return Ok(bytes.to_vec());
        }
        match self.is_named_device(Access::Read, path) {
            true => super::device::read(path),
            false => self.to_read(path)?.read(),
        }
    }

    fn list_dir(&self, path: &Path) -> io::Result<Vec<String>> {
        match packages::list(path) {
            Some(names) => Ok(names),
            None => self.to_read(path)?.list(),
        }
    }

    fn is_file(&self, path: &Path) -> bool {
        // The answer does not reveal whether a file that may not be read exists.
        packages::read(path).is_some() || path.is_file() && self.to_read(path).is_ok()
    }
}

/// Writes a file of the program itself, all of it or nothing.
pub(super) fn write_atomically(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let path = std::path::absolute(path)?;
    let mut content = |file: &mut dyn io::Write| file.write_all(bytes);
    Place::of(&path, true)?.write(&mut content, Safety::OnDisk, |_| Ok(()))
}

/// Writes a file of the program beside one that the command line names, or in such a folder: all of it
/// or nothing, and not where a link of this name leads, which the file replaces.
pub(super) fn write_beside(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let path = std::path::absolute(path)?;
    let mut content = |file: &mut dyn io::Write| file.write_all(bytes);
    Place::of(&path, false)?.replace_link().write(&mut content, Safety::OnDisk, |_| Ok(()))
}

/// The path of a file or folder without links, as it is now; the path itself where that is not known.
pub(super) fn real_path(path: &Path) -> PathBuf {
    Place::of(path, true).map_or_else(|_| path.to_owned(), |place| place.real)
}

/// A path that had no links when it was chosen, unless a link has taken the place of one of its folders
/// since then.
fn unlinked(path: &Path) -> io::Result<Place> {
    let place = Place::of(path, false)?;
    if place.real == path { Ok(place) } else { Err(Refusal::Link.into()) }
}

/// Makes an output folder, and those it lies in.
pub(super) fn create_own_folders(real: &Path) -> io::Result<()> {
    unlinked(real)?.create_folders().map(drop)
}

/// Opens a file of the program itself in an output folder, to append to it: no link, no file
/// with further names, and nothing where a link leads that was put there since the folder was chosen.
pub(super) fn open_own(path: &Path) -> io::Result<File> {
    match unlinked(path)?.open_to_append(false) {
        // Another run has made it just now.
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            unlinked(path)?.open_to_append(false)
        }
        opened => opened,
    }
}

/// Writes a file of the program itself in an output folder, as [`open_own`] opens it; a link of this
/// name is replaced.
pub(super) fn write_own(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut content = |file: &mut dyn io::Write| file.write_all(bytes);
    unlinked(path)?.replace_link().write(&mut content, Safety::OnDisk, |_| Ok(()))
}

/// Reads a file that the command line names, no pipe and no device.
pub(super) fn read_named(path: &Path) -> io::Result<Vec<u8>> {
    Place::of(&std::path::absolute(path)?, true)?.read()
}

/// Writes a file that the command line names, all of it or nothing; a pipe or a device as it is.
pub(super) fn write_named(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let is_device = fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir());
    match is_device {
        true => fs::OpenOptions::new().write(true).open(path)?.write_all(bytes),
        false if leads_elsewhere(&std::path::absolute(path)?) => Err(Refusal::NamedLink.into()),
        false => write_atomically(path, bytes),
    }
}

/// Whether a name that the user gives for an output is a link out of its folder, and to no device: it
/// may have come with a stranger's folder.
fn leads_elsewhere(path: &Path) -> bool {
    let is_device = || fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir());
    let folder = path.parent().and_then(|folder| Place::of(folder, true).ok());
    let end = Place::of(path, true).ok();
    !is_of_system(path)
        && path.is_symlink()
        && !is_device()
        && !folder.zip(end).is_some_and(|(folder, end)| end.real.starts_with(&folder.real))
}

/// The names in a folder that the command line names, sorted.
pub(super) fn list_named(path: &Path) -> io::Result<Vec<String>> {
    Place::of(&std::path::absolute(path)?, true)?.list()
}

/// Whether an entry of a folder that the command line names is a file in this folder or below it: no
/// pipe and no device, and no link that leads elsewhere: those are for files that are named.
pub(super) fn is_file_in(folder: &Path, entry: &Path) -> bool {
    let real = |path: &Path| Some(Place::of(&std::path::absolute(path).ok()?, true).ok()?.real);
    entry.is_file()
        && real(folder).zip(real(entry)).is_some_and(|(folder, file)| file.starts_with(folder))
}

/// Makes a folder that the command line names, and those it lies in.
pub(super) fn create_named_folders(path: &Path) -> io::Result<()> {
    Place::of(&std::path::absolute(path)?, true)?.create_folders().map(drop)
}

/// Removes the files in a folder that interrupted writing has left: the owner of the lock knows
/// that no other run writes there.
pub(super) fn remove_temporary_files(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if temporary::is_temporary(&entry.file_name()) {
            // What cannot be removed does no harm.
            let _ = fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod failure_points;
#[cfg(test)]
mod tests;

/// Writes the content of a file, in pieces.
fn filled(file: &fs::File, content: Content<'_>) -> io::Result<()> {
    let mut buffer = io::BufWriter::with_capacity(1 << 16, Stepwise(file));
    content(&mut buffer)?;
    buffer.flush()
}
