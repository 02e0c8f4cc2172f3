//! Expressions with arrays and records become scalars (MLS ch. 10).
//!
//! The rules of arrays are written once, here, for two targets: the equations of a model, and the
//! statements of user functions. What differs is a [`Target`].

mod arrays;
mod builtins;
mod calls;
mod expression;
mod homotopy;
mod message_text;
mod operators;
mod placed;
mod records;
mod string_parts;
mod strings;
mod varying_strings;
mod vectorized;

pub(crate) use super::string_part::StringPart;
pub(crate) use arrays::Choice;
pub(crate) use message_text::{message_parts, message_text, nth};
pub(crate) use records::field_of;

use super::errors::{ARRAY_MISMATCH, NO_CONSTANT_VALUE, NOT_SUPPORTED};
use super::loops::Loops;
use super::shape::{Shape, UNKNOWN_TEXT};
use super::string_array::StringArray;
use crate::diag::{At, Diagnostic, Fault};
use crate::external::Resources;
use crate::fault;
use crate::functions::{Builtin, Clocked, Temporal};
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::symbolic::RelationOperator;
use crate::symbolic::function::FunctionId;
use crate::syntax::ast::{ComponentReference, Expression};
use std::cell::Cell;
use std::sync::Arc;

/// Largest number of scalars of one array.
const MAX_SCALARS: usize = 2_000_000;
/// Deepest nesting of expressions.
const MAX_DEPTH: usize = 400;

/// What scalars are made into.
pub(crate) trait Target {
    /// A scalar.
    type Scalar: Copy + PartialEq;

    /// A number.
    fn constant(&mut self, value: f64) -> Self::Scalar;
    /// The number, if it is one.
    fn as_constant(&self, scalar: Self::Scalar) -> Option<f64>;
    /// `-a` or `not a`
    fn unary(&mut self, operation: Unary, a: Self::Scalar) -> Self::Scalar;
    /// `a + b` …
    fn binary(&mut self, operation: Binary, a: Self::Scalar, b: Self::Scalar) -> Self::Scalar;
    /// `a < b` …; `live` inside `noEvent`.
    fn relation(
        &mut self,
        operator: RelationOperator,
        a: Self::Scalar,
        b: Self::Scalar,
        live: bool,
        span: Span,
    ) -> Self::Scalar;
    /// A function of the table.
    fn apply(
        &mut self,
        function: FunctionId,
        arguments: &[Self::Scalar],
        live: bool,
        span: Span,
    ) -> Result<Self::Scalar, Diagnostic>;
    /// What follows is evaluated only where a condition holds, or does not, up to
    /// [`Target::leave`].
    fn enter(&mut self, condition: Self::Scalar, holds: bool) {
        let _ = (condition, holds);
    }
    /// Ends what [`Target::enter`] began.
    fn leave(&mut self) {}
    /// `a and b`, or `a or b`, of scalars.
    fn connective(&mut self, is_and: bool, a: Self::Scalar, b: Self::Scalar) -> Self::Scalar {
        self.binary(if is_and { Binary::And } else { Binary::Or }, a, b)
    }
    /// Begins the first branch of an if-expression.
    fn begin_if(&mut self, condition: Self::Scalar) -> Branch<Self::Scalar>;
    /// Ends the first branch, with these values, and begins the second.
    fn begin_else(&mut self, branch: &mut Branch<Self::Scalar>, values: &[Self::Scalar]);
    /// Ends the second branch; returns the values of the whole.
    fn end_if(
        &mut self,
        branch: Branch<Self::Scalar>,
        values: &[Self::Scalar],
    ) -> Vec<Self::Scalar>;
    /// An element of a vector of scalars at a position (from 0) that is not known yet.
    fn element(
        &mut self,
        elements: &[Self::Scalar],
        position: Self::Scalar,
        span: Span,
    ) -> Result<Self::Scalar, Diagnostic>;
    /// The value of an expression on which sizes or Strings depend, which cannot change from here
    /// on; `None` if it is not known.
    fn structural_value(&mut self, value: Self::Scalar) -> Option<f64> {
        let _ = value;
        None
    }
    /// Whether an expression is a clock, which is chosen at translation.
    fn is_clock(&self, e: &Expression) -> bool {
        let _ = e;
        false
    }
    /// The number that stands for a String where Strings change at events; `None` where none do.
    fn string_number(&mut self, text: &Arc<str>) -> Option<Self::Scalar> {
        let _ = text;
        None
    }
    /// Whether Strings can be made when what is translated runs.
    fn composes(&self) -> bool {
        false
    }
    /// The number of a text that is made of parts when what is translated runs.
    fn compose(
        &mut self,
        parts: &[StringPart<Self::Scalar>],
        span: Span,
    ) -> Result<Self::Scalar, Diagnostic> {
        let _ = parts;
        Err(varying_strings::computed(span))
    }
    /// Whether the outputs of the next call are needed where they are Strings made at run time.
    fn needs_string_outputs(&mut self, needed: bool) {
        let _ = needed;
    }
    /// What a String parameter, or a String that is bound, is made of: a scalar.
    fn string_binding(&self, path: &str) -> Option<Expression> {
        let _ = path;
        None
    }
    /// A text is needed that is not known, and that [`Target::composes`] would give.
    fn misses_text(&mut self) {}
    /// Whether parameters on which Strings depend are evaluated, to be switched; `None` where they
    /// cannot be.
    fn evaluates_string_parameters(&mut self) -> Option<&mut bool> {
        None
    }
    /// Whether the right operand of `and` and `or` is computed only where it decides.
    fn short_circuits(&self) -> bool {
        false
    }
    /// Whether [`Target::subscripted`] chooses elements at positions that are not known yet.
    fn chooses(&self) -> bool {
        false
    }
    /// Elements that subscripts choose, where [`Target::chooses`].
    fn subscripted(
        &mut self,
        array: &Array<Self::Scalar>,
        choices: Vec<Choice<Self::Scalar>>,
        span: Span,
    ) -> Result<Array<Self::Scalar>, Diagnostic> {
        let _ = (array, choices);
        Err(fault!(NO_CONSTANT_VALUE, "this subscript must be known at translation").at(span))
    }
    /// The scalars that a reference without its last subscripts stands for.
    fn reference(
        &mut self,
        path: &str,
        reference: &ComponentReference,
    ) -> Result<Lowered<Self::Scalar>, Diagnostic>;
    /// The sizes of an array of numbers of which [`Target::element_of`] gives single elements, without
    /// the others; `None` where there are none.
    fn sizes(&self, path: &str) -> Option<Vec<usize>> {
        let _ = path;
        None
    }
    /// The element at a position (from 0, the last dimension fastest) of an array that has
    /// [`Target::sizes`]; `None` where it is not to be had alone.
    fn element_of(
        &mut self,
        path: &str,
        position: usize,
    ) -> Result<Option<Self::Scalar>, Diagnostic> {
        let _ = (path, position);
        Ok(None)
    }
    /// What an external object is made by.
    fn constructor_of(&self, object: Self::Scalar) -> Option<Expression> {
        let _ = object;
        None
    }
    /// A variable of the function being compiled; `None` where no function is.
    fn own_variable(&self, name: Ident) -> Option<&Lowered<Self::Scalar>> {
        let _ = name;
        None
    }
    /// A user function; `None` if there is none of this name.
    fn function(&self, name: &Name) -> Option<Arc<crate::eval::Function>>;
    /// The type of the scalars of a variable that has this path.
    fn value_type(&self, path: &str) -> Option<crate::eval::ValueType>;
    /// All user functions.
    fn functions(&self) -> Vec<Arc<crate::eval::Function>>;
    /// The files that the model may use.
    fn resources(&self) -> Resources;
    /// Whether the evaluation of the current call will be abandoned: what it needs is not computed.
    fn gives_up(&self) -> bool {
        false
    }
    /// Whether what is translated is evaluated once, when a simulation starts.
    fn runs_once(&self) -> bool {
        false
    }
    /// Whether what the specification forbids is an error though libraries do it.
    fn is_strict(&self) -> bool;
    /// Takes warnings and notes about the model.
    fn warn(&mut self, warnings: Vec<Diagnostic>) {
        let _ = warnings;
    }
    /// How many statements the interpreter has run while the model is compiled.
    fn interpreted(&self) -> &Cell<u64>;
    /// Calls a user function with all its arguments.
    fn call(
        &mut self,
        function: &Arc<crate::eval::Function>,
        arguments: Vec<Lowered<Self::Scalar>>,
        span: Span,
    ) -> Result<Vec<Lowered<Self::Scalar>>, Diagnostic>;
    /// As [`Target::call`], of a function that the interpreter carries out whenever it is called; `None`
    /// where that is not possible.
    fn interpreted_call(
        &mut self,
        function: &Arc<crate::eval::Function>,
        arguments: &[Lowered<Self::Scalar>],
        span: Span,
    ) -> Option<Vec<Lowered<Self::Scalar>>> {
        let _ = (function, arguments, span);
        None
    }
    /// What leads from `simplified` to `actual` at the start, and is `actual` afterwards.
    fn homotopy(&mut self, actual: Self::Scalar, _simplified: Self::Scalar) -> Self::Scalar {
        actual
    }
    /// Announces an operator with a meaning in time, before its arguments are lowered; functions
    /// have none (MLS §12.2).
    fn begin_temporal(
        &mut self,
        entry: &Builtin,
        operator: Temporal,
        span: Span,
    ) -> Result<(), Diagnostic> {
        let _ = operator;
        Err(fault!(NOT_SUPPORTED, "`{}` in a function", entry.name).at(span))
    }
    /// The outputs of `spatialDistribution`.
    fn spatial_distribution(
        &mut self,
        _arguments: &[Array<Self::Scalar>],
        span: Span,
    ) -> Result<[Self::Scalar; 2], Diagnostic> {
        Err(fault!(NOT_SUPPORTED, "`spatialDistribution` in a function").at(span))
    }
    /// The value of an operator with a meaning in time that has been announced.
    fn temporal(
        &mut self,
        entry: &Builtin,
        operator: Temporal,
        arguments: Vec<Array<Self::Scalar>>,
        live: bool,
        span: Span,
    ) -> Result<Array<Self::Scalar>, Diagnostic> {
        let _ = (operator, arguments, live);
        Err(fault!(NOT_SUPPORTED, "`{}` in a function", entry.name).at(span))
    }
    /// The value of a clocked operator that has been announced (MLS §16.5).
    fn clocked(
        &mut self,
        entry: &Builtin,
        operator: Clocked,
        call: ClockedCall<Self::Scalar>,
        span: Span,
    ) -> Result<Lowered<Self::Scalar>, Diagnostic> {
        let _ = (operator, call);
        Err(fault!(NOT_SUPPORTED, "`{}` in a function", entry.name).at(span))
    }
}

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

/// An if-expression under construction.
pub(crate) struct Branch<S> {
    /// Its condition.
    pub(crate) condition: S,
    /// Values of the first branch.
    pub(crate) values: Vec<S>,
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
