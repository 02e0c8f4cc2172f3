//! Types and constants of loaded packages that scripts have named, until the classes change.

use crate::eval::FunctionComponent;
use crate::name::Name;
use crate::value::Value;
use std::collections::HashMap;

/// Types and constants by their names; `None` where there is none of that name.
#[derive(Default)]
pub(crate) struct ConstantCache {
    /// Types.
    pub types: HashMap<Name, Option<FunctionComponent>>,
    /// Constants.
    pub constants: HashMap<Name, Option<Value>>,
}

impl ConstantCache {
    /// Forgets everything.
    pub(crate) fn clear(&mut self) {
        self.types.clear();
        self.constants.clear();
    }
}
