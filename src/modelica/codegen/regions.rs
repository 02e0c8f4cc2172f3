//! Registers that are read outside of the branch that writes them.
//!
//! A branch computes nothing again that an earlier branch of the same condition has computed, so
//! the writer of a register need not stand on every way to its readers. Code that keeps values in
//! registers of the machine must know which these are.

use super::instruction::{Instruction, LinearSolve};
use super::tape::Tape;
use super::upcalls::Upcalls;
use crate::arithmetic::Register;
use rustc_hash::{FxHashMap, FxHashSet};

/// The registers that are written in a branch and read outside of it, or written in several. The
/// code is that of a tape, its routines where they are performed.
pub(super) fn shared_by_branches(
    code: &[Instruction],
    tape: &Tape,
    upcalls: &Upcalls,
) -> FxHashSet<Register> {
    let mut regions = Regions::default();
    for (at, instruction) in code.iter().enumerate() {
        regions.reach(at);
        instruction.for_each_operand(|register| regions.read(register));
        match *instruction {
            Instruction::Jump { target } | Instruction::JumpUnless { target, .. } => {
                // A jump at the end of a branch leads over the other one.
                regions.reach(at + 1);
                regions.begin(target as usize);
            }
            Instruction::Solve { solve } => regions.solve(&tape.solves[solve as usize]),
            Instruction::Call { call } => {
                let arguments = tape.calls[call as usize].arguments.iter();
                arguments.for_each(|register| regions.read(*register));
            }
            _ => instruction.result().into_iter().for_each(|d| regions.write(d)),
        }
        if let Some((d, results)) = upcalls.row(instruction, tape) {
            (d..).take(results).for_each(|d| regions.write(d));
        }
    }
    regions.shared
}

/// What lies between a jump and its target, one within the other.
#[derive(Default)]
struct Regions {
    /// Number and end of those that are open.
    open: Vec<(usize, usize)>,
    is_closed: Vec<bool>,
    /// The innermost region in which a register is written.
    written: FxHashMap<Register, Option<usize>>,
    /// The registers of the matrix in each workspace.
    matrices: FxHashMap<u32, Vec<Register>>,
    shared: FxHashSet<Register>,
}

impl Regions {
    fn begin(&mut self, end: usize) {
        self.open.push((self.is_closed.len(), end));
        self.is_closed.push(false);
    }

    /// Closes the regions that end where an instruction stands.
    fn reach(&mut self, at: usize) {
        while let Some((region, _)) = self.open.pop_if(|(_, end)| *end <= at) {
            self.is_closed[region] = true;
        }
    }

    fn current(&self) -> Option<usize> {
        self.open.last().map(|(region, _)| *region)
    }

    fn write(&mut self, register: Register) {
        if self.written.insert(register, self.current()).is_some() {
            self.shared.insert(register);
        }
    }

    fn read(&mut self, register: Register) {
        if let Some(Some(region)) = self.written.get(&register)
            && self.is_closed[*region]
        {
            self.shared.insert(register);
        }
    }

    fn solve(&mut self, solve: &LinearSolve) {
        if let Some(entries) = &solve.entries {
            let registers = entries.iter().map(|(_, register)| *register).collect();
            self.matrices.insert(solve.system, registers);
        }
        let entries = self.matrices.get(&solve.system).cloned().unwrap_or_default();
        entries.iter().chain(&solve.right).for_each(|register| self.read(*register));
    }
}
