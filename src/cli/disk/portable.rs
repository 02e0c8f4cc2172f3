//! A path resolved once, where the calls of POSIX are missing: the folder is taken from the system
//! in its real form, and the entry in it is judged and opened by that path.

use super::temporary::{is_old, is_temporary, temporary_name};
use super::{Safety, Unresolved};
use crate::script::access::policy::Refusal;
use crate::script::world::Content;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};

/// An entry of a folder, which may not exist yet.
pub(super) struct Place {
    /// The path without links and dots.
    pub real: PathBuf,
    kind: Option<fs::FileType>,
    /// The number of the user whom it belongs to: unknown here.
    pub owner: Option<u32>,
}

impl Place {
    /// Resolves an absolute path; a link at its end is followed if `follows`.
    pub fn of(path: &Path, follows: bool) -> Result<Place, Unresolved> {
        let path = &crate::script::world::normalized(path);
        Place::resolved(path, follows).map_err(|error| Unresolved { at: path.clone(), error })
    }

    fn resolved(path: &Path, follows: bool) -> io::Result<Place> {
        let found = fs::symlink_metadata(path).ok();
        let is_link = found.as_ref().is_some_and(|found| found.is_symlink());
        if let Some(kind) = found.map(|found| found.file_type())
            && !(is_link && follows)
        {
            let folder = path.parent().unwrap_or(path).canonicalize()?;
            let real = path.file_name().map_or(folder.clone(), |name| folder.join(name));
            return Ok(Place { real, kind: Some(kind), owner: None });
        }
        for known in path.ancestors() {
            if let Ok(real) = known.canonicalize() {
                let rest = path.strip_prefix(known).unwrap_or(Path::new(""));
                let real = if rest.as_os_str().is_empty() { real } else { real.join(rest) };
                let kind = fs::metadata(&real).ok().map(|found| found.file_type());
                return Ok(Place { real, kind, owner: None });
            }
        }
        Err(io::ErrorKind::NotFound.into())
    }

    /// The same where a link is written over as if there were none.
    pub(crate) fn replace_link(mut self) -> Place {
        self.kind.take_if(|kind| kind.is_symlink());
        self
    }

    pub fn exists(&self) -> bool {
        self.kind.is_some()
    }

    pub fn is_folder(&self) -> bool {
        self.kind.is_some_and(|kind| kind.is_dir())
    }

    fn is_device(&self) -> bool {
        self.kind.is_some_and(|kind| !kind.is_dir() && !kind.is_file())
    }

    pub fn read(&self) -> io::Result<Vec<u8>> {
        if self.is_device() {
            return Err(Refusal::System.into());
        }
        fs::read(&self.real)
    }

    pub fn read_start(&self, most: u64) -> io::Result<Vec<u8>> {
        if self.is_device() {
            return Err(Refusal::System.into());
        }
        let mut bytes = Vec::new();
        File::open(&self.real)?.take(most).read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    pub fn list(&self) -> io::Result<Vec<String>> {
        let mut names = Vec::new();
        for entry in fs::read_dir(&self.real)? {
            names.push(entry?.file_name().to_string_lossy().into_owned());
        }
        names.sort();
        Ok(names)
    }

    /// Removes the temporary files beside this one that killed processes have left.
    pub(crate) fn remove_abandoned(&self) -> io::Result<()> {
        for entry in fs::read_dir(self.real.parent().unwrap_or(&self.real))?.flatten() {
            if !is_temporary(&entry.file_name()) {
                continue;
            }
            let file = OpenOptions::new().write(true).open(entry.path())?;
            if is_old(&file.metadata()?) && file.try_lock().is_ok() {
                drop(file);
                fs::remove_file(entry.path())?;
            }
        }
        Ok(())
    }

    pub fn write(
        &self,
        content: Content<'_>,
        safety: Safety,
        note: impl FnOnce(&File) -> io::Result<()>,
    ) -> io::Result<()> {
        if self.is_device() {
            return Err(Refusal::System.into());
        }
        let name = self.real.file_name().unwrap_or_default();
        let temporary = self.real.with_file_name(temporary_name(name));
        let file = OpenOptions::new().write(true).create_new(true).open(&temporary)?;
        // Until the process ends, others know that the file is still written.
        let _ = file.try_lock();
        let written = super::filled(&file, content).and_then(|()| match safety {
            Safety::OnDisk => file.sync_data(),
            Safety::Buffered => Ok(()),
        });
        let written = written.and_then(|()| note(&file));
        drop(file);
        let written = written.and_then(|()| fs::rename(&temporary, &self.real));
        if written.is_err() {
            // The error of the write is the one to report.
            let _ = fs::remove_file(&temporary);
        }
        written
    }

    pub(crate) fn open_to_append(&self, _shared: bool) -> io::Result<File> {
        if self.is_device() {
            return Err(Refusal::System.into());
        }
        OpenOptions::new().append(true).create(true).open(&self.real)
    }

    pub fn remove(&self) -> io::Result<()> {
        if self.is_folder() { fs::remove_dir(&self.real) } else { fs::remove_file(&self.real) }
    }

    pub(crate) fn create_folders(self) -> io::Result<Vec<PathBuf>> {
        let missing = self.real.ancestors().take_while(|folder| !folder.exists());
        let new = missing.map(Path::to_owned).collect();
        fs::create_dir_all(&self.real)?;
        Ok(new)
    }
}

/// The number of the user.
pub(super) fn user() -> u32 {
    0
}
