//! Tapes that run often become machine code.
//!
//! A tape is run by its interpreter until it has run so often that translating it pays; then the
//! functions that Cranelift makes of it are called. Both give the same bits, so it does not matter
//! when this happens, nor in which thread. Machine code does not say where it failed: then the tape
//! runs and tells.
//!
//! Measured with `FC2Layer` on a 2.5 GHz Xeon that did other work as well: an evaluation of the
//! right-hand side takes a tenth of the time, of the Jacobian a tenth, a simulation less than half.

#![allow(unsafe_code, reason = "machine code made at run time can only be called so")]

use super::memory::Memory;
use super::pieces::{Piece, pieces};
use super::routines::without_routines;
use super::translation::{Matrices, Part, translate};
use super::upcalls::{Upcalls, Workspaces};
use crate::arithmetic::Register;
use crate::bytecode::Functions;
use crate::codegen::tape::Tape;
use crate::jit::{self, Effort, Executable};
use rustc_hash::FxHashSet;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

/// Runs of a tape after which it is translated: a translation takes about as long as a thousand.
const OFTEN: u32 = 1_000;
/// The same for tapes longer than [`LONG`], whose translation is quicker: with `EngineV6`, whose
/// Jacobian has 220,000 instructions, it takes as long as about 100 runs.
const OFTEN_LONG: u32 = 100;
/// Instructions beyond which the time of a translation matters more than the best code.
const LONG: usize = 3_000;
/// Longer tapes are translated in pieces of at most this many instructions: the time that a
/// translation takes is more than linear.
const PIECE: usize = 8_000;
/// A tape that cannot be cut is translated as a whole up to this length.
const WHOLE: usize = 100_000;
/// Tapes longer than this are not translated.
const LONGEST: usize = 2_000_000;

/// The machine code of a tape, once it has run often.
#[derive(Default)]
pub(crate) struct MachineCode {
    runs: AtomicU32,
    function: OnceLock<Option<Function>>,
}

impl MachineCode {
    /// Computes outputs from registers; whether it did. If not, the tape must be run.
    pub(crate) fn run(
        &self,
        tape: &Tape,
        outputs: &[Register],
        memory: &mut Memory,
        out: &mut [f64],
    ) -> bool {
        if let Some(function) = self.function.get() {
            // Who asks for fewer values than there are gets them from the tape.
            let function = function.as_ref().filter(|function| function.n_outputs <= out.len());
            return function.is_some_and(|function| function.call(memory, out));
        }
        self.count(tape, || {
            Function::new((tape, outputs, memory.calls.functions()), Results::InArray)
        });
        false
    }

    /// Computes what the tape leaves in the registers: the variables that it assigns and these other
    /// results; whether it did. If not, the tape must be run.
    pub(crate) fn run_in_place(
        &self,
        tape: &Tape,
        others: [&[Register]; 2],
        memory: &mut Memory,
    ) -> bool {
        if let Some(function) = self.function.get() {
            let done = function.as_ref().is_some_and(|function| function.call(memory, &mut []));
            if done {
                memory.overflow = None;
            }
            return done;
        }
        self.count(tape, || {
            let functions = memory.calls.functions();
            let results = left_by((tape, functions), memory.n_variables, others);
            Function::new((tape, &results, functions), Results::InRegisters)
        });
        false
    }

    /// Counts a run of the tape, and translates it where it has run often.
    fn count(&self, tape: &Tape, translated: impl FnOnce() -> Option<Function>) {
        let often = if tape.code.len() <= LONG { OFTEN } else { OFTEN_LONG };
        if self.runs.fetch_add(1, Ordering::Relaxed) == often {
            self.function.get_or_init(|| if jit::is_interpreted() { None } else { translated() });
        }
    }
}

impl Clone for MachineCode {
    fn clone(&self) -> MachineCode {
        MachineCode::default()
    }
}

impl std::fmt::Debug for MachineCode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("MachineCode").field("runs", &self.runs).finish_non_exhaustive()
    }
}

/// The variables that a tape assigns, and which of `others` it computes.
fn left_by(
    (tape, functions): (&Tape, &Functions),
    n_variables: usize,
    others: [&[Register]; 2],
) -> Vec<Register> {
    let others: FxHashSet<Register> = others.into_iter().flatten().copied().collect();
    let is_left =
        |register: &Register| (*register as usize) < n_variables || others.contains(register);
    let written = tape.written(functions).flat_map(|(d, results)| (d..).take(results));
    let mut left: Vec<Register> = written.filter(is_left).collect();
    left.sort_unstable();
    left.dedup();
    left
}

/// Where machine code writes its results to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Results {
    /// One after another into an array.
    InArray,
    /// Where the tape has them.
    InRegisters,
}

/// What the machine code is called as: registers, outputs, workspaces of linear systems and
/// functions; zero if all values are finite.
type Entry = unsafe extern "C" fn(*const f64, *mut f64, *mut Workspaces) -> f64;

/// A function in memory of its own.
pub(super) struct Function {
    /// More than one where the tape was cut into pieces.
    entries: Vec<Entry>,
    /// Whether they write to registers.
    in_registers: bool,
    /// The registers of the outputs that are copied into an array.
    outputs: Vec<Register>,
    /// One more than the last register read or written.
    n_registers: usize,
    n_outputs: usize,
    /// The machine code has addresses in it.
    _upcalls: Upcalls,
    _code: Executable,
}

impl Function {
    /// Translates a tape, if it consists of what can be translated and the machine is supported.
    fn new(code: Code, results: Results) -> Option<Function> {
        let (tape, _, functions) = code;
        let length =
            without_routines(tape, LONGEST)?.len() + Upcalls::of(tape, functions)?.length();
        match length {
            0..=LONG => Function::translated(code, results, LONG, Effort::Best),
            // Better code would take too long.
            _ => Function::translated(code, results, PIECE, Effort::Quick),
        }
    }

    /// Translates in pieces of at most so many instructions.
    fn translated(
        (tape, outputs, functions): Code,
        results: Results,
        longest: usize,
        effort: Effort,
    ) -> Option<Function> {
        let mut code = jit::Code::new(effort)?;
        let instructions = without_routines(tape, LONGEST)?;
        let upcalls = Upcalls::of(tape, functions)?;
        let whole = |instructions| vec![Piece { instructions, left: outputs.to_vec() }];
        let pieces = match pieces(&instructions, longest, outputs, (tape, &upcalls)) {
            Some(pieces) => pieces,
            None if instructions.len() <= WHOLE => whole(instructions),
            None => return None,
        };
        let in_registers = pieces.len() > 1 || results == Results::InRegisters;
        let mut matrices = Matrices::default();
        let mut ids = Vec::new();
        for (number, piece) in pieces.iter().enumerate() {
            let places: Vec<(Register, usize)> = match in_registers {
                true => piece.left.iter().map(|register| (*register, *register as usize)).collect(),
                false => outputs.iter().copied().zip(0..).collect(),
            };
            let part = Part {
                tape,
                upcalls: &upcalls,
                instructions: &piece.instructions,
                outputs: &places,
                keeps: in_registers,
            };
            let translated =
                |target, context: &mut _| translate(part, &mut matrices, target, context);
            ids.push(code.define(&format!("tape_{number}"), translated)?);
        }
        let code = code.finish()?;
        let entry = |id| {
            let address = code.address(id)?;
            // SAFETY: the function was declared with the signature of `Entry` and lives as long as
            // the code, which the result keeps.
            Some(unsafe { std::mem::transmute::<*const u8, Entry>(address) })
        };
        let copied = in_registers && results == Results::InArray;
        Some(Function {
            entries: ids.into_iter().map(entry).collect::<Option<_>>()?,
            in_registers,
            outputs: if copied { outputs.to_vec() } else { Vec::new() },
            n_registers: registers_used(tape, outputs, &upcalls),
            n_outputs: if results == Results::InArray { outputs.len() } else { 0 },
            _upcalls: upcalls,
            _code: code,
        })
    }

    /// Whether all values are finite.
    fn call(&self, memory: &mut Memory, out: &mut [f64]) -> bool {
        let (registers, mut workspaces) = Workspaces::of(memory);
        assert!(self.n_registers <= registers.len(), "registers are those the tape was made for");
        assert!(self.n_outputs <= out.len(), "there is room for every output");
        let registers_start = registers.as_mut_ptr();
        if let ([entry], false) = (&self.entries[..], self.in_registers) {
            // SAFETY: the code reads registers below `n_registers`, writes outputs below
            // `n_outputs`, and hands the workspaces to its upcalls alone.
            let check = unsafe { entry(registers_start, out.as_mut_ptr(), &raw mut workspaces) };
            return check == 0.0;
        }
        for entry in &self.entries {
            // SAFETY: the code reads and writes registers below `n_registers`, and hands the
            // workspaces to its upcalls alone.
            let check = unsafe { entry(registers_start, registers_start, &raw mut workspaces) };
            if check != 0.0 {
                return false;
            }
        }
        for (out, register) in out.iter_mut().zip(&self.outputs) {
            *out = registers[*register as usize];
        }
        true
    }
}

/// A tape, the registers of its outputs, and the functions that it calls.
type Code<'a> = (&'a Tape, &'a [Register], &'a Functions);

/// One more than the last register that a tape or its outputs mention.
fn registers_used(tape: &Tape, outputs: &[Register], upcalls: &Upcalls) -> usize {
    let mut last: Register = 0;
    for instruction in &tape.code {
        instruction.for_each_operand(|register| last = last.max(register));
        last = instruction.result().into_iter().fold(last, Register::max);
        if let Some((d, results)) = upcalls.row(instruction, tape) {
            last = last.max((d + results as Register).saturating_sub(1));
        }
    }
    for solve in &tape.solves {
        let entries = solve.entries.iter().flatten().map(|(_, register)| *register);
        last = entries.chain(solve.right.iter().copied()).fold(last, Register::max);
    }
    let arguments = tape.calls.iter().flat_map(|call| call.arguments.iter().copied());
    arguments.chain(outputs.iter().copied()).fold(last, Register::max) as usize + 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bytecode::Functions;
    use crate::codegen::code::Outputs;
    use crate::codegen::hoist::Hoisting;
    use crate::codegen::memory::Memory;
    use crate::codegen::registers::Registers;
    use crate::codegen::sequence::compile_continuous;
    use crate::codegen::tape_builder::TapeBuilder;
    use crate::symbolic::{Expr, Pool, RelationOperator, VarId};
    use proptest::prelude::*;
    use std::sync::Arc;

    const VARIABLES: usize = 4;
    const OPERATORS: [RelationOperator; 6] = [
        RelationOperator::Less,
        RelationOperator::LessEqual,
        RelationOperator::Greater,
        RelationOperator::GreaterEqual,
        RelationOperator::Equal,
        RelationOperator::NotEqual,
    ];

    /// An expression of others: its kind and four operands.
    type Step = (u8, [u8; 4]);

    /// Expressions made of variables and numbers.
    fn expressions(pool: &mut Pool, steps: &[Step]) -> Vec<Expr> {
        let mut known: Vec<Expr> = (0..VARIABLES as u32).map(|v| pool.variable(VarId(v))).collect();
        known.extend([0.0, 1.5, -2.0].map(|value| pool.constant(value)));
        for (kind, operands) in steps {
            let [a, b, c, d] = operands.map(|at| known[at as usize % known.len()]);
            let new = match kind % 20 {
                0 => pool.add(a, b),
                1 => pool.sub(a, b),
                2 => pool.mul(a, b),
                3 => pool.div(a, b),
                4 => pool.pow(a, b),
                5 => pool.neg(a),
                6 => pool.not(a),
                7 => pool.and(a, b),
                8 => pool.or(a, b),
                9 => pool.relation(OPERATORS[operands[2] as usize % 6], a, b),
                10 | 11 => pool.if_then_else(a, b, c),
                12 => pool.function("exp", &[a]),
                13 => pool.function("sqrt", &[a]),
                14 => pool.function("abs", &[a]),
                15 => pool.function("atan2", &[a, b]),
                16 => {
                    let (matrix, right) = (pool.list(&[a]), pool.list(&[b]));
                    pool.solution(matrix, right, 0)
                }
                17 => {
                    let matrix = pool.list(&[a, b, c, d, a, b, c, d, a]);
                    let right = pool.list(&[b, c, d]);
                    pool.solution(matrix, right, u32::from(operands[0] % 3))
                }
                18 => {
                    let zero = pool.constant(0.0);
                    let mut matrix = vec![zero; 64];
                    for (row, at) in (0..8).zip([a, b, c, d, c, b, a, d]) {
                        matrix[9 * row] = at;
                        matrix[8 * row + (row + 3) % 8] = d;
                    }
                    let (matrix, right) =
                        (pool.list(&matrix), pool.list(&[b, c, d, a, a, b, c, d]));
                    pool.solution(matrix, right, u32::from(operands[0] % 8))
                }
                _ => {
                    let (matrix, right) = (pool.list(&[a, b, c, d]), pool.list(&[b, c]));
                    pool.solution(matrix, right, u32::from(operands[0] % 2))
                }
            };
            known.push(new);
        }
        known.split_off(VARIABLES)
    }

    /// Code for all expressions, with registers for it.
    fn compiled(pool: &Pool, outputs: &[Expr]) -> (Outputs, Memory) {
        let mut registers = Registers::new(VARIABLES, Arc::new(Functions::default()));
        let code = compile_continuous(pool, &mut registers, &[], outputs, Hoisting::Never);
        (code, Memory::new(&registers))
    }

    fn value() -> impl Strategy<Value = f64> {
        prop_oneof![Just(0.0), Just(1.0), -3.0f64..3.0, -1e3f64..1e3]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn machine_code_computes_what_the_tape_computes(
            steps in prop::collection::vec((any::<u8>(), any::<[u8; 4]>()), 1..60),
            values in prop::collection::vec(prop::array::uniform4(value()), 4),
        ) {
            let mut pool = Pool::new();
            let outputs = expressions(&mut pool, &steps);
            let (code, mut memory) = compiled(&pool, &outputs);
            let functions = Functions::default();
            let code_of = (&code.tape, &*code.outputs, &functions);
            let best = Function::translated(code_of, Results::InArray, LONG, Effort::Best);
            let quick = Function::translated(code_of, Results::InArray, LONG, Effort::Quick);
            let whole = [best, quick].map(|f| f.expect("all of it can be translated"));
            let cut = [5, 20, 60].map(|longest| {
                Function::translated(code_of, Results::InArray, longest, Effort::Quick)
            });
            let cut = cut.map(|f| f.expect("all of it can be translated"));
            let functions = Functions::default();
            let left = left_by((&code.tape, &functions), VARIABLES, [&code.outputs, &[]]);
            let in_place = [LONG, 20].map(|longest| {
                let code = (&code.tape, &*left, &functions);
                Function::translated(code, Results::InRegisters, longest, Effort::Quick)
            });
            let in_place = in_place.map(|f| f.expect("all of it can be translated"));
            let made: Vec<Function> = whole.into_iter().chain(cut).chain(in_place).collect();
            for (values, function) in values.iter().flat_map(|v| made.iter().map(move |f| (v, f))) {
                memory[..VARIABLES].copy_from_slice(values);
                left.iter().for_each(|register| memory[*register as usize] = f64::NAN);
                let mut out = vec![f64::NAN; function.n_outputs];
                let done = function.call(&mut memory, &mut out);
                if function.n_outputs == 0 {
                    out = code.outputs.iter().map(|register| memory[*register as usize]).collect();
                }
                let succeeds = code.tape.run(&mut memory).is_ok();
                // Machine code may leave to the tape what is nearly singular and what overflows where
                // the tape continues, but nothing else.
                prop_assert!(!done || succeeds);
                let is_system = |(kind, _): &Step| kind % 20 >= 16;
                let may_leave = memory.overflow.is_some() || steps.iter().any(is_system);
                prop_assert!(done || !succeeds || may_leave);
                for (out, register) in out.iter().zip(&code.outputs).filter(|_| done) {
                    let expected = memory[*register as usize];
                    prop_assert!(out.to_bits() == expected.to_bits() || expected.is_nan());
                }
            }
        }
    }

    #[test]
    fn machine_code_keeps_what_branches_share() {
        let mut pool = Pool::new();
        let x = pool.variable(VarId(0));
        let mut value = pool.function("exp", &[x]);
        for step in 1..6 {
            let limit = pool.constant(f64::from(step) / 6.0);
            let condition = pool.relation(RelationOperator::Less, x, limit);
            let (scaled, root) = (pool.div(value, limit), pool.function("sqrt", &[value]));
            let (first, second) = (pool.add(scaled, root), pool.sub(scaled, root));
            let chosen = pool.if_then_else(condition, first, second);
            let again = pool.if_then_else(condition, root, scaled);
            value = pool.add(chosen, again);
        }
        let outputs = [value];
        let (code, mut memory) = compiled(&pool, &outputs);
        let functions = Functions::default();
        let code_of = (&code.tape, &*code.outputs, &functions);
        let function = Function::translated(code_of, Results::InArray, PIECE, Effort::Best);
        let function = function.expect("all of it can be translated");
        for x in [0.05, 0.3, 0.52, 0.8, 1.5] {
            memory[0] = x;
            let mut out = [f64::NAN];
            assert!(function.call(&mut memory, &mut out));
            code.tape.run(&mut memory).expect("all values are finite");
            assert_eq!(out[0].to_bits(), memory[code.outputs[0] as usize].to_bits());
        }
    }

    #[test]
    fn a_tape_becomes_machine_code_when_it_has_run_often() {
        let mut pool = Pool::new();
        let x = pool.variable(VarId(0));
        let outputs = [pool.function("log", &[x])];
        let (code, mut memory) = compiled(&pool, &outputs);
        let mut out = [0.0];
        memory[0] = 2.0;
        let first = (0..2 * OFTEN)
            .position(|_| code.machine_code.run(&code.tape, &code.outputs, &mut memory, &mut out));
        assert_eq!(first, Some(OFTEN as usize + 1));
        assert_eq!(out[0].to_bits(), 2f64.ln().to_bits());
        memory[0] = -1.0;
        assert!(
            !code.machine_code.run(&code.tape, &code.outputs, &mut memory, &mut out),
            "the tape tells what is wrong"
        );
    }

    #[test]
    fn assignments_become_machine_code_that_leaves_variables_in_the_registers() {
        let mut pool = Pool::new();
        let x = pool.variable(VarId(0));
        let root = pool.function("sqrt", &[x]);
        let mut registers = Registers::new(VARIABLES, Arc::new(Functions::default()));
        let mut builder = TapeBuilder::new(&pool, &mut registers);
        builder.store(VarId(1), root);
        let (tape, code) = (builder.finish(), MachineCode::default());
        let mut memory = Memory::new(&registers);
        memory[0] = 2.0;
        let run = |memory: &mut Memory| code.run_in_place(&tape, [&[], &[]], memory);
        let first = (0..2 * OFTEN).position(|_| run(&mut memory));
        assert_eq!(first, Some(OFTEN as usize + 1));
        assert_eq!(memory[1].to_bits(), 2f64.sqrt().to_bits());
        memory[0] = -1.0;
        assert!(!run(&mut memory), "the tape tells what is wrong");
    }
}
