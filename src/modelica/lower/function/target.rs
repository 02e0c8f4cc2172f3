//! Expressions of a function being compiled.

use super::emitter::Operand;
use super::statements::{Body, Counting};
use crate::arithmetic::{Elementary, Operation, Operator};
use crate::bytecode::Instruction;
use crate::diag::Diagnostic;
use crate::elementary;
use crate::eval::{Function, ValueType};
use crate::flatten::FlatModel;
use crate::lower::expressions::{
    Array, Binary, Branch, Choice, ConditionalValues, CountedLoop, FunctionCalls, Lowered,
    Operations, StringOperations, StringPart, TimeOperators, Unary, VariableReferences,
};
use crate::name::Ident;
use crate::source::Span;
use crate::symbolic::RelationOperator;
use crate::symbolic::function::{FunctionId, Value};
use crate::syntax::ast::{ComponentReference, Subscript};
use std::borrow::Cow;
use std::cell::Cell;
use std::sync::Arc;

impl Body<'_, '_> {
    /// The result of an instruction that writes one register.
    fn computed(&mut self, instruction: impl FnOnce(u32) -> Instruction) -> Operand {
        let d = self.emitter.block(1);
        self.emitter.emit(instruction(d));
        Operand::Register(d)
    }

    /// The result of an operation of one operand.
    fn of_one(&mut self, operator: Operator, a: u32) -> Operand {
        self.computed(|d| Operation::unary(operator, d, a).into())
    }

    /// The result of an operation of two operands.
    fn of_two(&mut self, operator: Operator, a: u32, b: u32) -> Operand {
        self.computed(|d| Operation::binary(operator, d, a, b).into())
    }

    /// A number that may exceed the largest Real.
    fn refused_beyond(&mut self, number: Operand) -> Operand {
        if let (true, Operand::Register(a)) = (self.instances.refuses_overflow, number) {
            self.emitter.emit(Instruction::Finite { a });
        }
        number
    }
}

impl Operations for Body<'_, '_> {
    type Scalar = Operand;

    fn constant(&mut self, value: f64) -> Operand {
        Operand::Constant(value)
    }

    fn as_constant(&self, scalar: Operand) -> Option<f64> {
        match scalar {
            Operand::Constant(value) => Some(value),
            Operand::Register(_) => None,
        }
    }

    fn unary(&mut self, operation: Unary, a: Operand) -> Operand {
        match (operation, a) {
            (Unary::Neg, Operand::Constant(a)) => Operand::Constant(-a),
            (Unary::Not, Operand::Constant(a)) => Operand::Constant(truth(a == 0.0)),
            (Unary::Neg, Operand::Register(a)) => self.of_one(Operator::Neg, a),
            (Unary::Not, Operand::Register(a)) => self.of_one(Operator::Not, a),
        }
    }

    fn binary(&mut self, operation: Binary, a: Operand, b: Operand) -> Operand {
        if let (Operand::Constant(x), Operand::Constant(y)) = (a, b)
            && let Some(value) = folded(operation, x, y)
        {
            return Operand::Constant(value);
        }
        if operation == Binary::Pow && b == Operand::Constant(2.0) {
            return self.binary(Binary::Mul, a, a);
        }
        let (a, b) = (self.emitter.register(a), self.emitter.register(b));
        let operator = match operation {
            Binary::Add => Operator::Add,
            Binary::Sub => Operator::Sub,
            Binary::Mul => Operator::Mul,
            Binary::Div => Operator::Div,
            Binary::Pow => Operator::Pow,
            Binary::And => Operator::And,
            Binary::Or => Operator::Or,
        };
        let result = self.of_two(operator, a, b);
        self.refused_beyond(result)
    }

    fn relation(
        &mut self,
        operator: RelationOperator,
        a: Operand,
        b: Operand,
        _: bool,
        _: Span,
    ) -> Operand {
        if let (Operand::Constant(a), Operand::Constant(b)) = (a, b) {
            return Operand::Constant(truth(operator.holds(a, b)));
        }
        let (a, b) = (self.emitter.register(a), self.emitter.register(b));
        self.of_two(Operator::Relation(operator), a, b)
    }

    fn apply(
        &mut self,
        function: FunctionId,
        arguments: &[Operand],
        _: bool,
        _: Span,
    ) -> Result<Operand, Diagnostic> {
        let known: Option<Vec<f64>> = arguments.iter().map(|a| self.as_constant(*a)).collect();
        if let Some(known) = known {
            let value = function.get().value.of(&known);
            if value.is_finite() {
                return Ok(Operand::Constant(value));
            }
        }
        let function = Elementary::of(function);
        let registers: Vec<u32> = arguments.iter().map(|a| self.emitter.register(*a)).collect();
        Ok(match (function.value, registers.as_slice()) {
            (Value::Unary(_), &[a]) => {
                let result = self.of_one(Operator::Unary(function), a);
                self.refused_beyond(result)
            }
            (Value::Binary(_), &[a, b]) => self.of_two(Operator::Binary(function), a, b),
            _ => unreachable!("lowering checks the number of arguments"),
        })
    }

    fn element(
        &mut self,
        elements: &[Operand],
        position: Operand,
        span: Span,
    ) -> Result<Operand, Diagnostic> {
        let one = Operand::Constant(1.0);
        let subscript = self.binary(Binary::Add, position, one);
        let array = Array { dims: vec![elements.len()], elements: elements.to_vec() };
        let chosen = self.subscripted(&array, vec![Choice::Computed(subscript)], span)?;
        Ok(chosen.elements[0])
    }

    fn chooses(&self) -> bool {
        true
    }

    fn subscripted(
        &mut self,
        array: &Array<Operand>,
        choices: Vec<Choice<Operand>>,
        span: Span,
    ) -> Result<Array<Operand>, Diagnostic> {
        let chosen = self.chosen(&array.dims, choices, span)?;
        let elements = match chosen.offset {
            None => chosen.positions.iter().map(|at| array.elements[*at]).collect(),
            Some(offset) => {
                let first = self.emitter.row(&array.elements);
                let load = |at: &usize| {
                    let base = first + *at as u32;
                    self.computed(|d| Instruction::Load { d, base, offset })
                };
                chosen.positions.iter().map(load).collect()
            }
        };
        Ok(Array { dims: chosen.dims, elements })
    }
}

impl ConditionalValues for Body<'_, '_> {
    fn short_circuits(&self) -> bool {
        true
    }

    fn begin_if(&mut self, condition: Operand) -> Branch<Operand> {
        let skip = self.emitter.jump_unless(condition);
        self.branches.push(skip);
        Branch { condition, values: Vec::new(), asserted: 0 }
    }

    fn begin_else(&mut self, branch: &mut Branch<Operand>, values: &[Operand]) {
        let d = self.emitter.copies(values);
        branch.values = (d..).take(values.len()).map(Operand::Register).collect();
        let end = self.emitter.jump();
        if let Some(skip) = self.branches.last_mut() {
            let skip = std::mem::replace(skip, end);
            self.emitter.land(skip);
        }
    }

    fn end_if(&mut self, branch: Branch<Operand>, values: &[Operand]) -> Vec<Operand> {
        if let Some(Operand::Register(d)) = branch.values.first().copied() {
            self.emitter.copy(d, values);
        }
        if let Some(end) = self.branches.pop() {
            self.emitter.land(end);
        }
        branch.values
    }

    fn runs_loops(&self) -> bool {
        true
    }

    fn begin_counted_loop(
        &mut self,
        range: [Operand; 3],
        value: Operand,
    ) -> Option<CountedLoop<Operand>> {
        let value = Operand::Register(self.emitter.copies(&[value]));
        let range = self.range(range);
        let Counting { variable, start, exit } = self.begin_counting(range);
        Some(CountedLoop { variable: Operand::Register(variable), value, start, exit })
    }

    fn end_counted_loop(&mut self, counted: CountedLoop<Operand>, value: Operand) -> Operand {
        let d = self.emitter.register(counted.value);
        self.emitter.copy(d, &[value]);
        self.emitter.jump_to(counted.start);
        self.emitter.land(counted.exit);
        counted.value
    }
}

impl VariableReferences for Body<'_, '_> {
    fn reference(
        &mut self,
        path: &str,
        reference: &ComponentReference,
    ) -> Result<Lowered<Operand>, Diagnostic> {
        super::local_value(&self.locals, path, reference)
    }

    fn own_variable(&self, name: Ident) -> Option<&Lowered<Operand>> {
        self.locals.iter().find(|(own, _)| *own == name).map(|(_, value)| value)
    }

    fn own_subscripts<'r>(
        &self,
        reference: &'r ComponentReference,
    ) -> Result<Cow<'r, [Subscript]>, Diagnostic> {
        super::subscripts_of(self.function, reference)
    }

    fn value_type(&self, path: &str) -> Option<ValueType> {
        super::component_type(self.function, path)
    }
}

impl FunctionCalls for Body<'_, '_> {
    fn flat(&self) -> &FlatModel {
        self.flat
    }

    fn call(
        &mut self,
        function: &Arc<Function>,
        arguments: Vec<Lowered<Operand>>,
        span: Span,
    ) -> Result<Vec<Lowered<Operand>>, Diagnostic> {
        let known: Vec<Lowered<Option<f64>>> =
            arguments.iter().map(|a| a.map(&mut |operand| self.as_constant(operand))).collect();
        let instance = self.instances.instance(self.flat, function, &known, span)?;
        let scalars = instance.passed_of(&arguments);
        let numbers: Option<Vec<f64>> = match instance.folds {
            true => scalars.iter().map(|s| self.as_constant(*s)).collect(),
            false => None,
        };
        let folded = numbers.and_then(|numbers| self.instances.evaluate(&instance, &numbers));
        let results: Vec<Operand> = match folded {
            Some(values) => values.into_iter().map(Operand::Constant).collect(),
            None => {
                let n: usize = instance.outputs.iter().map(|shape| shape.len()).sum();
                let a = self.emitter.row(&scalars);
                // A call without outputs returns one number, too.
                let d = self.emitter.block(n.max(1) as u32);
                self.emitter.place(span);
                self.emitter.emit(Instruction::Call { function: instance.code, d, a });
                (d..).take(n).map(Operand::Register).collect()
            }
        };
        let mut results = results.into_iter();
        Ok(instance.outputs.iter().map(|s| Lowered::from_scalars(s, &mut results)).collect())
    }

    fn interpreted(&self) -> &Cell<u64> {
        &self.instances.interpreted
    }
}

impl StringOperations for Body<'_, '_> {
    fn string_number(&mut self, text: &Arc<str>) -> Option<Operand> {
        self.composes.then(|| Operand::Constant(self.instances.number_of(text)))
    }

    fn composes(&self) -> bool {
        self.composes
    }

    fn compose(
        &mut self,
        parts: &[StringPart<Operand>],
        span: Span,
    ) -> Result<Operand, Diagnostic> {
        self.emitter.place(span);
        Ok(self.composed(parts))
    }

    fn needs_string_outputs(&mut self, needed: bool) {
        self.instances.needs_string_outputs = needed;
    }

    fn misses_text(&mut self) {
        self.instances.misses_text = true;
    }
}

impl TimeOperators for Body<'_, '_> {}

fn truth(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

/// The result of an operation on numbers, if it is finite.
fn folded(operation: Binary, a: f64, b: f64) -> Option<f64> {
    let value = match operation {
        Binary::Add => a + b,
        Binary::Sub => a - b,
        Binary::Mul => a * b,
        Binary::Div => a / b,
        Binary::Pow => elementary::powf(a, b),
        Binary::And => truth(a != 0.0 && b != 0.0),
        Binary::Or => truth(a != 0.0 || b != 0.0),
    };
    value.is_finite().then_some(value)
}
