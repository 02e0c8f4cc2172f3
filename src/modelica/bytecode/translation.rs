//! A function as code of Cranelift, which makes machine code of it.
//!
//! Every result is written to its register at once; a value that was read or written since the last
//! place that a jump leads to is not read again. An instruction that fails has changed nothing: the
//! code ends with its number, and the interpreter says what is wrong.

#![allow(unsafe_code, reason = "machine code hands over registers as pointers")]

use super::angles::{OfAngle, of_angle, shared};
use super::code::{Code, Functions, Instruction};
use super::constants::{constants_of, reads_constants};
use super::direct_calls::{Call, MakeCall, Packed};
use super::machine_code::{Layout, Translated};
use super::range::iterations;
use crate::arithmetic::translation::{Operand, Translator, is_true, sum};
use crate::arithmetic::{Number, Operation, Operator, Register};
use crate::jit::{self, Effort};
use cranelift_codegen::Context;
use cranelift_codegen::ir::condcodes::{FloatCC, IntCC};
use cranelift_codegen::ir::{
    AbiParam, Block, InstBuilder, MemFlagsData, SigRef, Signature, Type, Value, types,
};
use cranelift_codegen::isa::TargetFrontendConfig;
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext, Switch, Variable};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeMap;

/// Longer rows of registers are copied and filled by a function of this process.
const SHORT_ROW: u32 = 8;

/// Instructions beyond which the time of a translation matters more than the best code. Longer functions
/// leave calls to the interpreter: they may take much of the stack of the thread.
const LONG: usize = 3_000;
/// Longer functions are not translated: the time that it takes is more than linear.
const LONGEST: usize = 100_000;

/// The machine code of one of the functions for a kind of number, if it can have any; with what it calls
/// to make calls.
pub(super) fn translated<T: Number>(
    functions: &Functions,
    code: &Code,
    call: MakeCall<T>,
) -> Option<Translated> {
    let length = code.instructions.len();
    if jit::is_interpreted() || length > LONGEST || !functions.is_valid(code) {
        return None;
    }
    let effort = if length <= LONG { Effort::Best } else { Effort::Quick };
    let mut executable = jit::Code::new(effort)?;
    let call = (length <= LONG).then_some(call as *const () as usize);
    let translate =
        |target, context: &mut _| translate((functions, code), (T::PARTS, call), target, context);
    let id = executable.define("function", translate)?;
    let executable = executable.finish()?;
    let address = executable.address(id)?;
    let layout = Layout {
        frame: code.frame as usize,
        parts: T::PARTS,
        reads_constants: reads_constants(functions, code, SHORT_ROW),
    };
    // SAFETY: `translate` makes the signature. Registers that instructions name are in the frame, as was
    // checked above; the code itself checks those that offsets lead to.
    Some(unsafe { Translated::new(executable, address, layout) })
}

/// Writes the code of a function for numbers of one part (values) or two (with a derivative) into a
/// context; it makes calls by the function of this process at an address, if there is one.
fn translate(
    (functions, code): (&Functions, &Code),
    (parts, call): (usize, Option<usize>),
    target: TargetFrontendConfig,
    context: &mut Context,
) -> Option<()> {
    let pointer = target.pointer_type();
    let signature = &mut context.func.signature;
    signature.params.extend([pointer, types::F64, pointer, types::I64, pointer].map(AbiParam::new));
    signature.returns.push(AbiParam::new(types::I64));
    let mut workspace = FunctionBuilderContext::new();
    let mut builder = FunctionBuilder::new(&mut context.func, &mut workspace);
    let start = builder.create_block();
    builder.append_block_params_for_function_params(start);
    builder.switch_to_block(start);
    let frame = builder.declare_var(pointer);
    let given = builder.block_params(start);
    let (unassigned, budget_address, first, caller) = (given[1], given[2], given[3], given[4]);
    let first_frame = given[0];
    builder.def_var(frame, first_frame);
    let left = builder.create_block();
    builder.append_block_param(left, types::I64);
    let budget = builder.declare_var(types::I64);
    let before = builder.ins().load(types::I64, MemFlagsData::trusted(), budget_address, 0);
    builder.def_var(budget, before);
    let translator = Translator::new(&mut builder, target, parts);
    let callees = Callees::new(&mut builder, target);
    let mut translation = Translation {
        builder,
        code,
        parts,
        pointer,
        frame,
        unassigned,
        budget_address,
        budget,
        left,
        caller,
        call,
        operations: translator,
        callees,
        constants: constants_of(functions, code),
        shared_angles: shared(functions, code),
        angle: None,
        blocks: BTreeMap::new(),
        known: FxHashMap::default(),
    };
    translation.begin(first);
    for (at, instruction) in code.instructions.iter().enumerate() {
        translation.enter(at);
        translation.instruction(at, instruction);
    }
    translation.finish(target);
    Some(())
}

/// The signatures of functions of this process.
struct Callees {
    /// [`copy_row`].
    copy: SigRef,
    /// [`fill_row`].
    fill: SigRef,
    /// [`row_lacks`].
    lacks: SigRef,
    /// [`iterations_of`].
    iterations: SigRef,
    /// [`MakeCall`].
    call: SigRef,
}

impl Callees {
    fn new(builder: &mut FunctionBuilder, target: TargetFrontendConfig) -> Callees {
        let pointer = target.pointer_type();
        let mut import = |parameters: &[Type], result: Option<Type>| {
            let mut signature = Signature::new(target.default_call_conv);
            signature.params.extend(parameters.iter().copied().map(AbiParam::new));
            signature.returns.extend(result.map(AbiParam::new));
            builder.import_signature(signature)
        };
        let number = types::F64;
        Callees {
            copy: import(&[pointer; 3], None),
            fill: import(&[pointer, pointer, number, pointer], None),
            lacks: import(&[pointer; 3], Some(types::I64)),
            iterations: import(&[pointer; 2], Some(number)),
            call: import(&[pointer, pointer, types::I64, types::I64, types::I64], Some(pointer)),
        }
    }
}

/// Copies a row of so many parts of numbers.
unsafe extern "C" fn copy_row(from: *const f64, to: *mut f64, parts: usize) {
    // SAFETY: both rows lie in the frame.
    unsafe { std::ptr::copy(from, to, parts) }
}

/// Fills a row of so many numbers with a number without derivative.
unsafe extern "C" fn fill_row(first: *mut f64, n: usize, value: f64, parts: usize) {
    // SAFETY: the row lies in the frame.
    let row = unsafe { std::slice::from_raw_parts_mut(first, n * parts) };
    for number in row.chunks_exact_mut(parts) {
        number.fill(0.0);
        number[0] = value;
    }
}

/// Whether one of so many numbers has no value.
unsafe extern "C" fn row_lacks(first: *const f64, n: usize, parts: usize) -> u64 {
    // SAFETY: the row lies in the frame.
    let row = unsafe { std::slice::from_raw_parts(first, n * parts) };
    u64::from(row.chunks_exact(parts).any(|number| number[0].is_nan()))
}

/// The number of iterations of a loop over a range of three registers; NaN if it cannot be made.
unsafe extern "C" fn iterations_of(range: *const f64, parts: usize) -> f64 {
    // SAFETY: the row lies in the frame.
    let range = unsafe { std::slice::from_raw_parts(range, 3 * parts) };
    iterations(range[0], range[parts], range[2 * parts]).unwrap_or(f64::NAN)
}

struct Translation<'a> {
    builder: FunctionBuilder<'a>,
    code: &'a Code,
    parts: usize,
    pointer: Type,
    /// Where the frame is: the stack may move when a function is called.
    frame: Variable,
    unassigned: Value,
    budget_address: Value,
    budget: Variable,
    /// Writes the budget back and returns the number of an instruction.
    left: Block,
    /// What calls of functions need, and the address of the function that makes them.
    caller: Value,
    call: Option<usize>,
    operations: Translator,
    callees: Callees,
    /// Registers that always hold the same number.
    constants: FxHashMap<Register, f64>,
    /// Instructions that compute the sine or the cosine of an angle whose other one follows.
    shared_angles: FxHashSet<usize>,
    /// The last such angle since the block began, with its sine and cosine.
    angle: Option<(Value, [Value; 2])>,
    /// Where code begins that a jump leads to or that is entered.
    blocks: BTreeMap<usize, Block>,
    /// What registers hold since the block began.
    known: FxHashMap<Register, Operand>,
}

impl Translation<'_> {
    /// Goes to the instruction of this number: the first, one after a call, or the head of a loop.
    fn begin(&mut self, first: Value) {
        let mut entered = vec![0];
        for (at, instruction) in self.code.instructions.iter().enumerate() {
            match *instruction {
                Instruction::Jump { target } | Instruction::JumpUnless { target, .. } => {
                    let target = self.within(target);
                    self.block(target);
                    entered.extend((target <= at).then_some(target));
                }
                Instruction::Call { .. }
                | Instruction::External { .. }
                | Instruction::Warn { .. } => entered.push(at + 1),
                _ => {}
            }
        }
        entered.sort_unstable();
        entered.dedup();
        let mut switch = Switch::new();
        for at in entered {
            let block = self.block(at);
            switch.set_entry(at as u128, block);
        }
        let elsewhere = self.builder.create_block();
        switch.emit(&mut self.builder, first, elsewhere);
        self.builder.switch_to_block(elsewhere);
        self.builder.ins().jump(self.left, &[first.into()]);
    }

    /// The target of a jump; all positions after the last instruction are the end.
    fn within(&self, target: u32) -> usize {
        (target as usize).min(self.code.instructions.len())
    }

    fn block(&mut self, at: usize) -> Block {
        *self.blocks.entry(at).or_insert_with(|| self.builder.create_block())
    }

    /// Begins a block where one begins.
    fn enter(&mut self, at: usize) {
        let Some(block) = self.blocks.get(&at).copied() else {
            if self.is_left() {
                // Nothing leads here.
                let block = self.builder.create_block();
                self.builder.switch_to_block(block);
                self.forget();
            }
            return;
        };
        if !self.is_left() {
            self.builder.ins().jump(block, &[]);
        }
        self.builder.switch_to_block(block);
        self.forget();
    }

    /// Whether the last instruction was a jump.
    fn is_left(&self) -> bool {
        let block = self.builder.current_block();
        let last = block.and_then(|block| self.builder.func.layout.last_inst(block));
        last.is_some_and(|last| self.builder.func.dfg.insts[last].opcode().is_terminator())
    }

    /// Leaves the instruction to the interpreter unless a condition holds.
    fn go_on_if(&mut self, condition: Value, at: usize) {
        let next = self.builder.create_block();
        let number = self.builder.ins().iconst(types::I64, at as i64);
        self.builder.ins().brif(condition, next, &[], self.left, &[number.into()]);
        self.builder.seal_block(next);
        self.builder.switch_to_block(next);
    }

    fn leave(&mut self, at: usize) {
        let number = self.builder.ins().iconst(types::I64, at as i64);
        self.builder.ins().jump(self.left, &[number.into()]);
    }

    /// Forgets what registers hold.
    fn forget(&mut self) {
        self.known.clear();
        self.angle = None;
    }

    fn offset(&self, register: Register) -> i32 {
        (8 * self.parts * register as usize) as i32
    }

    fn address(&mut self, register: Register) -> Value {
        let offset = i64::from(self.offset(register));
        let frame = self.builder.use_var(self.frame);
        self.builder.ins().iadd_imm_s(frame, offset)
    }

    fn read(&mut self, from: Value, offset: i32) -> Operand {
        let flags = MemFlagsData::trusted();
        let v = self.builder.ins().load(types::F64, flags, from, offset);
        let d =
            (self.parts == 2).then(|| self.builder.ins().load(types::F64, flags, from, offset + 8));
        Operand { v, d }
    }

    fn write(&mut self, operand: Operand, to: Value, offset: i32) {
        let flags = MemFlagsData::trusted();
        self.builder.ins().store(flags, operand.v, to, offset);
        if let Some(d) = operand.d {
            self.builder.ins().store(flags, d, to, offset + 8);
        }
    }

    fn get(&mut self, register: Register) -> Operand {
        if let Some(operand) = self.known.get(&register) {
            return *operand;
        }
        let operand = match self.constants.get(&register).copied() {
            Some(value) => {
                let value = self.builder.ins().f64const(value);
                self.constant(value)
            }
            None => {
                let frame = self.builder.use_var(self.frame);
                self.read(frame, self.offset(register))
            }
        };
        self.known.insert(register, operand);
        operand
    }

    fn set(&mut self, d: Register, operand: Operand) {
        let frame = self.builder.use_var(self.frame);
        self.write(operand, frame, self.offset(d));
        self.known.insert(d, operand);
    }

    /// A value without derivative.
    fn constant(&mut self, v: Value) -> Operand {
        self.operations.constant(&mut self.builder, v)
    }

    /// The value of a condition, which must have one.
    fn decided(&mut self, a: Register, at: usize) -> Value {
        let a = self.get(a).v;
        let has_value = self.builder.ins().fcmp(FloatCC::Ordered, a, a);
        self.go_on_if(has_value, at);
        is_true(&mut self.builder, a)
    }

    fn go_on_if_finite(&mut self, value: Value, at: usize) {
        let magnitude = self.builder.ins().fabs(value);
        let infinite = self.builder.ins().f64const(f64::INFINITY);
        let is_finite = self.builder.ins().fcmp(FloatCC::LessThan, magnitude, infinite);
        self.go_on_if(is_finite, at);
    }

    fn instruction(&mut self, at: usize, instruction: &Instruction) {
        match *instruction {
            Instruction::Constant { d, value } => {
                let value = self.builder.ins().f64const(value);
                let operand = self.constant(value);
                self.set(d, operand);
            }
            Instruction::Unassign { d, n } => self.fill(d, n),
            Instruction::Move { d, a, n } => self.copy(d, a, n),
            Instruction::Offset { d, subscript, size, stride } => {
                self.subscript(d, subscript, (size, stride), at);
            }
            Instruction::Load { d, base, offset } => {
                let place = self.place(base, offset, at);
                let operand = self.read(place, 0);
                self.set(d, operand);
            }
            Instruction::Store { base, offset, a } => {
                let place = self.place(base, offset, at);
                let operand = self.get(a);
                self.write(operand, place, 0);
                self.forget();
            }
            Instruction::Iterations { d, range } => self.iterations(d, range, at),
            Instruction::Jump { target } => {
                self.spend(at, target);
                let target = self.within(target);
                let block = self.blocks[&target];
                self.builder.ins().jump(block, &[]);
            }
            Instruction::JumpUnless { a, target } => self.jump_unless(a, target, at),
            Instruction::Call { function, d, a } => {
                self.call_function(&Call { function, arguments: a, results: d }, at);
            }
            Instruction::External { .. } => self.leave(at),
            Instruction::Check { a, n } => self.check(a, n, at),
            Instruction::Finite { a } => {
                let value = self.get(a).v;
                self.go_on_if_finite(value, at);
            }
            Instruction::Assert { a, .. } | Instruction::Warn { a, .. } => {
                let holds = self.decided(a, at);
                self.go_on_if(holds, at);
            }
            Instruction::Operation(operation) => self.operation(operation, at),
        }
    }

    /// Calls another function, and continues on the frame that is then given back; leaves the call to the
    /// interpreter if there is none.
    fn call_function(&mut self, call: &Call, at: usize) {
        let Some(callee) = self.call else { return self.leave(at) };
        let before = self.builder.use_var(self.budget);
        let flags = MemFlagsData::trusted();
        self.builder.ins().store(flags, before, self.budget_address, 0);
        let packed = Packed::new(call, at as u32);
        let frame = self.builder.use_var(self.frame);
        let numbers = [packed.function_and_place, packed.registers, u64::from(self.code.frame)];
        let numbers = numbers.map(|n| self.builder.ins().iconst(types::I64, n as i64));
        let arguments = [&[self.caller, frame], numbers.as_slice()].concat();
        let frame = self.call(callee, self.callees.call, &arguments);
        let after = self.builder.ins().load(types::I64, flags, self.budget_address, 0);
        self.builder.def_var(self.budget, after);
        let is_made = self.builder.ins().icmp_imm_s(IntCC::NotEqual, frame, 0);
        self.go_on_if(is_made, at);
        self.builder.def_var(self.frame, frame);
        self.forget();
    }

    /// Sets the value of an operation, whose operands must have values and which must be finite where
    /// the interpreter asks for it.
    fn operation(&mut self, operation: Operation, at: usize) {
        let Operation { operator, d, a, b } = operation;
        let (a, b) = (self.get(a), self.get(b));
        if operator.hides_nan() {
            let have_values = self.builder.ins().fcmp(FloatCC::Ordered, a.v, b.v);
            self.go_on_if(have_values, at);
        }
        let result = match self.of_shared_angle(operator, a, at) {
            Some(v) => Operand { v, d: None },
            None => self.operations.operation(&mut self.builder, operator, a, b),
        };
        if operator.may_fail() {
            self.go_on_if_finite(result.v, at);
        }
        self.set(d, result);
    }

    /// The sine or cosine of a value, where the other is known or is computed with it.
    fn of_shared_angle(&mut self, operator: Operator, a: Operand, at: usize) -> Option<Value> {
        let of_angle = of_angle(operator).filter(|_| a.d.is_none())?;
        let known = self.angle.filter(|(angle, _)| *angle == a.v).map(|(_, both)| both);
        let [sine, cosine] = match known {
            Some(both) => both,
            None if self.shared_angles.contains(&at) => {
                let both = self.operations.sine_and_cosine(&mut self.builder, a.v);
                self.angle = Some((a.v, both));
                both
            }
            None => return None,
        };
        Some(match of_angle {
            OfAngle::Sine => sine,
            OfAngle::Cosine => cosine,
        })
    }

    fn number(&mut self, number: usize) -> Value {
        self.builder.ins().iconst(self.pointer, number as i64)
    }

    fn call(&mut self, callee: usize, signature: SigRef, arguments: &[Value]) -> Value {
        let callee = self.number(callee);
        let call = self.builder.ins().call_indirect(signature, callee, arguments);
        self.builder.inst_results(call)[0]
    }

    fn call_for_effect(&mut self, callee: usize, signature: SigRef, arguments: &[Value]) {
        let callee = self.number(callee);
        self.builder.ins().call_indirect(signature, callee, arguments);
    }

    /// A whole subscript from 1 to the size adds to an offset.
    fn subscript(
        &mut self,
        d: Register,
        subscript: Register,
        (size, stride): (u32, u32),
        at: usize,
    ) {
        let subscript = self.get(subscript).v;
        let one = self.builder.ins().f64const(1.0);
        let last = self.builder.ins().f64const(f64::from(size));
        let whole = self.builder.ins().fcvt_to_sint_sat(types::I64, subscript);
        let whole = self.builder.ins().fcvt_from_sint(types::F64, whole);
        let is_whole = self.builder.ins().fcmp(FloatCC::Equal, whole, subscript);
        let begins = self.builder.ins().fcmp(FloatCC::GreaterThanOrEqual, subscript, one);
        let ends = self.builder.ins().fcmp(FloatCC::LessThanOrEqual, subscript, last);
        let is_within = self.builder.ins().band(begins, ends);
        let is_good = self.builder.ins().band(is_whole, is_within);
        self.go_on_if(is_good, at);
        let before = self.builder.ins().fsub(subscript, one);
        let stride = self.builder.ins().f64const(f64::from(stride));
        let offset = self.builder.ins().fmul(before, stride);
        let offset = self.constant(offset);
        let known = self.get(d);
        let sum = sum(&mut self.builder, known, offset);
        self.set(d, sum);
    }

    /// The address of a register of the frame plus an offset.
    fn place(&mut self, base: Register, offset: Register, at: usize) -> Value {
        let offset = self.get(offset).v;
        let zero = self.builder.ins().f64const(0.0);
        let end =
            self.builder.ins().f64const(f64::from(self.code.frame - base.min(self.code.frame)));
        let begins = self.builder.ins().fcmp(FloatCC::GreaterThanOrEqual, offset, zero);
        let ends = self.builder.ins().fcmp(FloatCC::LessThan, offset, end);
        let is_within = self.builder.ins().band(begins, ends);
        self.go_on_if(is_within, at);
        let offset = self.builder.ins().fcvt_to_sint_sat(self.pointer, offset);
        let offset = self.builder.ins().imul_imm_s(offset, 8 * self.parts as i64);
        let first = self.address(base);
        self.builder.ins().iadd(first, offset)
    }

    fn iterations(&mut self, d: Register, range: Register, at: usize) {
        let arguments = [self.address(range), self.number(self.parts)];
        let iterations =
            self.call(iterations_of as *const () as usize, self.callees.iterations, &arguments);
        let has_value = self.builder.ins().fcmp(FloatCC::Ordered, iterations, iterations);
        self.go_on_if(has_value, at);
        let iterations = self.constant(iterations);
        self.set(d, iterations);
    }

    fn jump_unless(&mut self, a: Register, target: u32, at: usize) {
        let holds = self.decided(a, at);
        let (next, taken) = (self.builder.create_block(), self.builder.create_block());
        self.builder.ins().brif(holds, next, &[], taken, &[]);
        self.builder.seal_block(next);
        self.builder.seal_block(taken);
        self.builder.switch_to_block(taken);
        self.spend(at, target);
        let target = self.within(target);
        let block = self.blocks[&target];
        self.builder.ins().jump(block, &[]);
        self.builder.switch_to_block(next);
    }

    /// Takes what a jump costs from the budget, which must suffice.
    fn spend(&mut self, at: usize, target: u32) {
        let cost = (at + 1).saturating_sub(target as usize) as i64 + 1;
        let before = self.builder.use_var(self.budget);
        let suffices =
            self.builder.ins().icmp_imm_s(IntCC::UnsignedGreaterThanOrEqual, before, cost);
        self.go_on_if(suffices, at);
        let after = self.builder.ins().iadd_imm_s(before, -cost);
        self.builder.def_var(self.budget, after);
    }

    fn check(&mut self, a: Register, n: u32, at: usize) {
        if n <= SHORT_ROW {
            for register in a..a + n {
                let value = self.get(register).v;
                let has_value = self.builder.ins().fcmp(FloatCC::Ordered, value, value);
                self.go_on_if(has_value, at);
            }
            return;
        }
        let arguments = [self.address(a), self.number(n as usize), self.number(self.parts)];
        let lacks = self.call(row_lacks as *const () as usize, self.callees.lacks, &arguments);
        let has_all = self.builder.ins().icmp_imm_s(IntCC::Equal, lacks, 0);
        self.go_on_if(has_all, at);
    }

    fn fill(&mut self, d: Register, n: u32) {
        if n <= SHORT_ROW {
            for register in d..d + n {
                let operand = self.constant(self.unassigned);
                self.set(register, operand);
            }
            return;
        }
        let (first, n, parts) = (self.address(d), self.number(n as usize), self.number(self.parts));
        let arguments = [first, n, self.unassigned, parts];
        self.call_for_effect(fill_row as *const () as usize, self.callees.fill, &arguments);
        self.forget();
    }

    fn copy(&mut self, d: Register, a: Register, n: u32) {
        if n <= SHORT_ROW {
            // The rows may overlap: all are read first.
            let row: Vec<Operand> = (a..a + n).map(|register| self.get(register)).collect();
            row.into_iter().zip(d..).for_each(|(operand, d)| self.set(d, operand));
            return;
        }
        let parts = self.parts * n as usize;
        let arguments = [self.address(a), self.address(d), self.number(parts)];
        self.call_for_effect(copy_row as *const () as usize, self.callees.copy, &arguments);
        self.forget();
    }

    fn finish(mut self, target: TargetFrontendConfig) {
        let end = self.code.instructions.len();
        self.enter(end);
        if !self.is_left() {
            self.leave(end);
        }
        self.builder.switch_to_block(self.left);
        let number = self.builder.block_params(self.left)[0];
        let budget = self.builder.use_var(self.budget);
        let flags = MemFlagsData::trusted();
        self.builder.ins().store(flags, budget, self.budget_address, 0);
        self.builder.ins().return_(&[number]);
        self.builder.seal_all_blocks();
        self.builder.finalize(target);
    }
}
