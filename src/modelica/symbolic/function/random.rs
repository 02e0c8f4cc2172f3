//! Numbers that look random, as libraries of old draw them at events.

use super::{Function, Value, real, zero};

pub(super) const FUNCTIONS: &[Function] = &[Function {
    section: "none: a built-in function of Dymola before Modelica 2",
    ..real("RandomUniform", Value::Unary(uniform), zero)
}];

/// A number from 0 to 1, the same for the same argument, so that a simulation can be repeated: the
/// bits of the argument, mixed as by the generator SplitMix64.
fn uniform(x: f64) -> f64 {
    // Adding zero makes of -0 the 0 that it equals.
    let mut bits = (x + 0.0).to_bits().wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^= bits >> 31;
    (bits >> 11) as f64 / (1u64 << 53) as f64
}
