//! The values of bindings. Of components of records which functions compute, the function is called
//! once for all of them.

use super::builder::Builder;
use super::expressions::{Array, Lowered, Lowering, field_of, size_fault};
use crate::diag::Diagnostic;
use crate::symbolic::Expr;
use crate::syntax::ast::{Expression, ExpressionKind};

impl Builder<'_> {
    /// The value of a binding, which is in the flat model.
    fn binding_value(&mut self, binding: &Expression) -> Result<Lowered<Expr>, Diagnostic> {
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

    /// A value that must have these sizes; a scalar is repeated.
    pub(super) fn sized(
        &mut self,
        e: &Expression,
        dims: &[usize],
    ) -> Result<Array<Expr>, Diagnostic> {
        let array = self.binding_value(e)?.into_array(e.span)?;
        if array.dims == dims {
            return Ok(array);
        }
        if array.dims.is_empty() {
            let count = dims.iter().product();
            return Ok(Array { dims: dims.to_vec(), elements: vec![array.elements[0]; count] });
        }
        Err(size_fault(dims, &array.dims).at(e.span))
    }
}
