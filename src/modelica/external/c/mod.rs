//! External functions in C that a library brings along (MLS §12.9), compiled by the host where that
//! is allowed.
//!
//! ```text
//! Declaration ─wrapper▶ Unit (C) ─CCompiler▶ CLibrary ─CFunction▶ an Entry like those in Rust
//! ```
//!
//! All functions of a request are compiled as one unit, so that they share the static variables of
//! the sources that they include. Every function gets a wrapper with the same signature: a row of
//! pointers, one for each argument. An error of `ModelicaError` ends the wrapper (`longjmp`), never
//! code in Rust. Not handled, and refused by name: records, functions with arrays as results.

mod declaration;
mod frame;
mod function;
mod wrapper;

pub use declaration::{Argument, Declaration, Scalar};
pub use frame::{Cell, Frame};
pub use function::{CFunction, entry};
pub use wrapper::{HEADER, UTILITIES, source};

use crate::diag::Fault;
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

/// What is compiled together.
#[derive(Debug, Clone, Default)]
pub struct Unit {
    /// The text of the C file.
    pub source: String,
    /// Where included files are looked for.
    pub include_directories: Vec<PathBuf>,
    /// What is linked: `foo` for `libfoo`, or the path of a file.
    pub libraries: Vec<String>,
    /// Where libraries are looked for.
    pub library_directories: Vec<PathBuf>,
    /// The sources of the standard library's own functions in C, if it is at hand.
    pub standard_sources: Option<PathBuf>,
}

/// Compiles and loads C.
pub trait CCompiler: fmt::Debug + Send + Sync {
    /// Whether functions of the library with this class may be compiled.
    fn permits(&self, class: &str) -> bool;
    /// The shared object of a unit, compiled unless it is known.
    ///
    /// # Errors
    /// There is no compiler, or it refuses the source.
    fn load(&self, unit: &Unit) -> Result<Arc<dyn CLibrary>, Fault>;
}

/// A unit that is loaded.
pub trait CLibrary: Send + Sync {
    /// What tells it from others: a digest of all that it was made of.
    fn key(&self) -> &str;

    /// Calls a wrapper by its number.
    ///
    /// # Errors
    /// The text of `ModelicaError`.
    fn invoke(&self, function: usize, frame: &mut Frame) -> Result<(), String>;
}

/// Functions that are requested of one library.
#[derive(Debug, Clone)]
pub struct Request {
    /// All that are compiled together, sorted by name.
    pub declarations: Vec<Declaration>,
    /// The one that is called.
    pub requested: usize,
}

impl Request {
    /// Of all functions at hand those that share variables with the requested one, directly or
    /// through others. What does not belong to it cannot keep it from being compiled.
    pub fn new(requested: Declaration, mut others: Vec<Declaration>) -> Request {
        let mut sources = requested.sources();
        others.retain(|other| other.class != requested.class);
        let class = requested.class.clone();
        let mut declarations = vec![requested];
        loop {
            let shares = |other: &Declaration| !other.sources().is_disjoint(&sources);
            let (near, far): (Vec<_>, Vec<_>) = others.into_iter().partition(shares);
            if near.is_empty() {
                break;
            }
            near.iter().for_each(|other| sources.extend(other.sources()));
            declarations.extend(near);
            others = far;
        }
        declarations.sort_by(|a, b| a.class.cmp(&b.class));
        declarations.dedup_by(|a, b| a.class == b.class);
        let requested = declarations.iter().position(|one| one.class == class).unwrap_or(0);
        Request { declarations, requested }
    }

    /// The function that is called.
    pub fn requested(&self) -> &Declaration {
        &self.declarations[self.requested]
    }
}
