//! A tape as code of Cranelift, which makes machine code of it.
//!
//! Results stay in registers of the machine; only outputs are written to memory. Where the tape
//! fails at a value that is not finite, the code continues and adds up `0 · value`: the sum, which
//! it returns, is zero if all were finite. Calls of functions and linear systems that need a
//! workspace are [upcalls](super::upcalls), which are only made while all values are finite.

use super::instruction::{Instruction, LinearSolve};
use super::linear_system::{MOST_SMALL, SMALLEST_DETERMINANT, eliminate};
use super::regions::shared_by_branches;
use super::tape::Tape;
use super::upcalls::{self, Upcalls};
use crate::arithmetic::translation::{Operand, Translator, is_true};
use crate::arithmetic::{Operation, Register};
use cranelift_codegen::Context;
use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{
    AbiParam, Block, InstBuilder, MemFlagsData, SigRef, Signature, StackSlot, StackSlotData,
    StackSlotKind, Type, Value, types,
};
use cranelift_codegen::isa::TargetFrontendConfig;
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext, Variable};
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

/// Sums of `0 · value` that are added to in turn.
const CHECKS: usize = 4;

/// What becomes one function: instructions of a tape, without routines, that jump to each other
/// alone, and where values go.
#[derive(Clone, Copy)]
pub(super) struct Part<'a> {
    pub(super) tape: &'a Tape,
    pub(super) upcalls: &'a Upcalls,
    pub(super) instructions: &'a [Instruction],
    /// Registers with their places in the array of results.
    pub(super) outputs: &'a [(Register, usize)],
    /// Whether branches that are not taken leave what the memory holds.
    pub(super) keeps: bool,
}

/// Writes the code of a part of a tape into a context; `None` if it has what cannot be translated.
/// `matrices` are the entries of the matrix in each workspace, by rows, before and after it.
pub(super) fn translate(
    part: Part,
    matrices: &mut Matrices,
    target: TargetFrontendConfig,
    context: &mut Context,
) -> Option<()> {
    let Part { tape, upcalls, instructions, outputs, keeps } = part;
    let pointer = target.pointer_type();
    let signature = &mut context.func.signature;
    signature.params.extend([AbiParam::new(pointer); 3]);
    signature.returns.push(AbiParam::new(types::F64));
    let mut workspace = FunctionBuilderContext::new();
    let mut builder = FunctionBuilder::new(&mut context.func, &mut workspace);
    let start = builder.create_block();
    builder.append_block_params_for_function_params(start);
    builder.switch_to_block(start);
    builder.seal_block(start);
    let parameters = builder.block_params(start);
    let (memory, out, workspaces) = (parameters[0], parameters[1], parameters[2]);
    let operations = Translator::new(&mut builder, target, 1);
    let signatures = signatures(&mut builder, target);
    let array = (upcalls.room() > 0).then(|| array_of(upcalls.room(), &mut builder));
    let checks = std::array::from_fn(|_| builder.declare_var(types::F64));
    let zero = builder.ins().f64const(0.0);
    checks.iter().for_each(|check| builder.def_var(*check, zero));
    let mut translation = Translation {
        builder,
        tape,
        outputs,
        upcalls,
        instructions,
        pointer,
        memory,
        out,
        workspaces,
        array,
        failed: None,
        values: FxHashMap::default(),
        chosen: FxHashMap::default(),
        blocks: FxHashMap::default(),
        matrices,
        places: FxHashMap::default(),
        operations,
        signatures,
        checks,
        next_check: 0,
    };
    translation.prepare();
    if keeps {
        translation.begin_with_the_memory();
    }
    for (at, instruction) in instructions.iter().enumerate() {
        translation.enter(at);
        translation.instruction(*instruction)?;
    }
    translation.enter(instructions.len());
    translation.finish(target);
    Some(())
}

/// So many numbers on the stack.
fn array_of(length: usize, builder: &mut FunctionBuilder) -> StackSlot {
    let slot = StackSlotData::new(StackSlotKind::ExplicitSlot, 8 * length as u32, 3);
    builder.create_sized_stack_slot(slot)
}

/// The signatures of [`small_system`] and of the upcalls.
fn signatures(builder: &mut FunctionBuilder, target: TargetFrontendConfig) -> Signatures {
    let pointer = target.pointer_type();
    let mut signature = Signature::new(target.default_call_conv);
    signature.params.extend([AbiParam::new(pointer), AbiParam::new(pointer)]);
    let elimination = builder.import_signature(signature);
    let asking = [3, 4].map(|arguments| {
        let mut signature = Signature::new(target.default_call_conv);
        signature.params.extend(std::iter::repeat_n(AbiParam::new(pointer), arguments));
        signature.returns.push(AbiParam::new(types::F64));
        builder.import_signature(signature)
    });
    Signatures { elimination, asking }
}

/// Room for A by rows and b after it.
const SMALL_SYSTEM: usize = MOST_SMALL * (MOST_SMALL + 1);

/// Replaces b by the solution of n equations, by what is not a number if they are not clearly
/// regular.
extern "C" fn small_system(system: &mut [f64; SMALL_SYSTEM], n: usize) {
    let (a, b) = system[..n * (n + 1)].split_at_mut(n * n);
    if !eliminate(a, b) {
        b[0] = f64::NAN;
    }
}

/// The entries of the matrix in each workspace, by rows.
pub(super) type Matrices = FxHashMap<u32, Box<[(u32, Register)]>>;

struct Translation<'a> {
    builder: FunctionBuilder<'a>,
    tape: &'a Tape,
    outputs: &'a [(Register, usize)],
    upcalls: &'a Upcalls,
    instructions: &'a [Instruction],
    pointer: Type,
    memory: Value,
    out: Value,
    workspaces: Value,
    /// Operands and results of upcalls.
    array: Option<StackSlot>,
    /// Returns what is not a number.
    failed: Option<Block>,
    /// Registers that are written once, before they are read.
    values: FxHashMap<Register, Value>,
    /// Registers that a branch gives a value and that are read outside of it.
    chosen: FxHashMap<Register, Variable>,
    /// Targets of jumps.
    blocks: FxHashMap<usize, Block>,
    /// The entries of the matrix in each workspace, by rows.
    matrices: &'a mut Matrices,
    /// Where registers are written to that are outputs.
    places: FxHashMap<Register, Vec<usize>>,
    operations: Translator,
    signatures: Signatures,
    checks: [Variable; CHECKS],
    next_check: usize,
}

/// Signatures of the functions that code calls.
struct Signatures {
    /// The signature of [`small_system`].
    elimination: SigRef,
    /// The signatures of the upcalls: of linear systems, of functions.
    asking: [SigRef; 2],
}

impl Translation<'_> {
    fn prepare(&mut self) {
        let mut targets = BTreeSet::new();
        for instruction in self.instructions {
            match *instruction {
                Instruction::Jump { target } | Instruction::JumpUnless { target, .. } => {
                    targets.insert(target as usize);
                }
                Instruction::Move { d, .. } => self.choose(d),
                _ => {}
            }
        }
        let mut shared: Vec<Register> =
            shared_by_branches(self.instructions, self.tape, self.upcalls).into_iter().collect();
        shared.sort_unstable();
        shared.into_iter().for_each(|register| self.choose(register));
        for target in targets {
            let block = self.builder.create_block();
            self.blocks.insert(target, block);
        }
        for (register, place) in self.outputs {
            self.places.entry(*register).or_default().push(*place);
        }
    }

    fn begin_with_the_memory(&mut self) {
        let mut chosen: Vec<(Register, Variable)> =
            self.chosen.iter().map(|(register, variable)| (*register, *variable)).collect();
        chosen.sort_unstable_by_key(|(register, _)| *register);
        for (register, variable) in chosen {
            let value = self.load(register);
            self.builder.def_var(variable, value);
        }
    }

    fn choose(&mut self, register: Register) {
        let declare = || self.builder.declare_var(types::F64);
        self.chosen.entry(register).or_insert_with(declare);
    }

    /// Begins a block where jumps lead to. They lead forwards: all that lead here are written.
    fn enter(&mut self, at: usize) {
        if let Some(block) = self.blocks.get(&at).copied() {
            let here = self.builder.current_block();
            if here.is_some() && !self.is_left() {
                self.builder.ins().jump(block, &[]);
            }
            self.builder.switch_to_block(block);
            self.builder.seal_block(block);
        }
    }

    /// Whether the last instruction was a jump.
    fn is_left(&self) -> bool {
        let block = self.builder.current_block();
        let last = block.and_then(|block| self.builder.func.layout.last_inst(block));
        last.is_some_and(|last| self.builder.func.dfg.insts[last].opcode().is_terminator())
    }

    fn get(&mut self, register: Register) -> Value {
        if let Some(value) = self.values.get(&register) {
            return *value;
        }
        if let Some(variable) = self.chosen.get(&register) {
            return self.builder.use_var(*variable);
        }
        self.load(register)
    }

    fn load(&mut self, register: Register) -> Value {
        let flags = MemFlagsData::trusted();
        self.builder.ins().load(types::F64, flags, self.memory, 8 * register as i32)
    }

    fn set(&mut self, d: Register, value: Value) {
        for at in self.places.get(&d).into_iter().flatten() {
            self.builder.ins().store(MemFlagsData::trusted(), value, self.out, 8 * *at as i32);
        }
        match self.chosen.get(&d) {
            Some(variable) => self.builder.def_var(*variable, value),
            None => _ = self.values.insert(d, value),
        }
    }

    /// Sets a value that must be finite.
    fn set_checked(&mut self, d: Register, value: Value) {
        let zero = self.builder.ins().f64const(0.0);
        let term = self.builder.ins().fmul(value, zero);
        let check = self.checks[self.next_check];
        self.next_check = (self.next_check + 1) % CHECKS;
        let before = self.builder.use_var(check);
        let sum = self.builder.ins().fadd(before, term);
        self.builder.def_var(check, sum);
        self.set(d, value);
    }

    fn instruction(&mut self, instruction: Instruction) -> Option<()> {
        match instruction {
            Instruction::Move { d, a } => {
                let a = self.get(a);
                self.builder.def_var(self.chosen[&d], a);
            }
            Instruction::Operation(operation) => self.operation(operation),
            Instruction::Perform { .. } | Instruction::Return { .. } => return None,
            Instruction::Call { call } => self.ask_for_call(call),
            Instruction::Given { d, a, is_zero, .. } => {
                let a = self.get(a);
                let is_given = self.builder.ins().fcmp(FloatCC::Equal, a, a);
                let value = match is_zero {
                    true => {
                        let zero = self.builder.ins().f64const(0.0);
                        self.builder.ins().select(is_given, a, zero)
                    }
                    false => {
                        self.go_on_if(is_given);
                        a
                    }
                };
                self.set(d, value);
            }
            Instruction::Solve { solve } => match self.upcalls.solve(solve) {
                Some(_) => self.ask_for_solution(solve),
                None => {
                    let tape = self.tape;
                    self.solve(&tape.solves[solve as usize])?;
                }
            },
            Instruction::JumpUnless { a, target } => {
                let a = self.get(a);
                let holds = is_true(&mut self.builder, a);
                let next = self.builder.create_block();
                let target = self.blocks[&(target as usize)];
                self.builder.ins().brif(holds, next, &[], target, &[]);
                self.builder.switch_to_block(next);
                self.builder.seal_block(next);
            }
            Instruction::Jump { target } => {
                let target = self.blocks[&(target as usize)];
                self.builder.ins().jump(target, &[]);
            }
        }
        Some(())
    }

    fn operation(&mut self, operation: Operation) {
        let Operation { operator, d, a, b } = operation;
        let [a, b] = [a, b].map(|register| Operand { v: self.get(register), d: None });
        let value = self.operations.operation(&mut self.builder, operator, a, b).v;
        match operator.may_fail() {
            true => self.set_checked(d, value),
            false => self.set(d, value),
        }
    }

    fn address(&mut self, address: usize) -> Value {
        self.builder.ins().iconst(self.pointer, address as i64)
    }

    /// Few linear equations, as [`LinearSystem`](super::linear_system::LinearSystem) solves regular
    /// ones; others give values that are not finite.
    fn solve(&mut self, solve: &LinearSolve) -> Option<()> {
        if let Some(entries) = &solve.entries {
            self.matrices.insert(solve.system, entries.clone());
        }
        let n = solve.right.len();
        if n > MOST_SMALL {
            return None;
        }
        let mut matrix = [None; MOST_SMALL * MOST_SMALL];
        for (place, register) in self.matrices.get(&solve.system)?.clone() {
            matrix[place as usize] = Some(register);
        }
        let mut entries = Vec::new();
        for register in &matrix[..n * n] {
            let value = match register {
                Some(register) => self.get(*register),
                None => self.builder.ins().f64const(0.0),
            };
            entries.push(value);
        }
        let right: Vec<Value> = solve.right.iter().map(|register| self.get(*register)).collect();
        match (&entries[..], &right[..]) {
            (&[a], &[r]) => {
                let x = self.builder.ins().fdiv(r, a);
                self.set_checked(solve.d, x);
            }
            (&[a, b, c, d], &[r, s]) => {
                let (ad, bc) = (self.builder.ins().fmul(a, d), self.builder.ins().fmul(b, c));
                let determinant = self.builder.ins().fsub(ad, bc);
                let inverse = self.inverse(determinant, ad, bc);
                let x = self.cross(r, d, b, s, inverse);
                let y = self.cross(a, s, r, c, inverse);
                self.set_checked(solve.d, x);
                self.set_checked(solve.d + 1, y);
            }
            _ => self.eliminate(&entries, &right, solve.d),
        }
        Some(())
    }

    /// Writes a system to the stack, calls [`small_system`] and reads the solution.
    fn eliminate(&mut self, entries: &[Value], right: &[Value], d: Register) {
        let slot = array_of(SMALL_SYSTEM, &mut self.builder);
        for (place, value) in (0..).zip(entries.iter().chain(right)) {
            self.builder.ins().stack_store(self.pointer, *value, slot, 8 * place);
        }
        let system = self.builder.ins().stack_addr(self.pointer, slot, 0);
        let n = self.builder.ins().iconst(self.pointer, right.len() as i64);
        let callee = self.address(small_system as *const () as usize);
        self.builder.ins().call_indirect(self.signatures.elimination, callee, &[system, n]);
        for (at, register) in (0..right.len()).zip(d..) {
            let place = 8 * (entries.len() + at) as i32;
            let x = self.builder.ins().stack_load(self.pointer, types::F64, slot, place);
            self.set_checked(register, x);
        }
    }

    /// 1 / determinant, not finite if it is small compared with its terms.
    fn inverse(&mut self, determinant: Value, ad: Value, bc: Value) -> Value {
        let size = {
            let (ad, bc) = (self.builder.ins().fabs(ad), self.builder.ins().fabs(bc));
            self.builder.ins().fadd(ad, bc)
        };
        let smallest = self.builder.ins().f64const(SMALLEST_DETERMINANT);
        let smallest = self.builder.ins().fmul(smallest, size);
        let magnitude = self.builder.ins().fabs(determinant);
        let is_regular = self.builder.ins().fcmp(FloatCC::GreaterThan, magnitude, smallest);
        let one = self.builder.ins().f64const(1.0);
        let inverse = self.builder.ins().fdiv(one, determinant);
        let infinite = self.builder.ins().f64const(f64::INFINITY);
        self.builder.ins().select(is_regular, inverse, infinite)
    }

    /// (a d − b c) · inverse
    fn cross(&mut self, a: Value, d: Value, b: Value, c: Value, inverse: Value) -> Value {
        let (ad, bc) = (self.builder.ins().fmul(a, d), self.builder.ins().fmul(b, c));
        let difference = self.builder.ins().fsub(ad, bc);
        self.builder.ins().fmul(difference, inverse)
    }

    /// A linear system that needs a workspace.
    fn ask_for_solution(&mut self, number: u32) {
        let upcalls = self.upcalls;
        let Some((solve, operands)) = upcalls.solve(number) else { return };
        let entry = (upcalls::solve as *const () as usize, self.signatures.asking[0]);
        let subject = std::ptr::from_ref(solve) as usize;
        let rest = (solve.right.len(), solve.d, self.tape.solves[number as usize].d);
        self.ask(entry, &[subject], operands, rest);
    }

    fn ask_for_call(&mut self, number: u32) {
        let (upcalls, tape) = (self.upcalls, self.tape);
        let (call, results) = upcalls.call(number);
        let known = &tape.calls[number as usize];
        let entry = (upcalls::call as *const () as usize, self.signatures.asking[1]);
        let subject = std::ptr::from_ref(call) as usize;
        self.ask(entry, &[subject, *results], &known.arguments, (*results, call.d, known.d));
    }

    /// An upcall with the operands in these registers; so many results at a place of the array go to
    /// a row of registers.
    fn ask(
        &mut self,
        (entry, signature): (usize, SigRef),
        arguments: &[usize],
        operands: &[Register],
        (results, at, d): (usize, Register, Register),
    ) {
        let Some(array) = self.array else { return };
        let check = self.check();
        let zero = self.builder.ins().f64const(0.0);
        let is_good = self.builder.ins().fcmp(FloatCC::Equal, check, zero);
        self.go_on_if(is_good);
        for (place, register) in (0..).zip(operands) {
            let value = self.get(*register);
            self.builder.ins().stack_store(self.pointer, value, array, 8 * place);
        }
        let array_address = self.builder.ins().stack_addr(self.pointer, array, 0);
        let callee = self.address(entry);
        let mut given = vec![self.workspaces, self.address(arguments[0]), array_address];
        for argument in &arguments[1..] {
            given.push(self.address(*argument));
        }
        let call = self.builder.ins().call_indirect(signature, callee, &given);
        let status = self.builder.inst_results(call)[0];
        let has_results = self.builder.ins().fcmp(FloatCC::Equal, status, zero);
        self.go_on_if(has_results);
        for (place, register) in (at..).zip(d..).take(results) {
            let place = 8 * place as i32;
            let value = self.builder.ins().stack_load(self.pointer, types::F64, array, place);
            self.set(register, value);
        }
    }

    /// Returns what is not a number unless a condition holds.
    fn go_on_if(&mut self, condition: Value) {
        let next = self.builder.create_block();
        let failed = match self.failed {
            Some(block) => block,
            None => *self.failed.insert(self.builder.create_block()),
        };
        self.builder.ins().brif(condition, next, &[], failed, &[]);
        self.builder.switch_to_block(next);
        self.builder.seal_block(next);
    }

    /// The sum of all checks so far.
    fn check(&mut self) -> Value {
        let sums = self.checks.map(|check| self.builder.use_var(check));
        let mut total = sums[0];
        for sum in &sums[1..] {
            total = self.builder.ins().fadd(total, *sum);
        }
        total
    }

    /// Writes the outputs that are not written yet, and returns the check.
    fn finish(mut self, target: TargetFrontendConfig) {
        for (register, place) in self.outputs {
            if !self.values.contains_key(register) {
                let value = self.get(*register);
                self.builder.ins().store(
                    MemFlagsData::trusted(),
                    value,
                    self.out,
                    8 * *place as i32,
                );
            }
        }
        let total = self.check();
        self.builder.ins().return_(&[total]);
        if let Some(failed) = self.failed {
            self.builder.switch_to_block(failed);
            self.builder.seal_block(failed);
            let nothing = self.builder.ins().f64const(f64::NAN);
            self.builder.ins().return_(&[nothing]);
        }
        self.builder.finalize(target);
    }
}
