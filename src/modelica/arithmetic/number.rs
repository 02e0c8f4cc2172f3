//! Numbers that instructions compute with.

use super::elementary::Elementary;
use crate::elementary;
use crate::symbolic::function::Value;

/// A number with its derivatives, or without.
pub trait Number: Copy {
    /// How many floating-point numbers it consists of, which are contiguous.
    const PARTS: usize;

    /// Without a derivative.
    fn constant(value: f64) -> Self;
    /// The number alone.
    fn value(self) -> f64;
    /// Whether the number and all derivatives are zero.
    fn is_zero(self) -> bool;
    /// `-a`
    fn neg(self) -> Self;
    /// `a + b`
    fn add(self, b: Self) -> Self;
    /// `a - b`
    fn sub(self, b: Self) -> Self;
    /// `a * b`
    fn mul(self, b: Self) -> Self;
    /// `a / b`
    fn div(self, b: Self) -> Self;
    /// `a ^ b`
    fn pow(self, b: Self) -> Self;
    /// A function of one argument.
    fn unary(self, function: &Elementary) -> Self;
    /// A function of two arguments.
    fn binary(self, b: Self, function: &Elementary) -> Self;
    /// Whether all bits are the same.
    fn has_bits_of(self, other: Self) -> bool;
}

impl Number for f64 {
    const PARTS: usize = 1;

    fn constant(value: f64) -> f64 {
        value
    }

    fn value(self) -> f64 {
        self
    }

    fn is_zero(self) -> bool {
        self == 0.0
    }

    fn neg(self) -> f64 {
        -self
    }

    fn add(self, b: f64) -> f64 {
        self + b
    }

    fn sub(self, b: f64) -> f64 {
        self - b
    }

    fn mul(self, b: f64) -> f64 {
        self * b
    }

    fn div(self, b: f64) -> f64 {
        self / b
    }

    fn pow(self, b: f64) -> f64 {
        elementary::powf(self, b)
    }

    fn unary(self, function: &Elementary) -> f64 {
        match function.value {
            Value::Unary(value) => value(self),
            Value::Binary(_) => f64::NAN,
        }
    }

    fn binary(self, b: f64, function: &Elementary) -> f64 {
        match function.value {
            Value::Binary(value) => value(self, b),
            Value::Unary(_) => f64::NAN,
        }
    }

    fn has_bits_of(self, other: f64) -> bool {
        self.to_bits() == other.to_bits()
    }
}
