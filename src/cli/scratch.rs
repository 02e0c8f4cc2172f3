//! The world of a test: it reads the disk, and keeps in memory what is written.

use super::world::SystemWorld;
use crate::script::access::policy::{Access, Change, Grant, Policy};
use crate::script::runs::view::Progress;
use crate::script::world::{Environment, FileAccess, FileReader, Files, Screen, Stamp};
use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};

/// What a script prints, readable while its session owns the world.
pub(super) type Output = Arc<Mutex<String>>;

/// The disk below, memory above; the clock stands still and there is one thread, so that a test
/// gives the same text every time.
pub(super) struct ScratchWorld {
    policy: Policy,
    disk: SystemWorld,
    current: PathBuf,
    output: PathBuf,
    files: BTreeMap<PathBuf, Vec<u8>>,
    folders: BTreeSet<PathBuf>,
    removed: BTreeSet<PathBuf>,
    changes: u64,
    printed: Output,
}

impl ScratchWorld {
    /// A world whose working directory is `folder`.
    pub(super) fn new(disk: SystemWorld, folder: &Path, printed: Output) -> ScratchWorld {
        let current = disk.absolute(folder);
        let output = current.join("results");
        let mut world = ScratchWorld {
            policy: Policy::default(),
            output: output.clone(),
            current: current.clone(),
            disk,
            files: BTreeMap::new(),
            folders: BTreeSet::new(),
            removed: BTreeSet::new(),
            changes: 0,
            printed,
        };
        world.grant(Grant::Create(&current));
        world.grant(Grant::Own(&output));
        world
    }
}

fn missing(path: &Path) -> io::Error {
    io::Error::new(io::ErrorKind::NotFound, format!("no such file: {}", path.display()))
}

impl FileAccess for ScratchWorld {
    fn grant(&mut self, grant: Grant<'_>) {
        let path = grant.path().map(|path| self.absolute(path)).unwrap_or_default();
        self.disk.grant(grant.with_path(&path));
        self.policy.grant(grant, path);
    }

    fn permits(&self, path: &Path, access: Access) -> io::Result<()> {
        let path = self.absolute(path);
        match access {
            Access::Read if self.policy.has_made(&path) => Ok(()),
            Access::Read => self.disk.permits(&path, access),
            // What is written stays in memory.
            Access::Write | Access::Folder => {
                Ok(self.policy.may_write(&path, Change::by(access, self.exists(&path)))?)
            }
        }
    }
}

impl Files for ScratchWorld {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let path = self.absolute(path);
        match self.files.get(&path) {
            Some(bytes) => Ok(bytes.clone()),
            None if self.removed.contains(&path) => Err(missing(&path)),
            None => self.disk.read(&path),
        }
    }

    fn write(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        self.permits(path, Access::Write)?;
        let path = self.absolute(path);
        self.policy.note_made(path.clone());
        self.changes += 1;
        self.folders.extend(path.ancestors().skip(1).map(Path::to_path_buf));
        self.files.insert(path, bytes.to_vec());
        Ok(())
    }

    fn append(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let mut all = self.read(path).unwrap_or_default();
        all.extend_from_slice(bytes);
        self.write(path, &all)
    }

    fn remove(&mut self, path: &Path) -> io::Result<()> {
        if !self.exists(path) {
            return Err(missing(path));
        }
        self.permits(path, Access::Write)?;
        let path = self.absolute(path);
        self.files.remove(&path);
        self.folders.remove(&path);
        self.removed.insert(path);
        Ok(())
    }

    fn exists(&self, path: &Path) -> bool {
        let path = self.absolute(path);
        self.files.contains_key(&path)
            || self.folders.contains(&path)
            || !self.removed.contains(&path) && self.disk.exists(&path)
    }

    fn is_dir(&self, path: &Path) -> bool {
        let path = self.absolute(path);
        self.folders.contains(&path) || !self.removed.contains(&path) && self.disk.is_dir(&path)
    }

    fn stamp(&self, path: &Path) -> Option<Stamp> {
        let path = self.absolute(path);
        match self.files.get(&path) {
            Some(bytes) => Some(Stamp(0, bytes.len() as u64, self.changes)),
            None => self.disk.stamp(&path),
        }
    }

    fn list_dir(&self, path: &Path) -> io::Result<Vec<String>> {
        let path = self.absolute(path);
        let mut names: BTreeSet<String> =
            self.disk.list_dir(&path).unwrap_or_default().into_iter().collect();
        for written in self.files.keys().chain(&self.folders) {
            let inside = written.strip_prefix(&path).ok().and_then(|rest| rest.components().next());
            names.extend(inside.map(|name| name.as_os_str().to_string_lossy().into_owned()));
        }
        names.retain(|name| !self.removed.contains(&path.join(name)));
        match names.is_empty() && !self.is_dir(&path) {
            true => Err(missing(&path)),
            false => Ok(names.into_iter().collect()),
        }
    }

    fn reader(&self) -> Arc<dyn FileReader> {
        self.disk.reader()
    }

    fn create_dirs(&mut self, path: &Path) -> io::Result<()> {
        let path = self.absolute(path);
        if self.is_dir(&path) {
            return Ok(());
        }
        self.permits(&path, Access::Folder)?;
        self.policy.note_made(path.clone());
        self.folders.extend(path.ancestors().map(Path::to_path_buf));
        Ok(())
    }

    fn current_dir(&self) -> PathBuf {
        self.current.clone()
    }

    fn set_current_dir(&mut self, path: &Path) -> io::Result<()> {
        let path = self.absolute(path);
        if !self.is_dir(&path) {
            return Err(missing(&path));
        }
        self.current = path;
        Ok(())
    }

    fn output_dir(&self) -> PathBuf {
        self.output.clone()
    }
}

impl Environment for ScratchWorld {
    fn env(&self, name: &str) -> Option<String> {
        self.disk.env(name)
    }

    fn monotonic_seconds(&self) -> f64 {
        0.0
    }

    fn unix_seconds(&self) -> u64 {
        0
    }

    fn is_interrupted(&self) -> bool {
        self.disk.is_interrupted()
    }

    fn interrupt_flag(&self) -> Option<Arc<AtomicBool>> {
        self.disk.interrupt_flag()
    }

    fn stop_reason(&self) -> Option<String> {
        self.disk.stop_reason()
    }

    fn threads(&self) -> usize {
        1
    }
}

impl Screen for ScratchWorld {
    fn print(&mut self, text: &str) {
        if let Ok(mut printed) = self.printed.lock() {
            printed.push_str(text);
        }
    }

    fn eprint(&mut self, _text: &str) {}

    fn progress(&mut self, _progress: &Progress) {}
}
