//! Files as commands see them: found, read and written with errors that say what to do.

use super::SessionWorld;
use super::faults::{cannot, drive_help, escape_help, plain, shown};
use super::policy::{Access, Grant, Refusal, refusal_of};
use crate::bail;
use crate::diag::{Diagnostic, Fault};
use crate::errors::FILE_ERROR;
use crate::results::{self, Format, ResultTable};
use crate::syntax;
use crate::world::{FileReader, World, normalized};
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Files some of which are in memory.
#[derive(Debug)]
struct Given {
    files: Arc<dyn FileReader>,
    given: BTreeMap<PathBuf, Arc<[u8]>>,
}

impl FileReader for Given {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let given = self.given.get(path).map(|given| given.to_vec());
        given.map_or_else(|| self.files.read(path), Ok)
    }

    fn list_dir(&self, path: &Path) -> io::Result<Vec<String>> {
        self.files.list_dir(path)
    }

    fn is_file(&self, path: &Path) -> bool {
        self.given.contains_key(path) || self.files.is_file(path)
    }
}

impl SessionWorld {
    /// The file or directory that a script means: relative to the working directory, else to the
    /// folders of the scripts being run, innermost first. `None` if it is nowhere; one that may not be
    /// read is as if it were not there.
    pub(crate) fn find_file(&self, path: &Path) -> Option<PathBuf> {
        self.places_of(path).find(|place| self.sees(place))
    }

    /// Where a file may be that a script means, in the order of precedence.
    fn places_of(&self, path: &Path) -> impl Iterator<Item = PathBuf> {
        let path = self.expanded(path);
        let first = self.world.absolute(&path);
        let folders = self.folders();
        std::iter::once(first).chain(folders.map(move |folder| normalized(&folder.join(&path))))
    }

    /// Whether there is a file or folder that may be read.
    pub(crate) fn sees(&self, path: &Path) -> bool {
        let is_there = || self.world.exists(path) && self.world.permits(path, Access::Read).is_ok();
        self.given.contains_key(path) || is_there()
    }

    /// Gives the content of a file in memory, which counts instead of what is on the disk: the data or the
    /// problem of a program that embeds this one, the text in an editor.
    pub fn give(&mut self, path: &Path, bytes: impl Into<Arc<[u8]>>) {
        self.given.insert(self.world.absolute(path), bytes.into());
    }

    /// From now on the file on the disk counts again.
    pub fn take_back(&mut self, path: &Path) {
        self.given.remove(&self.world.absolute(path));
    }

    /// The bytes of a file by its own path: what was given, or what is on the disk.
    pub(crate) fn bytes_of(&self, path: &Path) -> io::Result<Vec<u8>> {
        match self.given.get(&self.world.absolute(path)) {
            Some(given) => Ok(given.to_vec()),
            None => self.world.read(path),
        }
    }

    /// The files as libraries read them, later and from any thread: with what was given.
    pub(crate) fn reader_with_given(&self) -> Arc<dyn FileReader> {
        match self.given.is_empty() {
            true => self.world.reader(),
            false => Arc::new(Given { files: self.world.reader(), given: self.given.clone() }),
        }
    }

    /// The bytes of a file that a script names.
    pub fn read_bytes(&self, path: &Path) -> Result<Vec<u8>, Fault> {
        if let Some(given) = self.given.get(&self.world.absolute(path)) {
            return Ok(given.to_vec());
        }
        let Some(found) = self.find_current(path)? else {
            return Err(self.missing_file(path));
        };
        self.world.read(&found).map_err(|error| cannot("read", path, &error))
    }

    /// The text of a file that a script names, UTF-8 or else Latin-1.
    pub fn read_text(&self, path: &Path) -> Result<String, Fault> {
        Ok(syntax::decode(&self.read_bytes(path)?).0)
    }

    /// As [`SessionWorld::find_file`], for reading.
    ///
    /// # Errors
    /// A command was to write this file and did not.
    pub(crate) fn find_current(&self, path: &Path) -> Result<Option<PathBuf>, Fault> {
        // One beside the script does not stand for one that was not written.
        self.check_current(&self.expanded(path))?;
        let found = self.find_file(path);
        found.as_deref().map_or(Ok(()), |found| self.check_current(found))?;
        Ok(found)
    }

    /// A fault if a command was to write this file and did not.
    pub(crate) fn check_current(&self, path: &Path) -> Result<(), Fault> {
        let path = normalized(&self.world.absolute(path));
        let Some(reason) = self.outdated.reason(&path) else { return Ok(()) };
        let shown = path.display();
        let state = match self.world.exists(&path) {
            true if self.outdated.is_unfinished(&path) => "ends before its simulation was to end",
            true => "is older than this script expects",
            false => "was not written",
        };
        bail!(
            FILE_ERROR,
            "`{shown}` {state}: {reason}";
            help: "correct the first error, or read a file that the script has written"
        )
    }

    /// A command is going to write this file: the path under which this is noted.
    pub(crate) fn expect_file(&mut self, path: &Path) -> PathBuf {
        let path = normalized(&self.world.absolute(&self.expanded(path)));
        self.outdated.expect(path.clone());
        path
    }

    /// The command that was going to write this file has ended: whether it has not written it.
    pub(crate) fn end_expected(&mut self, file: &Path, reason: &str) -> bool {
        self.outdated.end(file, reason)
    }

    /// Rewrites a file, with the directories it lies in.
    pub fn write_file(&mut self, path: &Path, bytes: &[u8]) -> Result<(), Fault> {
        let path = self.expanded(path);
        self.write_by(&path, &mut |world| world.write_with(&path, &mut |to| to.write_all(bytes)))
    }

    /// The same, safe against a power cut: for journals and what a run comes to. Of what scripts write in
    /// loops it would take far longer than the simulations.
    pub(crate) fn write_safely(&mut self, path: &Path, bytes: &[u8]) -> Result<(), Fault> {
        let path = self.expanded(path);
        self.write_by(&path, &mut |world| world.write(&path, bytes))
    }

    /// Appends to a file.
    pub(crate) fn append_file(&mut self, path: &Path, bytes: &[u8]) -> Result<(), Fault> {
        let path = self.expanded(path);
        self.write_by(&path, &mut |world| world.append(&path, bytes))
    }

    /// Rewrites a file of results, with the directories it lies in. A file with former results
    /// is replaced, no matter which program has written it.
    pub fn write_results(
        &mut self,
        path: &Path,
        format: &dyn Format,
        table: &ResultTable,
    ) -> Result<(), Fault> {
        table.check()?;
        let path = self.expanded(path);
        self.grant_replacement(&path);
        self.write_by(&path, &mut |world| {
            world.write_with(&path, &mut |to| format.write_to(table, to))
        })
    }

    /// The same for what a simulation had computed when it failed: for people and other programs, while
    /// the script that expected all of it gets an error when it reads it. What says why it failed then says
    /// where this is.
    pub(crate) fn write_unfinished(
        &mut self,
        path: &Path,
        table: &ResultTable,
        why: Diagnostic,
    ) -> Diagnostic {
        let format = results::format_of_file(&path.to_string_lossy());
        let last = table.time.last().copied().unwrap_or(f64::NAN);
        let kept = format.and_then(|format| self.write_results(path, format.as_ref(), table));
        match kept {
            Ok(()) => {
                let file = normalized(&self.world.absolute(&self.expanded(path)));
                self.outdated.note_unfinished(&file);
                why.help(format!("the results until t = {last} are in `{}`", shown(path)))
            }
            Err(fault) => {
                why.help(format!("the results until t = {last} are not kept: {}", fault.message))
            }
        }
    }

    /// The same for results that are written already.
    pub(crate) fn write_result_file(&mut self, path: &Path, bytes: &[u8]) -> Result<(), Fault> {
        let expanded = self.expanded(path);
        self.grant_replacement(&expanded);
        self.write_file(path, bytes)
    }

    /// Rewrites the log of a session, in place of one that another run has written: logs begin with
    /// `prompt`.
    pub(crate) fn write_log(
        &mut self,
        path: &Path,
        bytes: &[u8],
        prompt: &str,
    ) -> Result<(), Fault> {
        let expanded = self.expanded(path);
        self.grant_replacement_of(&expanded, |start| start.starts_with(prompt.as_bytes()));
        self.write_file(path, bytes)
    }

    /// Every Modelica tool replaces its result files: another script may have written this one.
    fn grant_replacement(&mut self, path: &Path) {
        self.grant_replacement_of(path, results::are_results);
    }

    /// Allows to replace a file that another run has written, if its beginning shows what it is.
    fn grant_replacement_of(&mut self, path: &Path, is_own: impl Fn(&[u8]) -> bool) {
        let permitted = self.world.permits(path, Access::Write);
        if permitted.err().and_then(|error| refusal_of(&error)) != Some(Refusal::Existing) {
            return;
        }
        let start = self.world.read_start(path, results::BEGINNING);
        if start.is_ok_and(|start| is_own(&start)) {
            self.world.grant(Grant::Replace(path));
        }
    }

    fn write_by(
        &mut self,
        path: &Path,
        write: &mut dyn FnMut(&mut dyn World) -> io::Result<()>,
    ) -> Result<(), Fault> {
        let written = self.may(Access::Write, path).and_then(|()| self.make_parents(path));
        let written = written
            .and_then(|()| write(&mut *self.world).map_err(|error| cannot("write", path, &error)));
        let path = normalized(&self.world.absolute(path));
        match &written {
            Ok(()) => self.outdated.note_written(&path),
            Err(fault) => self.outdated.note_failed(path, fault.message.clone()),
        }
        written
    }

    fn make_parents(&mut self, path: &Path) -> Result<(), Fault> {
        match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() && !self.world.exists(folder) => {
                self.world.create_dirs(folder).map_err(|e| cannot("make", folder, &e))
            }
            _ => Ok(()),
        }
    }

    /// Whether a folder (`Some(true)`) or a file has this path, as a script asks: what may not be
    /// read stays unknown. That the folders above the working directory exist is no secret.
    pub(crate) fn kind_of(&self, path: &Path) -> Result<Option<bool>, Fault> {
        let path = normalized(&self.world.absolute(&self.expanded(path)));
        if !self.world.current_dir().starts_with(&path) {
            self.may(Access::Read, &path)?;
        }
        Ok(self.world.exists(&path).then(|| self.world.is_dir(&path)))
    }

    /// The fault of a file that is nowhere, or that it may not be read if it were there.
    pub(crate) fn missing_file(&self, path: &Path) -> Fault {
        let refused = self.places_of(path).find_map(|place| self.may(Access::Read, &place).err());
        if let Some(refused) = refused {
            return refused;
        }
        let fault = Fault::new(FILE_ERROR, format!("there is no file `{}`", shown(path)));
        let fault = fault.help_if(escape_help(path)).help_if(drive_help(path));
        let start = self.starts.in_words(&self.world.current_dir());
        fault.help_if(self.similar_file(path)).help(start)
    }

    fn similar_file(&self, path: &Path) -> Option<String> {
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let entries = self.world.list_dir(&self.find_file(folder)?).ok()?;
        let name = path.file_name()?.to_string_lossy().into_owned();
        crate::diag::suggest::did_you_mean(&name, entries.iter().map(String::as_str))
    }

    /// Windows' separators, `file://` and `$NAME` at the beginning of a path. A variable that is
    /// not set or not readable stays as it is.
    pub(crate) fn expanded(&self, path: &Path) -> PathBuf {
        let text = plain(&path.to_string_lossy());
        let Some(rest) = text.strip_prefix('$') else { return PathBuf::from(text) };
        let (name, rest) = rest.split_once('/').unwrap_or((rest, ""));
        match self.environment_variable(name.trim_matches(['{', '}'])) {
            Ok(Some(value)) => PathBuf::from(value).join(rest),
            _ => PathBuf::from(text),
        }
    }

    /// Removes a file or an empty directory.
    pub(crate) fn remove_file(&mut self, path: &Path) -> Result<(), Fault> {
        self.world.remove(path).map_err(|error| cannot("remove", path, &error))
    }

    /// Makes a directory and the ones it lies in.
    pub(crate) fn create_directory(&mut self, path: &Path) -> Result<(), Fault> {
        self.world.create_dirs(path).map_err(|error| cannot("make", path, &error))
    }

    /// Changes the working directory.
    pub(crate) fn change_dir(&mut self, path: &str) -> Result<(), Fault> {
        let path = self.expanded(Path::new(path));
        // The answer does not reveal which folders exist elsewhere; those that the run lies in are known.
        let absolute = self.world.absolute(&path);
        if !self.world.current_dir().starts_with(&absolute) {
            self.may(Access::Read, &absolute)?;
        }
        let changed = self.world.set_current_dir(&path);
        changed.map_err(|error| {
            let here = self.world.current_dir();
            cannot("change to", &path, &error)
                .help(format!("the working directory is still `{}`", here.display()))
        })
    }
}
