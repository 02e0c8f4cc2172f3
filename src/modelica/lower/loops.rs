//! Variables of loops and iterators while what they repeat is lowered.

use crate::eval::ValueType;
use crate::name::Ident;

/// A variable of a loop with its value in the iteration at hand.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LoopVariable<S> {
    /// Its name.
    pub(crate) name: Ident,
    /// Its value.
    pub(crate) value: S,
    /// Its type, that of the elements of the range.
    pub(crate) value_type: ValueType,
}

/// The variables of the loops around what is lowered, innermost last.
pub(crate) type Loops<S> = Vec<LoopVariable<S>>;
