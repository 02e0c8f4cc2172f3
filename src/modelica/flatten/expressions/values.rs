//! The values of constants and parameters found so far, with the parameters that each needed.

use crate::external::AtTranslation;
use crate::name::Ident;
use crate::value::Value;
use indexmap::IndexSet;
use rustc_hash::FxHashMap;

/// Variables read while a value is found.
pub(crate) type Read = IndexSet<usize>;

/// The values of constants and parameters that are known at translation.
#[derive(Debug, Default)]
pub(crate) struct Values {
    /// Structural parameters: variables whose values determine the equations.
    pub structural: IndexSet<usize>,
    /// Variables whose values were drawn at random.
    pub drawn: IndexSet<usize>,
    /// Values found so far with the variables that they need; `None` while one is being found.
    pub known: FxHashMap<usize, Option<(Value, Read)>>,
    /// Variables read by the evaluation that is going on.
    pub read: Read,
    /// Statements run so far to find values.
    pub steps: u64,
    /// External objects by the names that stand for them in expressions of values.
    pub objects: FxHashMap<Ident, Value>,
    /// Files that values are read from, and what was printed.
    pub outside: AtTranslation,
}
