//! Sizes of arguments, which are those that the inputs are declared with (MLS §10.1, §12.4.1). They
//! may follow from other arguments; a size that is not known at translation is not checked.

use super::vectorized::sizes_for;
use super::{Lowered, Lowering, Target};
use crate::diag::Diagnostic;
use crate::eval::{self, Callee, Function, FunctionComponent, Host, Scope, ValueType};
use crate::fault;
use crate::functions;
use crate::lower::errors::ARRAY_MISMATCH;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{Arguments, ComponentReference, Expression, ExpressionKind, Subscript};
use crate::syntax::visit::{Rewrite, rewrite_expression};
use crate::value::Value;

impl<T: Target> Lowering<'_, T> {
    /// Refuses an argument that has other sizes than its input. What it has beyond the dimensions of
    /// the input is a call for each element (MLS §12.4.6).
    pub(super) fn check_sizes(
        &mut self,
        function: &Function,
        values: &[Lowered<T::Scalar>],
        arguments: &Arguments,
        span: Span,
    ) -> Result<(), Diagnostic> {
        for (at, (input, value)) in function.inputs.iter().zip(values).enumerate() {
            if input.dims.is_empty() {
                continue;
            }
            let Some(sizes) = sizes_for(input, value) else { continue };
            let given = &sizes[sizes.len().saturating_sub(input.dims.len())..];
            let declared = input.dims.iter().map(|size| self.declared_size(size, function, values));
            let declared: Vec<Option<usize>> = declared.collect();
            if !fits(given, &declared) {
                let named = arguments.named.iter().find(|one| one.name.node == input.name);
                let argument = arguments.positional.get(at).or(named.map(|one| &one.value));
                let (name, span) = (input.name, argument.map_or(span, |argument| argument.span));
                return Err(fault!(
                    ARRAY_MISMATCH,
                    "the input `{name}` of `{}` has the sizes {}, but its argument has {}",
                    function.name,
                    shown(&declared),
                    super::sizes(given)
                )
                .at(span));
            }
        }
        Ok(())
    }

    /// A size of an input in a call with these values; `None` where it is open or not known.
    fn declared_size(
        &mut self,
        size: &Subscript,
        function: &Function,
        values: &[Lowered<T::Scalar>],
    ) -> Option<usize> {
        let Subscript::Index(size) = size else { return None };
        let mut size = size.clone();
        let mut inputs = Inputs { lowering: self, function, values, is_open: false };
        inputs.expression(&mut size);
        if inputs.is_open {
            return None;
        }
        match eval::evaluate(&size, &mut Scope::script(), &mut Alone) {
            Ok(Value::Integer(size)) => usize::try_from(size).ok(),
            _ => None,
        }
    }
}

/// Whether an array has the declared sizes, as far as they are known. An array without elements may
/// have lost its further dimensions: `{}`.
fn fits(given: &[usize], declared: &[Option<usize>]) -> bool {
    let is_empty = given == [0] && declared.iter().any(|size| size.is_none_or(|size| size == 0));
    let is_size = |(size, declared): (&usize, &Option<usize>)| declared.is_none_or(|d| d == *size);
    is_empty || given.len() == declared.len() && given.iter().zip(declared).all(is_size)
}

/// `[3, :]`
fn shown(sizes: &[Option<usize>]) -> String {
    let size = |size: &Option<usize>| size.map_or(":".to_owned(), |size| size.to_string());
    format!("[{}]", sizes.iter().map(size).collect::<Vec<_>>().join(", "))
}

/// Evaluates what nothing but numbers and functions of the language are in.
struct Alone;

impl Host for Alone {
    fn callee(&mut self, _: &Name) -> Result<Option<Callee>, Diagnostic> {
        Ok(None)
    }

    fn variable(&mut self, _: &ComponentReference) -> Result<Option<Value>, Diagnostic> {
        Ok(None)
    }
}

/// Writes the values of inputs into a size, and the sizes of their arguments.
struct Inputs<'i, 'l, T: Target> {
    lowering: &'i mut Lowering<'l, T>,
    function: &'i Function,
    values: &'i [Lowered<T::Scalar>],
    /// Whether something in the size is not known.
    is_open: bool,
}

impl<'i, T: Target> Inputs<'i, '_, T> {
    /// The declaration and the value of an input, or of a component of a record that is one.
    fn input(
        &self,
        reference: &ComponentReference,
    ) -> Option<(&'i FunctionComponent, &'i Lowered<T::Scalar>)> {
        let (first, rest) = reference.parts.split_first()?;
        if reference.parts.iter().any(|part| !part.subscripts.is_empty()) {
            return None;
        }
        let mut inputs = self.function.inputs.iter().zip(self.values);
        let found = inputs.find(|(input, _)| input.name == first.name)?;
        rest.iter().try_fold(found, |(component, value), part| {
            let (ValueType::Record(_, fields), Lowered::Record(values)) =
                (&component.value_type, value)
            else {
                return None;
            };
            let is_it = |(name, _): &&(Ident, _)| *name == part.name;
            Some((fields.get(&part.name)?, &values.iter().find(is_it)?.1))
        })
    }

    /// The number that a scalar input is.
    fn number(&mut self, reference: &ComponentReference) -> Option<ExpressionKind> {
        let (input, value) = self.input(reference)?;
        let Lowered::Array(array) = value else { return None };
        let ([scalar], true) = (array.elements.as_slice(), array.dims.is_empty()) else {
            return None;
        };
        let target = &mut *self.lowering.target;
        let known = target.as_constant(*scalar).or_else(|| target.structural_value(*scalar))?;
        match input.value_type {
            ValueType::Integer | ValueType::Enumeration(_) => {
                Some(ExpressionKind::Integer(known as i64))
            }
            ValueType::Boolean => Some(ExpressionKind::Boolean(known != 0.0)),
            _ => None,
        }
    }

    /// `size(v, i)` of an input.
    fn size(&self, arguments: &[Expression]) -> Option<ExpressionKind> {
        let [Expression { kind: ExpressionKind::Reference(array), .. }, dimension] = arguments
        else {
            return None;
        };
        let ExpressionKind::Integer(dimension) = dimension.kind else { return None };
        let (input, value) = self.input(array)?;
        let sizes = sizes_for(input, value)?;
        let own = &sizes[sizes.len().checked_sub(input.dims.len())?..];
        let size = own.get(usize::try_from(dimension - 1).ok()?)?;
        Some(ExpressionKind::Integer(*size as i64))
    }
}

impl<T: Target> Rewrite for Inputs<'_, '_, T> {
    fn expression(&mut self, e: &mut Expression) {
        let written = match &e.kind {
            ExpressionKind::Reference(reference) => self.number(reference),
            ExpressionKind::Call { function, arguments } => match function.as_ident() {
                Some(name) if name == "size" => self.size(&arguments.positional),
                Some(name) if functions::find(name.as_str()).is_some() => {
                    return rewrite_expression(self, e);
                }
                _ => None,
            },
            _ => return rewrite_expression(self, e),
        };
        match written {
            Some(kind) => e.kind = kind,
            None => self.is_open = true,
        }
    }
}
