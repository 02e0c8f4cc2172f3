//! Operations that lean to the left, as the terms of a sum do (MLS §A.2.7, `arithmetic_expression`):
//! a list of operands, however long, is walked by a loop. Nothing that reads expressions may go down
//! into left operands by recursion.

use super::{BinaryOperator, Expression, ExpressionKind};
use crate::source::Span;
use std::fmt;
use std::mem;
use std::ops::{Deref, DerefMut};

/// One operation of a chain.
#[derive(Debug, Clone, Copy)]
pub struct Operation<'e> {
    /// The operation with all before it.
    pub whole: &'e Expression,
    /// The operator.
    pub operator: BinaryOperator,
    /// All before it.
    pub left: &'e Expression,
    /// The operand that it adds.
    pub right: &'e Expression,
}

/// One operation of a chain, to be changed.
#[derive(Debug)]
pub struct OperationMut<'e> {
    /// The place of the operation with all before it.
    pub span: &'e mut Span,
    /// The operator.
    pub operator: BinaryOperator,
    /// The operand that it adds.
    pub right: &'e mut Expression,
}

impl Expression {
    /// An operation of two operands.
    pub fn operation(
        operator: BinaryOperator,
        left: Expression,
        right: Expression,
        span: Span,
    ) -> Expression {
        let (left, right) = (left.into(), Box::new(right));
        Expression::new(ExpressionKind::Binary { operator, left, right }, span)
    }

    /// The first operand of a chain of operations, and the operations from left to right; none for any
    /// other expression.
    pub fn chain(&self) -> (&Expression, Vec<Operation<'_>>) {
        let (mut first, mut operations) = (self, Vec::new());
        while let ExpressionKind::Binary { operator, left, right } = &first.kind {
            operations.push(Operation { whole: first, operator: *operator, left, right });
            first = left;
        }
        operations.reverse();
        (first, operations)
    }

    /// The operands of a chain of operations, from left to right; any other expression is its own.
    pub fn operands(&self) -> impl Iterator<Item = &Expression> {
        self.operands_of(|_| true)
    }

    /// As [`Expression::operands`], of a chain of these operators; what is left of another operator is
    /// one operand.
    pub fn operands_of(
        &self,
        belongs: impl Fn(BinaryOperator) -> bool,
    ) -> impl Iterator<Item = &Expression> {
        let (mut first, mut operands) = (self, Vec::new());
        while let ExpressionKind::Binary { operator, left, right } = &first.kind
            && belongs(*operator)
        {
            operands.push(&**right);
            first = left;
        }
        std::iter::once(first).chain(operands.into_iter().rev())
    }

    /// The first operand, and the operations with their places and right operands from left to right, to
    /// be changed.
    pub fn chain_mut(&mut self) -> (&mut Expression, Vec<OperationMut<'_>>) {
        let (mut first, mut operations) = (self, Vec::new());
        while let Expression { kind: ExpressionKind::Binary { operator, left, right }, span } =
            first
        {
            operations.push(OperationMut { span, operator: *operator, right });
            first = left;
        }
        operations.reverse();
        (first, operations)
    }
}

/// The left operand of an operation: it is copied, compared and freed without recursion.
pub struct LeftOperand(Box<Expression>);

impl LeftOperand {
    fn take(&mut self) -> Expression {
        let span = self.0.span;
        mem::replace(&mut *self.0, Expression::new(ExpressionKind::End, span))
    }
}

impl From<Expression> for LeftOperand {
    fn from(expression: Expression) -> LeftOperand {
        LeftOperand(Box::new(expression))
    }
}

impl Deref for LeftOperand {
    type Target = Expression;

    fn deref(&self) -> &Expression {
        &self.0
    }
}

impl DerefMut for LeftOperand {
    fn deref_mut(&mut self) -> &mut Expression {
        &mut self.0
    }
}

impl Drop for LeftOperand {
    fn drop(&mut self) {
        let mut rest = self.take();
        while let ExpressionKind::Binary { left, .. } = &mut rest.kind {
            rest = left.take();
        }
    }
}

impl Clone for LeftOperand {
    fn clone(&self) -> LeftOperand {
        let (first, operations) = self.chain();
        let copy = operations.into_iter().fold(first.clone(), |left, one| {
            Expression::operation(one.operator, left, one.right.clone(), one.whole.span)
        });
        copy.into()
    }
}

impl PartialEq for LeftOperand {
    fn eq(&self, other: &LeftOperand) -> bool {
        let ((a, own), (b, others)) = (self.chain(), other.chain());
        let same = |(a, b): (Operation<'_>, Operation<'_>)| {
            a.operator == b.operator && a.whole.span == b.whole.span && a.right == b.right
        };
        own.len() == others.len() && a == b && own.into_iter().zip(others).all(same)
    }
}

impl fmt::Debug for LeftOperand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}
