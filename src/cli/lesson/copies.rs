//! The learner's folder: copies of the lessons, and what is passed.

use crate::lessons::{Lesson, Progress};
use crate::syntax;
use crate::{disk, named};
use std::io;
use std::path::{Path, PathBuf};

/// The learner's folder where the command line names no other.
pub(super) const FOLDER: &str = "lessons";
/// The file that says what is passed.
const PROGRESS: &str = "progress.toml";

/// The learner's folder.
pub(super) struct Copies<'a> {
    /// Where it is.
    pub folder: &'a Path,
}

impl Copies<'_> {
    /// A file of the learner.
    pub(super) fn file(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// All files of a lesson: their names and how they are shipped.
    fn shipped(lesson: &Lesson) -> impl Iterator<Item = (&str, &str)> {
        let companions = lesson.companions.iter().map(|(name, text)| (&**name, &**text));
        companions.chain([(&*lesson.file, &*lesson.text)])
    }

    /// Copies the files of a lesson that are not there yet; whether the script was among them.
    ///
    /// # Errors
    ///
    /// A file cannot be written.
    pub(super) fn make(&self, lesson: &Lesson) -> Result<bool, String> {
        let is_new = !self.file(&lesson.file).exists();
        for (name, text) in Self::shipped(lesson) {
            if !self.file(name).exists() {
                self.write(name, text)?;
            }
        }
        Ok(is_new)
    }

    /// Keeps the learner's files under other names and copies the unsolved ones; which is kept
    /// where. A file without changes is not kept.
    ///
    /// # Errors
    ///
    /// A file cannot be read or written.
    pub(super) fn reset(&self, lesson: &Lesson) -> Result<Vec<(PathBuf, PathBuf)>, String> {
        let mut kept = Vec::new();
        for (name, text) in Self::shipped(lesson) {
            let file = self.file(name);
            if file.exists() {
                let own = named::read(&file).map_err(|error| failed(&file, &error))?;
                if own != text.as_bytes() {
                    let beside = self.file(&format!("{name}.old"));
                    disk::write_beside(&beside, &own).map_err(|error| failed(&beside, &error))?;
                    kept.push((file, beside));
                }
            }
            self.write(name, text)?;
        }
        Ok(kept)
    }

    /// The contents of the learner's files: the script, and the others with their names. As scripts
    /// are read: in UTF-8 or Latin-1.
    ///
    /// # Errors
    ///
    /// A file cannot be read.
    pub(super) fn read(&self, lesson: &Lesson) -> Result<(String, Vec<(String, String)>), String> {
        let text = |name: &str| {
            let file = self.file(name);
            let bytes = named::read(&file).map_err(|error| failed(&file, &error))?;
            Ok::<_, String>(syntax::decode(&bytes).0)
        };
        let companions = lesson.companions.iter();
        let companions = companions.map(|(name, _)| Ok((name.clone(), text(name)?)));
        Ok((text(&lesson.file)?, companions.collect::<Result<_, String>>()?))
    }

    /// What is passed; nothing where there is no file yet.
    ///
    /// # Errors
    ///
    /// The file cannot be read.
    pub(super) fn progress(&self) -> Result<Progress, String> {
        let file = self.file(PROGRESS);
        if !file.exists() {
            return Ok(Progress::default());
        }
        let read = named::read_text(&file).map_err(|error| error.to_string());
        let progress = read.and_then(|text| Progress::read(&text));
        progress.map_err(|error| {
            let file = file.display();
            format!("`{file}`: {error}\n = help: correct it, or remove it to begin again")
        })
    }

    /// Writes what is passed.
    ///
    /// # Errors
    ///
    /// The file cannot be written.
    pub(super) fn keep(&self, progress: &Progress) -> Result<(), String> {
        self.write(PROGRESS, &progress.text())
    }

    /// Whether a link leads out of the folder, or out of the working folder if it was not named.
    fn leads_elsewhere(&self, file: &Path) -> bool {
        let real = |path: &Path| {
            std::path::absolute(path)
                .map_or_else(|_| path.to_owned(), |path| disk::real_path(&path))
        };
        let folder = real(self.folder);
        let is_named = self.folder != Path::new(FOLDER);
        let is_inside = file.parent().is_none_or(|parent| real(parent).starts_with(&folder));
        !is_inside || !is_named && !folder.starts_with(real(Path::new(".")))
    }

    fn write(&self, name: &str, text: &str) -> Result<(), String> {
        let file = self.file(name);
        if self.leads_elsewhere(&file) {
            return Err(format!(
                "`{}` is not written: a link leads out of the folder\n = help: remove the link, or \
                 name another folder with `--folder`",
                file.display()
            ));
        }
        let folders = file.parent().map_or(Ok(()), disk::create_named_folders);
        let written = folders.and_then(|()| disk::write_beside(&file, text.as_bytes()));
        written.map_err(|error| failed(&file, &error))
    }
}

fn failed(file: &Path, error: &io::Error) -> String {
    format!("`{}`: {error}", file.display())
}
