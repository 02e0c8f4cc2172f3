//! Bindings that are components of records which functions compute: the function is called once for
//! all of them.

use super::builder::Builder;
use super::expressions::{Lowered, Lowering, field_of};
use crate::diag::Diagnostic;
use crate::symbolic::Expr;
use crate::syntax::ast::{Expression, ExpressionKind};

impl Builder<'_> {
    /// The value of a binding, which is in the flat model.
    pub(super) fn binding_value(
        &mut self,
        binding: &Expression,
    ) -> Result<Lowered<Expr>, Diagnostic> {
        let (base, name) = match &binding.kind {
            ExpressionKind::Field { base, name } => (&**base, *name),
            _ => return Lowering::new(self).lower(binding),
        };
        let at = (std::ptr::from_ref(base), self.place);
        if !self.records.contains_key(&at) {
            let value = self.binding_value(base)?;
            self.records.insert(at, value);
        }
        field_of(&self.records[&at], name, binding.span).cloned()
    }
}
