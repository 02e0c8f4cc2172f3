//! `homotopy(actual, simplified)` (MLS §3.7.4.3).

use super::{Array, Lowered, Lowering, Target, size_fault};
use crate::diag::Diagnostic;
use crate::source::Span;

impl<T: Target> Lowering<'_, T> {
    /// Both arguments, joined element by element as the target requires.
    pub(super) fn homotopy(
        &mut self,
        actual: Array<T::Scalar>,
        simplified: Array<T::Scalar>,
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        if actual.dims != simplified.dims {
            return Err(size_fault(&actual.dims, &simplified.dims).at(span));
        }
        let pairs = actual.elements.into_iter().zip(simplified.elements);
        let elements = pairs.map(|(a, s)| self.target.homotopy(a, s)).collect();
        Ok(Lowered::Array(Array { dims: actual.dims, elements }))
    }
}
