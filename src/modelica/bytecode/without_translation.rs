//! In place of machine code where the feature `jit` is left out: functions are always interpreted.

use super::code::{Code, Functions};
use super::machine_code::Translated;

/// No function has machine code.
#[allow(clippy::extra_unused_type_parameters, reason = "who calls it names its numbers")]
pub(super) fn translated<T>(_: &Functions, _: &Code) -> Option<Translated> {
    None
}
