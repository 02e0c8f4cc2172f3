//! In place of machine code where the feature `jit` is left out: there is none.

/// Nothing becomes machine code in any case.
pub(crate) fn interpret() {}

/// Machine code, which is never made.
pub(crate) enum Executable {}
