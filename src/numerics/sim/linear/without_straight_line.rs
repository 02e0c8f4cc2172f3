//! In place of machine code for factors where the feature `jit` is left out: loops always.

use super::SingularMatrix;
use super::factor_pattern::Shape;

/// Nothing is ever translated.
pub fn interpret() {}

/// The code that factors never get.
#[derive(Debug, Clone, Default)]
pub(super) struct StraightLine {}

impl StraightLine {
    /// Loops over the pattern compute them.
    pub fn factorize(
        &mut self,
        _: &Shape<'_>,
        _: &[f64],
        _: &mut [f64],
        _: f64,
    ) -> Option<Result<(), SingularMatrix>> {
        None
    }

    /// Loops over the pattern have them.
    pub fn numbers(&self) -> Option<&[f64]> {
        None
    }

    /// Loops over the pattern solve.
    pub fn solve(
        &self,
        _: &mut [f64],
        _: &mut [f64],
        _: impl FnOnce(&mut [f64], &mut [f64]),
    ) -> bool {
        false
    }
}
