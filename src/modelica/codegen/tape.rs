//! Instructions on registers. A jump skips what is not needed, so that a branch that is not taken
//! is never evaluated.
//!
//! A value that is not finite is a failure at once, but for one: where `exp`, `sinh` or `cosh` of a
//! finite argument overflows, the value is infinite as in IEEE 754 until a variable takes it, so that
//! `2/(1 + exp(-v/v0)) - 1` has its limit for every v.

use super::instruction::LinearSolve;
use super::memory::Memory;
use crate::arithmetic::{Operation, Register};
use crate::bytecode::Functions;
use crate::codegen::instruction::{Call, Instruction};

/// A sequence of instructions.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub(crate) struct Tape {
    pub(crate) code: Vec<Instruction>,
    pub(super) calls: Vec<Call>,
    pub(super) solves: Vec<LinearSolve>,
    /// First instructions of the routines, ascending, and their links.
    pub(super) routines: Vec<(u32, Register)>,
    /// First instruction of every origin, ascending.
    pub(super) origins: Vec<(u32, u32)>,
}

impl Tape {
    /// The registers that are written, in rows: the results of instructions, calls and linear systems.
    pub(super) fn written(&self, functions: &Functions) -> impl Iterator<Item = (Register, usize)> {
        let calls = self.calls.iter().map(|call| (call.d, functions.n_outputs(call.function)));
        let solves = self.solves.iter().map(|solve| (solve.d, solve.right.len()));
        let results = self.code.iter().filter_map(Instruction::result).map(|d| (d, 1));
        results.chain(calls).chain(solves)
    }

    /// The function whose output is all that the tape computes, where the run failed because the
    /// function gives that output no value.
    pub(crate) fn lacking(&self, failed: u32) -> Option<u32> {
        let (at, rest) = self.code.get(failed as usize..)?.split_first()?;
        match at {
            Instruction::Given { function, .. } => rest
                .iter()
                .all(|instruction| matches!(instruction, Instruction::Move { .. }))
                .then_some(*function),
            _ => None,
        }
    }

    /// Runs it; on failure the number of the instruction without a finite value. Where an overflow
    /// was passed on, [`Memory::overflow`] has its number, and every variable is finite.
    pub(crate) fn run(&self, memory: &mut Memory) -> Result<(), u32> {
        let Memory { registers: r, calls, systems, n_variables, overflow } = memory;
        *overflow = None;
        self.routines.iter().for_each(|(_, link)| r[*link as usize] = 0.0);
        let mut at = 0usize;
        while let Some(instruction) = self.code.get(at) {
            at += 1;
            match *instruction {
                Instruction::Move { d, a } => r[d as usize] = r[a as usize],
                Instruction::Operation(operation) => {
                    let value = operation.value(r);
                    let Operation { operator, d, a, .. } = operation;
                    if operator.may_fail() && !value.is_finite() {
                        if !operator.overflows_at(r[a as usize]) {
                            return Err(at as u32 - 1);
                        }
                        overflow.get_or_insert(at as u32 - 1);
                    }
                    r[d as usize] = value;
                }
                Instruction::Call { call } => {
                    let call = &self.calls[call as usize];
                    calls.run(call, r).map_err(|_| at as u32 - 1)?;
                }
                Instruction::Given { d, a, is_zero, function } => {
                    r[d as usize] = match r[a as usize] {
                        value if !value.is_nan() => value,
                        _ if is_zero => calls.default_of(function).ok_or(at as u32 - 1)?,
                        _ => return Err(at as u32 - 1),
                    };
                }
                Instruction::Solve { solve } => {
                    let solve = &self.solves[solve as usize];
                    let system = &mut systems[solve.system as usize];
                    system.run(solve, r).map_err(|_| at as u32 - 1)?;
                }
                Instruction::JumpUnless { a, target } => {
                    if r[a as usize] == 0.0 {
                        at = target as usize;
                    }
                }
                Instruction::Jump { target } => at = target as usize,
                Instruction::Perform { target, link } => {
                    if r[link as usize] == 0.0 {
                        r[link as usize] = at as f64;
                        at = target as usize;
                    }
                }
                Instruction::Return { link } => at = r[link as usize] as usize,
            }
        }
        match *overflow {
            Some(at) if !self.variables_are_finite(r, *n_variables) => Err(at),
            _ => Ok(()),
        }
    }

    /// Whether the variables that the tape assigns have finite values.
    fn variables_are_finite(&self, r: &[f64], n_variables: usize) -> bool {
        let mut assigned = self.code.iter().filter_map(Instruction::result);
        assigned.all(|d| d as usize >= n_variables || r[d as usize].is_finite())
    }

    /// The origin of an instruction.
    pub(crate) fn origin(&self, at: u32) -> u32 {
        let position = self.origins.partition_point(|(first, _)| *first <= at);
        position.checked_sub(1).map_or(u32::MAX, |position| self.origins[position].1)
    }
}
