//! Where a command writes its results: a folder for each problem below `results`, so that no
//! problem replaces the results of another.
//!
//! The file `origin.json` in a folder names the command and its input, by the way from the folder
//! to it: the same file is the same problem, however much was changed in it. Beside the folders the
//! link `latest` leads to the one that was written last.

use super::disk::{self, read_named, real_path, write_own};
use super::lock::{self, Lock};
use super::terminal;
use crate::script::world::normalized;
use std::path::{Component, Path, PathBuf};
use std::{fs, io};

/// The file that says whose results a folder holds.
const ORIGIN: &str = "origin.json";
/// The link to the folder that was written last.
const LATEST: &str = "latest";
/// The folder of all results.
pub(super) const RESULTS: &str = "results";
/// The folder of a session in which statements come one after the other.
pub(super) const REPL_RESULTS: &str = "results/repl";
/// Problems of one name below one folder.
const MOST: usize = 10_000;

/// A folder for the results of one problem.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Output {
    /// The folder, absolute.
    pub folder: PathBuf,
    /// The same without links, as it was when the folder was chosen.
    pub real: PathBuf,
    origin: String,
    /// The link that is to lead to it.
    latest: Option<PathBuf>,
}

impl Output {
    /// The folder for the results of `command` on the file `input`: the one that is given, else a
    /// separate one below `results`.
    ///
    /// # Errors
    ///
    /// The given folder holds the results of another problem, and `overwrite` is not set; the
    /// working directory cannot be read.
    pub(super) fn of(
        command: &str,
        input: &Path,
        given: Option<&Path>,
        overwrite: bool,
    ) -> Result<Output, String> {
        match given {
            None => Output::below(Path::new(RESULTS), command, input),
            Some(folder) => {
                let (folder, input) = (absolute(folder)?, absolute(input)?);
                let output = Output::at(folder, command, &input);
                if !overwrite && output.is_of_old_version() {
                    terminal::eprint(&format!(
                        "warning: `{}` does not record which problem its results belong to; they \
                         are replaced\n",
                        output.folder.display()
                    ));
                }
                match output.holder() {
                    Some(other) if other != output.origin && !overwrite => Err(format!(
                        "`{}` contains the results of another problem: {}\n = help: choose \
                         another folder with `--out`, or replace them with `--overwrite`",
                        output.folder.display(),
                        named(&other)
                    )),
                    _ => Ok(output),
                }
            }
        }
    }

    /// A folder of its own below another one, named after the input: that of the same problem, or
    /// one that is free.
    ///
    /// # Errors
    ///
    /// The working directory cannot be read; too many problems have this name.
    pub(super) fn below(all: &Path, command: &str, input: &Path) -> Result<Output, String> {
        let (all, input) = (absolute(all)?, absolute(input)?);
        let stem = input.file_stem().map_or("run".into(), |stem| stem.to_string_lossy());
        let stem = match &*stem {
            // The link has this name.
            LATEST => "latest-problem".into(),
            // `...mos` would make the folder above the output folder.
            stem if stem.trim_matches('.').is_empty() => "run".into(),
            _ => stem,
        };
        let real = real_path(&all);
        if !real.starts_with(real_path(all.parent().unwrap_or(&all))) {
            return Err(format!(
                "`{}` is a link to another folder\n = help: name the folder with `--out`, or \
                 remove the link",
                all.display()
            ));
        }
        let folders = (1..=MOST).map(|k| match k {
            1 => all.join(&*stem),
            k => all.join(format!("{stem}-{k}")),
        });
        let outputs = folders.map(|folder| Output::at(folder, command, &input));
        // A link that came with the folder would make another one the output folder.
        let mut outputs = outputs.filter(|output| output.real.starts_with(&real));
        let own = outputs.find(|output| match output.holder() {
            Some(origin) => origin == output.origin,
            None => is_free(&output.folder),
        });
        let own =
            own.ok_or_else(|| format!("`{}` has no free name for `{stem}`", all.display()))?;
        Ok(Output { latest: Some(all.join(LATEST)), ..own })
    }

    /// A folder within this one, for a further run of the same problem.
    pub(super) fn within(&self, name: &str) -> Output {
        let (folder, real) = (self.folder.join(name), self.real.join(name));
        Output { folder, real, origin: self.origin.clone(), latest: None }
    }

    fn at(folder: PathBuf, command: &str, input: &Path) -> Output {
        let file = way(&folder, input);
        let origin = serde_json::json!({ "command": command, "input": file.to_string_lossy() });
        let real = real_path(&folder);
        Output { folder, real, origin: format!("{origin:#}\n"), latest: None }
    }

    /// Whose results the folder holds, as its `origin.json` says.
    fn holder(&self) -> Option<String> {
        content_of(&self.folder.join(ORIGIN))
    }

    /// Whether it holds results of version 0.1.0, which did not say whose they were.
    fn is_of_old_version(&self) -> bool {
        self.holder().is_none() && self.folder.join("result.json").exists()
    }

    /// Keeps other runs out of the folder, if it is there.
    ///
    /// # Errors
    ///
    /// Another run writes into it.
    pub(super) fn lock_if_there(&self) -> io::Result<Option<Lock>> {
        if self.folder.is_dir() { Lock::of(&self.real).map(Some) } else { Ok(None) }
    }

    /// Says in the folder whose results it holds, before the first of them is written, and keeps
    /// other runs out of it.
    ///
    /// # Errors
    ///
    /// The folder cannot be made or written, or another run writes into it.
    pub(super) fn claim(&self, lock: Option<Lock>) -> io::Result<Lock> {
        disk::create_own_folders(&self.real)?;
        let lock = match lock {
            Some(lock) if self.folder.join(lock::FILE).exists() => lock,
            _ => Lock::of(&self.real)?,
        };
        self.describe().map(|()| lock)
    }

    fn describe(&self) -> io::Result<()> {
        if self.holder().as_ref() != Some(&self.origin) {
            write_own(&self.real.join(ORIGIN), self.origin.as_bytes())?;
        }
        // Without the link the output still says where the results are.
        self.latest.as_ref().map_or(Ok(()), |link| relink(link, &self.folder)).or(Ok(()))
    }
}

/// The folder with results that is meant: the folder itself, or what its link `latest` leads to, if
/// that is a folder in it.
pub(super) fn latest_of(folder: &Path) -> PathBuf {
    let latest = folder.join(LATEST);
    if folder.join("result.json").exists() || !latest.exists() {
        return folder.to_owned();
    }
    let latest = match content_of(&latest) {
        Some(name) => folder.join(name.trim()),
        None => latest,
    };
    let is_inside = || Some(latest.canonicalize().ok()?.starts_with(folder.canonicalize().ok()?));
    if is_inside() == Some(true) { latest } else { folder.to_owned() }
}

/// The text of a file, no pipe and no device.
fn content_of(path: &Path) -> Option<String> {
    String::from_utf8(read_named(path).ok()?).ok()
}

#[cfg(unix)]
fn relink(link: &Path, folder: &Path) -> io::Result<()> {
    if fs::symlink_metadata(link).is_ok_and(|found| !found.is_symlink()) {
        // A file or folder of the user's.
        return Ok(());
    }
    let _ = fs::remove_file(link);
    std::os::unix::fs::symlink(folder.file_name().unwrap_or_default(), link)
}

/// Where links need rights that users do not have, a file names the folder.
#[cfg(not(unix))]
fn relink(link: &Path, folder: &Path) -> io::Result<()> {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    if link.is_dir() { Ok(()) } else { fs::write(link, name.as_bytes()) }
}

/// Whether there is nothing that results could replace.
fn is_free(folder: &Path) -> bool {
    match fs::read_dir(folder) {
        Ok(mut entries) => entries.next().is_none(),
        Err(_) => !folder.exists(),
    }
}

/// A path as it is shown: from the working directory where it lies below.
pub(super) fn shown(path: &Path) -> PathBuf {
    let current = std::env::current_dir().unwrap_or_default();
    path.strip_prefix(&current).unwrap_or(path).to_owned()
}

fn absolute(path: &Path) -> Result<PathBuf, String> {
    let current = std::env::current_dir()
        .map_err(|error| format!("the working directory cannot be read: {error}"))?;
    Ok(normalized(&current.join(path)))
}

/// The way from a folder to a file, so that a project that is moved keeps its results.
fn way(folder: &Path, file: &Path) -> PathBuf {
    let (from, to): (Vec<Component<'_>>, Vec<Component<'_>>) =
        (folder.components().collect(), file.components().collect());
    let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    if common == 0 {
        return file.to_owned();
    }
    let up = (common..from.len()).map(|_| Component::ParentDir);
    up.chain(to[common..].iter().copied()).collect()
}

/// The input that an `origin.json` names.
fn named(origin: &str) -> String {
    let origin: serde_json::Value = serde_json::from_str(origin).unwrap_or_default();
    format!(
        "`{} {}`",
        origin["command"].as_str().unwrap_or("?"),
        origin["input"].as_str().unwrap_or("?")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_problem_has_a_folder_of_its_own() {
        let here = tempfile::tempdir().expect("a folder");
        let all = here.path().join("results");
        let of = |script: &str| {
            let output = Output::below(&all, "gapi run", &here.path().join(script)).expect("room");
            output.claim(None).expect("written");
            output.folder.strip_prefix(&all).expect("below").to_owned()
        };
        assert_eq!(of("a/fit.mos"), Path::new("fit"));
        assert_eq!(of("b/fit.mos"), Path::new("fit-2"));
        assert_eq!(of("a/...mos"), Path::new("run"));
        assert_eq!(of("a/..mos"), Path::new("run-2"));
        assert_eq!(of("a/fit.mos"), Path::new("fit"), "the same problem again");
        fs::write(all.join("fit/result.json"), "{}").expect("written");
        assert_eq!(latest_of(&all).file_name(), Some("latest".as_ref()));
        assert!(latest_of(&all).join("result.json").exists());
    }

    #[test]
    fn results_of_another_problem_are_not_replaced_unasked() {
        let here = tempfile::tempdir().expect("a folder");
        let out = here.path().join("out");
        let of = |command: &str, script: &str, overwrite| {
            Output::of(command, &here.path().join(script), Some(&out), overwrite)
        };
        of("gapi run", "a.mos", false).expect("free").claim(None).expect("written");
        assert!(of("gapi run", "a.mos", false).is_ok());
        let refused = of("gapi run", "b.mos", false).unwrap_err();
        assert!(
            refused.contains("`gapi run ../a.mos`") && refused.contains("--overwrite"),
            "{refused}"
        );
        assert!(of("gapi identify", "a.mos", false).is_err());
        assert!(of("gapi run", "b.mos", true).is_ok());
    }

    /// As another user can do it in a folder that both may write.
    #[test]
    #[cfg(unix)]
    fn a_link_that_takes_the_place_of_the_folder_is_not_followed() {
        let here = tempfile::tempdir().expect("a folder");
        let root = here.path().canonicalize().expect("an absolute path");
        let (all, victim) = (root.join("results"), root.join("victim"));
        fs::create_dir(&victim).expect("made");
        let swapped = |put_away: &Path| {
            let output = Output::below(&all, "gapi run", &root.join("a.mos")).expect("room");
            output.claim(None).expect("written");
            fs::rename(put_away, root.join("away")).expect("renamed");
            std::os::unix::fs::symlink(&victim, put_away).expect("a link");
            assert!(output.claim(None).is_err());
            assert!(!output.lock_if_there().is_ok_and(|lock| lock.is_some()));
            assert_eq!(fs::read_dir(&victim).expect("readable").count(), 0);
            fs::remove_file(put_away).expect("removed");
            fs::remove_dir_all(root.join("away")).expect("removed");
        };
        swapped(&all.join("a"));
        swapped(&all);
    }
}
