//! Execution of code on the registers of a system, with failures that say which operation of which
//! equation failed.

use crate::codegen::memory::Memory;
use crate::codegen::program::Outputs;
use crate::codegen::tape::{Instruction, Tape};
use crate::sim::Failure;
use crate::symbolic::function;

/// Computes the outputs of code that computes nothing else.
pub(super) fn read(code: &Outputs, registers: &mut Memory, out: &mut [f64]) -> Result<(), Failure> {
    if code.machine_code.run(code, registers, out) {
        return Ok(());
    }
    run(&code.tape, registers)?;
    for (value, register) in out.iter_mut().zip(&code.outputs) {
        *value = registers[*register as usize];
    }
    Ok(())
}

/// Runs a tape; a failure says which operation of which equation.
pub(super) fn run(tape: &Tape, registers: &mut Memory) -> Result<(), Failure> {
    tape.run(registers).map_err(|at| {
        let code = match tape.code[at as usize] {
            Instruction::Unary { id, .. } | Instruction::Binary { id, .. } => {
                function::functions().position(|(known, _)| known == id).map_or(0xff, |n| n + 2)
            }
            Instruction::Call { .. } => {
                if let Some(failure) = registers.calls.failure {
                    return Failure::Function {
                        function: failure.function,
                        at: failure.at,
                        reason: failure.reason as u8,
                    };
                }
                0
            }
            Instruction::Given { function, .. } => {
                return Failure::Function {
                    function,
                    at: registers.calls.end_of(function),
                    reason: crate::bytecode::Reason::Unassigned as u8,
                };
            }
            Instruction::Pow { .. } => 1,
            _ => 0,
        };
        let origin = tape.origin(at).min(u32::MAX >> 8);
        Failure::Domain { place: (origin << 8) | code.min(0xff) as u32 }
    })
}
