//! Operators (MLS §3.4–3.6, §10.6). Integer operands give Integer results where the operator
//! allows it, `/` and `^` always give Reals, and nothing wraps around or becomes infinite
//! where the operands are finite: that is a [`Fault`].

mod arithmetic;
mod elementwise;
mod matrix;
mod relation;
mod scalar;

pub use arithmetic::{add, divide, multiply, plus, power, subtract};

pub(crate) use arithmetic::negate;
pub(crate) use elementwise::{
    elementwise_add, elementwise_divide, elementwise_multiply, elementwise_power,
    elementwise_subtract,
};
pub(crate) use matrix::product_sizes;
pub use relation::{and, equal, less, not, or, order};
pub(crate) use relation::{greater, greater_equal, less_equal, not_equal};

use super::Value;
use super::errors::TYPE_MISMATCH;
use crate::diag::Fault;
use crate::fault;

fn unsuitable(symbol: &str, left: &Value, right: &Value) -> Fault {
    let fault = fault!(
        TYPE_MISMATCH,
        "`{symbol}` is not defined for {} and {}",
        left.type_name(),
        right.type_name()
    );
    match (left.is_text(), right.is_text(), symbol) {
        (true, false, "+") | (false, true, "+") => {
            fault.help("use `String(x)` to convert a number to a string".to_owned())
        }
        _ => fault,
    }
}
