//! Values of parameters that shape the sorted system: those in `fixed` and `stateSelect`, and those that
//! decide sizes in the functions which give other parameters their values.

use super::builder::Builder;
use super::dae::VariableKind;
use super::errors::NO_CONSTANT_VALUE;
use super::expressions::{Array, Lowering};
use crate::diag::Diagnostic;
use crate::flatten::{BaseType, Variability};
use crate::symbolic::{Expr, VarId, evaluate};
use crate::syntax::ast::{ComponentReference, Expression};
use crate::syntax::visit::{Visit, walk_reference};

/// Deepest chain of parameters.
const MAX_DEPTH: usize = 100;

/// What becomes of parameters whose values have been read.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Afterwards {
    Settable,
    Fixed,
}

impl Builder<'_> {
    /// The value of a parameter. Where a function in it has variables whose sizes follow from what the
    /// function computes, the parameters that it is called with are evaluated when compiling; they
    /// cannot be set any more.
    pub(super) fn parameter_value(
        &mut self,
        binding: &Expression,
        dims: &[usize],
    ) -> Result<Array<Expr>, Diagnostic> {
        let before = std::mem::replace(&mut self.place.at_start, true);
        let value = self.value_at_start(binding, dims);
        self.place.at_start = before;
        value
    }

    fn value_at_start(
        &mut self,
        binding: &Expression,
        dims: &[usize],
    ) -> Result<Array<Expr>, Diagnostic> {
        let error = match self.sized(binding, dims) {
            Err(error) if error.code == NO_CONSTANT_VALUE => error,
            result => return result,
        };
        let mut named = Named(Vec::new());
        named.expression(binding);
        for reference in named.0 {
            self.evaluate_named(&reference)?;
        }
        self.sized(binding, dims)
            .map_err(|why| error.or_else("with the values of parameters", &why))
    }

    /// Evaluates the parameter that a reference names, if its value is known.
    fn evaluate_named(&mut self, reference: &ComponentReference) -> Result<(), Diagnostic> {
        let path = Lowering::new(self).path(reference)?;
        let Some((position, _, variable)) = self.flat.variables.get_full(&*path) else {
            return Ok(());
        };
        if variable.variability != Variability::Parameter || variable.base == BaseType::String {
            return Ok(());
        }
        let first = self.scalars.first[position].0;
        for scalar in first..first + variable.len() as u32 {
            if let Some(value) =
                self.evaluated_parameter(VarId(scalar), MAX_DEPTH, Afterwards::Fixed)?
            {
                self.dae.variables[scalar as usize].kind = VariableKind::Constant(value);
            }
        }
        Ok(())
    }

    /// The value that parameters give an expression when compiling; they cannot be set any more.
    /// `None` if it depends on variables, or on parameters without values.
    pub(super) fn evaluate_structural(&mut self, e: Expr) -> Result<Option<f64>, Diagnostic> {
        self.evaluate_below(e, MAX_DEPTH, Afterwards::Fixed)
    }

    /// The same value, while the parameters can still be set.
    pub(super) fn value_in_model(&mut self, e: Expr) -> Result<Option<f64>, Diagnostic> {
        self.evaluate_below(e, MAX_DEPTH, Afterwards::Settable)
    }

    fn evaluate_below(
        &mut self,
        e: Expr,
        depth: usize,
        afterwards: Afterwards,
    ) -> Result<Option<f64>, Diagnostic> {
        if let Some(known) = self.dae.pool.as_constant(e) {
            return Ok(Some(known));
        }
        let variables = self.dae.pool.variables(e);
        let mut values = vec![f64::NAN; variables.last().map_or(0, |v| v.0 as usize + 1)];
        for variable in variables {
            let Some(value) = self.evaluated_parameter(variable, depth, afterwards)? else {
                return Ok(None);
            };
            values[variable.0 as usize] = value;
        }
        let value = evaluate(&self.dae.pool, e, &values[..]);
        Ok(value.is_finite().then_some(value))
    }

    fn evaluated_parameter(
        &mut self,
        variable: VarId,
        depth: usize,
        afterwards: Afterwards,
    ) -> Result<Option<f64>, Diagnostic> {
        let position = variable.0 as usize;
        match self.dae.variables[position].kind {
            VariableKind::Constant(value) => return Ok(Some(value)),
            VariableKind::Parameter { .. } if depth > 0 => {}
            // An Integer or a Boolean that is bound to what is known never changes.
            VariableKind::Discrete
                if depth > 0 && self.dae.variables[position].base != BaseType::Real =>
            {
                return self.evaluated_variable(variable, depth, afterwards);
            }
            _ => return Ok(None),
        }
        let Some(at) = self.flat_position(variable) else { return Ok(None) };
        let declared = &self.flat.variables[at];
        let given = declared.binding.as_ref();
        let Some(given) = given.or(declared.attributes.get("start").map(|a| &a.value)) else {
            return Ok(None);
        };
        let element = self.sized(given, &declared.dims)?.elements
            [(variable.0 - self.scalars.first[at].0) as usize];
        let value = self.evaluate_below(element, depth - 1, afterwards)?;
        if value.is_some() && afterwards == Afterwards::Fixed {
            self.dae.variables[position].kind = VariableKind::Parameter { tunable: false };
        }
        Ok(value)
    }

    /// The value of a discrete variable by its binding equation.
    fn evaluated_variable(
        &mut self,
        variable: VarId,
        depth: usize,
        afterwards: Afterwards,
    ) -> Result<Option<f64>, Diagnostic> {
        let Some(at) = self.flat_position(variable) else { return Ok(None) };
        let declared = &self.flat.variables[at];
        let is_number = matches!(
            declared.base,
            BaseType::Integer | BaseType::Boolean | BaseType::Enumeration(_)
        );
        let Some(binding) = declared.binding.as_ref().filter(|_| is_number) else {
            return Ok(None);
        };
        let place = (variable.0 - self.scalars.first[at].0) as usize;
        match self.sized(binding, &declared.dims) {
            Ok(array) => self.evaluate_below(array.elements[place], depth - 1, afterwards),
            Err(_) => Ok(None),
        }
    }

    /// The flat variable that a scalar is an element of: the last that does not begin after it.
    pub(super) fn flat_position(&self, variable: VarId) -> Option<usize> {
        self.scalars.first.partition_point(|first| *first <= variable).checked_sub(1)
    }
}

/// Collects what expressions name.
struct Named(Vec<ComponentReference>);

impl Visit for Named {
    fn reference(&mut self, reference: &ComponentReference) {
        walk_reference(self, reference);
        self.0.push(reference.clone());
    }
}
