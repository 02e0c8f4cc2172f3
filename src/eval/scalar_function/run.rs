//! Executing operations; `None` wherever the general way has to be taken.

use super::{Bounds, Compiled, Instruction, MAX_SLOTS, Operation, ScalarFunction, compile};
use crate::eval::expression::apply;
use crate::eval::scalar::{Scalar, binary, unary};
use crate::eval::{Flow, Function, Host};
use crate::syntax::ast::BinaryOperator;
use crate::value::Value;
use crate::value::construct::Range;

impl Compiled {
    /// The outputs of the function for these values of its inputs; `None` where it has to be
    /// called in the general way.
    pub(in crate::eval) fn call(
        function: &Function,
        given: &[Option<Value>],
        host: &mut dyn Host,
    ) -> Option<Vec<Value>> {
        let compiled = function.compiled.0.get_or_init(|| compile::compile(function, host));
        let compiled = compiled.as_ref()?;
        let mut run = Run { slots: [None; MAX_SLOTS], host };
        run.declare(compiled, given)?;
        run.instructions(&compiled.body)?;
        let outputs = &run.slots[compiled.inputs..compiled.inputs + compiled.outputs];
        outputs.iter().map(|output| output.map(Value::from)).collect()
    }
}

/// One call.
struct Run<'h> {
    /// Values by slot; `None` where there is none yet.
    slots: [Option<Scalar>; MAX_SLOTS],
    host: &'h mut dyn Host,
}

impl Run<'_> {
    fn declare(&mut self, function: &ScalarFunction, given: &[Option<Value>]) -> Option<()> {
        for (slot, component) in function.components.iter().enumerate() {
            let value = match (given.get(slot).and_then(Option::as_ref), &component.binding) {
                (Some(value), _) => Scalar::of(value)?,
                (None, Some(binding)) => self.value(binding)?,
                (None, None) => continue,
            };
            self.slots[slot] = Some(component.kind.convert(value)?);
        }
        Some(())
    }

    fn instructions(&mut self, instructions: &[Instruction]) -> Option<Flow> {
        for instruction in instructions {
            let flow = self.instruction(instruction)?;
            if flow != Flow::Next {
                return Some(flow);
            }
        }
        Some(Flow::Next)
    }

    fn instruction(&mut self, instruction: &Instruction) -> Option<Flow> {
        match instruction {
            Instruction::Assign { slot, kind, value } => {
                self.slots[*slot] = Some(kind.convert(self.value(value)?)?);
            }
            Instruction::If { branches, otherwise } => {
                for (condition, instructions) in branches {
                    if self.condition(condition)? {
                        return self.instructions(instructions);
                    }
                }
                return self.instructions(otherwise);
            }
            Instruction::For { slot, bounds, body } => return self.for_loop(*slot, bounds, body),
            Instruction::While { condition, body } => {
                while self.condition(condition)? {
                    match self.turn(body)? {
                        Flow::Next => {}
                        Flow::Break => return Some(Flow::Next),
                        Flow::Return => return Some(Flow::Return),
                    }
                }
            }
            Instruction::Assert(condition) => {
                return self.condition(condition)?.then_some(Flow::Next);
            }
            Instruction::Break => return Some(Flow::Break),
            Instruction::Return => return Some(Flow::Return),
        }
        Some(Flow::Next)
    }

    fn for_loop(&mut self, slot: usize, bounds: &Bounds, body: &[Instruction]) -> Option<Flow> {
        let start = self.value(&bounds.start)?.into();
        let step = match &bounds.step {
            Some(step) => Some(self.value(step)?.into()),
            None => None,
        };
        let stop = self.value(&bounds.stop)?.into();
        let range = Range::new(&start, step.as_ref(), &stop).ok()?;
        for at in 0..range.count() {
            self.slots[slot] = Some(Scalar::of(&range.get(at))?);
            match self.turn(body)? {
                Flow::Next => {}
                Flow::Break => return Some(Flow::Next),
                Flow::Return => return Some(Flow::Return),
            }
        }
        Some(Flow::Next)
    }

    /// A turn of a loop, unless the user wants to stop.
    fn turn(&mut self, body: &[Instruction]) -> Option<Flow> {
        match self.host.interrupted() {
            None => self.instructions(body),
            Some(_) => None,
        }
    }

    fn condition(&self, operation: &Operation) -> Option<bool> {
        match self.value(operation)? {
            Scalar::Boolean(value) => Some(value),
            _ => None,
        }
    }

    fn value(&self, operation: &Operation) -> Option<Scalar> {
        match operation {
            Operation::Constant(value) => Some(*value),
            Operation::Slot(slot) => self.slots[*slot],
            Operation::Binary(operator, operands) => self.binary(*operator, operands),
            Operation::Unary(operator, operand) => unary(*operator, self.value(operand)?),
            Operation::If(parts) => match self.condition(&parts[0])? {
                true => self.value(&parts[1]),
                false => self.value(&parts[2]),
            },
            Operation::Intrinsic(entry, operands) => {
                let result = match operands.as_slice() {
                    [only] => entry.call(&[self.value(only)?.into()]),
                    [first, second] => {
                        entry.call(&[self.value(first)?.into(), self.value(second)?.into()])
                    }
                    _ => return None,
                };
                Scalar::of(&result.ok()?)
            }
        }
    }

    fn binary(&self, operator: BinaryOperator, operands: &[Operation; 2]) -> Option<Scalar> {
        let a = self.value(&operands[0])?;
        match (operator, a) {
            (BinaryOperator::And, Scalar::Boolean(false))
            | (BinaryOperator::Or, Scalar::Boolean(true)) => return Some(a),
            _ => {}
        }
        let b = self.value(&operands[1])?;
        binary(operator, a, b).or_else(|| Scalar::of(&apply(operator, &a.into(), &b.into()).ok()?))
    }
}
