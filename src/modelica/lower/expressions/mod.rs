//! Expressions with arrays and records become scalars (MLS ch. 10).
//!
//! The rules of arrays are written once, here, for two targets: the equations of a model, and the
//! statements of user functions. What differs is a [`Target`].

mod argument_sizes;
mod arrays;
mod builtins;
mod calls;
mod counted_reductions;
mod expression;
mod homotopy;
mod message_text;
mod operators;
mod placed;
mod records;
mod string_parts;
mod strings;
mod target;
mod varying_strings;
mod vectorized;

pub(crate) use super::string_part::StringPart;
pub(crate) use message_text::{message_parts, message_text, nth};
pub(crate) use records::{field_of, stacked};
pub(crate) use target::{
    ConditionalValues, FunctionCalls, Operations, StringOperations, Target, TimeOperators,
    VariableReferences,
};

use super::errors::{ARRAY_MISMATCH, NO_CONSTANT_VALUE};
use super::loops::Loops;
use super::shape::{Shape, UNKNOWN_TEXT};
use super::string_array::StringArray;
use crate::diag::{At, Diagnostic, Fault};
use crate::fault;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::Expression;
use std::sync::Arc;

/// Largest number of scalars of one array.
const MAX_SCALARS: usize = 2_000_000;
/// Deepest nesting of expressions.
const MAX_DEPTH: usize = 400;

/// The arguments of a clocked operator.
pub(crate) struct ClockedCall<S> {
    /// Those by position.
    pub(crate) positional: Vec<Lowered<S>>,
    /// Those by name.
    pub(crate) named: Vec<(Ident, Lowered<S>)>,
}

impl<S> ClockedCall<S> {
    /// The argument at a position or of a name.
    pub(crate) fn at(&self, position: usize, name: &str) -> Option<&Lowered<S>> {
        let named = || self.named.iter().find(|(known, _)| *known == name).map(|(_, value)| value);
        self.positional.get(position).or_else(named)
    }
}

/// The positions that a subscript chooses from one dimension.
pub(crate) enum Choice<S> {
    /// Known positions from 0; `keeps` if the dimension stays.
    Known { positions: Vec<usize>, keeps: bool },
    /// One position (from 1) that is computed.
    Computed(S),
    /// Positions (from 1) of which some are computed; the dimension stays.
    ComputedVector(Vec<S>),
}

/// An if-expression under construction.
pub(crate) struct Branch<S> {
    /// Its condition.
    pub(crate) condition: S,
    /// How many assertions there were when the branch at hand began.
    pub(crate) asserted: usize,
    /// Values of the first branch.
    pub(crate) values: Vec<S>,
}

/// A loop under construction that is run when what is translated runs.
pub(crate) struct CountedLoop<S> {
    /// The loop variable.
    pub(crate) variable: S,
    /// What the iterations so far have made.
    pub(crate) value: S,
    /// Where an iteration begins in the code.
    pub(crate) start: usize,
    /// The jump out of the loop, after the last iteration.
    pub(crate) exit: usize,
}

/// Operations of one operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unary {
    /// `-`
    Neg,
    /// `not`
    Not,
}

/// Operations of two operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Binary {
    /// `+`
    Add,
    /// `-`
    Sub,
    /// `*`
    Mul,
    /// `/`
    Div,
    /// `^`
    Pow,
    /// `and`
    And,
    /// `or`
    Or,
}

/// What an expression becomes.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) enum Lowered<S> {
    /// A scalar or an array of scalars.
    Array(Array<S>),
    /// A record.
    Record(Vec<(Ident, Lowered<S>)>),
    /// A text known when compiling, but for the parts of messages that are not.
    Text(Arc<str>),
    /// An array of such Strings.
    Strings(StringArray),
    /// The number of a text that changes at events.
    Numbered(S),
}

/// An array of scalars; no sizes for a scalar.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) struct Array<S> {
    /// Its sizes.
    pub(crate) dims: Vec<usize>,
    /// Row-major.
    pub(crate) elements: Vec<S>,
}

impl<S: Copy> Array<S> {
    pub(crate) fn scalar(element: S) -> Array<S> {
        Array { dims: Vec::new(), elements: vec![element] }
    }

    pub(crate) fn vector(elements: Vec<S>) -> Array<S> {
        Array { dims: vec![elements.len()], elements }
    }
}

impl<S: Copy> Lowered<S> {
    pub(crate) fn scalar(element: S) -> Lowered<S> {
        Lowered::Array(Array::scalar(element))
    }

    /// The shape of the value.
    pub(crate) fn shape(&self) -> Option<Shape> {
        match self {
            Lowered::Array(array) => Some(Shape::Array(array.dims.clone())),
            Lowered::Record(fields) => {
                let shape = |(name, field): &(Ident, Lowered<S>)| Some((*name, field.shape()?));
                Some(Shape::Record(fields.iter().map(shape).collect::<Option<_>>()?))
            }
            Lowered::Text(text) => Some(Shape::Text(text.clone())),
            Lowered::Strings(strings) => Some(Shape::Strings(strings.clone())),
            Lowered::Numbered(_) => Some(Shape::Numbered),
        }
    }

    /// A scalar or array, no record.
    pub(crate) fn into_array(self, span: Span) -> Result<Array<S>, Diagnostic> {
        match self {
            Lowered::Array(array) => Ok(array),
            Lowered::Record(_) => {
                Err(fault!(ARRAY_MISMATCH, "expected a number, got a record").at(span))
            }
            Lowered::Text(_) | Lowered::Strings(_) | Lowered::Numbered(_) => {
                Err(fault!(ARRAY_MISMATCH, "expected a number, got a String").at(span))
            }
        }
    }

    /// Whether sizes and components are those of another value.
    pub(crate) fn fits(&self, other: &Lowered<S>) -> bool {
        matches!((self.shape(), other.shape()), (Some(a), Some(b)) if a.joined(&b).is_some())
    }

    /// The same with every scalar replaced.
    pub(crate) fn map<R: Copy>(&self, replace: &mut impl FnMut(S) -> R) -> Lowered<R> {
        match self {
            Lowered::Array(array) => Lowered::Array(Array {
                dims: array.dims.clone(),
                elements: array.elements.iter().map(|element| replace(*element)).collect(),
            }),
            Lowered::Record(fields) => {
                Lowered::Record(fields.iter().map(|(n, f)| (*n, f.map(replace))).collect())
            }
            Lowered::Text(text) => Lowered::Text(text.clone()),
            Lowered::Strings(strings) => Lowered::Strings(strings.clone()),
            Lowered::Numbered(number) => Lowered::Numbered(replace(*number)),
        }
    }

    /// All scalars, in order.
    pub(crate) fn append_scalars(&self, out: &mut Vec<S>) {
        match self {
            Lowered::Array(array) => out.extend(&array.elements),
            Lowered::Record(fields) => fields.iter().for_each(|(_, f)| f.append_scalars(out)),
            Lowered::Numbered(number) => out.push(*number),
            Lowered::Text(_) | Lowered::Strings(_) => {}
        }
    }

    /// A value of this shape made of scalars in order.
    pub(crate) fn from_scalars(shape: &Shape, scalars: &mut impl Iterator<Item = S>) -> Lowered<S> {
        match shape {
            Shape::Array(dims) => {
                let elements = scalars.take(shape.len()).collect();
                Lowered::Array(Array { dims: dims.clone(), elements })
            }
            Shape::Record(fields) => Lowered::Record(
                fields.iter().map(|(n, s)| (*n, Lowered::from_scalars(s, scalars))).collect(),
            ),
            Shape::Text(text) => Lowered::Text(text.clone()),
            Shape::Strings(strings) => Lowered::Strings(strings.clone()),
            // There is a scalar for every part of a shape.
            Shape::Numbered => match scalars.next() {
                Some(number) => Lowered::Numbered(number),
                None => Lowered::Text(UNKNOWN_TEXT.into()),
            },
        }
    }
}

/// Lowers expressions to the scalars of a target.
pub(crate) struct Lowering<'a, T: Target> {
    /// Where the scalars go.
    pub(crate) target: &'a mut T,
    /// Loop variables, innermost last.
    pub(crate) loops: Loops<T::Scalar>,
    /// Whether relations are evaluated as they are (inside `noEvent`).
    pub(crate) live: bool,
    /// Whether Strings that are not known are made when what is translated runs.
    pub(crate) composes: bool,
    /// Size of the dimension that `end` stands for, innermost last.
    ends: Vec<usize>,
    depth: usize,
}

impl<'a, T: Target> Lowering<'a, T> {
    /// A lowering outside loops.
    pub(crate) fn new(target: &'a mut T) -> Lowering<'a, T> {
        Lowering {
            target,
            loops: Vec::new(),
            live: false,
            composes: false,
            ends: Vec::new(),
            depth: 0,
        }
    }

    /// A scalar.
    pub(crate) fn scalar(&mut self, e: &Expression) -> Result<T::Scalar, Diagnostic> {
        let array = self.array(e)?;
        match array.elements.as_slice() {
            [element] if array.dims.is_empty() => Ok(*element),
            _ => Err(fault!(
                ARRAY_MISMATCH,
                "expected a scalar, got an array of size {}",
                sizes(&array.dims)
            )
            .at(e.span)),
        }
    }

    /// A scalar or array, no record.
    pub(crate) fn array(&mut self, e: &Expression) -> Result<Array<T::Scalar>, Diagnostic> {
        self.lower(e)?.into_array(e.span)
    }

    /// A number known when compiling.
    pub(crate) fn known(&mut self, e: &Expression) -> Result<f64, Diagnostic> {
        let scalar = self.scalar(e)?;
        self.target.as_constant(scalar).ok_or_else(|| not_known(e.span))
    }

    /// A number that sizes depend on: parameters in it are evaluated.
    pub(crate) fn shaping(&mut self, e: &Expression) -> Result<f64, Diagnostic> {
        let scalar = self.scalar(e)?;
        let known =
            self.target.as_constant(scalar).or_else(|| self.target.structural_value(scalar));
        known.ok_or_else(|| not_known(e.span))
    }

    /// A size known when compiling.
    pub(crate) fn known_size(&mut self, e: &Expression) -> Result<usize, Diagnostic> {
        let value = self.shaping(e)?;
        if value < 0.0 || value > MAX_SCALARS as f64 || value.fract() != 0.0 {
            return Err(fault!(ARRAY_MISMATCH, "{value} is not a valid array size").at(e.span));
        }
        Ok(value as usize)
    }
}

fn not_known(span: Span) -> Diagnostic {
    fault!(NO_CONSTANT_VALUE, "this must be known at translation";
        help: "use a constant, or a parameter that is `final` or has `annotation(Evaluate = true)`")
    .at(span)
}

/// Sizes for messages: `[2, 3]`, `scalar`.
pub(crate) fn sizes(dims: &[usize]) -> String {
    if dims.is_empty() {
        return "scalar".into();
    }
    let strings: Vec<String> = dims.iter().map(usize::to_string).collect();
    format!("[{}]", strings.join(", "))
}

/// The fault of two sizes that differ.
pub(crate) fn size_fault(a: &[usize], b: &[usize]) -> Fault {
    fault!(ARRAY_MISMATCH, "the sizes {} and {} do not match", sizes(a), sizes(b))
}

/// Places a fault of a result.
fn at<X>(result: Result<X, Fault>, span: Span) -> Result<X, Diagnostic> {
    result.at(span)
}
