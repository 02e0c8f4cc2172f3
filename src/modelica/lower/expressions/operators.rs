//! Operators on scalars, vectors and matrices (MLS §10.6).

use super::{Array, Binary, Lowered, Lowering, Target, Unary, size_fault};
use crate::diag::{At, Diagnostic, Fault};
use crate::eval::ValueType;
use crate::fault;
use crate::lower::errors::{ARRAY_MISMATCH, NOT_SUPPORTED};
use crate::lower::shape::UNKNOWN_TEXT;
use crate::source::Span;
use crate::symbolic::RelationOperator;
use crate::symbolic::function::{self, INTEGER_ARITHMETIC, LARGEST_INTEGER};
use crate::syntax::ast::{BinaryOperator, Expression};
use crate::value::check_length;
use crate::value::errors::INTEGER_OVERFLOW;
use crate::value::ops::product_sizes;
use std::sync::Arc;

/// The greatest exponent of a matrix.
const MAX_POWER: f64 = 64.0;

/// See [`Lowering::may_be_inexact`].
const SMALL_INTEGER: f64 = 1_048_576.0;

impl<T: Target> Lowering<'_, T> {
    pub(super) fn map_unary(&mut self, op: Unary, mut a: Array<T::Scalar>) -> Array<T::Scalar> {
        for element in &mut a.elements {
            *element = self.target.unary(op, *element);
        }
        a
    }

    /// An Integer is taken from zero, and not negated: it has no negative zero.
    pub(super) fn negated(
        &mut self,
        mut numbers: Array<T::Scalar>,
        operand: &Expression,
    ) -> Array<T::Scalar> {
        let varies = numbers.elements.iter().any(|x| self.target.as_constant(*x).is_none());
        if !varies || self.type_of(operand) != ValueType::Integer {
            return self.map_unary(Unary::Neg, numbers);
        }
        let zero = self.target.constant(0.0);
        for element in &mut numbers.elements {
            *element = self.target.binary(Binary::Sub, zero, *element);
        }
        numbers
    }

    pub(super) fn binary(&mut self, e: &Expression) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let (first, operations) = e.chain();
        let mut lowered = self.lower(first)?;
        for one in operations {
            let left = (lowered, one.left);
            lowered = self.operation(one.operator, left, one.right, one.whole.span)?;
        }
        Ok(lowered)
    }

    fn operation(
        &mut self,
        operator: BinaryOperator,
        (lowered, left): (Lowered<T::Scalar>, &Expression),
        right: &Expression,
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let a = match lowered {
            Lowered::Text(a) => return self.strings(operator, (a, left), right, span),
            Lowered::Numbered(a) => return self.varying_strings(operator, a, right, span),
            Lowered::Array(a) => a,
            Lowered::Record(_) | Lowered::Strings(_) => self.array(left)?,
        };
        if matches!(operator, BinaryOperator::And | BinaryOperator::Or) && a.dims.is_empty() {
            return match self.target.short_circuits() {
                true => self.short_circuit(operator, a.elements[0], right),
                false => self.guarded(operator, a.elements[0], right, span),
            };
        }
        let b = self.array(right)?;
        let is_integer = self.may_be_inexact(operator, [&a, &b])
            && self.type_of(right) == ValueType::Integer
            && self.type_of(left) == ValueType::Integer;
        let array = self.of_arrays(operator, a, b, is_integer, span)?;
        let array = if is_integer { self.exact(array, span)? } else { array };
        Ok(Lowered::Array(array))
    }

    /// Whether Integers may lead beyond those that are exact. A sum with a small number is far from it, and
    /// would have to be made too often: 2^32 such sums do not get from 2^52 to 2^53, and no call has so many
    /// instructions.
    fn may_be_inexact(&self, operator: BinaryOperator, sides: [&Array<T::Scalar>; 2]) -> bool {
        let varies = |array: &Array<T::Scalar>| {
            let is_small = |x: f64| x.abs() <= SMALL_INTEGER;
            let mut elements = array.elements.iter();
            elements.any(|element| !self.target.as_constant(*element).is_some_and(is_small))
        };
        match operator {
            BinaryOperator::Multiply | BinaryOperator::ElementwiseMultiply => true,
            BinaryOperator::Add
            | BinaryOperator::Subtract
            | BinaryOperator::ElementwiseAdd
            | BinaryOperator::ElementwiseSubtract => sides.into_iter().all(varies),
            // That of a scalar is a Real.
            BinaryOperator::Power => !sides[0].dims.is_empty(),
            _ => false,
        }
    }

    /// An operation on numbers; `exact` if all are Integers, as which what it computes on the way must be
    /// exact.
    fn of_arrays(
        &mut self,
        operator: BinaryOperator,
        a: Array<T::Scalar>,
        b: Array<T::Scalar>,
        exact: bool,
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        match operator {
            BinaryOperator::Add => self.same_size(Binary::Add, a, b, span),
            BinaryOperator::Subtract => self.same_size(Binary::Sub, a, b, span),
            BinaryOperator::ElementwiseAdd => self.elementwise(Binary::Add, a, b, span),
            BinaryOperator::ElementwiseSubtract => self.elementwise(Binary::Sub, a, b, span),
            BinaryOperator::ElementwiseMultiply => self.elementwise(Binary::Mul, a, b, span),
            BinaryOperator::ElementwiseDivide => self.elementwise(Binary::Div, a, b, span),
            BinaryOperator::ElementwisePower => self.elementwise(Binary::Pow, a, b, span),
            BinaryOperator::Multiply => self.product(a, b, exact, span),
            BinaryOperator::Divide if b.dims.is_empty() => {
                self.elementwise(Binary::Div, a, b, span)
            }
            BinaryOperator::Divide => Err(fault!(ARRAY_MISMATCH, "the divisor is an array";
                help: "write `./` for element-wise division")
            .at(span)),
            BinaryOperator::Power => self.power(a, b, exact, span),
            BinaryOperator::And => self.same_size(Binary::And, a, b, span),
            BinaryOperator::Or => self.same_size(Binary::Or, a, b, span),
            BinaryOperator::Less => self.compare(RelationOperator::Less, a, b, span),
            BinaryOperator::LessEqual => self.compare(RelationOperator::LessEqual, a, b, span),
            BinaryOperator::Greater => self.compare(RelationOperator::Greater, a, b, span),
            BinaryOperator::GreaterEqual => {
                self.compare(RelationOperator::GreaterEqual, a, b, span)
            }
            BinaryOperator::Equal => self.compare(RelationOperator::Equal, a, b, span),
            BinaryOperator::NotEqual => self.compare(RelationOperator::NotEqual, a, b, span),
        }
    }

    /// A literal.
    pub(super) fn integer(
        &mut self,
        value: i64,
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        let literal = Array::scalar(self.target.constant(value as f64));
        let is_exact = i128::from(value) == value as f64 as i128;
        if is_exact { Ok(literal) } else { self.exact(literal, span) }
    }

    /// Integers that are exact or fail: models compute with Reals.
    pub(super) fn exact(
        &mut self,
        mut integers: Array<T::Scalar>,
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        let Some(arithmetic) = function::find(INTEGER_ARITHMETIC) else { return Ok(integers) };
        for integer in &mut integers.elements {
            *integer = match self.target.as_constant(*integer) {
                Some(known) if known.abs() <= LARGEST_INTEGER => *integer,
                Some(known) => {
                    return Err(fault!(
                        INTEGER_OVERFLOW,
                        "{known} is beyond {LARGEST_INTEGER}, up to which models have exact Integers";
                        help: "use Reals, or a function that a script calls")
                    .at(span));
                }
                None => self.target.apply(arithmetic, &[*integer], true, span)?,
            };
        }
        Ok(integers)
    }

    /// `a and b` as `if a then b else false`, `a or b` as `if a then true else b`.
    fn short_circuit(
        &mut self,
        operator: BinaryOperator,
        a: T::Scalar,
        right: &Expression,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let is_and = operator == BinaryOperator::And;
        if let Some(known) = self.target.as_constant(a) {
            return match (known != 0.0) == is_and {
                true => Ok(Lowered::scalar(self.scalar(right)?)),
                false => Ok(Lowered::scalar(a)),
            };
        }
        let decided = self.target.constant(f64::from(u8::from(!is_and)));
        let mut branch = self.target.begin_if(a);
        let first = if is_and { self.scalar(right)? } else { decided };
        self.target.begin_else(&mut branch, &[first]);
        let second = if is_and { decided } else { self.scalar(right)? };
        let values = self.target.end_if(branch, &[second]);
        Ok(Lowered::scalar(values[0]))
    }

    /// `a and b`, `a or b` of a model: b may be what has a value only where a does not decide, as
    /// in `n > 0 and v[1] > 2`.
    fn guarded(
        &mut self,
        operator: BinaryOperator,
        a: T::Scalar,
        right: &Expression,
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let is_and = operator == BinaryOperator::And;
        let decides = |a: Option<f64>| a.is_some_and(|a| (a != 0.0) != is_and);
        if decides(self.target.as_constant(a)) {
            return Ok(Lowered::scalar(a));
        }
        let b = match self.branch(a, is_and, |own| own.array(right)) {
            Ok(b) => b,
            Err(error) => {
                let known = self.target.structural_value(a);
                return if decides(known) { Ok(Lowered::scalar(a)) } else { Err(error) };
            }
        };
        if let ([b], true) = (b.elements.as_slice(), b.dims.is_empty()) {
            return Ok(Lowered::scalar(self.target.connective(is_and, a, *b)));
        }
        let operation = if is_and { Binary::And } else { Binary::Or };
        self.same_size(operation, Array::scalar(a), b, span).map(Lowered::Array)
    }

    /// Two Strings joined, which may be unknown in parts, or a relation of two that are known.
    fn strings(
        &mut self,
        operator: BinaryOperator,
        (a, left): (Arc<str>, &Expression),
        right: &Expression,
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let b = match self.lower(right)? {
            Lowered::Text(b) => b,
            b @ Lowered::Numbered(_) if operator == BinaryOperator::Add && self.composes => {
                return self.composed_sum([Lowered::Text(a), b], span);
            }
            Lowered::Numbered(_) if operator == BinaryOperator::Add => UNKNOWN_TEXT.into(),
            Lowered::Numbered(b) => {
                let a = match a.contains(UNKNOWN_TEXT) {
                    true => self.run_time_string(left)?,
                    false => Lowered::Text(a),
                };
                let a = self.number_of_text(a, span)?;
                return self.compare_strings(operator, a, b, span);
            }
            _ => return Err(not_a_string(operator).at(span)),
        };
        let a = &*a;
        if operator == BinaryOperator::Add {
            check_length(a.len().saturating_add(b.len())).at(span)?;
            return Ok(Lowered::Text(format!("{a}{b}").into()));
        }
        if (a.contains(UNKNOWN_TEXT) || b.contains(UNKNOWN_TEXT))
            && matches!(operator, BinaryOperator::Equal | BinaryOperator::NotEqual)
            && self.target.composes()
        {
            let sides = [self.run_time_string(left)?, self.run_time_string(right)?];
            let [a, b] = sides.map(|side| self.number_of_text(side, span));
            return self.compare_strings(operator, a?, b?, span);
        }
        if a.contains(UNKNOWN_TEXT) || b.contains(UNKNOWN_TEXT) {
            self.target.misses_text();
            return Err(fault!(NOT_SUPPORTED, "a text that is unknown at translation").at(span));
        }
        let holds = match operator {
            BinaryOperator::Equal => a == &*b,
            BinaryOperator::NotEqual => a != &*b,
            BinaryOperator::Less => a < &*b,
            BinaryOperator::LessEqual => a <= &*b,
            BinaryOperator::Greater => a > &*b,
            BinaryOperator::GreaterEqual => a >= &*b,
            _ => {
                return Err(
                    fault!(NOT_SUPPORTED, "this operator does not support Strings").at(span)
                );
            }
        };
        Ok(Lowered::scalar(self.target.constant(f64::from(u8::from(holds)))))
    }

    fn compare(
        &mut self,
        operator: RelationOperator,
        a: Array<T::Scalar>,
        b: Array<T::Scalar>,
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        match (a.dims.as_slice(), b.dims.as_slice(), a.elements.as_slice(), b.elements.as_slice()) {
            ([], [], [a], [b]) => {
                Ok(Array::scalar(self.target.relation(operator, *a, *b, self.live, span)))
            }
            _ => Err(fault!(ARRAY_MISMATCH, "a relation needs scalar operands").at(span)),
        }
    }

    fn same_size(
        &mut self,
        op: Binary,
        a: Array<T::Scalar>,
        b: Array<T::Scalar>,
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        if a.dims != b.dims {
            return Err(size_fault(&a.dims, &b.dims).at(span));
        }
        self.elementwise(op, a, b, span)
    }

    /// Element by element; a scalar goes with every element.
    fn elementwise(
        &mut self,
        op: Binary,
        a: Array<T::Scalar>,
        b: Array<T::Scalar>,
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        let (dims, elements) = if a.dims == b.dims {
            let pairs = a.elements.iter().zip(&b.elements);
            (a.dims, pairs.map(|(x, y)| self.target.binary(op, *x, *y)).collect())
        } else if b.dims.is_empty() {
            let y = b.elements[0];
            (a.dims, a.elements.iter().map(|x| self.target.binary(op, *x, y)).collect())
        } else if a.dims.is_empty() {
            let x = a.elements[0];
            (b.dims, b.elements.iter().map(|y| self.target.binary(op, x, *y)).collect())
        } else {
            return Err(size_fault(&a.dims, &b.dims).at(span));
        };
        Ok(Array { dims, elements })
    }

    /// `*`: scaling, inner product, matrix products (MLS §10.6.5).
    fn product(
        &mut self,
        a: Array<T::Scalar>,
        b: Array<T::Scalar>,
        exact: bool,
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        if a.dims.is_empty() || b.dims.is_empty() {
            return self.elementwise(Binary::Mul, a, b, span);
        }
        let sizes = product_sizes(&a.dims, &b.dims).filter(|((inner, other), _)| inner == other);
        let Some(((inner, _), dims)) = sizes else {
            return Err(size_fault(&a.dims, &b.dims).at(span));
        };
        let rows: usize = a.dims[..a.dims.len() - 1].iter().product();
        let columns: usize = b.dims[1..].iter().product();
        let mut elements = Vec::with_capacity(rows * columns);
        for row in 0..rows {
            for column in 0..columns {
                let factors = (0..inner)
                    .map(|k| (a.elements[row * inner + k], b.elements[k * columns + column]));
                let products = factors.map(|(x, y)| self.target.binary(Binary::Mul, x, y));
                let products = Array::vector(products.collect());
                let products = if exact { self.exact(products, span)? } else { products };
                elements.push(self.fold(Binary::Add, 0.0, &products.elements, exact, span)?);
            }
        }
        Ok(Array { dims, elements })
    }

    fn power(
        &mut self,
        a: Array<T::Scalar>,
        b: Array<T::Scalar>,
        exact: bool,
        span: Span,
    ) -> Result<Array<T::Scalar>, Diagnostic> {
        if a.dims.is_empty() && b.dims.is_empty() {
            return self.elementwise(Binary::Pow, a, b, span);
        }
        let exponent = match (b.dims.as_slice(), b.elements.as_slice()) {
            ([], [b]) => self.target.as_constant(*b),
            _ => None,
        };
        let &[n, m] = a.dims.as_slice() else {
            return Err(
                fault!(ARRAY_MISMATCH, "`^` needs scalars, or a square matrix and a whole number";
                help: "write `.^` for the element-wise power")
                .at(span),
            );
        };
        let Some(exponent) = exponent else {
            return Err(fault!(
                NOT_SUPPORTED,
                "a matrix to a power that is unknown at translation"
            )
            .at(span));
        };
        if n != m || exponent < 0.0 || exponent.fract() != 0.0 {
            return Err(fault!(ARRAY_MISMATCH,
                "the power of a matrix needs a square matrix and a whole number, 0 or more";
                help: "write `.^` for the element-wise power")
            .at(span));
        }
        if exponent > MAX_POWER {
            return Err(fault!(
                NOT_SUPPORTED,
                "the power of a matrix with an exponent above {MAX_POWER}"
            )
            .at(span));
        }
        if exponent == 0.0 {
            return Ok(self.identity(n));
        }
        let mut result = a.clone();
        for _ in 1..exponent as usize {
            result = self.product(result, a.clone(), exact, span)?;
        }
        Ok(result)
    }

    fn identity(&mut self, n: usize) -> Array<T::Scalar> {
        let element = |at: usize| if at / n == at % n { 1.0 } else { 0.0 };
        let elements = (0..n * n).map(|at| self.target.constant(element(at))).collect();
        Array { dims: vec![n, n], elements }
    }

    /// `a op b op …`; `empty` without elements. Of Integers, what it comes to on the way is exact as well.
    pub(super) fn fold(
        &mut self,
        op: Binary,
        empty: f64,
        elements: &[T::Scalar],
        exact: bool,
        span: Span,
    ) -> Result<T::Scalar, Diagnostic> {
        let Some((first, rest)) = elements.split_first() else {
            return Ok(self.target.constant(empty));
        };
        rest.iter().try_fold(*first, |total, element| {
            let total = Array::scalar(self.target.binary(op, total, *element));
            Ok(if exact { self.exact(total, span)? } else { total }.elements[0])
        })
    }
}

/// The fault of an operator whose left side is a String, and the right side none.
fn not_a_string(operator: BinaryOperator) -> Fault {
    match operator {
        BinaryOperator::Add => fault!(
            ARRAY_MISMATCH,
            "`+` joins Strings, but the right side is none";
            help: "write `String(x)`"
        ),
        _ => fault!(ARRAY_MISMATCH, "comparing a String with a number"),
    }
}
