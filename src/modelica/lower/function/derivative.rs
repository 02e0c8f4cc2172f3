//! `annotation(derivative = …)` (MLS §12.7.1): the function that computes the derivatives of
//! another.
//!
//! The annotation counts where its function can be compiled and its inputs are those of the
//! function, followed by a derivative for every Real input that is not `noDerivative`; otherwise
//! the function is differentiated itself. A derivative function may have a derivative of its own,
//! `derivative(order = 2)`, whose inputs are its inputs, followed by second derivatives.

use super::instances::{Argument, Instance, Instances, passed};
use super::inverse::element;
use crate::bytecode::Derivative;
use crate::eval::{Function, FunctionComponent, ValueType};
use crate::flatten::FlatModel;
use crate::lower::expressions::Lowered;
use crate::lower::shape::Shape;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{self, Binding, ExpressionKind, Modification};
use std::sync::Arc;

/// What an annotation says.
struct DerivativeAnnotation {
    name: Name,
    without: Vec<Ident>,
    zero: Vec<Ident>,
    order: i64,
}

impl Instances {
    /// The first derivative function that can be used.
    pub(super) fn derivative(
        &mut self,
        flat: &FlatModel,
        function: &Arc<Function>,
        arguments: &[Argument],
        span: Span,
    ) -> Option<Derivative> {
        let annotated: Vec<DerivativeAnnotation> =
            function.annotation.iter().filter_map(derivative_annotation).collect();
        let mut first = annotated.iter().filter(|annotated| annotated.order == 1);
        first.find_map(|annotated| self.used(flat, function, arguments, annotated, span))
    }

    fn used(
        &mut self,
        flat: &FlatModel,
        function: &Function,
        arguments: &[Argument],
        annotated: &DerivativeAnnotation,
        span: Span,
    ) -> Option<Derivative> {
        let bare = Name { global: false, parts: annotated.name.parts.clone() };
        let of = flat.functions.get(&bare)?.clone();
        let mut given: Vec<Lowered<Option<f64>>> = arguments.iter().map(known).collect();
        if arguments.iter().any(|argument| matches!(argument, Argument::Record(_))) {
            return None;
        }
        let (mut tangents, mut zero, mut next) = (Vec::new(), Vec::new(), 0u32);
        let mut second = Vec::new();
        for (input, argument) in function.inputs.iter().zip(arguments) {
            let Argument::Shape(shape) = argument else { continue };
            let scalars = next..next + shape.len() as u32;
            next = scalars.end;
            if annotated.zero.contains(&input.name) {
                zero.extend(scalars);
            } else if is_real(input) && !annotated.without.contains(&input.name) {
                tangents.extend(scalars);
                given.push(known(argument));
                second.push(known(argument));
            }
        }
        if of.inputs.len() != given.len() {
            return None;
        }
        let instance = self.instance(flat, &of, &given, span).ok()?;
        let all = passed(arguments).into_iter().chain(std::iter::repeat(true));
        if instance.passed.iter().zip(all).any(|(passed, own)| *passed != own) {
            return None;
        }
        let mut outputs = Vec::new();
        let mut place = 0u32;
        let mut shapes = instance.outputs.iter();
        for output in &function.outputs {
            let shape = match output.value_type {
                ValueType::Real => shapes.next()?.len() as u32,
                // Whole numbers have no derivative; arrays of them are left to differentiation.
                ValueType::Integer | ValueType::Boolean if output.dims.is_empty() => {
                    outputs.push(None);
                    continue;
                }
                _ => return None,
            };
            outputs.extend((place..place + shape).map(Some));
            place += shape;
        }
        let second = self.second(flat, &of, [given, second].concat(), &instance, span);
        Some(Derivative { function: instance.code, tangents, zero, outputs, second })
    }

    /// The derivative of a derivative function, for what that is given and second derivatives.
    fn second(
        &mut self,
        flat: &FlatModel,
        function: &Function,
        given: Vec<Lowered<Option<f64>>>,
        first: &Instance,
        span: Span,
    ) -> Option<u32> {
        let mut annotated = function.annotation.iter().filter_map(derivative_annotation);
        let annotated =
            annotated.find(|annotated| annotated.order == 2 && annotated.zero.is_empty())?;
        let bare = Name { global: false, parts: annotated.name.parts.clone() };
        let of = flat.functions.get(&bare)?.clone();
        if of.inputs.len() != given.len() {
            return None;
        }
        let instance = self.instance(flat, &of, &given, span).ok()?;
        let (own, passed) = (&first.passed, &instance.passed);
        let fits = instance.outputs == first.outputs
            && passed[..own.len()] == **own
            && passed[own.len()..].iter().all(|passed| *passed);
        fits.then_some(instance.code)
    }
}

fn is_real(component: &FunctionComponent) -> bool {
    component.value_type == ValueType::Real
}

/// An argument of the same shape or value.
fn known(argument: &Argument) -> Lowered<Option<f64>> {
    match argument {
        Argument::Shape(shape) => unknown(shape),
        Argument::Known(bits) => Lowered::scalar(Some(f64::from_bits(*bits))),
        Argument::Text(text) => Lowered::Text(text.clone()),
        Argument::Strings(strings) => Lowered::Strings(strings.clone()),
        Argument::Record(fields) => {
            Lowered::Record(fields.iter().map(|(name, field)| (*name, known(field))).collect())
        }
    }
}

fn unknown(shape: &Shape) -> Lowered<Option<f64>> {
    Lowered::from_scalars(shape, &mut std::iter::repeat(None))
}

/// `derivative(order = 1, noDerivative = a, zeroDerivative = b) = f`
fn derivative_annotation(argument: &ast::Argument) -> Option<DerivativeAnnotation> {
    let (name, modification) = element(argument)?;
    if name != "derivative" {
        return None;
    }
    let mut annotated = DerivativeAnnotation {
        name: reference(modification)?,
        without: vec![],
        zero: vec![],
        order: 1,
    };
    for argument in &modification.arguments {
        let (name, modification) = element(argument)?;
        match name {
            "noDerivative" => annotated.without.push(reference(modification)?.last()?),
            "zeroDerivative" => annotated.zero.push(reference(modification)?.last()?),
            "order" => match &modification.binding {
                Some(Binding::Expression(e)) => match e.kind {
                    ExpressionKind::Integer(order) => annotated.order = order,
                    _ => return None,
                },
                _ => return None,
            },
            _ => return None,
        }
    }
    Some(annotated)
}

/// The name after `=`.
fn reference(modification: &Modification) -> Option<Name> {
    match &modification.binding {
        Some(Binding::Expression(e)) => match &e.kind {
            ExpressionKind::Reference(reference) => Some(reference.name()),
            _ => None,
        },
        _ => None,
    }
}
