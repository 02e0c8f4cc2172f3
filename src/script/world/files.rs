//! Files and folders as scripts see them.

use crate::access::policy::{Access, Grant};
use std::fmt;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// A stamp of a file's state: another stamp means that the content may have changed. When it was
/// changed, its size, and how often the world itself has changed files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stamp(pub u64, pub u64, pub u64);

/// The files of a world, for reading alone: what a library keeps to read its classes when they are
/// needed, from any thread. Paths are absolute.
pub trait FileReader: fmt::Debug + Send + Sync {
    /// The bytes of a file.
    fn read(&self, path: &Path) -> io::Result<Vec<u8>>;
    /// Names of the entries of a directory, sorted.
    fn list_dir(&self, path: &Path) -> io::Result<Vec<String>>;
    /// Whether there is a file of this path that is no directory.
    fn is_file(&self, path: &Path) -> bool;
}

/// Writes the content of a file.
pub type Content<'a> = &'a mut dyn FnMut(&mut dyn io::Write) -> io::Result<()>;

/// Which files a script may read and write.
pub trait FileAccess {
    /// Allows something from here on: called by what starts the run, never by a script.
    fn grant(&mut self, grant: Grant<'_>);
    /// What is allowed and excluded, for people: what it means, and the path or whatever it is about.
    fn permissions(&self) -> Vec<(String, String)> {
        Vec::new()
    }
    /// Whether a path may be read or written.
    ///
    /// # Errors
    /// What refuses it; see `refusal_of`.
    fn permits(&self, path: &Path, access: Access) -> io::Result<()>;
}

/// The files that a script can read and write. Paths may be relative to [`Files::current_dir`].
pub trait Files: FileAccess {
    /// The bytes of a file.
    fn read(&self, path: &Path) -> io::Result<Vec<u8>>;
    /// The first bytes of a file, at most this many.
    fn read_start(&self, path: &Path, most: usize) -> io::Result<Vec<u8>> {
        let mut bytes = self.read(path)?;
        bytes.truncate(most);
        Ok(bytes)
    }
    /// Rewrites a file, safe against a power cut.
    fn write(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()>;
    /// Rewrites a file as `content` writes it: implementations with a disk keep none of it in
    /// memory, and leave it to the system when it reaches the disk.
    fn write_with(&mut self, path: &Path, content: Content<'_>) -> io::Result<()> {
        let mut bytes = Vec::new();
        content(&mut bytes)?;
        self.write(path, &bytes)
    }
    /// Appends to a file, which is created if there is none.
    fn append(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()>;
    /// Makes what a file holds safe against a power cut.
    fn sync(&mut self, _path: &Path) -> io::Result<()> {
        Ok(())
    }
    /// Removes a file or an empty directory.
    fn remove(&mut self, path: &Path) -> io::Result<()>;
    /// Whether a file or directory of this path exists.
    fn exists(&self, path: &Path) -> bool;
    /// Whether it is a directory.
    fn is_dir(&self, path: &Path) -> bool;
    /// Whether it is a symbolic link.
    fn is_link(&self, _path: &Path) -> bool {
        false
    }
    /// A stamp of a file, `None` if there is none.
    fn stamp(&self, path: &Path) -> Option<Stamp>;
    /// Names of the entries of a directory, sorted.
    fn list_dir(&self, path: &Path) -> io::Result<Vec<String>>;
    /// The files as they are, or as they are now.
    fn reader(&self) -> Arc<dyn FileReader>;
    /// Makes a directory and the ones it lies in.
    fn create_dirs(&mut self, path: &Path) -> io::Result<()>;
    /// The working directory, absolute.
    fn current_dir(&self) -> PathBuf;
    /// Changes the working directory.
    fn set_current_dir(&mut self, path: &Path) -> io::Result<()>;
    /// Where plots and reports go.
    fn output_dir(&self) -> PathBuf;
    /// Copies a file over another.
    fn copy(&mut self, from: &Path, to: &Path) -> io::Result<()> {
        let bytes = self.read(from)?;
        self.write(to, &bytes)
    }
    /// The absolute form of a path: joined to the working directory, `.` and `..` resolved in the
    /// text.
    fn absolute(&self, path: &Path) -> PathBuf {
        normalized(&self.current_dir().join(path))
    }
}

/// A path with `.` and `..` resolved in the text.
pub fn normalized(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => match out.components().next_back() {
                Some(Component::Normal(_)) => {
                    out.pop();
                }
                Some(Component::RootDir | Component::Prefix(_)) => {}
                _ => out.push(component),
            },
            _ => out.push(component),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dots_above_the_root_stay() {
        assert_eq!(normalized(Path::new("a/../../b")), PathBuf::from("../b"));
        assert_eq!(normalized(Path::new("/a/./b/../c")), PathBuf::from("/a/c"));
    }
}
