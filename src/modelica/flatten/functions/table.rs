//! The functions of the flat model, and the names under which they and the constructors of records
//! are known.

use crate::eval::Function;
use crate::flatten::ids::ScopeId;
use crate::name::Name;
use indexmap::IndexMap;
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// The functions that calls name.
#[derive(Debug, Default)]
pub(crate) struct FunctionTable {
    /// The functions; `None` while one is being made.
    pub table: IndexMap<Name, Option<Arc<Function>>>,
    /// The function that alone is asked for; `None` for a model.
    pub asked: Option<Name>,
    /// The names under which functions are known.
    pub names: FxHashMap<ScopeId, Name>,
    /// The classes of records by the names of their constructors.
    pub(crate) record_scopes: FxHashMap<Name, ScopeId>,
}
