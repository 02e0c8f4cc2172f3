//! The functions of the table of [`symbolic`](crate::symbolic::function), at hand for operations.

use crate::symbolic::function::{self, FunctionId, Value};
use std::sync::LazyLock;

/// A function of one or two arguments.
pub struct Elementary {
    /// Which function it is.
    pub id: FunctionId,
    /// How its value is computed.
    pub value: Value,
}

impl PartialEq for Elementary {
    fn eq(&self, other: &Elementary) -> bool {
        self.id == other.id
    }
}

impl Eq for Elementary {}

impl std::hash::Hash for Elementary {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.id.hash(state);
    }
}

impl std::fmt::Debug for Elementary {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Elementary").field("name", &self.id.get().name).finish_non_exhaustive()
    }
}

/// A function in a file: its number in the table.
pub(super) mod by_number {
    use super::{Elementary, FunctionId};
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer>(
        function: &&'static Elementary,
        target: S,
    ) -> Result<S::Ok, S::Error> {
        function.id.serialize(target)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(
        source: D,
    ) -> Result<&'static Elementary, D::Error> {
        FunctionId::deserialize(source).map(Elementary::of)
    }
}

static TABLE: LazyLock<Vec<Elementary>> = LazyLock::new(|| {
    function::functions().map(|(id, function)| Elementary { id, value: function.value }).collect()
});

static LOGARITHM: LazyLock<&'static Elementary> = LazyLock::new(|| {
    Elementary::of(function::find("log").expect("the function table has a logarithm"))
});

impl Elementary {
    /// The function of this number.
    pub fn of(id: FunctionId) -> &'static Elementary {
        &TABLE[id.index()]
    }

    /// The natural logarithm.
    pub(super) fn logarithm() -> &'static Elementary {
        *LOGARITHM
    }
}
