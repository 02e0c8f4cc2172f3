//! The instructions of tapes, and what they work on.

use crate::arithmetic::{Operation, Register};
use crate::symbolic::function::Function;

/// One instruction; `d` is the register written.
#[derive(Debug, Clone, Copy, serde::Serialize, serde::Deserialize)]
pub(crate) enum Instruction {
    Move {
        d: Register,
        a: Register,
    },
    Operation(Operation),
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

impl From<Operation> for Instruction {
    fn from(operation: Operation) -> Instruction {
        Instruction::Operation(operation)
    }
}

impl Instruction {
    /// The mathematical function that it calls.
    pub(super) fn function(&self) -> Option<&'static Function> {
        match self {
            Instruction::Operation(operation) => operation.operator.function(),
            _ => None,
        }
    }

    /// Visits the registers read, but for those of calls and linear systems.
    pub(super) fn for_each_operand(&self, mut visit: impl FnMut(Register)) {
        match *self {
            Instruction::Move { a, .. }
            | Instruction::Given { a, .. }
            | Instruction::JumpUnless { a, .. } => visit(a),
            Instruction::Operation(Operation { a, b, .. }) => {
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
            | Instruction::Operation(Operation { d, .. })
            | Instruction::Given { d, .. } => Some(d),
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
