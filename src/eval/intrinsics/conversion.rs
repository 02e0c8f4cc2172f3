//! Conversions (MLS §3.7.1). `String` takes named arguments and is an operator of `special`.

use super::Entry;
use crate::bail;
use crate::diag::Fault;
use crate::value::Value;
use crate::value::errors::TYPE_MISMATCH;

pub(super) const FUNCTIONS: &[Entry] = &[Entry::of_scalars("Integer", 1, ordinal)];

/// `Integer(e)`: which literal of its enumeration, from 1.
fn ordinal(arguments: &[Value]) -> Result<Value, Fault> {
    match &arguments[0] {
        Value::Enumeration(value) => Ok(Value::Integer(value.ordinal)),
        Value::Integer(value) => Ok(Value::Integer(*value)),
        other => bail!(
            TYPE_MISMATCH,
            "`Integer` is not defined for {}", other.type_name();
            help: "use `integer(x)` for the largest Integer not above `x`"
        ),
    }
}
