//! Files that models use, granted while they are compiled.

use super::Entry;
use super::c::Request;
use super::call::Outside;
use super::errors::EXTERNAL_OUTSIDE;
use crate::diag::Fault;
use crate::fault;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// Finds and reads the files that models name: paths, or `modelica://` URIs (MLS §13.5).
pub trait Provide: fmt::Debug + Send + Sync {
    /// The path of a file; it need not exist.
    fn path(&self, name: &str) -> Result<String, Fault>;
    /// The content of a file.
    fn read(&self, name: &str) -> Result<Vec<u8>, Fault>;
    /// A function in C that a library brings along, compiled and loaded.
    fn c_function(&self, request: &Request) -> Result<&'static Entry, Fault> {
        ().c_function(request)
    }
    /// Whether there is a file (`Some(false)`) or a folder (`Some(true)`) of this name.
    fn is_folder(&self, name: &str) -> Option<bool>;
    /// The content of an environment variable; `None` if it is not set.
    fn environment_variable(&self, name: &str) -> Result<Option<String>, Fault> {
        ().environment_variable(name)
    }
}

/// The files that a model may use; none by default.
#[derive(Debug, Clone, Default)]
pub struct Resources(Option<Arc<dyn Provide>>);

/// Equal if the same files are meant by the same names.
impl PartialEq for Resources {
    fn eq(&self, other: &Resources) -> bool {
        match (&self.0, &other.0) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        }
    }
}

impl Resources {
    /// What this one provides.
    pub fn new(provider: Arc<dyn Provide>) -> Resources {
        Resources(Some(provider))
    }

    /// The path of a file that a model names.
    pub fn path(&self, name: &str) -> Result<String, Fault> {
        self.provider(name)?.path(name)
    }

    /// Whether there are files at all.
    fn is_granted(&self) -> bool {
        self.0.is_some()
    }

    fn provider(&self, name: &str) -> Result<&dyn Provide, Fault> {
        self.0.as_deref().ok_or_else(|| {
            fault!(
                EXTERNAL_OUTSIDE,
                "the model needs the file `{name}`, but there is no file access"
            )
        })
    }
}

impl Outside for Resources {
    fn read(&mut self, path: &str) -> Result<Vec<u8>, Fault> {
        self.provider(path)?.read(path)
    }

    /// Dropped: what is called at translation says it again when the simulation starts.
    fn log(&mut self, _: &str) -> Result<(), Fault> {
        Ok(())
    }

    fn is_folder(&mut self, path: &str) -> Result<Option<bool>, Fault> {
        Ok(self.provider(path)?.is_folder(path))
    }

    fn full_path(&mut self, path: &str) -> Result<String, Fault> {
        self.provider(path)?.path(path)
    }

    fn environment_variable(&mut self, name: &str) -> Result<Option<String>, Fault> {
        match &self.0 {
            Some(provider) => provider.environment_variable(name),
            None => ().environment_variable(name),
        }
    }

    fn c_function(&mut self, request: &Request) -> Result<&'static Entry, Fault> {
        match &self.0 {
            Some(provider) => provider.c_function(request),
            None => ().c_function(request),
        }
    }
}

/// Contents of files by the names that external functions are called with; shared by clones.
#[derive(Clone, Default, serde::Serialize, serde::Deserialize)]
pub struct Contents {
    kept: Arc<BTreeMap<Arc<str>, Arc<[u8]>>>,
    /// Answers for files whose names only the simulation knows.
    #[serde(skip)]
    others: Resources,
}

impl fmt::Debug for Contents {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(self.kept.keys()).finish()
    }
}

impl Contents {
    /// Keeps the content of a file, unless it is there already.
    pub fn keep(&mut self, name: &Arc<str>, resources: &Resources) -> Result<(), Fault> {
        if !self.kept.contains_key(name) {
            let bytes = resources.clone().read(name)?;
            Arc::make_mut(&mut self.kept).insert(name.clone(), bytes.into());
        }
        Ok(())
    }

    /// Lets files be read whose names only the simulation knows.
    pub(crate) fn grant_others(&mut self, resources: &Resources) {
        self.others = resources.clone();
    }

    /// The content of a file that was kept, or of another.
    pub fn read(&self, path: &str) -> Result<Vec<u8>, Fault> {
        match self.kept.get(path) {
            Some(bytes) => Ok(bytes.to_vec()),
            None if self.others.is_granted() => self.others.clone().read(path),
            None => ().read(path),
        }
    }

    /// Whether a path is a file (`Some(false)`) or a folder (`Some(true)`), if it exists.
    pub fn is_folder(&self, path: &str) -> Result<Option<bool>, Fault> {
        match self.kept.contains_key(path) {
            true => Ok(Some(false)),
            false if self.others.is_granted() => self.others.clone().is_folder(path),
            false => ().is_folder(path),
        }
    }

    /// The absolute path of a file or a folder.
    pub(crate) fn full_path(&self, path: &str) -> Result<String, Fault> {
        match self.others.is_granted() {
            true => self.others.path(path),
            false => ().full_path(path),
        }
    }
}
