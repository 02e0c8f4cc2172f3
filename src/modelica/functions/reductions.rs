//! Reductions of arrays: `min`, `max`, `sum`, `product` (MLS §10.3.4). With iterators they are
//! evaluated element by element elsewhere.

use super::rules::{ShapeRule, TypeRule};
use super::{Builtin, Meaning};
use crate::diag::Fault;
use crate::fault;
use crate::symbolic::function::UnitRule;
use crate::value::errors::{DOMAIN_ERROR, INTEGER_OVERFLOW, REAL_OVERFLOW, TYPE_MISMATCH};
use crate::value::{ArrayValue, Elements, Value, ops};
use std::cmp::Ordering;

/// How the elements of an array become one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reduction {
    /// The greatest.
    Max,
    /// The least.
    Min,
    /// The product, 1 of none.
    Product,
    /// The sum, 0 of none.
    Sum,
}

pub(super) const FUNCTIONS: &[Builtin] = &[
    Builtin { most: 2, value_type: TypeRule::Joined, ..reducing("max", Reduction::Max) },
    Builtin { most: 2, value_type: TypeRule::Joined, ..reducing("min", Reduction::Min) },
    Builtin { unit: UnitRule::Unknown, ..reducing("product", Reduction::Product) },
    reducing("sum", Reduction::Sum),
];

const fn reducing(name: &'static str, reduction: Reduction) -> Builtin {
    let entry = Builtin::new(name, Meaning::Reduction(reduction), "MLS §10.3.4");
    Builtin { shape: ShapeRule::Reduced, unit: UnitRule::Common, ..entry }
}

impl Reduction {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Reduction::Max => "max",
            Reduction::Min => "min",
            Reduction::Product => "product",
            Reduction::Sum => "sum",
        }
    }

    /// What it makes of no elements; `None` where that depends on their type.
    pub fn of_none(self) -> Option<i64> {
        match self {
            Reduction::Product => Some(1),
            Reduction::Sum => Some(0),
            Reduction::Max | Reduction::Min => None,
        }
    }

    /// The value of a call.
    pub(super) fn value(self, arguments: &[Value]) -> Result<Value, Fault> {
        match self {
            Reduction::Max => extreme("max", arguments, Ordering::Greater),
            Reduction::Min => extreme("min", arguments, Ordering::Less),
            Reduction::Product => product(arguments),
            Reduction::Sum => sum(arguments),
        }
    }

    /// The first value of several, as with iterators.
    ///
    /// # Errors
    ///
    /// A product of arrays, which is not a reduction.
    pub fn first(self, value: Value) -> Result<Value, Fault> {
        if self == Reduction::Product && value.rank() > 0 {
            return Err(fault!(
                TYPE_MISMATCH,
                "`product` needs scalars, not values of type {}",
                value.type_name()
            ));
        }
        Ok(value)
    }

    /// Two values combined, as with iterators.
    ///
    /// # Errors
    ///
    /// The values are not numbers, or have different sizes, or the result is out of range.
    pub fn combine(self, a: &Value, b: &Value) -> Result<Value, Fault> {
        match self {
            Reduction::Sum => ops::add(a, b),
            Reduction::Product => ops::multiply(a, &self.first(b.clone())?),
            Reduction::Min => Ok(if ops::less(b, a)? { b.clone() } else { a.clone() }),
            Reduction::Max => Ok(if ops::greater(b, a)? { b.clone() } else { a.clone() }),
        }
    }
}

/// Of two scalars, or of the elements of one array. A NaN among them is the result.
fn extreme(name: &str, arguments: &[Value], better: Ordering) -> Result<Value, Fault> {
    match arguments {
        [Value::Array(array)] => {
            let mut elements = (0..array.elements.len()).map(|at| array.elements.get(at));
            let Some(first) = elements.next() else {
                return Err(fault!(DOMAIN_ERROR, "`{name}` of an empty array has no value"));
            };
            elements.try_fold(first, |best, next| chosen(name, best, next, better))
        }
        [a, b] => {
            let both = chosen(name, a.clone(), b.clone(), better)?;
            let is_real = matches!(a, Value::Real(_)) || matches!(b, Value::Real(_));
            Ok(if is_real { both.promoted() } else { both })
        }
        _ => Err(fault!(TYPE_MISMATCH, "`{name}` takes two scalars or one array")),
    }
}

fn chosen(name: &str, best: Value, next: Value, better: Ordering) -> Result<Value, Fault> {
    match ops::order(name, &next, &best)? {
        Some(order) if order == better => Ok(next),
        Some(_) => Ok(best),
        None if matches!(best, Value::Real(x) if x.is_nan()) => Ok(best),
        None => Ok(next),
    }
}

fn sum(arguments: &[Value]) -> Result<Value, Fault> {
    match &arguments[0] {
        Value::Array(ArrayValue { elements: Elements::Real(values), .. }) => {
            representable("sum", values, values.iter().sum())
        }
        Value::Array(ArrayValue { elements: Elements::Integer(values), .. }) => {
            let total = values.iter().try_fold(0i64, |sum, value| sum.checked_add(*value));
            total.map(Value::Integer).ok_or_else(|| overflow("sum"))
        }
        other => Err(unsuitable("sum", other)),
    }
}

fn product(arguments: &[Value]) -> Result<Value, Fault> {
    match &arguments[0] {
        Value::Array(ArrayValue { elements: Elements::Real(values), .. }) => {
            representable("product", values, values.iter().product())
        }
        Value::Array(ArrayValue { elements: Elements::Integer(values), .. }) => {
            let total = values.iter().try_fold(1i64, |product, value| product.checked_mul(*value));
            total.map(Value::Integer).ok_or_else(|| overflow("product"))
        }
        other => Err(unsuitable("product", other)),
    }
}

/// The total, a fault if it is not finite although all elements are.
fn representable(name: &str, values: &[f64], total: f64) -> Result<Value, Fault> {
    if !total.is_finite() && values.iter().all(|value| value.is_finite()) {
        return Err(fault!(REAL_OVERFLOW, "the {name} exceeds the largest Real, 1.8e308"));
    }
    Ok(Value::Real(total))
}

fn overflow(name: &str) -> Fault {
    fault!(INTEGER_OVERFLOW, "the {name} does not fit in an Integer")
}

fn unsuitable(name: &str, value: &Value) -> Fault {
    fault!(TYPE_MISMATCH, "`{name}` needs an array of numbers, got {}", value.type_name())
}
