//! Sizes of the outputs and locals of a user function for inputs of given sizes.

use super::errors::{NOT_SUPPORTED, UNRESOLVED_REFERENCE};
use super::lowering::{Binary, Branch, Lowered, Lowering, Operator, Target, Unary};
use super::model::Shape;
use crate::diag::Diagnostic;
use crate::eval::{Function, FunctionComponent, ValueType};
use crate::fault;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::symbolic::RelationOperator;
use crate::symbolic::function::FunctionId;
use crate::syntax::ast::{ComponentReference, Expression, Subscript};
use indexmap::IndexMap;
use std::sync::Arc;

/// Shapes of the outputs.
pub(super) fn shapes(
    function: &Function,
    inputs: &[Shape],
    known: &[Option<f64>],
    functions: &IndexMap<Name, Arc<Function>>,
    span: Span,
) -> Result<Vec<Shape>, Diagnostic> {
    let mut sizes = Sizes { components: Vec::new(), functions };
    for ((input, shape), known) in function.inputs.iter().zip(inputs).zip(known) {
        sizes.declare(input.name, shape, *known);
    }
    let mut outputs = Vec::new();
    for output in &function.outputs {
        let shape = sizes.shape(output, span)?;
        sizes.declare(output.name, &shape, None);
        outputs.push(shape);
    }
    Ok(outputs)
}

/// The shape of a component, its sizes given by the components before it.
pub(crate) fn component_shape<T: Target>(
    lowering: &mut Lowering<'_, T>,
    component: &FunctionComponent,
    span: Span,
) -> Result<Shape, Diagnostic> {
    let mut dims = Vec::new();
    for subscript in &component.dims {
        match subscript {
            Subscript::Index(size) => dims.push(lowering.known_size(size)?),
            Subscript::All(place) => {
                return Err(fault!(
                    NOT_SUPPORTED,
                    "the size of `{}` is not declared",
                    component.name
                )
                .at(*place)
                .related(span, "called here"));
            }
        }
    }
    match &component.value_type {
        ValueType::Record(_, fields) if dims.is_empty() => {
            let shape = |(name, field): (&Ident, &FunctionComponent)| {
                Ok((*name, component_shape(lowering, field, span)?))
            };
            Ok(Shape::Record(fields.iter().map(shape).collect::<Result<_, Diagnostic>>()?))
        }
        ValueType::Real | ValueType::Integer | ValueType::Boolean | ValueType::Enumeration(_) => {
            Ok(Shape::Array(dims))
        }
        _ => Err(fault!(
            NOT_SUPPORTED,
            "`{}` is of a type that functions in equations cannot have",
            component.name
        )
        .at(component.span)),
    }
}

/// Numbers where they are known, nothing elsewhere.
struct Sizes<'a> {
    components: Vec<(Ident, Lowered<Option<f64>>)>,
    functions: &'a IndexMap<Name, Arc<Function>>,
}

impl Sizes<'_> {
    fn declare(&mut self, name: Ident, shape: &Shape, known: Option<f64>) {
        let value = Lowered::from_scalars(shape, &mut std::iter::repeat(known));
        self.components.push((name, value));
    }

    fn shape(&mut self, c: &FunctionComponent, span: Span) -> Result<Shape, Diagnostic> {
        component_shape(&mut Lowering::new(self), c, span)
    }
}

impl Target for Sizes<'_> {
    type Scalar = Option<f64>;

    fn constant(&mut self, value: f64) -> Option<f64> {
        Some(value)
    }

    fn as_constant(&self, scalar: Option<f64>) -> Option<f64> {
        scalar
    }

    fn unary(&mut self, operation: Unary, a: Option<f64>) -> Option<f64> {
        match operation {
            Unary::Neg => a.map(|a| -a),
            Unary::Not => a.map(|a| f64::from(u8::from(a == 0.0))),
        }
    }

    fn binary(&mut self, operation: Binary, a: Option<f64>, b: Option<f64>) -> Option<f64> {
        let (a, b) = (a?, b?);
        Some(match operation {
            Binary::Add => a + b,
            Binary::Sub => a - b,
            Binary::Mul => a * b,
            Binary::Div => a / b,
            Binary::Pow => a.powf(b),
            Binary::And => a.min(b),
            Binary::Or => a.max(b),
        })
    }

    fn relation(
        &mut self,
        operator: RelationOperator,
        a: Option<f64>,
        b: Option<f64>,
        _: bool,
        _: Span,
    ) -> Option<f64> {
        Some(f64::from(u8::from(operator.holds(a?, b?))))
    }

    fn apply(
        &mut self,
        function: FunctionId,
        arguments: &[Option<f64>],
        _: bool,
        _: Span,
    ) -> Result<Option<f64>, Diagnostic> {
        let values: Option<Vec<f64>> = arguments.iter().copied().collect();
        Ok(values.map(|values| function.get().value.of(&values)))
    }

    fn begin_if(&mut self, condition: Option<f64>) -> Branch<Option<f64>> {
        Branch { condition, values: Vec::new(), jumps: [0; 2] }
    }

    fn begin_else(&mut self, _: &mut Branch<Option<f64>>, _: &[Option<f64>]) {}

    fn end_if(&mut self, _: Branch<Option<f64>>, values: &[Option<f64>]) -> Vec<Option<f64>> {
        vec![None; values.len()]
    }

    fn element(
        &mut self,
        _: &[Option<f64>],
        _: Option<f64>,
        _: Span,
    ) -> Result<Option<f64>, Diagnostic> {
        Ok(None)
    }

    fn reference(
        &mut self,
        path: &str,
        reference: &ComponentReference,
    ) -> Result<Lowered<Option<f64>>, Diagnostic> {
        let mut parts = path.split('.');
        let first = parts.next().unwrap_or(path);
        let found = self.components.iter().find(|(name, _)| *name == first);
        let mut value = found.map(|(_, value)| value.clone()).ok_or_else(|| {
            fault!(UNRESOLVED_REFERENCE, "there is no variable `{path}`").at(reference.span)
        })?;
        for part in parts {
            value = super::lowering::field(value, Ident::new(part), reference.span)?;
        }
        Ok(value)
    }

    fn function(&self, name: &Name) -> Option<Arc<Function>> {
        self.functions.get(name).cloned()
    }

    fn call(
        &mut self,
        function: &Arc<Function>,
        _: Vec<Lowered<Option<f64>>>,
        span: Span,
    ) -> Result<Vec<Lowered<Option<f64>>>, Diagnostic> {
        Err(fault!(NOT_SUPPORTED, "a size given by the function `{}`", function.name).at(span))
    }

    fn operator(
        &mut self,
        _: &str,
        _: &[Expression],
        _: Span,
    ) -> Option<Result<Operator, Diagnostic>> {
        None
    }

    fn derivative(&mut self, _: Option<f64>, span: Span) -> Result<Option<f64>, Diagnostic> {
        Err(fault!(NOT_SUPPORTED, "a derivative in a function").at(span))
    }
}
