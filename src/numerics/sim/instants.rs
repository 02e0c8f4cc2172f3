//! Times that are one but for rounding.

/// Relative distance of times that are one.
pub const AT_ONCE: f64 = 1e-12;

/// Whether two times are the same but for rounding.
#[inline]
pub fn same_time(a: f64, b: f64) -> bool {
    (a - b).abs() <= AT_ONCE * a.abs().max(b.abs())
}
