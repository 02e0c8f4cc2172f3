//! Numbers with a derivative (forward accumulation).

use super::elementary::Elementary;
use super::number::Number;
use super::partial::partial;

/// A number `v` with its derivative `d` in one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Dual<T> {
    /// The number.
    pub v: T,
    /// Its derivative.
    pub d: T,
}

impl<T: Number> Dual<T>
where
    Dual<T>: Number,
{
    /// With the derivative of the chain rule with one factor; a derivative of zero hides an
    /// infinite factor.
    fn chained(v: T, factor: impl FnOnce() -> T, inner: T) -> Dual<T> {
        let d = if inner.is_zero() { T::constant(0.0) } else { factor().mul(inner) };
        Dual { v, d }
    }
}

/// The arithmetic of dual numbers over such numbers.
macro_rules! dual {
    ($inner:ty) => {
        impl Number for Dual<$inner> {
            const PARTS: usize = 2 * <$inner as Number>::PARTS;

            fn constant(value: f64) -> Self {
                Dual { v: Number::constant(value), d: Number::constant(0.0) }
            }

            fn value(self) -> f64 {
                self.v.value()
            }

            fn is_zero(self) -> bool {
                self.v.is_zero() && self.d.is_zero()
            }

            fn neg(self) -> Self {
                Dual { v: self.v.neg(), d: self.d.neg() }
            }

            fn add(self, b: Self) -> Self {
                Dual { v: self.v.add(b.v), d: self.d.add(b.d) }
            }

            fn sub(self, b: Self) -> Self {
                Dual { v: self.v.sub(b.v), d: self.d.sub(b.d) }
            }

            fn mul(self, b: Self) -> Self {
                Dual { v: self.v.mul(b.v), d: self.d.mul(b.v).add(self.v.mul(b.d)) }
            }

            /// (a/b)′ = (a′ − (a/b) b′) / b
            fn div(self, b: Self) -> Self {
                let v = self.v.div(b.v);
                Dual { v, d: self.d.sub(v.mul(b.d)).div(b.v) }
            }

            /// (a^b)′ = b a^(b−1) a′ + a^b log(a) b′, the second term 0 where a is 0.
            fn pow(self, b: Self) -> Self {
                let v = self.v.pow(b.v);
                let one = Number::constant(1.0);
                let base = match b.v.is_zero() {
                    true => Number::constant(0.0),
                    false => Self::chained(v, || b.v.mul(self.v.pow(b.v.sub(one))), self.d).d,
                };
                let exponent = match self.v.value() == 0.0 {
                    true => Number::constant(0.0),
                    false => {
                        let logarithm = || v.mul(self.v.unary(Elementary::logarithm()));
                        Self::chained(v, logarithm, b.d).d
                    }
                };
                Dual { v, d: base.add(exponent) }
            }

            fn unary(self, function: &Elementary) -> Self {
                let v = self.v.unary(function);
                Self::chained(v, || partial(function, 0, &[self.v]), self.d)
            }

            fn binary(self, b: Self, function: &Elementary) -> Self {
                let v = self.v.binary(b.v, function);
                let first = Self::chained(v, || partial(function, 0, &[self.v, b.v]), self.d);
                let second = Self::chained(v, || partial(function, 1, &[self.v, b.v]), b.d);
                Dual { v, d: first.d.add(second.d) }
            }

            fn has_bits_of(self, other: Self) -> bool {
                self.v.has_bits_of(other.v) && self.d.has_bits_of(other.d)
            }
        }
    };
}

dual!(f64);
dual!(Dual<f64>);
