//! Code that several branches of a tape share.
//!
//! An if-expression that occurs in several branches is evaluated only in those that are taken. It
//! is written at most twice: where it is met first, and as a routine that all other branches
//! perform, and that runs at most once in a run of the tape. Otherwise a chain of functions with
//! such branches, as media have, would be written as often as there are ways through it.

use super::instruction::Instruction;
use super::tape::Tape;
use crate::arithmetic::Register;
use crate::symbolic::Expr;
use rustc_hash::{FxHashMap, FxHashSet};

/// Instructions from which an if-expression is not repeated in every branch.
const LARGE: usize = 50;

/// The routines of a tape that is being written.
#[derive(Debug, Default)]
pub(super) struct Routines {
    known: FxHashMap<Expr, Routine>,
    /// If-expressions with many instructions that have been written.
    large: FxHashSet<Expr>,
    /// Codes, with the equations they come from. Their jumps count from their own beginning.
    codes: Vec<Code>,
}

/// The code of a routine.
#[derive(Debug)]
struct Code {
    origin: u32,
    link: Register,
    instructions: Vec<Instruction>,
}

/// A routine: its number, the register of the way back, and that of its result.
#[derive(Debug, Clone, Copy)]
pub(super) struct Routine {
    number: u32,
    pub(super) link: Register,
    pub(super) result: Register,
}

impl Routine {
    /// The instruction that performs it; its target is filled in by [`Routines::append`].
    pub(super) fn perform(self) -> Instruction {
        Instruction::Perform { target: self.number, link: self.link }
    }
}

impl Routines {
    pub(super) fn get(&self, e: Expr) -> Option<Routine> {
        self.known.get(&e).copied()
    }

    /// An if-expression has been written with so many instructions.
    pub(super) fn note(&mut self, e: Expr, length: usize) {
        if length >= LARGE {
            self.large.insert(e);
        }
    }

    /// Whether an if-expression is to be a routine; asked again it is not.
    pub(super) fn take_large(&mut self, e: Expr) -> bool {
        self.large.remove(&e)
    }

    pub(super) fn add(
        &mut self,
        e: Expr,
        (origin, instructions): (u32, Vec<Instruction>),
        [link, result]: [Register; 2],
    ) -> Routine {
        let routine = Routine { number: self.codes.len() as u32, link, result };
        self.codes.push(Code { origin, link, instructions });
        self.known.insert(e, routine);
        routine
    }

    /// What was computed is not what it was.
    pub(super) fn forget(&mut self) {
        self.known.clear();
    }

    /// Writes the routines after the code of a tape.
    pub(super) fn append(self, tape: &mut Tape) {
        if self.codes.is_empty() {
            return;
        }
        let end = tape.code.len();
        tape.code.push(Instruction::Jump { target: 0 });
        for Code { origin, link, mut instructions } in self.codes {
            let start = tape.code.len() as u32;
            instructions.iter_mut().for_each(|instruction| instruction.shift(start));
            tape.origins.push((start, origin));
            tape.routines.push((start, link));
            tape.code.append(&mut instructions);
        }
        tape.code[end] = Instruction::Jump { target: tape.code.len() as u32 };
        for instruction in &mut tape.code {
            if let Instruction::Perform { target, .. } = instruction {
                *target = tape.routines[*target as usize].0;
            }
        }
    }
}

/// The code of a tape with every routine where it is performed; `None` if it is longer than that.
pub(super) fn without_routines(tape: &Tape, longest: usize) -> Option<Vec<Instruction>> {
    let Some((first, _)) = tape.routines.first() else {
        return (tape.code.len() <= longest).then(|| tape.code.clone());
    };
    let mut written = Vec::new();
    write(&tape.code, 0, *first as usize - 1, &mut written, longest)?;
    Some(written)
}

/// Writes the instructions from one to before another, which jump to each other alone.
fn write(
    code: &[Instruction],
    from: usize,
    to: usize,
    written: &mut Vec<Instruction>,
    longest: usize,
) -> Option<()> {
    let mut places = Vec::with_capacity(to - from + 1);
    let mut jumps = Vec::new();
    for instruction in &code[from..to] {
        places.push(written.len() as u32);
        match *instruction {
            Instruction::Perform { target, .. } => {
                let start = target as usize;
                let is_end = |i: &Instruction| matches!(i, Instruction::Return { .. });
                let length = code[start..].iter().position(is_end)?;
                write(code, start, start + length, written, longest)?;
            }
            Instruction::Jump { .. } | Instruction::JumpUnless { .. } => {
                jumps.push(written.len());
                written.push(*instruction);
            }
            _ => written.push(*instruction),
        }
        if written.len() > longest {
            return None;
        }
    }
    places.push(written.len() as u32);
    for jump in jumps {
        if let Instruction::Jump { target } | Instruction::JumpUnless { target, .. } =
            &mut written[jump]
        {
            *target = places[*target as usize - from];
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arithmetic::{Operation, Operator};
    use crate::bytecode::Functions;
    use crate::codegen::code::Outputs;
    use crate::codegen::hoist::Hoisting;
    use crate::codegen::memory::Memory;
    use crate::codegen::registers::Registers;
    use crate::codegen::sequence::compile_continuous;
    use crate::symbolic::{Pool, RelationOperator, VarId, evaluate};
    use std::sync::Arc;

    fn compiled(pool: &Pool, outputs: &[Expr]) -> (Outputs, Memory) {
        let mut registers = Registers::new(1, Arc::new(Functions::default()));
        let code = compile_continuous(pool, &mut registers, &[], outputs, Hoisting::Never);
        (code, Memory::new(&registers))
    }

    /// A chain of steps each of which uses the one before in both of its branches.
    fn chain(pool: &mut Pool, steps: u32) -> Expr {
        let x = pool.variable(VarId(0));
        let mut value = x;
        for step in 0..steps {
            let limit = pool.constant(f64::from(step) / f64::from(steps));
            let condition = pool.relation(RelationOperator::Less, x, limit);
            let square = pool.mul(value, value);
            let denominator = pool.add(square, limit);
            let first = pool.div(value, denominator);
            let root = pool.function("sqrt", &[denominator]);
            let second = pool.sub(root, limit);
            value = pool.if_then_else(condition, first, second);
        }
        value
    }

    #[test]
    fn code_grows_with_the_expression_not_with_the_ways_through_it() {
        let length = |steps| {
            let mut pool = Pool::new();
            let root = chain(&mut pool, steps);
            compiled(&pool, &[root]).0.tape.code.len()
        };
        assert!(length(40) < 3 * length(20), "{} {}", length(20), length(40));
    }

    #[test]
    fn routines_compute_what_the_expression_says() {
        let mut pool = Pool::new();
        let root = chain(&mut pool, 12);
        let (code, mut memory) = compiled(&pool, &[root]);
        assert!(!code.tape.routines.is_empty());
        for x in [0.01, 0.2, 0.45, 0.7, 0.99] {
            memory[0] = x;
            code.tape.run(&mut memory).expect("all values are finite");
            let expected = evaluate(&pool, root, &[x][..]);
            assert_eq!(memory[code.outputs[0] as usize].to_bits(), expected.to_bits());
        }
    }

    #[test]
    fn code_without_routines_computes_the_same() {
        let mut pool = Pool::new();
        let root = chain(&mut pool, 12);
        let (code, mut memory) = compiled(&pool, &[root]);
        let written = without_routines(&code.tape, usize::MAX).expect("there is no limit");
        let plain = Tape { code: written, ..Tape::default() };
        for x in [0.01, 0.45, 0.99] {
            memory[0] = x;
            code.tape.run(&mut memory).expect("all values are finite");
            let expected = memory[code.outputs[0] as usize];
            plain.run(&mut memory).expect("all values are finite");
            assert_eq!(memory[code.outputs[0] as usize].to_bits(), expected.to_bits());
        }
        assert!(without_routines(&code.tape, code.tape.code.len()).is_none());
    }

    #[test]
    fn branches_of_one_condition_share_what_they_compute() {
        let mut pool = Pool::new();
        let x = pool.variable(VarId(0));
        let (zero, root) = (pool.constant(0.0), pool.function("sqrt", &[x]));
        let condition = pool.relation(RelationOperator::Greater, x, zero);
        let mut element = |at: u32| {
            let factor = pool.constant(f64::from(at + 2));
            let product = pool.mul(factor, root);
            pool.if_then_else(condition, product, zero)
        };
        let elements: Vec<Expr> = (0..10).map(&mut element).collect();
        let (code, _) = compiled(&pool, &elements);
        let is_root = |i: &&Instruction| {
            matches!(i, Instruction::Operation(Operation { operator: Operator::Unary(_), .. }))
        };
        assert_eq!(code.tape.code.iter().filter(is_root).count(), 1);
    }

    /// Expressions that share what they are made of, under conditions that come again.
    fn shared(pool: &mut Pool, seed: u64) -> Vec<Expr> {
        let mut state = seed;
        let mut draw = |n: usize| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) as usize % n
        };
        let x = pool.variable(VarId(0));
        let mut conditions = Vec::new();
        for share in [0.2, 0.5, 0.8] {
            let limit = pool.constant(share);
            conditions.push(pool.relation(RelationOperator::Less, x, limit));
        }
        let mut all = vec![x];
        for step in 0..60 {
            let (a, b) = (all[draw(all.len())], all[draw(all.len())]);
            let next = match draw(5) {
                0 | 1 => pool.if_then_else(conditions[draw(3)], a, b),
                2 => pool.add(a, b),
                3 => pool.function("sin", &[a]),
                _ => {
                    let half = pool.constant(0.5 + f64::from(step) / 64.0);
                    pool.mul(half, b)
                }
            };
            all.push(next);
        }
        all.split_off(all.len() - 6)
    }

    #[test]
    fn branches_that_come_again_know_what_they_computed() {
        for seed in 0..200 {
            let mut pool = Pool::new();
            let roots = shared(&mut pool, seed);
            let (code, mut memory) = compiled(&pool, &roots);
            for x in [0.1, 0.3, 0.6, 0.9] {
                memory[0] = x;
                code.tape.run(&mut memory).expect("all values are finite");
                for (root, output) in roots.iter().zip(&code.outputs) {
                    let expected = evaluate(&pool, *root, &[x][..]);
                    assert_eq!(memory[*output as usize].to_bits(), expected.to_bits(), "{seed}");
                }
            }
        }
    }
}
