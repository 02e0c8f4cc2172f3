//! Which files a script or a model may read, make, replace and remove.
//!
//! The rules work on real paths: a [`World`](crate::world::World) resolves a path once, links and
//! `..` included, asks here, and acts on what it has resolved. So a name that leads somewhere else
//! is judged by where it leads.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Access {
    /// To read a file or the names in a folder.
    Read,
    /// To create or change a file, or to remove a file or folder.
    Write,
    /// To create a folder.
    Folder,
}

/// What a write does to the disk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Change {
    /// It creates a file.
    NewFile,
    /// It creates a folder.
    NewFolder,
    /// It replaces, extends or removes what is there.
    Existing,
}

impl Change {
    /// The change that this access makes where something `exists` or not.
    pub fn by(access: Access, exists: bool) -> Change {
        match (exists, access) {
            (true, _) => Change::Existing,
            (false, Access::Folder) => Change::NewFolder,
            (false, _) => Change::NewFile,
        }
    }
}

/// What the user allows. Folders include what is below them; paths may be relative.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Grant<'a> {
    /// To read what is in this folder, or this file or device, which the user has named.
    Read(&'a Path),
    /// To read what is in this folder, or this file, which was found beside or above one that the
    /// user has named: if its real path lies in the folder where it was found, and if it belongs to
    /// the user, to the system or to the owner of what the user has named.
    Found(&'a Path),
    /// To make new files in this folder.
    Create(&'a Path),
    /// To make new files of results and data in this folder, not below it.
    Results(&'a Path),
    /// To replace this file, which holds results of a simulation, where new files may be made.
    Replace(&'a Path),
    /// To make, replace and remove files in this folder, which holds the results of the run.
    Own(&'a Path),
    /// To write this one file or device, whatever it is: the user has named it on the command line.
    Named(&'a Path),
    /// Nothing in this folder, whatever else is allowed.
    Deny(&'a Path),
    /// To read all files.
    ReadAll,
    /// To write and remove all files.
    WriteAll,
    /// To compile and call functions in C of a library, or of all.
    ExternalCode(Option<&'a str>),
    /// To run this functional mock-up unit.
    ExternalFile(&'a Path),
    /// Functions in C are not called, even if they are allowed: the models are only checked.
    CheckOnly,
}

impl<'a> Grant<'a> {
    /// The file or folder that it names.
    pub fn path(self) -> Option<&'a Path> {
        match self {
            Grant::Read(path)
            | Grant::Found(path)
            | Grant::Create(path)
            | Grant::Results(path)
            | Grant::Replace(path)
            | Grant::Own(path)
            | Grant::Named(path)
            | Grant::Deny(path)
            | Grant::ExternalFile(path) => Some(path),
            Grant::ReadAll | Grant::WriteAll | Grant::ExternalCode(_) | Grant::CheckOnly => None,
        }
    }

    /// The same for another path.
    #[must_use]
    pub fn with_path(self, path: &'a Path) -> Grant<'a> {
        match self {
            Grant::Read(_) => Grant::Read(path),
            Grant::Found(_) => Grant::Found(path),
            Grant::Create(_) => Grant::Create(path),
            Grant::Results(_) => Grant::Results(path),
            Grant::Replace(_) => Grant::Replace(path),
            Grant::Own(_) => Grant::Own(path),
            Grant::Named(_) => Grant::Named(path),
            Grant::Deny(_) => Grant::Deny(path),
            Grant::ExternalFile(_) => Grant::ExternalFile(path),
            Grant::ReadAll | Grant::WriteAll | Grant::ExternalCode(_) | Grant::CheckOnly => self,
        }
    }
}

/// Why something is not done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Refusal {
    /// Reading outside of the folders that may be read.
    Reading,
    /// Reading what a link leads to that was found beside or above a file of the user.
    Link,
    /// Reading what was found there and belongs to another user.
    Owner,
    /// What the user or the program excludes.
    Denied,
    /// Writing outside of the folders that may be written.
    Outside,
    /// A file of the operating system, or one that is neither a file nor a folder.
    System,
    /// A name that begins with a dot.
    Hidden,
    /// A new file of a kind that scripts do not create.
    Kind,
    /// A file that the run has not made.
    Existing,
    /// A file that has further names (hard links).
    Shared,
    /// A file in which the program keeps account.
    Reserved,
    /// Writing where a link leads that the user has named, out of its folder.
    NamedLink,
}

impl Refusal {
    /// Why, as the end of a sentence about the file.
    pub fn reason(self) -> &'static str {
        match self {
            Refusal::Reading => "it is outside the folders that may be read",
            Refusal::Link => "a link leads there, out of the folders that may be read",
            Refusal::Owner => "it belongs to another user",
            Refusal::Denied => "it is closed to scripts and models",
            Refusal::Outside => "it is outside the directory where the run started",
            Refusal::System => "it belongs to the operating system",
            Refusal::Hidden => "its name starts with a dot",
            Refusal::Kind => {
                "scripts create data, figures, text, logs, models and scripts here, and no other \
                 files"
            }
            Refusal::Existing => "this run did not create it",
            Refusal::Shared => "it has a second name elsewhere (a hard link)",
            Refusal::Reserved => "the program keeps its own records in it",
            Refusal::NamedLink => "it is a link that leads to another folder",
        }
    }

    /// What the user can do about it; `file` is what was refused.
    pub fn help(self, file: &Path) -> Option<String> {
        Some(match self {
            Refusal::Reading | Refusal::Link | Refusal::Owner => {
                let folder = quoted(file.parent().unwrap_or(file));
                format!("allow it with `--allow-read={folder}`, or `--allow-read` for all files")
            }
            Refusal::System | Refusal::Reserved | Refusal::Denied => return None,
            Refusal::NamedLink => "name the file to which it leads, or remove the link".to_owned(),
            Refusal::Kind => {
                "write it to the output folder, or allow it with `--allow-write`".to_owned()
            }
            _ => "allow it with `--allow-write`".to_owned(),
        })
    }

    /// Whether it was about reading.
    pub fn is_of(self) -> Access {
        match self {
            Refusal::Reading | Refusal::Link | Refusal::Owner => Access::Read,
            _ => Access::Write,
        }
    }
}

/// A folder as a shell takes it.
fn quoted(folder: &Path) -> String {
    let text = folder.display().to_string();
    let is_plain = |c: char| c.is_alphanumeric() || "/\\._-:~".contains(c);
    if text.chars().all(is_plain) { text } else { format!("\"{text}\"") }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.reason())
    }
}

impl std::error::Error for Refusal {}

impl From<Refusal> for io::Error {
    fn from(refusal: Refusal) -> io::Error {
        io::Error::new(io::ErrorKind::PermissionDenied, refusal)
    }
}

/// The refusal that an error is, if it is one.
pub fn refusal_of(error: &io::Error) -> Option<Refusal> {
    error.get_ref()?.downcast_ref().copied()
}

/// Folders whose files are not files, but the state of the operating system and its devices.
const SYSTEM: &[&str] = &["/proc", "/sys", "/dev"];

/// The file in an output folder that lists what runs have made outside of it.
pub const RECORD: &str = "files_made.txt";

/// The files that scripts create beside themselves and in the working folder, by the ends of their
/// names. All other files are created in the output folder only: build systems, interpreters and
/// shells execute files by their names alone.
pub const KINDS: &[(&str, &[&str])] = &[
    ("data", &["mat", "csv", "tsv", "txt", "dat"]),
    ("figures", &["svg", "png", "pdf", "eps"]),
    ("text and logs", &["txt", "md", "tex", "log"]),
    ("models and scripts", &["mo", "mos", "fmu"]),
];

/// Names of these kinds that other programs execute, or that stand for a library in later runs.
pub const EXCEPTIONS: &[&str] = &[
    "CMakeLists.txt",
    "conanfile.txt",
    "requirements.txt",
    "package.mo",
    "Modelica.mo",
    "ModelicaServices.mo",
    "Complex.mo",
    "GAPILib.mo",
    "startup.mos",
    "dymola.mos",
];

/// What the user allows, all in real paths.
#[derive(Debug, Clone, Default)]
pub struct Policy {
    readable: BTreeSet<PathBuf>,
    denied: BTreeSet<PathBuf>,
    passed_over: BTreeMap<PathBuf, Refusal>,
    creatable: BTreeSet<PathBuf>,
    results: BTreeSet<PathBuf>,
    own: BTreeSet<PathBuf>,
    named: BTreeSet<PathBuf>,
    made: BTreeSet<PathBuf>,
    /// What earlier runs have made, as their record says: it may be replaced, not read for that.
    recorded: BTreeSet<PathBuf>,
    reads_all: bool,
    writes_all: bool,
    external_code: ExternalCode,
}

/// Functions in C that may be called.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ExternalCode {
    /// Those of these libraries.
    libraries: BTreeSet<String>,
    /// The functional mock-up units in these files.
    files: BTreeSet<PathBuf>,
    /// Those of all.
    all: bool,
    /// Whether they are only checked.
    pub is_only_checked: bool,
}

impl ExternalCode {
    /// The libraries, for people.
    pub fn listed(&self) -> String {
        let files = self.files.iter().map(|file| file.display().to_string());
        let named: Vec<String> = self.libraries.iter().cloned().chain(files).collect();
        match (self.all, named.is_empty()) {
            (true, _) => "of all libraries".to_owned(),
            (false, true) => "none".to_owned(),
            _ => named.join(", "),
        }
    }

    /// Whether functions of any library are allowed.
    pub fn is_allowed(&self) -> bool {
        self.all || !self.libraries.is_empty()
    }

    /// Whether the functional mock-up unit in the file with this real path is allowed: itself, or all files of
    /// its name.
    pub fn permits_file(&self, real: &Path) -> bool {
        let name = real.file_name().and_then(|name| name.to_str());
        let is_named = name.is_some_and(|name| self.libraries.contains(name));
        self.all || is_named || self.files.contains(real)
    }

    /// Whether those of the library with this class are allowed.
    pub fn permits(&self, class: &str) -> bool {
        let library = class.split('.').next().unwrap_or_default();
        self.all || self.libraries.contains(library)
    }
}

impl Policy {
    /// Allows something; `real` is the real path of the one that the grant names.
    pub fn grant(&mut self, grant: Grant<'_>, real: PathBuf) {
        match grant {
            Grant::Read(_) | Grant::Found(_) => drop(self.readable.insert(real)),
            Grant::Deny(_) => drop(self.denied.insert(real)),
            Grant::Create(_) => drop(self.creatable.insert(real)),
            Grant::Results(_) => drop(self.results.insert(real)),
            Grant::Replace(_) => self.note_made(real),
            Grant::Own(_) => drop(self.own.insert(real)),
            Grant::Named(_) => drop(self.named.insert(real)),
            Grant::ReadAll => self.reads_all = true,
            Grant::WriteAll => self.writes_all = true,
            Grant::ExternalCode(Some(library)) => {
                self.external_code.libraries.insert(library.to_owned());
            }
            Grant::ExternalFile(_) => drop(self.external_code.files.insert(real)),
            Grant::ExternalCode(None) => self.external_code.all = true,
            Grant::CheckOnly => self.external_code.is_only_checked = true,
        }
    }

    /// What is allowed and excluded: what it means, and the real path where it is one.
    pub fn listed(&self) -> Vec<(String, PathBuf)> {
        let mut rows = Vec::new();
        let mut list = |meaning: &str, paths: &BTreeSet<PathBuf>| {
            rows.extend(paths.iter().map(|path| (meaning.to_owned(), path.clone())));
        };
        list("read", &self.readable);
        list("read, create new files", &self.creatable);
        list("create results", &self.results);
        list("read, create, replace, remove", &self.own);
        list("write this file", &self.named);
        list("closed", &self.denied);
        let everywhere = [("read", self.reads_all), ("write", self.writes_all)];
        for (verb, _) in everywhere.into_iter().filter(|(_, all)| *all) {
            rows.push((format!("{verb} everywhere"), PathBuf::from("/")));
        }
        let passed = self.passed_over.iter();
        rows.extend(passed.map(|(path, why)| (format!("not read: {why}"), path.clone())));
        rows
    }

    /// Notes why a file or folder that was found is not granted.
    pub fn pass_over(&mut self, real: PathBuf, why: Refusal) {
        self.passed_over.insert(real, why);
    }

    /// Notes that the run has made this file or folder.
    pub fn note_made(&mut self, real: PathBuf) {
        self.made.insert(real);
    }

    /// Notes that an earlier run has made this file or folder.
    pub fn note_recorded(&mut self, real: PathBuf) {
        self.recorded.insert(real);
    }

    /// Whether the run has made this file or folder.
    pub fn has_made(&self, real: &Path) -> bool {
        self.made.contains(real)
    }

    /// Notes that the file or folder is gone.
    pub fn note_removed(&mut self, real: &Path) {
        self.made.remove(real);
        self.recorded.remove(real);
    }

    /// Whether all files may be written.
    pub fn writes_all(&self) -> bool {
        self.writes_all
    }

    /// The functions in C that may be compiled and called.
    pub fn external_code(&self) -> &ExternalCode {
        &self.external_code
    }

    /// Whether the user has named this file.
    pub fn is_named(&self, real: &Path) -> bool {
        self.named.contains(real)
    }

    /// The output folder that a file is in.
    pub fn own_folder_of(&self, real: &Path) -> Option<&Path> {
        deepest(&self.own, real)
    }

    /// The output folders.
    pub fn own_folders(&self) -> impl Iterator<Item = &Path> {
        self.own.iter().map(PathBuf::as_path)
    }

    /// # Errors
    /// The file or folder may not be read.
    pub fn may_read(&self, real: &Path) -> Result<(), Refusal> {
        if let Some(decided) = self.decided(real) {
            return decided;
        }
        let known = [&self.readable, &self.creatable, &self.own];
        let is_readable = known.into_iter().any(|folders| deepest(folders, real).is_some());
        match is_readable || self.reads_all || self.made.contains(real) {
            true => Ok(()),
            false => Err(self.why_not_read(real)),
        }
    }

    fn why_not_read(&self, real: &Path) -> Refusal {
        let known = real.ancestors().find_map(|folder| self.passed_over.get(folder));
        known.copied().unwrap_or(Refusal::Reading)
    }

    /// What holds whatever else is granted.
    fn decided(&self, real: &Path) -> Option<Result<(), Refusal>> {
        match () {
            () if self.named.contains(real) => Some(Ok(())),
            () if is_of_system(real) => Some(Err(Refusal::System)),
            () if deepest(&self.denied, real).is_some() => Some(Err(Refusal::Denied)),
            () => None,
        }
    }

    /// # Errors
    /// The file or folder may not be made, changed or removed.
    pub fn may_write(&self, real: &Path, change: Change) -> Result<(), Refusal> {
        if let Some(decided) = self.decided(real) {
            return decided;
        }
        let own = deepest(&self.own, real);
        if own.is_some() && real.file_name().is_some_and(|name| name == RECORD) {
            return Err(Refusal::Reserved);
        }
        if self.writes_all {
            return Ok(());
        }
        let results =
            real.parent().filter(|folder| is_result(real) && self.results.contains(*folder));
        let roots = [own, deepest(&self.creatable, real), results];
        let root = roots.into_iter().flatten().max_by_key(|root| root.as_os_str().len());
        let below = root.and_then(|root| real.strip_prefix(root).ok()).ok_or(Refusal::Outside)?;
        if below.iter().any(|name| name.as_encoded_bytes().starts_with(b".")) {
            return Err(Refusal::Hidden);
        }
        match change {
            _ if own.is_some() => Ok(()),
            Change::Existing if self.made.contains(real) || self.recorded.contains(real) => Ok(()),
            Change::Existing => Err(Refusal::Existing),
            Change::NewFile if !is_created(real) => Err(Refusal::Kind),
            Change::NewFile | Change::NewFolder => Ok(()),
        }
    }
}

/// The folder among these that the path is in and that is the closest to it.
fn deepest<'a>(folders: &'a BTreeSet<PathBuf>, real: &Path) -> Option<&'a Path> {
    real.ancestors().find_map(|folder| folders.get(folder)).map(PathBuf::as_path)
}

/// Whether the file is one of the operating system, its devices and processes.
pub fn is_of_system(real: &Path) -> bool {
    // Linux keeps a file system for ordinary files there.
    !real.starts_with("/dev/shm") && SYSTEM.iter().any(|folder| real.starts_with(folder))
}

/// Whether it has the name of a file of results or data.
fn is_result(real: &Path) -> bool {
    real.extension().is_some_and(|e| e == "mat" || e == "csv" || e == "txt")
}

/// Whether scripts create files of this name outside of the output folder.
fn is_created(real: &Path) -> bool {
    let Some(name) = real.file_name().and_then(|name| name.to_str()) else { return false };
    let Some((_, ending)) = name.rsplit_once('.') else { return false };
    let is_kind = |known: &&str| known.eq_ignore_ascii_case(ending);
    KINDS.iter().any(|(_, endings)| endings.iter().any(is_kind))
        && !EXCEPTIONS.iter().any(|known| known.eq_ignore_ascii_case(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn policy() -> Policy {
        let mut policy = Policy::default();
        for (grant, path) in [
            (Grant::Create("".as_ref()), "/home/me"),
            (Grant::Own("".as_ref()), "/home/me/results/fit"),
            (Grant::Read("".as_ref()), "/libraries"),
            (Grant::Named("".as_ref()), "/data/.curve.mo"),
        ] {
            policy.grant(grant, path.into());
        }
        policy
    }

    #[test]
    fn reading_ends_at_the_folders_of_the_run() {
        let policy = policy();
        for path in ["/home/me/a", "/home/me/.b", "/libraries/M/a.mo", "/data/.curve.mo"] {
            assert_eq!(policy.may_read(path.as_ref()), Ok(()), "{path}");
        }
        assert_eq!(policy.may_read("/data/other".as_ref()), Err(Refusal::Reading));
        assert_eq!(policy.may_read("/home/me2/a".as_ref()), Err(Refusal::Reading));
    }

    #[test]
    fn the_system_stays_closed_whatever_is_allowed() {
        let mut policy = policy();
        policy.grant(Grant::ReadAll, PathBuf::new());
        policy.grant(Grant::WriteAll, PathBuf::new());
        assert_eq!(policy.may_read("/etc/hostname".as_ref()), Ok(()));
        for path in ["/proc/self/environ", "/sys/power/state", "/dev/sda"] {
            assert_eq!(policy.may_read(path.as_ref()), Err(Refusal::System));
            let written = policy.may_write(path.as_ref(), Change::Existing);
            assert_eq!(written, Err(Refusal::System));
        }
    }

    #[test]
    fn writing_makes_new_files_and_replaces_results() {
        use Change::{Existing, NewFile, NewFolder};
        let mut policy = policy();
        let cases = [
            ("/home/me/new.csv", NewFile, Ok(())),
            ("/home/me/NEW.MOS", NewFile, Ok(())),
            ("/home/me/sweep", NewFolder, Ok(())),
            ("/home/me/thesis.tex", Existing, Err(Refusal::Existing)),
            ("/home/me/M.mo", Existing, Err(Refusal::Existing)),
            ("/home/me/.profile", NewFile, Err(Refusal::Hidden)),
            ("/home/me/.config/a.txt", NewFile, Err(Refusal::Hidden)),
            ("/home/me/results/fit/a.csv", Existing, Ok(())),
            ("/home/me/results/fit/Makefile", NewFile, Ok(())),
            ("/home/me/results/fit/.a", Existing, Err(Refusal::Hidden)),
            ("/home/me/results/other/a.csv", Existing, Err(Refusal::Existing)),
            ("/home/me/results/fit/files_made.txt", NewFile, Err(Refusal::Reserved)),
            ("/libraries/a.txt", NewFile, Err(Refusal::Outside)),
            ("/data/.curve.mo", Existing, Ok(())),
        ];
        for (path, change, expected) in cases {
            assert_eq!(policy.may_write(path.as_ref(), change), expected, "{path} {change:?}");
        }
        policy.note_made("/home/me/new.csv".into());
        assert_eq!(policy.may_write("/home/me/new.csv".as_ref(), Existing), Ok(()));
        policy.grant(Grant::Replace("".as_ref()), "/libraries/r.mat".into());
        let outside = policy.may_write("/libraries/r.mat".as_ref(), Existing);
        assert_eq!(outside, Err(Refusal::Outside));
    }

    #[test]
    fn what_is_granted_is_listed() {
        let mut policy = policy();
        let rows = |policy: &Policy| {
            let rows = policy.listed().into_iter();
            rows.map(|(meaning, path)| format!("{meaning}: {}", path.display())).collect::<Vec<_>>()
        };
        policy.grant(Grant::Deny("".as_ref()), "/home/me/private".into());
        policy.pass_over("/home/models".into(), Refusal::Owner);
        let before = rows(&policy);
        let expected = ["closed: /home/me/private", "write this file: /data/.curve.mo"];
        assert!(expected.iter().all(|row| before.iter().any(|one| one == row)), "{before:?}");
        assert!(before.contains(&format!("not read: {}: /home/models", Refusal::Owner)));
        assert!(!before.iter().any(|row| row.contains("everywhere")), "{before:?}");
        policy.grant(Grant::ReadAll, PathBuf::new());
        policy.grant(Grant::WriteAll, PathBuf::new());
        let all = rows(&policy);
        assert!(
            ["read everywhere: /", "write everywhere: /"]
                .iter()
                .all(|row| { all.iter().any(|one| one == row) })
        );
        // What is excluded stays so.
        let private = Path::new("/home/me/private/a.csv");
        assert_eq!(policy.may_read(private), Err(Refusal::Denied));
        assert_eq!(policy.may_write(private, Change::NewFile), Err(Refusal::Denied));
    }

    #[test]
    fn functions_in_c_are_allowed_by_library() {
        let mut policy = policy();
        assert_eq!(policy.external_code().listed(), "none");
        for library in ["Pumps", "Fans"] {
            policy.grant(Grant::ExternalCode(Some(library)), PathBuf::new());
        }
        let code = policy.external_code();
        assert_eq!(code.listed(), "Fans, Pumps");
        assert!(code.permits("Fans.Axial.run") && code.permits("Pumps"));
        assert!(!code.permits("FansToo.run") && !code.permits("Other.Fans"));
        policy.grant(Grant::ExternalCode(None), PathBuf::new());
        assert_eq!(policy.external_code().listed(), "of all libraries");
        assert!(policy.external_code().permits("Other.Fans"));
    }

    #[test]
    fn what_other_programs_execute_is_not_created() {
        let policy = policy();
        for name in [
            "Makefile",
            "conftest.py",
            "sitecustomize.py",
            "CMakeLists.txt",
            "cmakelists.TXT",
            "package.json",
            "package.mo",
            "modelica.mo",
            "run.bat",
            "a.csv.sh",
            "setup.cfg",
            "csv",
        ] {
            let refused = policy.may_write(&Path::new("/home/me").join(name), Change::NewFile);
            assert_eq!(refused, Err(Refusal::Kind), "{name}");
        }
    }
}
