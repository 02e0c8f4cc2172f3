//! The files that a model may use while it is compiled: tables above all.

use super::c_functions;
use super::stored::{Reads, Watched};
use crate::Session;
use crate::access::faults::{cannot, plain};
use crate::access::permissions::Permissions;
use crate::access::process::Process;
use crate::diag::Fault;
use crate::errors::FILE_ERROR;
use crate::external::c::{CCompiler, Request};
use crate::external::{Entry, Provide, Resources};
use crate::name::{Ident, Name};
use crate::world::{FileReader, normalized};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Files of a session as they are looked for in one model.
#[derive(Debug)]
struct ModelFiles {
    files: Arc<dyn FileReader>,
    /// Where relative paths start: the first folder that has the file.
    folders: Vec<PathBuf>,
    /// The file or folder of each loaded top-level class.
    packages: BTreeMap<Ident, PathBuf>,
    /// Who compiles C, if that is allowed.
    compiler: Option<Arc<dyn CCompiler>>,
    /// What a translation that is kept depends on, and what the model itself does.
    reads: [Reads; 2],
    /// The environment variables that the session has set, and those of the system.
    process: Process,
    permissions: Permissions,
    variables: Option<fn(&str) -> Option<String>>,
}

impl Session {
    /// Files for a model: relative paths start from the working directory, the folder of the
    /// script, the folder of the file that the model is in.
    pub(crate) fn resources_for(&self, model: &Name) -> Resources {
        let packages = self.classes.packages();
        let own = model.first().and_then(|top| packages.get(&top));
        let is_file = |own: &PathBuf| own.extension().is_some_and(|e| e == "mo");
        let folder = own.and_then(|own| if is_file(own) { own.parent() } else { Some(own) });
        self.resources_below(folder)
    }

    /// Files for any model: relative paths start from the working directory and the folder of the
    /// script.
    pub fn resources(&self) -> Resources {
        self.resources_below(None)
    }

    fn resources_below(&self, folder: Option<&Path>) -> Resources {
        let mut folders = vec![self.world.current_dir()];
        folders.extend(self.world.folders().map(Path::to_path_buf));
        folders.extend(folder.map(Path::to_path_buf));
        let mut seen = BTreeSet::new();
        folders.retain(|folder| seen.insert(folder.clone()));
        let packages = self.classes.packages();
        let files = Arc::new(Watched::new(self.world.reader(), self.classes.reads.clone()));
        let files: Arc<dyn FileReader> =
            Arc::new(Watched::new(files, self.classes.model_files.clone()));
        let compiler = self.world.c_compiler();
        Resources::new(Arc::new(ModelFiles {
            files,
            folders,
            packages,
            compiler,
            reads: [self.classes.reads.clone(), self.classes.model_files.clone()],
            process: self.world.process().clone(),
            permissions: self.world.permitted(),
            variables: self.world.env_reader(),
        }))
    }
}

impl ModelFiles {
    fn found(&self, name: &str) -> Result<PathBuf, Fault> {
        if let Some(uri) = name.strip_prefix("modelica://") {
            return self.in_package(name, uri);
        }
        let path = plain(name.trim());
        let candidates = || self.folders.iter().map(|folder| normalized(&folder.join(&path)));
        let exists = |path: &PathBuf| self.files.is_file(path) || self.has_entries(path);
        candidates().find(exists).or_else(|| candidates().next()).ok_or_else(|| missing(name))
    }

    /// `modelica://Package.Inner/path`: below the folder of the package (MLS §13.5).
    fn in_package(&self, name: &str, uri: &str) -> Result<PathBuf, Fault> {
        let (package, file) = uri.split_once('/').unwrap_or((uri, ""));
        let package = Name::parse(package);
        let top = package.first().and_then(|top| self.packages.get(&top));
        let Some(own) = top else {
            return Err(missing(name).help("load the package that the URI names"));
        };
        let root = match own.extension().is_some_and(|e| e == "mo") {
            true => own.parent().unwrap_or(own),
            false => own,
        };
        let mut folder = root.to_path_buf();
        for part in &package.parts[1..] {
            let inner = folder.join(part.as_str());
            if !self.has_entries(&inner) {
                break;
            }
            folder = inner;
        }
        // `modelica://Package//path`: the path does not start at the root of the disk.
        Ok(normalized(&folder.join(file.trim_start_matches('/'))))
    }

    fn has_entries(&self, path: &Path) -> bool {
        self.files.list_dir(path).is_ok_and(|entries| !entries.is_empty())
    }
}

fn missing(name: &str) -> Fault {
    Fault::new(FILE_ERROR, format!("there is no file `{name}`"))
}

impl Provide for ModelFiles {
    fn path(&self, name: &str) -> Result<String, Fault> {
        let mut path = self.found(name)?.display().to_string();
        // Libraries append names of files to a folder that they name with a slash at its end.
        if name.ends_with('/') && !path.ends_with('/') {
            path.push('/');
        }
        Ok(path)
    }

    fn read(&self, name: &str) -> Result<Vec<u8>, Fault> {
        let path = self.found(name)?;
        let read = self.files.read(&path);
        if read.as_ref().is_err_and(|error| error.kind() == std::io::ErrorKind::NotFound) {
            let folders = self.folders.iter().map(|f| format!("`{}`", f.display()));
            let folders = folders.collect::<Vec<_>>().join(", ");
            return Err(missing(name).help(format!("relative paths start from {folders}")));
        }
        read.map_err(|error| cannot("read", &path, &error))
    }

    fn c_function(&self, request: &Request) -> Result<&'static Entry, Fault> {
        let path = |name: &str| self.found(name).ok();
        c_functions::compiled(request, self.compiler.as_deref(), &*self.files, &path)
    }

    fn environment_variable(&self, name: &str) -> Result<Option<String>, Fault> {
        let of_system = |name: &str| self.variables.and_then(|variable| variable(name));
        let content = self.process.variable(of_system, self.permissions, name)?;
        self.reads.iter().for_each(|reads| reads.note_variable(name, content.as_deref()));
        Ok(content)
    }

    fn is_folder(&self, name: &str) -> Option<bool> {
        let path = self.found(name).ok()?;
        // The working directory and the folders above it exist, whether they may be read or not.
        let is_above = self.folders.first().is_some_and(|current| current.starts_with(&path));
        match self.files.is_file(&path) {
            true => Some(false),
            false => (is_above || self.files.list_dir(&path).is_ok()).then_some(true),
        }
    }
}
