//! What expressions become: the equations of a model, statements that are inlined into them, or code.

use super::{Array, Binary, Branch, Choice, ClockedCall, CountedLoop, Lowered, StringPart, Unary};
use crate::diag::Diagnostic;
use crate::eval::{Function, ValueType};
use crate::fault;
use crate::flatten::FlatModel;
use crate::functions::{Builtin, Clocked, Temporal};
use crate::lower::errors::{NO_CONSTANT_VALUE, NOT_SUPPORTED};
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::symbolic::RelationOperator;
use crate::symbolic::function::FunctionId;
use crate::syntax::ast::{ComponentReference, Expression, Subscript};
use std::borrow::Cow;
use std::cell::Cell;
use std::sync::Arc;

/// What scalars are made into.
pub(crate) trait Target:
    Operations
    + ConditionalValues
    + VariableReferences
    + FunctionCalls
    + StringOperations
    + TimeOperators
{
}

impl<T> Target for T where
    T: Operations
        + ConditionalValues
        + VariableReferences
        + FunctionCalls
        + StringOperations
        + TimeOperators
{
}

/// Makes scalars of numbers and of other scalars.
pub(crate) trait Operations {
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
    /// An element of a vector of scalars at a position (from 0) that is not known yet.
    fn element(
        &mut self,
        elements: &[Self::Scalar],
        position: Self::Scalar,
        span: Span,
    ) -> Result<Self::Scalar, Diagnostic>;
    /// Whether [`Operations::subscripted`] chooses elements at positions that are not known yet.
    fn chooses(&self) -> bool {
        false
    }
    /// Elements that subscripts choose, where [`Operations::chooses`].
    fn subscripted(
        &mut self,
        array: &Array<Self::Scalar>,
        choices: Vec<Choice<Self::Scalar>>,
        span: Span,
    ) -> Result<Array<Self::Scalar>, Diagnostic> {
        let _ = (array, choices);
        Err(fault!(NO_CONSTANT_VALUE, "this subscript must be known at translation").at(span))
    }
    /// What leads from `simplified` to `actual` at the start, and is `actual` afterwards.
    fn homotopy(&mut self, actual: Self::Scalar, _simplified: Self::Scalar) -> Self::Scalar {
        actual
    }
}

/// Makes scalars that are evaluated only where a condition holds, or does not.
pub(crate) trait ConditionalValues: Operations {
    /// `a and b`, or `a or b`, of scalars.
    fn connective(&mut self, is_and: bool, a: Self::Scalar, b: Self::Scalar) -> Self::Scalar {
        self.binary(if is_and { Binary::And } else { Binary::Or }, a, b)
    }
    /// Whether the right operand of `and` and `or` is computed only where it decides.
    fn short_circuits(&self) -> bool {
        false
    }
    /// What follows is evaluated only where a condition holds, or does not, up to
    /// [`ConditionalValues::leave`].
    fn enter(&mut self, condition: Self::Scalar, holds: bool) {
        let _ = (condition, holds);
    }
    /// Ends what [`ConditionalValues::enter`] began.
    fn leave(&mut self) {}
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
    /// Whether loops are run when what is translated runs: [`ConditionalValues::begin_counted_loop`].
    fn runs_loops(&self) -> bool {
        false
    }
    /// Begins a loop over `start:step:stop`, which is run when what is translated runs, with a value
    /// that each iteration changes; `None` where the ranges of all loops must be known.
    fn begin_counted_loop(
        &mut self,
        range: [Self::Scalar; 3],
        value: Self::Scalar,
    ) -> Option<CountedLoop<Self::Scalar>> {
        let _ = (range, value);
        None
    }
    /// Ends an iteration, after which the value is another one; returns it as it is after the loop.
    fn end_counted_loop(
        &mut self,
        counted: CountedLoop<Self::Scalar>,
        value: Self::Scalar,
    ) -> Self::Scalar {
        let _ = counted;
        value
    }
}

/// Gives what references to variables stand for.
pub(crate) trait VariableReferences: Operations {
    /// The scalars that a reference without its last subscripts stands for.
    fn reference(
        &mut self,
        path: &str,
        reference: &ComponentReference,
    ) -> Result<Lowered<Self::Scalar>, Diagnostic>;
    /// The sizes of an array of numbers of which [`VariableReferences::element_of`] gives single elements, without
    /// the others; `None` where there are none.
    fn sizes(&self, path: &str) -> Option<Vec<usize>> {
        let _ = path;
        None
    }
    /// The element at a position (from 0, the last dimension fastest) of an array that has
    /// [`VariableReferences::sizes`]; `None` where it is not to be had alone.
    fn element_of(
        &mut self,
        path: &str,
        position: usize,
    ) -> Result<Option<Self::Scalar>, Diagnostic> {
        let _ = (path, position);
        Ok(None)
    }
    /// A variable of the function being compiled; `None` where no function is.
    fn own_variable(&self, name: Ident) -> Option<&Lowered<Self::Scalar>> {
        let _ = name;
        None
    }
    /// The subscripts of all parts of a reference to an own variable, for the array that its last
    /// component is.
    fn own_subscripts<'r>(
        &self,
        reference: &'r ComponentReference,
    ) -> Result<Cow<'r, [Subscript]>, Diagnostic> {
        Ok(reference.parts.last().map_or(&[][..], |part| &part.subscripts).into())
    }
    /// The type of the scalars of a variable that has this path.
    fn value_type(&self, path: &str) -> Option<ValueType>;
    /// What an external object is made by.
    fn constructor_of(&self, object: Self::Scalar) -> Option<Expression> {
        let _ = object;
        None
    }
    /// The value of an expression on which sizes or Strings depend, which cannot change from here
    /// on; `None` if it is not known.
    fn structural_value(&mut self, value: Self::Scalar) -> Option<f64> {
        let _ = value;
        None
    }
}

/// Calls functions of the model, at translation or when what is translated runs.
pub(crate) trait FunctionCalls: Operations {
    /// The model, with its functions and the files that it may use.
    fn flat(&self) -> &FlatModel;
    /// A function of the model; `None` if there is none of this name.
    fn function(&self, name: &Name) -> Option<Arc<Function>> {
        let functions = &self.flat().functions;
        let bare = Name { global: false, parts: name.parts.clone() };
        functions.get(&bare).or_else(|| functions.get(name)).cloned()
    }
    /// Calls a user function with all its arguments.
    fn call(
        &mut self,
        function: &Arc<Function>,
        arguments: Vec<Lowered<Self::Scalar>>,
        span: Span,
    ) -> Result<Vec<Lowered<Self::Scalar>>, Diagnostic>;
    /// As [`FunctionCalls::call`], of a function that the interpreter carries out whenever it is called; `None`
    /// where that is not possible.
    fn interpreted_call(
        &mut self,
        function: &Arc<Function>,
        arguments: &[Lowered<Self::Scalar>],
        span: Span,
    ) -> Option<Vec<Lowered<Self::Scalar>>> {
        let _ = (function, arguments, span);
        None
    }
    /// How many statements the interpreter has run while the model is compiled.
    fn interpreted(&self) -> &Cell<u64>;
    /// Whether the evaluation of the current call will be abandoned: what it needs is not computed.
    fn gives_up(&self) -> bool {
        false
    }
    /// Whether what is translated is evaluated once, when a simulation starts.
    fn runs_once(&self) -> bool {
        false
    }
    /// Takes warnings and notes about the model.
    fn warn(&mut self, warnings: Vec<Diagnostic>) {
        let _ = warnings;
    }
}

/// Makes Strings when what is translated runs. By default there are none.
pub(crate) trait StringOperations: Operations {
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
        Err(computed_string(span))
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
    /// A text is needed that is not known, and that [`StringOperations::composes`] would give.
    fn misses_text(&mut self) {}
    /// Whether parameters on which Strings depend are evaluated, to be switched; `None` where they
    /// cannot be.
    fn evaluates_string_parameters(&mut self) -> Option<&mut bool> {
        None
    }
}

/// Gives operators a meaning in time. FunctionCalls have none (MLS §12.2).
pub(crate) trait TimeOperators: Operations {
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
    /// The outputs of `spatialDistribution`.
    fn spatial_distribution(
        &mut self,
        _arguments: &[Array<Self::Scalar>],
        span: Span,
    ) -> Result<[Self::Scalar; 2], Diagnostic> {
        Err(fault!(NOT_SUPPORTED, "`spatialDistribution` in a function").at(span))
    }
    /// Whether an expression is a clock, which is chosen at translation.
    fn is_clock(&self, e: &Expression) -> bool {
        let _ = e;
        false
    }
}

/// A String that would have to be made at run time.
pub(super) fn computed_string(span: Span) -> Diagnostic {
    fault!(NOT_SUPPORTED, "a String that is computed during the simulation";
        help: "select among Strings that are known at translation")
    .at(span)
}
