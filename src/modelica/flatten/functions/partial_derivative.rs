//! Functions that are partial derivatives of others (MLS §12.7.2).

use crate::diag::Diagnostic;
use crate::eval::{Function, FunctionBody, ValueType};
use crate::fault;
use crate::flatten::errors::{NOT_SUPPORTED, TYPE_MISMATCH, UNKNOWN_CLASS};
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::lookup::types::Type;
use crate::name::Name;
use crate::syntax::ast::DerivativeClass;

impl Instantiation<'_> {
    /// `function f_x = der(f, x)` (MLS §12.7.2)
    pub(super) fn partial_derivative(
        &mut self,
        name: &Name,
        class: ScopeId,
        derivative: &DerivativeClass,
    ) -> Result<Function, Diagnostic> {
        let span = derivative.target.span;
        let scope = self.classes.scope(class).parent.unwrap_or(ScopeId::TOP);
        let of = match self.classes.lookup(scope, &derivative.target.name)? {
            Some(Type::Class(id)) => self.function(id)?,
            _ => None,
        };
        let known = of.as_ref().and_then(|of| self.functions.table.get(of).cloned().flatten());
        let (Some(of), Some(target)) = (of, known) else {
            return Err(
                fault!(UNKNOWN_CLASS, "there is no function `{}`", derivative.target.name).at(span)
            );
        };
        for by in &derivative.variables {
            let input = target.inputs.iter().find(|input| input.name == by.node);
            if !input.is_some_and(|i| i.value_type == ValueType::Real && i.dims.is_empty()) {
                return Err(fault!(
                    TYPE_MISMATCH,
                    "`{}` is not a scalar Real input of `{of}`, so there is no derivative by it",
                    by.node
                )
                .at(by.span));
            }
        }
        if let Some(other) = target.outputs.iter().find(|o| o.value_type != ValueType::Real) {
            return Err(fault!(
                NOT_SUPPORTED,
                "the derivative of `{of}`, whose output `{}` is not Real",
                other.name
            )
            .at(span));
        }
        let by = derivative.variables.iter().map(|by| by.node).collect();
        Ok(Function {
            name: name.clone(),
            body: FunctionBody::PartialDerivative { of, by },
            annotation: Vec::new(),
            span: self.classes.text(class).span(),
            ..(*target).clone()
        })
    }
}
