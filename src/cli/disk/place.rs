//! A path resolved once, folder by folder: every step is taken from the open folder before it and
//! follows no link by itself, so what the policy judges is what is opened afterwards.
//!
//! This is what `openat2` does with `RESOLVE_NO_MAGICLINKS`, in the portable calls of POSIX.1-2008
//! (`openat`, `fstatat`, `readlinkat`); the real path is known as a by-product.

use super::steps::step;
use super::temporary::{is_old, is_temporary, temporary_name};
use super::{Safety, Unresolved};
use crate::budget::has_memory;
use crate::memory;
use crate::script::access::policy::Refusal;
use crate::script::world::Content;
use rustix::fs::{self, AtFlags, FileType, Mode, OFlags, Stat};
use rustix::io::Errno;
use std::collections::VecDeque;
use std::ffi::{OsStr, OsString};
use std::fs::File;
use std::io::{self, Read as _};
use std::os::fd::OwnedFd;
use std::os::unix::ffi::OsStringExt as _;
use std::path::{Component, Path, PathBuf};

/// Links that lead to links; as many as operating systems follow.
const MAX_LINKS: usize = 40;

/// Bytes from which a file is compared with the memory before it is read.
const LARGE: u64 = 1 << 30;

/// An entry of a folder, which may not exist yet.
pub(super) struct Place {
    /// The folder, open; the deepest that exists.
    folder: OwnedFd,
    /// Folders below it that do not exist.
    missing: Vec<OsString>,
    name: OsString,
    /// The path without links and dots.
    pub real: PathBuf,
    kind: Option<FileType>,
    mode: u32,
    /// The number of the user whom it belongs to, if it exists.
    pub owner: Option<u32>,
}

/// What a step of a walk comes to.
enum Step {
    Taken,
    /// The walk ends here, at an entry or at none.
    End(Option<Stat>),
}

/// The folders walked through, from the root.
struct PathWalk {
    folders: Vec<OwnedFd>,
    names: Vec<OsString>,
    /// What is still to be walked.
    ahead: VecDeque<OsString>,
}

impl PathWalk {
    fn enqueue(&mut self, path: &Path) {
        for component in path.components().rev() {
            match component {
                Component::Normal(name) => self.ahead.push_front(name.to_owned()),
                Component::ParentDir => self.ahead.push_front("..".into()),
                Component::RootDir => {
                    self.folders.truncate(1);
                    self.names.clear();
                }
                Component::CurDir | Component::Prefix(_) => {}
            }
        }
    }

    fn up(&mut self) {
        if self.folders.len() > 1 {
            self.folders.pop();
            self.names.pop();
        }
    }

    fn here(&self) -> io::Result<&OwnedFd> {
        self.folders.last().ok_or_else(|| io::Error::from(io::ErrorKind::NotFound))
    }

    /// Enters a folder, or continues where a link leads; `links` counts them.
    fn step(&mut self, part: &OsStr, follows: bool, links: &mut usize) -> io::Result<Step> {
        let is_last = self.ahead.is_empty();
        let stat = match fs::statat(self.here()?, part, AtFlags::SYMLINK_NOFOLLOW) {
            Ok(stat) => stat,
            Err(Errno::NOENT) => return Ok(Step::End(None)),
            Err(error) => return Err(error.into()),
        };
        match FileType::from_raw_mode(stat.st_mode) {
            FileType::Symlink if follows || !is_last => {
                *links += 1;
                if *links > MAX_LINKS {
                    return Err(Errno::LOOP.into());
                }
                let target = fs::readlinkat(self.here()?, part, Vec::new())?;
                self.enqueue(Path::new(&OsString::from_vec(target.into_bytes())));
            }
            FileType::Directory => {
                let folder = fs::openat(self.here()?, part, folder_flags(), Mode::empty())?;
                self.folders.push(folder);
                self.names.push(part.to_owned());
            }
            _ if is_last => return Ok(Step::End(Some(stat))),
            _ => return Err(Errno::NOTDIR.into()),
        }
        Ok(Step::Taken)
    }

    /// A step of the walk that was not possible, to this entry of the folder that it is in.
    fn stopped(&self, part: &OsStr, error: impl Into<io::Error>) -> Unresolved {
        let mut at = PathBuf::from("/");
        at.extend(&self.names);
        at.push(part);
        Unresolved { at, error: error.into() }
    }

    /// Where the walk ends: at an entry of the folder that it is in.
    fn end(mut self, name: OsString, found: Option<&Stat>) -> Result<Place, Unresolved> {
        if self.ahead.iter().any(|part| part == "..") {
            return Err(self.stopped(&name, io::ErrorKind::NotFound));
        }
        let mut parts: Vec<OsString> = std::iter::once(name).chain(self.ahead.drain(..)).collect();
        let mut real = PathBuf::from("/");
        real.extend(self.names.iter().chain(&parts));
        let name = parts.pop().unwrap_or_default();
        let folder = self.folders.pop().ok_or_else(|| Unresolved {
            at: real.clone(),
            error: io::ErrorKind::NotFound.into(),
        })?;
        let kind = found.map(|stat| FileType::from_raw_mode(stat.st_mode));
        let mode = found.map_or(0, |stat| stat.st_mode & 0o777);
        let owner = found.map(|stat| stat.st_uid);
        Ok(Place { folder, missing: parts, name, real, kind, mode, owner })
    }

    /// Where the walk ends: at the folder that it is in.
    fn end_in_folder(mut self) -> Result<Place, Unresolved> {
        let stat = self.here().and_then(|folder| Ok(fs::fstat(folder)?));
        let stat = stat.map_err(|error| self.stopped(OsStr::new(""), error))?;
        let Some(name) = self.names.pop() else { return self.end(".".into(), Some(&stat)) };
        self.folders.pop();
        self.end(name, Some(&stat))
    }
}

impl Place {
    /// Resolves an absolute path; a link at its end is followed if `follows`.
    ///
    /// # Errors
    /// A folder cannot be entered, links go round.
    pub(super) fn of(path: &Path, follows: bool) -> Result<Place, Unresolved> {
        let root = fs::open("/", folder_flags(), Mode::empty());
        let root = root.map_err(|error| Unresolved { at: "/".into(), error: error.into() })?;
        let mut walk = PathWalk { folders: vec![root], names: Vec::new(), ahead: VecDeque::new() };
        walk.enqueue(path);
        let mut links = 0;
        while let Some(part) = walk.ahead.pop_front() {
            if part == ".." {
                walk.up();
                continue;
            }
            match walk.step(&part, follows, &mut links) {
                Ok(Step::Taken) => {}
                Ok(Step::End(stat)) => return walk.end(part, stat.as_ref()),
                Err(error) => return Err(walk.stopped(&part, error)),
            }
        }
        walk.end_in_folder()
    }

    /// The same where a link is written over as if there were none.
    pub(super) fn replace_link(mut self) -> Place {
        if self.kind == Some(FileType::Symlink) {
            self.kind = None;
        }
        self
    }

    pub(super) fn exists(&self) -> bool {
        self.kind.is_some()
    }

    pub(super) fn is_folder(&self) -> bool {
        self.kind == Some(FileType::Directory)
    }

    /// The bytes of the file; only of what the disk keeps, not of pipes and devices.
    pub(super) fn read(&self) -> io::Result<Vec<u8>> {
        self.read_start(u64::MAX)
    }

    /// The first bytes of the file, at most this many.
    pub(super) fn read_start(&self, most: u64) -> io::Result<Vec<u8>> {
        let file = self.open(OFlags::RDONLY | OFlags::NONBLOCK)?;
        let mut bytes = Vec::new();
        // `Take` hides the size of the file, for which room is made at once.
        let size = file.metadata()?.len().min(most);
        if size > LARGE && memory::default_limit().is_some_and(|limit| size >> 20 > limit.into()) {
            return Err(io::Error::other("it is larger than the memory of this machine"));
        }
        let size = usize::try_from(size).unwrap_or(usize::MAX);
        if !has_memory(size) {
            return Err(io::ErrorKind::OutOfMemory.into());
        }
        bytes.try_reserve(size)?;
        file.take(most).read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    fn open(&self, flags: OFlags) -> io::Result<File> {
        if !self.missing.is_empty() || self.kind.is_none() {
            return Err(io::ErrorKind::NotFound.into());
        }
        if self.is_folder() {
            return Err(Errno::ISDIR.into());
        }
        if self.kind != Some(FileType::RegularFile) {
            return Err(Refusal::System.into());
        }
        let flags = flags | OFlags::NOFOLLOW | OFlags::CLOEXEC;
        let file = File::from(fs::openat(&self.folder, &self.name, flags, Mode::empty())?);
        // The entry may have become another one since it was looked at.
        if !file.metadata()?.is_file() || is_made_up(&file) {
            return Err(Refusal::System.into());
        }
        Ok(file)
    }

    /// The names in the folder, sorted.
    pub(super) fn list(&self) -> io::Result<Vec<String>> {
        if !self.missing.is_empty() || self.kind.is_none() {
            return Err(io::ErrorKind::NotFound.into());
        }
        let flags = OFlags::RDONLY | OFlags::DIRECTORY | OFlags::NOFOLLOW | OFlags::CLOEXEC;
        let folder = fs::openat(&self.folder, &self.name, flags, Mode::empty())?;
        let mut names = Vec::new();
        for entry in fs::Dir::read_from(&folder)? {
            let entry = entry?;
            let name = entry.file_name().to_string_lossy();
            if name != "." && name != ".." {
                names.push(name.into_owned());
            }
        }
        names.sort();
        Ok(names)
    }

    /// Writes beside the file and renames, so that an interrupted write leaves the old file whole.
    /// `note` is called with the new file before it takes the name.
    pub(super) fn write(
        &self,
        content: Content<'_>,
        safety: Safety,
        note: impl FnOnce(&File) -> io::Result<()>,
    ) -> io::Result<()> {
        if self.is_folder() {
            return Err(Errno::ISDIR.into());
        }
        if !self.missing.is_empty() {
            return Err(io::ErrorKind::NotFound.into());
        }
        if self.kind.is_some_and(|kind| kind != FileType::RegularFile) {
            return Err(Refusal::System.into());
        }
        let temporary = temporary_name(&self.name);
        let file = self.create(&temporary)?;
        // Until the process ends, others know that the file is still written.
        let _ = file.try_lock();
        let written = self
            .fill(&file, content, safety)
            .and_then(|()| note(&file))
            .and_then(|()| step(|| ()))
            .and_then(|()| Ok(fs::renameat(&self.folder, &temporary, &self.folder, &self.name)?));
        if written.is_err() && step(|| ()).is_ok() {
            // The error of the write is the one to report.
            let _ = fs::unlinkat(&self.folder, &temporary, AtFlags::empty());
        }
        written
    }

    /// Removes the temporary files beside this one that killed processes have left.
    pub(super) fn remove_abandoned(&self) -> io::Result<()> {
        if !self.missing.is_empty() {
            return Ok(());
        }
        let flags = OFlags::RDONLY | OFlags::DIRECTORY | OFlags::NOFOLLOW | OFlags::CLOEXEC;
        let folder = fs::openat(&self.folder, ".", flags, Mode::empty())?;
        for entry in fs::Dir::read_from(&folder)?.flatten() {
            let name = OsString::from_vec(entry.file_name().to_bytes().to_vec());
            if is_temporary(&name) && self.is_abandoned(&name).unwrap_or(false) {
                fs::unlinkat(&self.folder, &name, AtFlags::empty())?;
            }
        }
        Ok(())
    }

    /// Whether a temporary file belongs to the user and to no process any more.
    fn is_abandoned(&self, name: &OsStr) -> io::Result<bool> {
        use std::os::unix::fs::MetadataExt as _;
        let flags = OFlags::RDWR | OFlags::NOFOLLOW | OFlags::NONBLOCK | OFlags::CLOEXEC;
        let file = File::from(fs::openat(&self.folder, name, flags, Mode::empty())?);
        let found = file.metadata()?;
        let is_ours = found.is_file() && found.nlink() == 1 && found.uid() == user();
        Ok(is_ours && is_old(&found) && file.try_lock().is_ok())
    }

    /// A file that was not there before.
    fn create(&self, name: &OsStr) -> io::Result<File> {
        let flags = OFlags::WRONLY | OFlags::CREATE | OFlags::EXCL;
        let flags = flags | OFlags::NOFOLLOW | OFlags::CLOEXEC;
        step(|| ())?;
        Ok(fs::openat(&self.folder, name, flags, Mode::from_raw_mode(0o666))?.into())
    }

    fn fill(&self, file: &File, content: Content<'_>, safety: Safety) -> io::Result<()> {
        if self.exists() {
            step(|| ())?;
            fs::fchmod(file, Mode::from_raw_mode(self.mode as _))?;
        }
        super::filled(file, content)?;
        if safety == Safety::Buffered {
            return Ok(());
        }
        // After a power cut the name must not lead to a file without its content.
        step(|| ())?;
        file.sync_data()
    }

    /// The file opened for appending, created if there is none. A file with further names
    /// is not changed unless `shared`: one of them may lie elsewhere.
    pub(super) fn open_to_append(&self, shared: bool) -> io::Result<File> {
        if !self.exists() && self.missing.is_empty() {
            return self.create(&self.name);
        }
        let file = self.open(OFlags::WRONLY | OFlags::APPEND | OFlags::NONBLOCK)?;
        let names = std::os::unix::fs::MetadataExt::nlink(&file.metadata()?);
        if names > 1 && !shared {
            return Err(Refusal::Shared.into());
        }
        Ok(file)
    }

    /// Removes the file, the link or the empty folder.
    pub(super) fn remove(&self) -> io::Result<()> {
        if !self.missing.is_empty() {
            return Err(io::ErrorKind::NotFound.into());
        }
        let flags = if self.is_folder() { AtFlags::REMOVEDIR } else { AtFlags::empty() };
        step(|| ())?;
        Ok(fs::unlinkat(&self.folder, &self.name, flags)?)
    }

    /// Makes the folder and those it lies in; tells which are new.
    pub(super) fn create_folders(self) -> io::Result<Vec<PathBuf>> {
        if self.is_folder() {
            return Ok(Vec::new());
        }
        let (mut folder, mut new) = (self.folder, Vec::new());
        let count = self.missing.len() + 1;
        for (k, name) in self.missing.iter().chain([&self.name]).enumerate() {
            step(|| ())?;
            match fs::mkdirat(&folder, name, Mode::from_raw_mode(0o777)) {
                Ok(()) => new.extend(self.real.ancestors().nth(count - 1 - k).map(Path::to_owned)),
                Err(Errno::EXIST) => {}
                Err(error) => return Err(error.into()),
            }
            folder = fs::openat(&folder, name, folder_flags(), Mode::empty())?;
        }
        Ok(new)
    }
}

/// The number of the user.
pub(super) fn user() -> u32 {
    rustix::process::geteuid().as_raw()
}

/// A folder as a step of a walk: it need not be readable.
fn folder_flags() -> OFlags {
    let flags = OFlags::DIRECTORY | OFlags::NOFOLLOW | OFlags::CLOEXEC;
    #[cfg(any(target_os = "linux", target_os = "android"))]
    let flags = flags | OFlags::PATH;
    flags
}

/// Whether the operating system makes up the content when it is read, wherever it is mounted.
#[cfg(target_os = "linux")]
fn is_made_up(file: &File) -> bool {
    /// `SYSFS_MAGIC` and `PROC_SUPER_MAGIC` of Linux's `magic.h`.
    const MADE_UP: [u64; 2] = [0x6265_6572, 0x9fa0];
    fs::fstatfs(file).is_ok_and(|found| MADE_UP.contains(&(found.f_type as u64)))
}

#[cfg(not(target_os = "linux"))]
fn is_made_up(_: &File) -> bool {
    false
}
