//! Records.

use super::Value;
use crate::name::{Ident, Name};
use indexmap::IndexMap;

/// A record: its type's name and its components in order of declaration.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordValue {
    /// The record class.
    pub type_name: Name,
    /// Its components.
    pub fields: IndexMap<Ident, Value>,
}
