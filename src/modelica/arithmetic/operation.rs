//! The operations of instructions: the same for tapes and functions, values and derivatives,
//! interpreters and machine code.

use super::elementary::{Elementary, by_number};
use super::number::Number;
use crate::symbolic::function::Function;
use crate::symbolic::{Expr, Node, RelationOperator};

/// A register.
pub(crate) type Register = u32;

/// What an operation computes of one operand, or of two. Truth is 1 or 0, and what is not 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub enum Operator {
    /// `-a`
    Neg,
    /// `not a`
    Not,
    /// `a + b`
    Add,
    /// `a - b`
    Sub,
    /// `a * b`
    Mul,
    /// `a / b`
    Div,
    /// `a ^ b`
    Pow,
    /// `a and b`
    And,
    /// `a or b`
    Or,
    /// Whether a relation holds.
    Relation(RelationOperator),
    /// A function of one argument.
    Unary(#[serde(with = "by_number")] &'static Elementary),
    /// A function of two arguments.
    Binary(#[serde(with = "by_number")] &'static Elementary),
}

impl Operator {
    /// The operator of a node with its operands, the second of which is the first again if there is
    /// one alone; `None` if the node is something else.
    pub(crate) fn of_node(node: &Node) -> Option<(Operator, Expr, Expr)> {
        Some(match node {
            Node::Neg(a) => (Operator::Neg, *a, *a),
            Node::Not(a) => (Operator::Not, *a, *a),
            Node::Add(a, b) => (Operator::Add, *a, *b),
            Node::Sub(a, b) => (Operator::Sub, *a, *b),
            Node::Mul(a, b) => (Operator::Mul, *a, *b),
            Node::Div(a, b) => (Operator::Div, *a, *b),
            Node::Pow(a, b) => (Operator::Pow, *a, *b),
            Node::And(a, b) => (Operator::And, *a, *b),
            Node::Or(a, b) => (Operator::Or, *a, *b),
            Node::Relation(operator, a, b) => (Operator::Relation(*operator), *a, *b),
            Node::Apply(id, arguments) => {
                let (function, a) = (Elementary::of(*id), arguments.first());
                match arguments.second() {
                    None => (Operator::Unary(function), a, a),
                    Some(b) => (Operator::Binary(function), a, b),
                }
            }
            Node::Constant(_)
            | Node::Variable(_)
            | Node::If(..)
            | Node::Call { .. }
            | Node::CallDerivative { .. }
            | Node::List(_)
            | Node::Solution { .. } => return None,
        })
    }

    /// The function of the table that it is.
    pub(crate) fn function(self) -> Option<&'static Function> {
        match self {
            Operator::Unary(function) | Operator::Binary(function) => Some(function.id.get()),
            _ => None,
        }
    }

    /// Whether a function takes as many operands as there are.
    pub(crate) fn is_valid(self) -> bool {
        match self {
            Operator::Unary(function) => function.id.get().arity() == 1,
            Operator::Binary(function) => function.id.get().arity() == 2,
            _ => true,
        }
    }

    /// Whether finite operands may have no finite value.
    #[inline(always)]
    pub(crate) fn may_fail(self) -> bool {
        matches!(self, Operator::Div | Operator::Pow | Operator::Unary(_) | Operator::Binary(_))
    }

    /// Whether operands without value (NaN) may have one.
    #[inline(always)]
    pub(crate) fn hides_nan(self) -> bool {
        matches!(
            self,
            Operator::Not
                | Operator::And
                | Operator::Or
                | Operator::Relation(_)
                | Operator::Pow
                | Operator::Binary(_)
        )
    }

    /// The value; those of one operand do not look at the second.
    #[inline(always)]
    pub(crate) fn of<T: Number>(self, a: T, b: T) -> T {
        let truth = |holds: bool| T::constant(f64::from(u8::from(holds)));
        match self {
            Operator::Neg => a.neg(),
            Operator::Not => truth(a.value() == 0.0),
            Operator::Add => a.add(b),
            Operator::Sub => a.sub(b),
            Operator::Mul => a.mul(b),
            Operator::Div => a.div(b),
            Operator::Pow => a.pow(b),
            Operator::And => truth(a.value() != 0.0 && b.value() != 0.0),
            Operator::Or => truth(a.value() != 0.0 || b.value() != 0.0),
            Operator::Relation(operator) => truth(operator.holds(a.value(), b.value())),
            Operator::Unary(function) => a.unary(function),
            Operator::Binary(function) => a.binary(b, function),
        }
    }

    /// Whether the value for an operand is beyond the largest number as in IEEE 754: it is then
    /// infinite until a variable takes it.
    pub(crate) fn overflows_at(self, a: f64) -> bool {
        a.is_finite() && self.function().is_some_and(|function| function.overflows)
    }
}

/// An operation on registers: `d` is the one written, `a` and `b` are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Operation {
    /// What is computed.
    pub operator: Operator,
    /// The register written.
    pub d: Register,
    /// The first operand.
    pub a: Register,
    /// The second operand; the first again if there is one alone.
    pub b: Register,
}

impl Operation {
    /// Of one operand.
    pub(crate) fn unary(operator: Operator, d: Register, a: Register) -> Operation {
        Operation { operator, d, a, b: a }
    }

    /// Of two operands.
    pub(crate) fn binary(operator: Operator, d: Register, a: Register, b: Register) -> Operation {
        Operation { operator, d, a, b }
    }

    /// The value for what the registers hold.
    #[inline(always)]
    pub(crate) fn value<T: Number>(&self, r: &[T]) -> T {
        self.operator.of(r[self.a as usize], r[self.b as usize])
    }
}
