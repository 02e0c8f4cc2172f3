//! External objects (MLS §12.9.7): values that only external functions look into.

use crate::name::Name;
use std::any::Any;
use std::sync::Arc;

/// An object that an external constructor has made.
#[derive(Clone)]
pub struct ExternalObject {
    /// The class, derived from `ExternalObject`.
    pub class: Name,
    /// What external functions make of it.
    pub object: Arc<dyn Any + Send + Sync>,
}

impl std::fmt::Debug for ExternalObject {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ExternalObject").field("class", &self.class).finish_non_exhaustive()
    }
}

/// An object is equal to itself only.
impl PartialEq for ExternalObject {
    fn eq(&self, other: &ExternalObject) -> bool {
        Arc::ptr_eq(&self.object, &other.object)
    }
}
