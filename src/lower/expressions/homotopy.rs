//! `homotopy(actual, simplified)` (MLS §3.7.4.3).

use super::{Array, Lowered, Lowering, Target, size_fault};
use crate::diag::Diagnostic;
use crate::fault;
use crate::lower::errors::ARRAY_MISMATCH;
use crate::source::Span;
use crate::syntax::ast::Arguments;

impl<T: Target> Lowering<'_, T> {
    /// Both arguments, joined element by element as the target wishes.
    pub(super) fn homotopy(
        &mut self,
        arguments: &Arguments,
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let mut argument = |position: usize, name: &str| {
            let named = arguments.named.iter().find(|a| a.name.node == name).map(|a| &a.value);
            let Some(given) = arguments.positional.get(position).or(named) else {
                return Err(
                    fault!(ARRAY_MISMATCH, "`homotopy` needs the argument `{name}`").at(span)
                );
            };
            self.array(given)
        };
        let (actual, simplified) = (argument(0, "actual")?, argument(1, "simplified")?);
        if actual.dims != simplified.dims {
            return Err(size_fault(&actual.dims, &simplified.dims).at(span));
        }
        let pairs = actual.elements.into_iter().zip(simplified.elements);
        let elements = pairs.map(|(a, s)| self.target.homotopy(a, s)).collect();
        Ok(Lowered::Array(Array { dims: actual.dims, elements }))
    }
}
