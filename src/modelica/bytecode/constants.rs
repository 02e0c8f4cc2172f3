//! Registers that hold constants: machine code has their numbers in it, so that few functions need
//! them in their frames before something is left to the interpreter.

use super::code::{Code, Functions, Instruction};
use crate::arithmetic::Register;
use rustc_hash::FxHashMap;

/// Some registers in a row: the first, and how many.
type Row = (Register, u32);

/// Registers with the numbers that they always hold.
pub(super) fn constants_of(functions: &Functions, code: &Code) -> FxHashMap<Register, f64> {
    if !code.externals.is_empty() {
        // They write where their arguments are.
        return FxHashMap::default();
    }
    let mut constants: FxHashMap<Register, f64> = code.constants.iter().copied().collect();
    for (first, n) in code.instructions.iter().filter_map(|i| written(functions, i)) {
        constants.retain(|register, _| !(first..first + n).contains(register));
    }
    constants
}

/// Whether something reads constants from the frame as machine code runs, which copies and checks
/// rows up to `short` one by one.
pub(super) fn reads_constants(functions: &Functions, code: &Code, short: u32) -> bool {
    let holds_constants = |(first, n): Row| {
        code.constants.iter().any(|(register, _)| (first..first + n).contains(register))
    };
    !code.externals.is_empty()
        || holds_constants((code.outputs, code.n_outputs))
        || code
            .instructions
            .iter()
            .filter_map(|i| read(functions, code, i, short))
            .any(holds_constants)
}

/// The row that an instruction writes at a known place.
pub(super) fn written(functions: &Functions, instruction: &Instruction) -> Option<Row> {
    match *instruction {
        Instruction::Unassign { d, n } | Instruction::Move { d, n, .. } => Some((d, n)),
        Instruction::Call { function, d, .. } => {
            Some((d, functions.codes[function as usize].n_outputs))
        }
        Instruction::Operation(operation) => Some((operation.d, 1)),
        Instruction::Constant { d, .. }
        | Instruction::Offset { d, .. }
        | Instruction::Load { d, .. }
        | Instruction::Iterations { d, .. } => Some((d, 1)),
        _ => None,
    }
}

/// The row that machine code of an instruction reads from the frame, whatever is known of it.
fn read(functions: &Functions, code: &Code, instruction: &Instruction, short: u32) -> Option<Row> {
    match *instruction {
        Instruction::Move { a, n, .. } | Instruction::Check { a, n } if n > short => Some((a, n)),
        Instruction::Iterations { range, .. } => Some((range, 3)),
        Instruction::Load { base, .. } => Some((base, code.frame.saturating_sub(base))),
        Instruction::Call { function, a, .. } => {
            Some((a, functions.codes[function as usize].n_inputs))
        }
        _ => None,
    }
}
