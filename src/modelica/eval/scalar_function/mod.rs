//! The quick way to call functions of scalars: inputs, outputs and local variables are scalar
//! numbers or Booleans and the algorithm only calculates. Such a function is compiled once to
//! operations on numbered slots; a call then touches neither names nor the heap.
//!
//! Nothing with an effect is compiled and nothing fails: where anything else stands, a value is
//! missing or a result is out of range, the function is called again in the general way, which
//! gives the same values and the errors.

mod compile;
mod run;

use super::scalar::Scalar;
use crate::functions::Builtin;
use crate::syntax::ast::{BinaryOperator, UnaryOperator};
use std::sync::OnceLock;

/// Slots of a function at most: its components and the variables of its loops.
const MAX_SLOTS: usize = 24;

/// The compiled form of a function, made when it is called first. Equal to every other: it says
/// nothing that the function does not.
#[derive(Default)]
pub struct Compiled(OnceLock<Option<ScalarFunction>>);

impl Clone for Compiled {
    /// Empty: the copy of a function may be changed before it is called.
    fn clone(&self) -> Compiled {
        Compiled::default()
    }
}

impl PartialEq for Compiled {
    fn eq(&self, _: &Compiled) -> bool {
        true
    }
}

impl std::fmt::Debug for Compiled {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Compiled")
    }
}

/// A function of scalars. Slots are numbered: inputs, outputs, local variables, variables of loops.
struct ScalarFunction {
    inputs: usize,
    outputs: usize,
    components: Vec<Component>,
    body: Vec<Instruction>,
}

struct Component {
    kind: SlotType,
    /// Default of an input, initial value of any other.
    binding: Option<Operation>,
}

/// The declared type of a slot.
#[derive(Clone, Copy)]
enum SlotType {
    Real,
    Integer,
    Boolean,
}

impl SlotType {
    /// The value as a slot of this type holds it; `None` if it does not take it.
    fn convert(self, value: Scalar) -> Option<Scalar> {
        match (self, value) {
            (SlotType::Real, Scalar::Integer(value)) => Some(Scalar::Real(value as f64)),
            (SlotType::Real, Scalar::Real(_))
            | (SlotType::Integer, Scalar::Integer(_))
            | (SlotType::Boolean, Scalar::Boolean(_)) => Some(value),
            _ => None,
        }
    }
}

/// An expression.
enum Operation {
    Constant(Scalar),
    Slot(usize),
    Binary(BinaryOperator, Box<[Operation; 2]>),
    Unary(UnaryOperator, Box<Operation>),
    /// Condition, value, value otherwise.
    If(Box<[Operation; 3]>),
    Builtin(&'static Builtin, Vec<Operation>),
}

/// A statement.
enum Instruction {
    Assign { slot: usize, kind: SlotType, value: Operation },
    If { branches: Vec<(Operation, Vec<Instruction>)>, otherwise: Vec<Instruction> },
    For { slot: usize, bounds: Box<Bounds>, body: Vec<Instruction> },
    While { condition: Operation, body: Vec<Instruction> },
    Assert(Operation),
    Break,
    Return,
}

/// `start : step : stop`
struct Bounds {
    start: Operation,
    step: Option<Operation>,
    stop: Operation,
}
