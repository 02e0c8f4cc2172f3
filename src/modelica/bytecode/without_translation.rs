//! In place of machine code where the feature `jit` is left out: functions are always interpreted.

use super::code::{Code, Functions};
use super::direct_calls::MakeCall;
use super::machine_code::Translated;

/// No function has machine code.
pub(super) fn translated<T>(_: &Functions, _: &Code, _: MakeCall<T>) -> Option<Translated> {
    None
}
