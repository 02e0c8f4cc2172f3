//! Operations as code of Cranelift, on values and on dual numbers.
//!
//! Nothing is checked here: tapes and functions differ in what they do with a value that is not
//! finite.

#![allow(unsafe_code, reason = "machine code hands over results as pointers")]

use super::dual::Dual;
use super::elementary::Elementary;
use super::number::Number;
use super::operation::Operator;
use crate::elementary;
use crate::symbolic::RelationOperator;
use crate::symbolic::function::Value as FunctionValue;
use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{
    AbiParam, InstBuilder, MemFlagsData, SigRef, Signature, StackSlot, StackSlotData,
    StackSlotKind, Type, Value, types,
};
use cranelift_codegen::isa::TargetFrontendConfig;
use cranelift_frontend::FunctionBuilder;

/// A number with its derivative where it has one.
#[derive(Clone, Copy)]
pub(crate) struct Operand {
    pub(crate) v: Value,
    pub(crate) d: Option<Value>,
}

/// Writes operations of one function.
pub(crate) struct Translator {
    pointer: Type,
    /// Functions of the table with one and two arguments.
    table: [SigRef; 2],
    /// [`sine_and_cosine`], and where it writes to.
    angle: (SigRef, StackSlot),
    /// Where numbers have derivatives: the same with one and two arguments, and where they write
    /// their result to.
    dual: Option<([SigRef; 2], StackSlot)>,
}

impl Translator {
    /// For numbers of one part (values) or two (with a derivative).
    pub(crate) fn new(
        builder: &mut FunctionBuilder,
        target: TargetFrontendConfig,
        parts: usize,
    ) -> Translator {
        let pointer = target.pointer_type();
        let mut import = |numbers: usize, rest: &[Type], result: Option<Type>| {
            let mut signature = Signature::new(target.default_call_conv);
            let numbers = std::iter::repeat_n(types::F64, numbers);
            let parameters = [pointer].into_iter().chain(numbers).chain(rest.iter().copied());
            signature.params.extend(parameters.map(AbiParam::new));
            signature.returns.extend(result.map(AbiParam::new));
            builder.import_signature(signature)
        };
        let table = [1, 2].map(|arity| import(arity, &[], Some(types::F64)));
        let dual = (parts == 2).then(|| [2, 4].map(|numbers| import(numbers, &[pointer], None)));
        let mut angle = Signature::new(target.default_call_conv);
        angle.params.extend([types::F64, pointer].map(AbiParam::new));
        let angle = builder.import_signature(angle);
        let mut two_numbers = || {
            let slot = StackSlotData::new(StackSlotKind::ExplicitSlot, 16, 3);
            builder.create_sized_stack_slot(slot)
        };
        let angle = (angle, two_numbers());
        let dual = dual.map(|signatures| (signatures, two_numbers()));
        Translator { pointer, table, angle, dual }
    }

    /// A value without derivative.
    pub(crate) fn constant(&self, builder: &mut FunctionBuilder, v: Value) -> Operand {
        let d = self.dual.is_some().then(|| builder.ins().f64const(0.0));
        Operand { v, d }
    }

    /// 1 or 0.
    fn truth(&self, builder: &mut FunctionBuilder, holds: Value) -> Operand {
        let one = builder.ins().f64const(1.0);
        let zero = builder.ins().f64const(0.0);
        let value = builder.ins().select(holds, one, zero);
        self.constant(builder, value)
    }

    /// The value of an operation, as [`Operator::of`] gives it.
    pub(crate) fn operation(
        &self,
        builder: &mut FunctionBuilder,
        operator: Operator,
        a: Operand,
        b: Operand,
    ) -> Operand {
        match operator {
            Operator::Neg => {
                let v = builder.ins().fneg(a.v);
                Operand { v, d: a.d.map(|d| builder.ins().fneg(d)) }
            }
            Operator::Not => {
                let zero = builder.ins().f64const(0.0);
                let holds = builder.ins().fcmp(FloatCC::Equal, a.v, zero);
                self.truth(builder, holds)
            }
            Operator::Add => sum(builder, a, b),
            Operator::Sub => {
                let v = builder.ins().fsub(a.v, b.v);
                Operand { v, d: a.d.zip(b.d).map(|(a, b)| builder.ins().fsub(a, b)) }
            }
            Operator::Mul => product(builder, a, b),
            Operator::Div => quotient(builder, a, b),
            Operator::And => {
                let (a, b) = (is_true(builder, a.v), is_true(builder, b.v));
                let holds = builder.ins().band(a, b);
                self.truth(builder, holds)
            }
            Operator::Or => {
                let (a, b) = (is_true(builder, a.v), is_true(builder, b.v));
                let holds = builder.ins().bor(a, b);
                self.truth(builder, holds)
            }
            Operator::Relation(operator) => {
                let holds = builder.ins().fcmp(condition(operator), a.v, b.v);
                self.truth(builder, holds)
            }
            Operator::Unary(function) => self.unary(builder, function, a),
            Operator::Pow => {
                let of_values = elementary::powf as fn(f64, f64) -> f64;
                self.binary(builder, of_values, (dual_power as *const () as usize, 0), [a, b])
            }
            Operator::Binary(function) => match function.value {
                FunctionValue::Binary(of_values) => {
                    let address = std::ptr::from_ref(function) as usize;
                    let of_duals = (dual_binary as *const () as usize, address);
                    self.binary(builder, of_values, of_duals, [a, b])
                }
                FunctionValue::Unary(_) => self.nothing(builder),
            },
        }
    }

    /// What has no value.
    fn nothing(&self, builder: &mut FunctionBuilder) -> Operand {
        let v = builder.ins().f64const(f64::NAN);
        self.constant(builder, v)
    }

    fn unary(
        &self,
        builder: &mut FunctionBuilder,
        function: &'static Elementary,
        a: Operand,
    ) -> Operand {
        if let Some(d) = a.d {
            let address = std::ptr::from_ref(function) as usize;
            let function = builder.ins().iconst(self.pointer, address as i64);
            return self.on_duals(builder, dual_unary as *const () as usize, &[function, a.v, d]);
        }
        let FunctionValue::Unary(of_values) = function.value else { return self.nothing(builder) };
        let v = match function.id.get().name {
            "sqrt" => builder.ins().sqrt(a.v),
            "abs" => builder.ins().fabs(a.v),
            _ => self.on_values(builder, (unary as *const () as usize, of_values as usize), &[a.v]),
        };
        Operand { v, d: None }
    }

    /// A function of two arguments: on values, on dual numbers (with what it takes first).
    fn binary(
        &self,
        builder: &mut FunctionBuilder,
        of_values: fn(f64, f64) -> f64,
        (of_duals, function): (usize, usize),
        [a, b]: [Operand; 2],
    ) -> Operand {
        if let Some((first, second)) = a.d.zip(b.d) {
            let function = builder.ins().iconst(self.pointer, function as i64);
            return self.on_duals(builder, of_duals, &[function, a.v, first, b.v, second]);
        }
        let callee = (binary as *const () as usize, of_values as usize);
        Operand { v: self.on_values(builder, callee, &[a.v, b.v]), d: None }
    }

    /// Calls a function of the table by the function of this process that does so.
    fn on_values(
        &self,
        builder: &mut FunctionBuilder,
        (callee, function): (usize, usize),
        arguments: &[Value],
    ) -> Value {
        let signature = self.table[arguments.len() - 1];
        let callee = builder.ins().iconst(self.pointer, callee as i64);
        let function = builder.ins().iconst(self.pointer, function as i64);
        let arguments = [&[function], arguments].concat();
        let call = builder.ins().call_indirect(signature, callee, &arguments);
        builder.inst_results(call)[0]
    }

    /// Sine and cosine of a value.
    pub(crate) fn sine_and_cosine(&self, builder: &mut FunctionBuilder, a: Value) -> [Value; 2] {
        let (signature, slot) = self.angle;
        let callee = sine_and_cosine as *const () as usize;
        let callee = builder.ins().iconst(self.pointer, callee as i64);
        let result = builder.ins().stack_addr(self.pointer, slot, 0);
        builder.ins().call_indirect(signature, callee, &[a, result]);
        let flags = MemFlagsData::trusted();
        [0, 8].map(|offset| builder.ins().load(types::F64, flags, result, offset))
    }

    /// The result of a function that writes it where its last argument points to.
    fn on_duals(
        &self,
        builder: &mut FunctionBuilder,
        callee: usize,
        arguments: &[Value],
    ) -> Operand {
        let Some((signatures, slot)) = self.dual else { return self.nothing(builder) };
        let signature = signatures[usize::from(arguments.len() > 3)];
        let callee = builder.ins().iconst(self.pointer, callee as i64);
        let result = builder.ins().stack_addr(self.pointer, slot, 0);
        let arguments = [arguments, &[result]].concat();
        builder.ins().call_indirect(signature, callee, &arguments);
        let flags = MemFlagsData::trusted();
        let v = builder.ins().load(types::F64, flags, result, 0);
        let d = builder.ins().load(types::F64, flags, result, 8);
        Operand { v, d: Some(d) }
    }
}

/// Whether a number is true.
pub(crate) fn is_true(builder: &mut FunctionBuilder, a: Value) -> Value {
    let zero = builder.ins().f64const(0.0);
    builder.ins().fcmp(FloatCC::NotEqual, a, zero)
}

pub(crate) fn sum(builder: &mut FunctionBuilder, a: Operand, b: Operand) -> Operand {
    let v = builder.ins().fadd(a.v, b.v);
    Operand { v, d: a.d.zip(b.d).map(|(a, b)| builder.ins().fadd(a, b)) }
}

fn product(builder: &mut FunctionBuilder, a: Operand, b: Operand) -> Operand {
    let v = builder.ins().fmul(a.v, b.v);
    let d = a.d.zip(b.d).map(|(tangent_a, tangent_b)| {
        let first = builder.ins().fmul(tangent_a, b.v);
        let second = builder.ins().fmul(a.v, tangent_b);
        builder.ins().fadd(first, second)
    });
    Operand { v, d }
}

fn quotient(builder: &mut FunctionBuilder, a: Operand, b: Operand) -> Operand {
    let v = builder.ins().fdiv(a.v, b.v);
    let d = a.d.zip(b.d).map(|(tangent_a, tangent_b)| {
        let part = builder.ins().fmul(v, tangent_b);
        let rest = builder.ins().fsub(tangent_a, part);
        builder.ins().fdiv(rest, b.v)
    });
    Operand { v, d }
}

/// The comparison that a relation makes.
fn condition(operator: RelationOperator) -> FloatCC {
    match operator {
        RelationOperator::Less => FloatCC::LessThan,
        RelationOperator::LessEqual => FloatCC::LessThanOrEqual,
        RelationOperator::Greater => FloatCC::GreaterThan,
        RelationOperator::GreaterEqual => FloatCC::GreaterThanOrEqual,
        RelationOperator::Equal => FloatCC::Equal,
        RelationOperator::NotEqual => FloatCC::NotEqual,
    }
}

/// Calls a function of the table.
#[allow(improper_ctypes_definitions, reason = "only code of this process calls it")]
extern "C" fn unary(function: fn(f64) -> f64, a: f64) -> f64 {
    function(a)
}

/// Calls a function of the table.
#[allow(improper_ctypes_definitions, reason = "only code of this process calls it")]
extern "C" fn binary(function: fn(f64, f64) -> f64, a: f64, b: f64) -> f64 {
    function(a, b)
}

/// Writes sine and cosine of a number.
unsafe extern "C" fn sine_and_cosine(a: f64, result: *mut [f64; 2]) {
    // SAFETY: a slot of the stack.
    unsafe { *result = elementary::sin_cos(a).into() }
}

/// A function of one argument on a dual number.
unsafe extern "C" fn dual_unary(
    function: *const Elementary,
    v: f64,
    d: f64,
    result: *mut Dual<f64>,
) {
    // SAFETY: the function is of the table, which lives for ever; a slot of the stack.
    unsafe { *result = Dual { v, d }.unary(&*function) }
}

/// A function of two arguments on dual numbers.
unsafe extern "C" fn dual_binary(
    function: *const Elementary,
    a: f64,
    a_tangent: f64,
    b: f64,
    b_tangent: f64,
    result: *mut Dual<f64>,
) {
    let (a, b) = (Dual { v: a, d: a_tangent }, Dual { v: b, d: b_tangent });
    // SAFETY: as in `dual_unary`.
    unsafe { *result = a.binary(b, &*function) }
}

/// A power of dual numbers; the first argument is that of [`dual_binary`] and not used.
unsafe extern "C" fn dual_power(
    _: *const Elementary,
    a: f64,
    a_tangent: f64,
    b: f64,
    b_tangent: f64,
    result: *mut Dual<f64>,
) {
    let (a, b) = (Dual { v: a, d: a_tangent }, Dual { v: b, d: b_tangent });
    // SAFETY: a slot of the stack.
    unsafe { *result = a.pow(b) }
}
