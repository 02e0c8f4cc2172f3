//! The file of a model: read once, shared by all instances of it that a process has at a time.

use crate::codegen::Program;
use crate::fmi::export::{Content, FILE};
use std::ffi::CString;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// A model with what its value references stand for.
pub(crate) struct Loaded {
    pub(crate) content: Content,
    pub(crate) program: Arc<Program>,
    /// The strings of the content as strings of C, which importers read as long as it is in use.
    pub(crate) strings: Vec<CString>,
}

/// The models in use, by their files and tokens.
static IN_USE: Mutex<Vec<(PathBuf, Weak<Loaded>)>> = Mutex::new(Vec::new());

/// The model in a folder of resources, which has this token.
///
/// # Errors
/// Why it cannot be used, in words.
pub(crate) fn load(resources: &Path, token: &str) -> Result<Arc<Loaded>, String> {
    let path = resources.join(FILE);
    let mut in_use = IN_USE.lock().unwrap_or_else(PoisonError::into_inner);
    in_use.retain(|(_, model)| model.strong_count() > 0);
    let known = in_use.iter().filter(|(known, _)| *known == path);
    let mut known = known.filter_map(|(_, model)| model.upgrade());
    if let Some(model) = known.find(|model| model.content.token == token) {
        return Ok(model);
    }
    let shown = path.display();
    let bytes = fs::read(&path).map_err(|error| {
        format!("`{shown}` cannot be read: {error}; unpack the whole unit, with its `resources`")
    })?;
    let read = Content::read(&bytes);
    let Some((content, program)) = read else {
        return Err(format!("`{shown}` does not belong to this library: export the unit again"));
    };
    if content.token != token {
        return Err(format!(
            "the unit has the token {}, but {token} was requested: `modelDescription.xml` is that \
             of another unit",
            content.token
        ));
    }
    let text = |own: &String| CString::new(own.replace('\0', " ")).unwrap_or_default();
    let strings = content.strings.iter().map(text).collect();
    let model = Arc::new(Loaded { content, program, strings });
    in_use.push((path, Arc::downgrade(&model)));
    Ok(model)
}
