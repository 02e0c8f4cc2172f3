//! `annotation(inverse(x = f(y), …))` (MLS §12.8): the functions that solve another for its inputs.
//!
//! The annotation counts where the function has one Real output and scalar Real inputs, and the
//! inverse function takes nothing but these and returns one Real. Both are tried at some points, since
//! functions of libraries are inverse to each other but for the range where they are made smooth: the
//! flow through a resistance of IBPSA, solved by its declared inverse, differs by a third where it is
//! laminar. Such an inverse solves an equation that stands alone, as its author intends, but none
//! in a loop. What is an inverse nowhere is not used.

use super::instances::{Argument, Instance, Instances};
use crate::bytecode::{Functions, Machine};
use crate::eval::{Function, FunctionComponent, ValueType};
use crate::flatten::FlatModel;
use crate::lower::expressions::Lowered;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::symbolic::Inverse;
use crate::syntax::ast::{self, Binding, Expression, ExpressionKind, Modification};
use std::sync::Arc;

/// Whether calls of a function are kept as calls, so that equations can be solved for their
/// arguments: it has inverses, and its author prevents its inlining.
pub(super) fn is_kept(function: &Function) -> bool {
    let mut of_inputs = function.annotation.iter().filter_map(|a| inverses(a));
    let not_inlined = function.annotation.iter().any(|argument| {
        matches!(element(argument), Some(("Inline", modification)) if is_false(modification))
    });
    not_inlined && is_scalar(function) && of_inputs.next().is_some()
}

impl Instances {
    /// The inverses of a function that can be used, by input.
    pub(super) fn inverses(
        &mut self,
        flat: &FlatModel,
        function: &Arc<Function>,
        arguments: &[Argument],
        span: Span,
    ) -> Vec<(u32, Inverse)> {
        let is_passed = |argument: &Argument| matches!(argument, Argument::Shape(_));
        if !is_kept(function) || !arguments.iter().all(is_passed) {
            return Vec::new();
        }
        let mut found = Vec::new();
        for argument in function.annotation.iter().filter_map(inverses).flatten() {
            let Some((input, modification)) = element(argument) else { continue };
            let at = function.inputs.iter().position(|own| own.name.as_str() == input);
            let Some(Binding::Expression(call)) = &modification.binding else { continue };
            if let Some(at) = at
                && let Some(inverse) = self.inverse(flat, function, at, call, span)
            {
                found.push((at as u32, inverse));
            }
        }
        found
    }

    /// The inverse for the input at a place; `None` if its call gives anything but the other inputs
    /// and the output.
    fn inverse(
        &mut self,
        flat: &FlatModel,
        function: &Function,
        at: usize,
        call: &Expression,
        span: Span,
    ) -> Option<Inverse> {
        let ExpressionKind::Call { function: callee, arguments } = &call.kind else { return None };
        let name = Name { global: false, ..callee.name() };
        let of = flat.functions.get(&name)?.clone();
        if !is_scalar(&of) || arguments.positional.len() > of.inputs.len() {
            return None;
        }
        let mut sources = Vec::with_capacity(of.inputs.len());
        for (position, input) in of.inputs.iter().enumerate() {
            let named = arguments.named.iter().find(|a| a.name.node == input.name);
            let given = arguments.positional.get(position).or(named.map(|a| &a.value))?;
            let ExpressionKind::Reference(reference) = &given.kind else { return None };
            let name = reference.name();
            sources.push(source(function, at, name.first().filter(|_| name.is_simple())?)?);
        }
        let unknown = vec![Lowered::scalar(None); of.inputs.len()];
        let instance: Instance = self.instance(flat, &of, &unknown, span).ok()?;
        let is_plain = instance.passed.iter().all(|passed| *passed) && !instance.impure;
        is_plain.then(|| Inverse {
            function: instance.code,
            arguments: sources.into(),
            is_exact: true,
        })
    }
}

/// The values of the input for which an inverse is tried: small, middle and large, of both signs.
const TRIED: [f64; 12] = [1e-4, -1e-4, 0.01, -0.01, 0.2, -0.2, 0.7, -0.7, 3.0, -3.0, 200.0, -200.0];
/// The values of the other inputs, in turn.
const OTHERS: [f64; 5] = [0.6, 1.7, 0.05, 12.0, 1.0];
/// How far the input may be missed, relative to itself.
const INVERTED: f64 = 1e-9;
/// So many tries must give the input back.
const FEWEST: usize = 6;

/// Where a declared inverse gives the input back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::lower) enum Inverts {
    /// Wherever it was tried.
    Everywhere,
    /// At some of the points.
    Somewhere,
    /// At too few of them.
    Nowhere,
}

/// Tries a declared inverse.
pub(in crate::lower) fn inverts(
    functions: &Functions,
    function: u32,
    input: u32,
    inverse: &Inverse,
) -> Inverts {
    let n = functions.codes[function as usize].n_inputs as usize;
    let mut machine = Machine::default();
    let mut value = |function: u32, arguments: &[f64]| -> Option<f64> {
        machine.call(functions, function, arguments.iter().copied()).ok()?.first().copied()
    };
    let (mut given, mut inverted) = (0, 0);
    for (first, x) in (0..OTHERS.len()).flat_map(|first| TRIED.map(|x| (first, x))) {
        let mut arguments: Vec<f64> = (0..n).map(|i| OTHERS[(first + i) % OTHERS.len()]).collect();
        arguments[input as usize] = x;
        let Some(y) = value(function, &arguments) else { continue };
        let sources = inverse.arguments.iter();
        let of: Vec<f64> = sources.map(|at| at.map_or(y, |at| arguments[at as usize])).collect();
        let Some(back) = value(inverse.function, &of) else { continue };
        given += 1;
        arguments[input as usize] = back;
        // An error of the input that the output does not show is none.
        let shown = value(function, &arguments).map(|again| (again - y).abs());
        let is_same = shown.is_some_and(|error| error <= 4.0 * f64::EPSILON * y.abs());
        inverted += usize::from((back - x).abs() <= INVERTED * x.abs() || is_same);
    }
    match inverted >= FEWEST {
        true if inverted == given => Inverts::Everywhere,
        true => Inverts::Somewhere,
        false => Inverts::Nowhere,
    }
}

/// What a name in the call of an inverse stands for: another input, or `None` for the output.
fn source(function: &Function, at: usize, name: Ident) -> Option<Option<u32>> {
    if function.outputs[0].name == name {
        return Some(None);
    }
    let input = function.inputs.iter().position(|input| input.name == name)?;
    (input != at).then_some(Some(input as u32))
}

/// Whether all inputs are scalars of type Real, and so is the only output.
fn is_scalar(function: &Function) -> bool {
    let is_real = |c: &FunctionComponent| c.value_type == ValueType::Real && c.dims.is_empty();
    function.outputs.len() == 1 && function.inputs.iter().chain(&function.outputs).all(is_real)
}

/// The arguments of `inverse(…)`.
fn inverses(argument: &ast::Argument) -> Option<&[ast::Argument]> {
    match element(argument)? {
        ("inverse", modification) => Some(&modification.arguments),
        _ => None,
    }
}

/// The name and the modification of an argument of an annotation.
pub(super) fn element(argument: &ast::Argument) -> Option<(&'static str, &Modification)> {
    match argument {
        ast::Argument::Element(element) => {
            Some((element.name.node.last()?.as_str(), element.modification.as_ref()?))
        }
        ast::Argument::Redeclaration(_) => None,
    }
}

fn is_false(modification: &Modification) -> bool {
    matches!(&modification.binding,
        Some(Binding::Expression(e)) if e.kind == ExpressionKind::Boolean(false))
}
