//! Execution of code on the registers of a system, with failures that say which operation of which
//! equation failed.

use crate::arithmetic::{Operation, Operator};
use crate::codegen::code::{CompiledLoop, CompiledRun, Outputs};
use crate::codegen::instruction::Instruction;
use crate::codegen::memory::Memory;
use crate::codegen::tape::Tape;
use crate::sim::Failure;
use crate::symbolic::VarId;
use crate::symbolic::function::{self, Function};

/// Computes the outputs of code that computes nothing else.
pub fn read(code: &Outputs, registers: &mut Memory, out: &mut [f64]) -> Result<(), Failure> {
    if code.machine_code.run(&code.tape, &code.outputs, registers, out) {
        return Ok(());
    }
    run(&code.tape, registers)?;
    for (value, register) in out.iter_mut().zip(&code.outputs) {
        *value = registers[*register as usize];
    }
    match registers.overflow {
        Some(at) if !out.iter().all(|value| value.is_finite()) => {
            Err(failure(&code.tape, registers, at))
        }
        _ => Ok(()),
    }
}

/// The operation that had no value, and its number in a [`Failure::Domain`].
#[derive(Debug, Clone, Copy)]
pub enum FailedOperation {
    /// A division, or another operation that overflowed.
    Division,
    /// A power.
    Power,
    /// A function of the table.
    Function(&'static Function),
    /// Another one.
    Other,
}

impl FailedOperation {
    pub(crate) const DIVISION: u32 = 0;
    pub const POWER: u32 = 1;
    pub const OTHER: u32 = u32::MAX;
    /// The number of the first function.
    const FUNCTIONS: u32 = 2;

    /// The number of an operator that failed.
    fn of_operator(operator: Operator) -> u32 {
        match operator {
            Operator::Pow => FailedOperation::POWER,
            Operator::Unary(function) | Operator::Binary(function) => {
                let at = function::functions().position(|(known, _)| known == function.id);
                at.map_or(FailedOperation::OTHER, |at| FailedOperation::FUNCTIONS + at as u32)
            }
            _ => FailedOperation::DIVISION,
        }
    }

    /// The operation of a number.
    pub fn of(number: u32) -> FailedOperation {
        match number {
            FailedOperation::DIVISION => FailedOperation::Division,
            FailedOperation::POWER => FailedOperation::Power,
            _ => function::functions()
                .nth((number - FailedOperation::FUNCTIONS) as usize)
                .map_or(FailedOperation::Other, |(_, function)| {
                    FailedOperation::Function(function)
                }),
        }
    }
}

/// Runs a tape; a failure says which operation of which equation.
pub fn run(tape: &Tape, registers: &mut Memory) -> Result<(), Failure> {
    tape.run(registers).map_err(|at| failure(tape, registers, at))
}

/// Runs assignments, whose results stay in the registers.
pub(crate) fn run_assignments(code: &CompiledRun, registers: &mut Memory) -> Result<(), Failure> {
    match code.machine_code.run_in_place(&code.tape, [&[], &[]], registers) {
        true => Ok(()),
        false => run(&code.tape, registers),
    }
}

/// Computes residuals and Jacobian of a loop from its unknowns, in the registers.
pub(crate) fn run_loop(torn: &CompiledLoop, registers: &mut Memory) -> Result<(), Failure> {
    let others = [&*torn.residuals, &*torn.jacobian];
    if !torn.machine_code.run_in_place(&torn.tape, others, registers) {
        return run(&torn.tape, registers);
    }
    registers[torn.has_residuals as usize] = 1.0;
    Ok(())
}

/// Runs a tape where what it computes is used long after: an overflow is a failure at once.
pub(crate) fn run_strictly(tape: &Tape, registers: &mut Memory) -> Result<(), Failure> {
    run(tape, registers)?;
    match registers.overflow {
        Some(at) => Err(failure(tape, registers, at)),
        None => Ok(()),
    }
}

/// Computes a parameter. One that a function leaves without value is not a number, and the failure
/// that it is to who reads it is returned: records are passed of which the case at hand needs a part.
pub(crate) fn run_parameter(
    parameter: VarId,
    tape: &Tape,
    registers: &mut Memory,
) -> Result<Option<Failure>, Failure> {
    registers.calls.keeps_unassigned = true;
    let result = tape.run(registers);
    registers.calls.keeps_unassigned = false;
    match result {
        Err(at) if tape.lacking(at).is_some() => {
            registers[parameter.0 as usize] = f64::NAN;
            Ok(Some(failure(tape, registers, at)))
        }
        Err(at) => Err(failure(tape, registers, at)),
        Ok(()) => registers.overflow.map_or(Ok(None), |at| Err(failure(tape, registers, at))),
    }
}

/// The failure of an instruction.
fn failure(tape: &Tape, registers: &Memory, at: u32) -> Failure {
    let operation = match tape.code[at as usize] {
        Instruction::Operation(Operation { operator, .. }) => {
            FailedOperation::of_operator(operator)
        }
        Instruction::Call { .. } => {
            if let Some(failure) = &registers.calls.failure {
                return failure.into();
            }
            FailedOperation::DIVISION
        }
        Instruction::Given { function, .. } => {
            return Failure::Function {
                function,
                at: registers.calls.end_of(function),
                reason: crate::bytecode::Reason::Unassigned as u8,
            };
        }
        _ => FailedOperation::DIVISION,
    };
    Failure::Domain { origin: tape.origin(at), operation }
}
