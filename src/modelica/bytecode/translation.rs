//! A function as code of Cranelift, which makes machine code of it.
//!
//! Every result is written to its register at once; a value that was read or written since the last
//! place that a jump leads to is not read again. An instruction that fails has changed nothing: the
//! code ends with its number, and the interpreter says what is wrong.

#![allow(unsafe_code, reason = "machine code hands over registers as pointers")]

use super::code::{Code, Functions, Instruction, Register};
use super::machine_code::Translated;
use super::range::iterations;
use crate::arithmetic::Elementary;
use crate::arithmetic::{Dual, Number};
use crate::elementary;
use crate::jit::{self, Effort, binary, condition, unary};
use crate::symbolic::function::Value as FunctionValue;
use cranelift_codegen::Context;
use cranelift_codegen::ir::condcodes::{FloatCC, IntCC};
use cranelift_codegen::ir::{
    AbiParam, Block, InstBuilder, MemFlagsData, SigRef, Signature, StackSlot, StackSlotData,
    StackSlotKind, Type, Value, types,
};
use cranelift_codegen::isa::TargetFrontendConfig;
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext, Switch, Variable};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// Longer rows of registers are copied and filled by a function of this process.
const SHORT_ROW: u32 = 8;

/// Instructions beyond which the time of a translation matters more than the best code.
const LONG: usize = 3_000;
/// Longer functions are not translated: the time that it takes is more than linear.
const LONGEST: usize = 100_000;

/// The machine code of one of the functions for a kind of number, if it can have any.
pub(super) fn translated<T: Number>(functions: &Functions, code: &Code) -> Option<Translated> {
    let length = code.instructions.len();
    if jit::is_interpreted() || length > LONGEST || !functions.is_valid(code) {
        return None;
    }
    let effort = if length <= LONG { Effort::Best } else { Effort::Quick };
    let mut executable = jit::Code::new(effort)?;
    let translate = |target, context: &mut _| translate((code, T::PARTS), target, context);
    let id = executable.define("function", translate)?;
    let executable = executable.finish()?;
    let address = executable.address(id)?;
    // SAFETY: `translate` makes the signature. Registers that instructions name are in the frame, as was
    // checked above; the code itself checks those that offsets lead to.
    Some(unsafe { Translated::new(executable, address, (code.frame as usize, T::PARTS)) })
}

/// Writes the code of a function for numbers of one part (values) or two (with a derivative) into a
/// context.
fn translate(
    (code, parts): (&Code, usize),
    target: TargetFrontendConfig,
    context: &mut Context,
) -> Option<()> {
    let pointer = target.pointer_type();
    let signature = &mut context.func.signature;
    signature.params.extend([pointer, types::F64, pointer, types::I64].map(AbiParam::new));
    signature.returns.push(AbiParam::new(types::I64));
    let mut workspace = FunctionBuilderContext::new();
    let mut builder = FunctionBuilder::new(&mut context.func, &mut workspace);
    let start = builder.create_block();
    builder.append_block_params_for_function_params(start);
    builder.switch_to_block(start);
    let given = builder.block_params(start);
    let (frame, unassigned, budget_address, first) = (given[0], given[1], given[2], given[3]);
    let left = builder.create_block();
    builder.append_block_param(left, types::I64);
    let budget = builder.declare_var(types::I64);
    let before = builder.ins().load(types::I64, MemFlagsData::trusted(), budget_address, 0);
    builder.def_var(budget, before);
    let slot = StackSlotData::new(StackSlotKind::ExplicitSlot, 8 * parts as u32, 3);
    let result = builder.create_sized_stack_slot(slot);
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
        result,
        callees,
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
    /// Functions of the table with one and two arguments.
    table: [SigRef; 2],
    /// The same on dual numbers, by address: the function, the operands and the result.
    dual: [SigRef; 2],
    /// [`copy_row`].
    copy: SigRef,
    /// [`fill_row`].
    fill: SigRef,
    /// [`row_lacks`].
    lacks: SigRef,
    /// [`iterations_of`].
    iterations: SigRef,
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
            table: [
                import(&[pointer, number], Some(number)),
                import(&[pointer, number, number], Some(number)),
            ],
            dual: [import(&[pointer; 3], None), import(&[pointer; 4], None)],
            copy: import(&[pointer; 3], None),
            fill: import(&[pointer, pointer, number, pointer], None),
            lacks: import(&[pointer; 3], Some(types::I64)),
            iterations: import(&[pointer; 2], Some(number)),
        }
    }
}

/// A function of one argument on a dual number.
unsafe extern "C" fn dual_unary(
    function: *const Elementary,
    a: *const Dual<f64>,
    result: *mut Dual<f64>,
) {
    // SAFETY: the function is of the table, which lives for ever; a register of the frame; a slot of
    // the stack.
    unsafe { *result = (*a).unary(&*function) }
}

/// A function of two arguments on dual numbers.
unsafe extern "C" fn dual_binary(
    function: *const Elementary,
    a: *const Dual<f64>,
    b: *const Dual<f64>,
    result: *mut Dual<f64>,
) {
    // SAFETY: as in `dual_unary`.
    unsafe { *result = (*a).binary(*b, &*function) }
}

/// A power of dual numbers; the first argument is that of [`dual_binary`] and not used.
unsafe extern "C" fn dual_power(
    _: *const Elementary,
    a: *const Dual<f64>,
    b: *const Dual<f64>,
    result: *mut Dual<f64>,
) {
    // SAFETY: as in `dual_unary`.
    unsafe { *result = (*a).pow(*b) }
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

/// A number with its derivative where it has one.
#[derive(Clone, Copy)]
struct Operand {
    v: Value,
    d: Option<Value>,
}

/// A function of this process for dual numbers, and the address of the one of the table that it takes.
struct OnDuals {
    callee: usize,
    function: usize,
}

struct Translation<'a> {
    builder: FunctionBuilder<'a>,
    code: &'a Code,
    parts: usize,
    pointer: Type,
    frame: Value,
    unassigned: Value,
    budget_address: Value,
    budget: Variable,
    /// Writes the budget back and returns the number of an instruction.
    left: Block,
    /// The result of a function on dual numbers.
    result: StackSlot,
    callees: Callees,
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
                self.known.clear();
            }
            return;
        };
        if !self.is_left() {
            self.builder.ins().jump(block, &[]);
        }
        self.builder.switch_to_block(block);
        self.known.clear();
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

    fn offset(&self, register: Register) -> i32 {
        (8 * self.parts * register as usize) as i32
    }

    fn address(&mut self, register: Register) -> Value {
        let offset = i64::from(self.offset(register));
        self.builder.ins().iadd_imm_s(self.frame, offset)
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
        let operand = self.read(self.frame, self.offset(register));
        self.known.insert(register, operand);
        operand
    }

    fn set(&mut self, d: Register, operand: Operand) {
        self.write(operand, self.frame, self.offset(d));
        self.known.insert(d, operand);
    }

    /// A value without derivative.
    fn constant(&mut self, v: Value) -> Operand {
        let d = (self.parts == 2).then(|| self.builder.ins().f64const(0.0));
        Operand { v, d }
    }

    /// Sets 1 or 0.
    fn set_truth(&mut self, d: Register, holds: Value) {
        let one = self.builder.ins().f64const(1.0);
        let zero = self.builder.ins().f64const(0.0);
        let value = self.builder.ins().select(holds, one, zero);
        let operand = self.constant(value);
        self.set(d, operand);
    }

    /// The value of a condition, which must have one.
    fn decided(&mut self, a: Register, at: usize) -> Value {
        let a = self.get(a).v;
        let has_value = self.builder.ins().fcmp(FloatCC::Ordered, a, a);
        self.go_on_if(has_value, at);
        let zero = self.builder.ins().f64const(0.0);
        self.builder.ins().fcmp(FloatCC::NotEqual, a, zero)
    }

    /// Two operands, which must have values.
    fn given(&mut self, a: Register, b: Register, at: usize) -> [Operand; 2] {
        let (a, b) = (self.get(a), self.get(b));
        let have_values = self.builder.ins().fcmp(FloatCC::Ordered, a.v, b.v);
        self.go_on_if(have_values, at);
        [a, b]
    }

    /// Sets a result that must be finite.
    fn set_finite(&mut self, d: Register, result: Operand, at: usize) {
        self.go_on_if_finite(result.v, at);
        self.set(d, result);
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
                self.known.clear();
            }
            Instruction::Iterations { d, range } => self.iterations(d, range, at),
            Instruction::Jump { target } => {
                self.spend(at, target);
                let target = self.within(target);
                let block = self.blocks[&target];
                self.builder.ins().jump(block, &[]);
            }
            Instruction::JumpUnless { a, target } => self.jump_unless(a, target, at),
            Instruction::Call { .. } | Instruction::External { .. } => self.leave(at),
            Instruction::Check { a, n } => self.check(a, n, at),
            Instruction::Finite { a } => {
                let value = self.get(a).v;
                self.go_on_if_finite(value, at);
            }
            Instruction::Assert { a, .. } | Instruction::Warn { a, .. } => {
                let holds = self.decided(a, at);
                self.go_on_if(holds, at);
            }
            _ => self.arithmetic(at, instruction),
        }
    }

    /// An instruction that computes one number from others.
    fn arithmetic(&mut self, at: usize, instruction: &Instruction) {
        match *instruction {
            Instruction::Neg { d, a } => {
                let a = self.get(a);
                let v = self.builder.ins().fneg(a.v);
                let tangent = a.d.map(|a| self.builder.ins().fneg(a));
                self.set(d, Operand { v, d: tangent });
            }
            Instruction::Not { d, a } => {
                let holds = self.decided(a, at);
                let one = self.builder.ins().iconst(types::I8, 1);
                let opposite = self.builder.ins().bxor(holds, one);
                self.set_truth(d, opposite);
            }
            Instruction::Add { d, a, b } => {
                let (a, b) = (self.get(a), self.get(b));
                let sum = self.sum(a, b);
                self.set(d, sum);
            }
            Instruction::Sub { d, a, b } => {
                let (a, b) = (self.get(a), self.get(b));
                let v = self.builder.ins().fsub(a.v, b.v);
                let tangent = a.d.zip(b.d).map(|(a, b)| self.builder.ins().fsub(a, b));
                self.set(d, Operand { v, d: tangent });
            }
            Instruction::Mul { d, a, b } => self.product(d, a, b),
            Instruction::Div { d, a, b } => self.quotient(d, a, b, at),
            Instruction::Relation { operator, d, a, b } => {
                let [a, b] = self.given(a, b, at);
                let holds = self.builder.ins().fcmp(condition(operator), a.v, b.v);
                self.set_truth(d, holds);
            }
            Instruction::Unary { function, d, a } => self.unary(function, d, a, at),
            Instruction::Pow { d, a, b } => {
                let power = elementary::powf as fn(f64, f64) -> f64;
                let dual = OnDuals { callee: dual_power as *const () as usize, function: 0 };
                self.binary((power, dual), d, [a, b], at);
            }
            Instruction::Binary { function, d, a, b } => {
                let FunctionValue::Binary(value) = function.value else { return self.leave(at) };
                let function = std::ptr::from_ref(function) as usize;
                let dual = OnDuals { callee: dual_binary as *const () as usize, function };
                self.binary((value, dual), d, [a, b], at);
            }
            // The others compute nothing.
            _ => self.leave(at),
        }
    }

    fn sum(&mut self, a: Operand, b: Operand) -> Operand {
        let v = self.builder.ins().fadd(a.v, b.v);
        let d = a.d.zip(b.d).map(|(a, b)| self.builder.ins().fadd(a, b));
        Operand { v, d }
    }

    fn product(&mut self, d: Register, a: Register, b: Register) {
        let (a, b) = (self.get(a), self.get(b));
        let v = self.builder.ins().fmul(a.v, b.v);
        let tangent = a.d.zip(b.d).map(|(tangent_a, tangent_b)| {
            let first = self.builder.ins().fmul(tangent_a, b.v);
            let second = self.builder.ins().fmul(a.v, tangent_b);
            self.builder.ins().fadd(first, second)
        });
        self.set(d, Operand { v, d: tangent });
    }

    fn quotient(&mut self, d: Register, a: Register, b: Register, at: usize) {
        let (a, b) = (self.get(a), self.get(b));
        let v = self.builder.ins().fdiv(a.v, b.v);
        let tangent = a.d.zip(b.d).map(|(tangent_a, tangent_b)| {
            let part = self.builder.ins().fmul(v, tangent_b);
            let rest = self.builder.ins().fsub(tangent_a, part);
            self.builder.ins().fdiv(rest, b.v)
        });
        self.set_finite(d, Operand { v, d: tangent }, at);
    }

    fn unary(&mut self, function: &'static Elementary, d: Register, a: Register, at: usize) {
        let FunctionValue::Unary(value) = function.value else { return self.leave(at) };
        let result = match self.parts {
            1 => {
                let a = self.get(a).v;
                let v = match function.id.get().name {
                    "sqrt" => self.builder.ins().sqrt(a),
                    "abs" => self.builder.ins().fabs(a),
                    _ => {
                        let value = self.number(value as usize);
                        self.call(unary as *const () as usize, self.callees.table[0], &[value, a])
                    }
                };
                Operand { v, d: None }
            }
            _ => {
                let function = self.number(std::ptr::from_ref(function) as usize);
                let a = self.address(a);
                self.on_duals(
                    (dual_unary as *const () as usize, self.callees.dual[0]),
                    &[function, a],
                )
            }
        };
        self.set_finite(d, result, at);
    }

    /// A function of two arguments, on values and on dual numbers.
    fn binary(
        &mut self,
        (value, dual): (fn(f64, f64) -> f64, OnDuals),
        d: Register,
        [a, b]: [Register; 2],
        at: usize,
    ) {
        let given = self.given(a, b, at);
        let result = match self.parts {
            1 => {
                let value = self.number(value as usize);
                let arguments = [value, given[0].v, given[1].v];
                let callee = binary as *const () as usize;
                Operand { v: self.call(callee, self.callees.table[1], &arguments), d: None }
            }
            _ => {
                let arguments = [self.number(dual.function), self.address(a), self.address(b)];
                self.on_duals((dual.callee, self.callees.dual[1]), &arguments)
            }
        };
        self.set_finite(d, result, at);
    }

    /// The result of a function that writes it after its arguments.
    fn on_duals(&mut self, (callee, signature): (usize, SigRef), arguments: &[Value]) -> Operand {
        let result = self.builder.ins().stack_addr(self.pointer, self.result, 0);
        let arguments = [arguments, &[result]].concat();
        self.call_for_effect(callee, signature, &arguments);
        self.read(result, 0)
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
        let sum = self.sum(known, offset);
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
        self.known.clear();
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
        self.known.clear();
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
