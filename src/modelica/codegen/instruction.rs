//! The instructions of tapes, and what they work on.

use crate::symbolic::RelationOperator;
use crate::symbolic::function::{FunctionId, Value};

/// A register.
pub(crate) type Register = u32;

/// One instruction; `d` is the register written.
#[derive(Debug, Clone, Copy, serde::Serialize, serde::Deserialize)]
pub(crate) enum Instruction {
    Move {
        d: Register,
        a: Register,
    },
    Neg {
        d: Register,
        a: Register,
    },
    Not {
        d: Register,
        a: Register,
    },
    Add {
        d: Register,
        a: Register,
        b: Register,
    },
    Sub {
        d: Register,
        a: Register,
        b: Register,
    },
    Mul {
        d: Register,
        a: Register,
        b: Register,
    },
    Div {
        d: Register,
        a: Register,
        b: Register,
    },
    Pow {
        d: Register,
        a: Register,
        b: Register,
    },
    And {
        d: Register,
        a: Register,
        b: Register,
    },
    Or {
        d: Register,
        a: Register,
        b: Register,
    },
    Relation {
        operator: RelationOperator,
        d: Register,
        a: Register,
        b: Register,
    },
    Unary {
        id: FunctionId,
        d: Register,
        a: Register,
        #[serde(skip, default = "unlinked")]
        function: fn(f64) -> f64,
    },
    Binary {
        id: FunctionId,
        d: Register,
        a: Register,
        b: Register,
        #[serde(skip, default = "unlinked_binary")]
        function: fn(f64, f64) -> f64,
    },
    /// The call of this number in the tape.
    Call {
        call: u32,
    },
    /// A component of a record that a function gave: one without value fails, or is zero.
    Given {
        d: Register,
        a: Register,
        is_zero: bool,
        function: u32,
    },
    /// The linear system of this number in the tape.
    Solve {
        solve: u32,
    },
    JumpUnless {
        a: Register,
        target: u32,
    },
    Jump {
        target: u32,
    },
    /// Runs the routine at the target unless it has run; the link keeps the way back.
    Perform {
        target: u32,
        link: Register,
    },
    /// Ends a routine.
    Return {
        link: Register,
    },
}

/// In place of a function until [`Instruction::linked`].
fn unlinked() -> fn(f64) -> f64 {
    |_| f64::NAN
}

/// In place of a function until [`Instruction::linked`].
fn unlinked_binary() -> fn(f64, f64) -> f64 {
    |_, _| f64::NAN
}

impl Instruction {
    /// An instruction read from a file with the function that it calls.
    fn linked(self) -> Instruction {
        match (self, self.function().map(|id| id.get().value)) {
            (Instruction::Unary { id, d, a, .. }, Some(Value::Unary(function))) => {
                Instruction::Unary { id, d, a, function }
            }
            (Instruction::Binary { id, d, a, b, .. }, Some(Value::Binary(function))) => {
                Instruction::Binary { id, d, a, b, function }
            }
            (other, _) => other,
        }
    }

    /// The mathematical function that it calls.
    pub(super) fn function(self) -> Option<FunctionId> {
        match self {
            Instruction::Unary { id, .. } | Instruction::Binary { id, .. } => Some(id),
            _ => None,
        }
    }

    /// Visits the registers read, but for those of calls and linear systems.
    pub(super) fn for_each_operand(&self, mut visit: impl FnMut(Register)) {
        match *self {
            Instruction::Move { a, .. }
            | Instruction::Neg { a, .. }
            | Instruction::Not { a, .. }
            | Instruction::Unary { a, .. }
            | Instruction::Given { a, .. }
            | Instruction::JumpUnless { a, .. } => visit(a),
            Instruction::Add { a, b, .. }
            | Instruction::Sub { a, b, .. }
            | Instruction::Mul { a, b, .. }
            | Instruction::Div { a, b, .. }
            | Instruction::Pow { a, b, .. }
            | Instruction::And { a, b, .. }
            | Instruction::Or { a, b, .. }
            | Instruction::Relation { a, b, .. }
            | Instruction::Binary { a, b, .. } => {
                visit(a);
                visit(b);
            }
            Instruction::Call { .. }
            | Instruction::Solve { .. }
            | Instruction::Jump { .. }
            | Instruction::Perform { .. }
            | Instruction::Return { .. } => {}
        }
    }

    /// The register written, but for those of calls and linear systems.
    pub(super) fn result(&self) -> Option<Register> {
        match *self {
            Instruction::Move { d, .. }
            | Instruction::Neg { d, .. }
            | Instruction::Not { d, .. }
            | Instruction::Unary { d, .. }
            | Instruction::Add { d, .. }
            | Instruction::Sub { d, .. }
            | Instruction::Mul { d, .. }
            | Instruction::Div { d, .. }
            | Instruction::Pow { d, .. }
            | Instruction::And { d, .. }
            | Instruction::Or { d, .. }
            | Instruction::Relation { d, .. }
            | Instruction::Given { d, .. }
            | Instruction::Binary { d, .. } => Some(d),
            Instruction::Call { .. }
            | Instruction::Solve { .. }
            | Instruction::Jump { .. }
            | Instruction::JumpUnless { .. }
            | Instruction::Perform { .. }
            | Instruction::Return { .. } => None,
        }
    }

    /// The instruction relative to code that begins later.
    pub(super) fn shift(&mut self, by: u32) {
        if let Instruction::Jump { target } | Instruction::JumpUnless { target, .. } = self {
            *target += by;
        }
    }
}

/// A call of a function: its scalar outputs, or their derivatives for some inputs, are written to
/// registers in a row.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(super) struct Call {
    pub(super) function: u32,
    pub(super) inputs: Box<[u32]>,
    pub(super) arguments: Box<[Register]>,
    pub(super) d: Register,
}

/// Solves A x = b.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub(super) struct LinearSolve {
    /// The workspace.
    pub(super) system: u32,
    /// Places in A, by rows, with the registers of the entries that are not always zero; `None` if
    /// A is that of the instruction before on the same workspace.
    pub(super) entries: Option<Box<[(u32, Register)]>>,
    pub(super) right: Box<[Register]>,
    /// Register of the first unknown; the others follow.
    pub(super) d: Register,
    /// Whether b need not fit to a singular A.
    pub(super) is_derivative: bool,
}

/// Instructions from a file, with the functions that they call.
pub(super) fn read_linked<'de, D: serde::Deserializer<'de>>(
    source: D,
) -> Result<Vec<Instruction>, D::Error> {
    let read: Vec<Instruction> = serde::Deserialize::deserialize(source)?;
    Ok(read.into_iter().map(Instruction::linked).collect())
}
