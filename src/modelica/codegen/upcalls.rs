//! What machine code asks this process for: solutions of linear systems that need a workspace, and
//! calls of functions.
//!
//! The code writes the operands to an array on its stack and reads the results after them. The
//! workspaces are those of the interpreter, which solves and calls likewise: so both find the same
//! factors, and give the same bits.

#![allow(unsafe_code, reason = "machine code hands over the array as a pointer")]

use super::instruction::{Call, Instruction, LinearSolve};
use super::linear_system::{LinearSystem, MOST_SMALL};
use super::memory::{Calls, Memory};
use super::tape::Tape;
use crate::arithmetic::Register;
use crate::bytecode::Functions;

/// An array on the stack has at most so many numbers: threads have stacks of 2 MB at least.
const LARGEST: usize = 8192;

/// What the upcalls of one run work on.
pub(super) struct Workspaces<'a> {
    calls: &'a mut Calls,
    systems: &'a mut [LinearSystem],
}

impl Workspaces<'_> {
    /// Those of a memory, beside its registers.
    pub(super) fn of(memory: &mut Memory) -> (&mut [f64], Workspaces<'_>) {
        let Memory { registers, calls, systems, .. } = memory;
        (registers, Workspaces { calls, systems })
    }
}

/// The systems and calls of a tape on registers of their own: operands from register 0 on, results
/// after them. Machine code has their addresses, so it is kept as long as they are.
pub(super) struct Upcalls {
    /// With the registers of the operands in the tape; `None` for systems that need no workspace.
    solves: Vec<Option<(LinearSolve, Vec<Register>)>>,
    calls: Vec<(Call, usize)>,
}

impl Upcalls {
    /// Those of a tape; `None` if it has some that machine code cannot ask for: impure functions,
    /// whose messages must not come twice, and systems with too many entries.
    pub(super) fn of(tape: &Tape, functions: &Functions) -> Option<Upcalls> {
        let is_pure = |call: &Call| !functions.codes[call.function as usize].impure;
        if !tape.calls.iter().all(is_pure) {
            return None;
        }
        let solves: Vec<_> = tape.solves.iter().map(on_own_registers).collect();
        let calls = tape.calls.iter().map(|call| {
            let n = call.arguments.len() as Register;
            let own = Call { arguments: (0..n).collect(), d: n, ..call.clone() };
            (own, functions.n_outputs(call.function))
        });
        let upcalls = Upcalls { solves, calls: calls.collect() };
        (upcalls.room() <= LARGEST).then_some(upcalls)
    }

    /// How many numbers the array must hold.
    pub(super) fn room(&self) -> usize {
        let of_solve = |(solve, _): &(LinearSolve, _)| solve.d as usize + solve.right.len();
        let of_call = |(call, results): &(Call, usize)| call.d as usize + results;
        let solves = self.solves.iter().flatten().map(of_solve);
        solves.chain(self.calls.iter().map(of_call)).max().unwrap_or(0)
    }

    /// How many numbers are handed over in all.
    pub(super) fn length(&self) -> usize {
        let solves = self.solves.iter().flatten().map(|(_, operands)| operands.len());
        solves.chain(self.calls.iter().map(|(call, _)| call.arguments.len())).sum()
    }

    /// The system of this number in the tape if it needs a workspace, with the registers of its
    /// operands in the tape.
    pub(super) fn solve(&self, number: u32) -> Option<&(LinearSolve, Vec<Register>)> {
        self.solves[number as usize].as_ref()
    }

    /// The call of this number in the tape, and how many results it has.
    pub(super) fn call(&self, number: u32) -> &(Call, usize) {
        &self.calls[number as usize]
    }

    /// The first register that an instruction writes a row of results to, and their number.
    pub(super) fn row(&self, instruction: &Instruction, tape: &Tape) -> Option<(Register, usize)> {
        match *instruction {
            Instruction::Call { call } => {
                Some((tape.calls[call as usize].d, self.calls[call as usize].1))
            }
            Instruction::Solve { solve } => {
                let solve = &tape.solves[solve as usize];
                Some((solve.d, solve.right.len()))
            }
            _ => None,
        }
    }
}

fn on_own_registers(solve: &LinearSolve) -> Option<(LinearSolve, Vec<Register>)> {
    if solve.right.len() <= MOST_SMALL {
        return None;
    }
    let given = solve.entries.as_deref().unwrap_or_default();
    let entries = given.iter().zip(0..).map(|((place, _), at)| (*place, at)).collect();
    let first = given.len() as Register;
    let d = first + solve.right.len() as Register;
    let operands = given.iter().map(|(_, register)| *register).chain(solve.right.iter().copied());
    let own = LinearSolve {
        entries: solve.entries.is_some().then_some(entries),
        right: (first..d).collect(),
        d,
        ..solve.clone()
    };
    Some((own, operands.collect()))
}

/// Solves a linear system; zero, or what is not a number if it has no solution.
pub(super) unsafe extern "C" fn solve(
    workspaces: *mut Workspaces,
    solve: *const LinearSolve,
    values: *mut f64,
) -> f64 {
    // SAFETY: machine code gives the workspaces it was called with, an address that its `Upcalls`
    // keep, and an array with the room that they ask for.
    let (workspaces, solve) = unsafe { (&mut *workspaces, &*solve) };
    let length = solve.d as usize + solve.right.len();
    let values = unsafe { std::slice::from_raw_parts_mut(values, length) };
    let system = workspaces.systems.get_mut(solve.system as usize);
    let is_solved = system.is_some_and(|system| system.run(solve, values).is_ok());
    if is_solved { 0.0 } else { f64::NAN }
}

/// Calls a function with so many results; zero, or what is not a number if it failed.
pub(super) unsafe extern "C" fn call(
    workspaces: *mut Workspaces,
    call: *const Call,
    values: *mut f64,
    results: usize,
) -> f64 {
    // SAFETY: as in `solve`.
    let (workspaces, call) = unsafe { (&mut *workspaces, &*call) };
    let values = unsafe { std::slice::from_raw_parts_mut(values, call.d as usize + results) };
    let has_values = workspaces.calls.run(call, values).is_ok();
    if has_values { 0.0 } else { f64::NAN }
}
