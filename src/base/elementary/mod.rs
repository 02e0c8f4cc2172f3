//! Elementary functions with the same bits on every machine.
//!
//! `f64::exp` and its like call the C library of the system, which chooses its code by processor
//! (with or without fused multiply-add) and by version; musl and a browser round otherwise again.
//! Everything that reaches a result takes them from here: interpreter, symbolic evaluation, tapes,
//! machine code, optimizers, statistics. They are those of `pxfm`, in Rust alone, and correctly
//! rounded: the result is the number nearest to the exact value, which leaves an implementation
//! no choice of bits. Square root, absolute value, rounding and fused multiply-add are exact by
//! IEEE 754 and come from the standard library.
//!
//! `clippy.toml` forbids the functions of the standard library in the rest of the program.

mod double;
mod powers;
#[cfg(test)]
mod tests;

pub use powers::{hypot, powf, powi};

/// A function of one number that `pxfm` rounds correctly.
macro_rules! rounded {
    ($($words:literal $name:ident = $origin:ident;)*) => {
        $(
            #[doc = $words]
            #[must_use]
            #[inline]
            pub fn $name(x: f64) -> f64 {
                pxfm::$origin(x)
            }
        )*
    };
}

rounded! {
    "eˣ" exp = f_exp;
    "eˣ − 1, exact for small `x`" exp_m1 = f_expm1;
    "Natural logarithm; NaN for negative numbers" ln = f_log;
    "ln(1 + x), exact for small `x`" ln_1p = f_log1p;
    "Logarithm to the base 10" log10 = f_log10;
    "Logarithm to the base 2" log2 = f_log2;
    "Sine of an angle in rad" sin = f_sin;
    "Cosine of an angle in rad" cos = f_cos;
    "Tangent of an angle in rad" tan = f_tan;
    "Arcsine in rad; NaN outside -1 … 1" asin = f_asin;
    "Arccosine in rad; NaN outside -1 … 1" acos = f_acos;
    "Arctangent in rad" atan = f_atan;
    "Hyperbolic cosine" cosh = f_cosh;
    "Hyperbolic tangent" tanh = f_tanh;
    "Inverse hyperbolic sine" asinh = f_asinh;
    "Inverse hyperbolic cosine; NaN below 1" acosh = f_acosh;
    "Inverse hyperbolic tangent; NaN outside -1 … 1" atanh = f_atanh;
    "Cube root" cbrt = f_cbrt;
}

/// Hyperbolic sine
#[must_use]
#[inline]
pub fn sinh(x: f64) -> f64 {
    // That of `pxfm` loses the sign of zero.
    if x == 0.0 { x } else { pxfm::f_sinh(x) }
}

/// Angle of the point (`x`, `y`) in rad, from -π to π.
#[must_use]
#[inline]
pub fn atan2(y: f64, x: f64) -> f64 {
    pxfm::f_atan2(y, x)
}

/// [`sin`] and [`cos`] of an angle in rad, in two thirds of the time.
#[must_use]
#[inline]
pub fn sin_cos(x: f64) -> (f64, f64) {
    pxfm::f_sincos(x)
}
