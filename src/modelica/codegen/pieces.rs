//! A long tape cut into pieces that are translated one by one.
//!
//! What a translation to machine code takes grows more than linearly with the length of a
//! function, so that long tapes become several. A piece leaves what later ones read in the
//! registers of the memory, as the tape does when it is interpreted.

use super::instruction::Instruction;
use super::tape::Tape;
use super::upcalls::Upcalls;
use crate::arithmetic::Register;
use rustc_hash::FxHashMap;
use std::ops::Range;

/// Instructions that run in a row, which jump to each other alone.
#[derive(Debug)]
pub(super) struct Piece {
    /// Their jumps count from the first.
    pub(super) instructions: Vec<Instruction>,
    /// The registers written here that are outputs or read in a later piece, ascending.
    pub(super) left: Vec<Register>,
}

/// Cuts the instructions of a tape, its routines where they are performed, into pieces with at most
/// that many. `None` where jumps lead over more.
pub(super) fn pieces(
    code: &[Instruction],
    longest: usize,
    outputs: &[Register],
    (tape, upcalls): (&Tape, &Upcalls),
) -> Option<Vec<Piece>> {
    let ranges = ranges(code, longest)?;
    let mut read = last_reads(code, &ranges, tape);
    read.extend(outputs.iter().map(|output| (*output, usize::MAX)));
    let pieces = ranges.into_iter().enumerate().map(|(number, range)| {
        let first = range.start as u32;
        let mut left = Vec::new();
        for instruction in &code[range.clone()] {
            let mut write = |d: Register| {
                if read.get(&d).is_some_and(|last| *last > number) {
                    left.push(d);
                }
            };
            instruction.result().into_iter().for_each(&mut write);
            if let Some((d, results)) = upcalls.row(instruction, tape) {
                (d..).take(results).for_each(&mut write);
            }
        }
        left.sort_unstable();
        left.dedup();
        let instructions = code[range].iter().map(|instruction| counted_from(first, *instruction));
        Piece { instructions: instructions.collect(), left }
    });
    Some(pieces.collect())
}

/// Where the pieces begin and end: no jump leads over a cut.
fn ranges(code: &[Instruction], longest: usize) -> Option<Vec<Range<usize>>> {
    let (mut ranges, mut start, mut cut, mut reached) = (Vec::new(), 0, 0, 0);
    for at in 0..=code.len() {
        if at - start > longest {
            if cut == start {
                return None;
            }
            ranges.push(start..cut);
            start = cut;
        }
        if reached <= at {
            cut = at;
        }
        if let Some(Instruction::Jump { target } | Instruction::JumpUnless { target, .. }) =
            code.get(at)
        {
            reached = reached.max(*target as usize);
        }
    }
    ranges.push(start..code.len());
    Some(ranges)
}

/// The last piece that reads a register.
fn last_reads(
    code: &[Instruction],
    ranges: &[Range<usize>],
    tape: &Tape,
) -> FxHashMap<Register, usize> {
    let mut last = FxHashMap::default();
    let mut matrices: FxHashMap<u32, &[(u32, Register)]> = FxHashMap::default();
    for (number, range) in ranges.iter().enumerate() {
        let mut read = |register: Register| _ = last.insert(register, number);
        for instruction in &code[range.clone()] {
            instruction.for_each_operand(&mut read);
            match *instruction {
                Instruction::Call { call } => {
                    tape.calls[call as usize].arguments.iter().copied().for_each(&mut read);
                }
                Instruction::Solve { solve } => {
                    let solve = &tape.solves[solve as usize];
                    if let Some(entries) = &solve.entries {
                        matrices.insert(solve.system, entries);
                    }
                    let entries = matrices.get(&solve.system).copied().unwrap_or_default();
                    entries.iter().map(|(_, register)| *register).for_each(&mut read);
                    solve.right.iter().copied().for_each(&mut read);
                }
                _ => {}
            }
        }
    }
    last
}

/// The instruction where its code begins at `first`.
fn counted_from(first: u32, mut instruction: Instruction) -> Instruction {
    if let Instruction::Jump { target } | Instruction::JumpUnless { target, .. } = &mut instruction
    {
        *target -= first;
    }
    instruction
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arithmetic::{Operation, Operator};

    fn add(d: Register, a: Register) -> Instruction {
        Operation::binary(Operator::Add, d, a, a).into()
    }

    #[test]
    fn cuts_are_where_no_jump_leads_over() {
        let code = [
            add(1, 0),
            Instruction::JumpUnless { a: 1, target: 4 },
            add(2, 1),
            Instruction::Jump { target: 5 },
            add(2, 0),
            add(3, 2),
        ];
        assert_eq!(ranges(&code, 4), Some(vec![0..1, 1..5, 5..6]));
        assert_eq!(ranges(&code, 5), Some(vec![0..5, 5..6]));
        assert_eq!(ranges(&code, 6).map(|ranges| ranges.len()), Some(1));
        assert_eq!(ranges(&code, 3), None);
    }

    #[test]
    fn a_piece_leaves_what_later_ones_read() {
        let tape = Tape::default();
        let upcalls = Upcalls::of(&tape, &crate::bytecode::Functions::default()).expect("none");
        let code = [add(1, 0), add(2, 1), add(3, 1), add(4, 3)];
        let pieces = pieces(&code, 2, &[4], (&tape, &upcalls)).expect("there are no jumps");
        let left: Vec<_> = pieces.iter().map(|piece| piece.left.clone()).collect();
        assert_eq!(left, [vec![1], vec![4]]);
    }
}
