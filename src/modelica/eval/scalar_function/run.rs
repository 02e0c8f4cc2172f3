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
        let compiled = Compiled::of(function, host)?;
        let scalar = |at: usize| match given.get(at).and_then(Option::as_ref) {
            Some(value) => Scalar::of(value).map(Some),
            None => Some(None),
        };
        let slots = compiled.slots(scalar, host)?;
        let outputs = &slots[compiled.inputs..compiled.inputs + compiled.outputs];
        outputs.iter().map(|output| output.map(Value::from)).collect()
    }

    /// The first output for arguments that `scalar` gives by their position, `count` of them.
    pub(in crate::eval) fn first_output(
        function: &Function,
        count: usize,
        scalar: impl Fn(usize) -> Option<Scalar>,
        host: &mut dyn Host,
    ) -> Option<Scalar> {
        let compiled = Compiled::of(function, host)?;
        if count > compiled.inputs || compiled.outputs == 0 {
            return None;
        }
        let given = |at: usize| match at < count {
            true => scalar(at).map(Some),
            false => Some(None),
        };
        compiled.slots(given, host)?[compiled.inputs]
    }

    fn of<'f>(function: &'f Function, host: &mut dyn Host) -> Option<&'f ScalarFunction> {
        let compiled = &function.compiled.0;
        compiled.get_or_init(|| compile::compile(function, host)).as_ref()
    }
}

impl ScalarFunction {
    /// The values of all slots once the function has run. `given` knows the arguments by position:
    /// `Some(None)` where the default counts, `None` where one is not a scalar.
    fn slots(
        &self,
        given: impl Fn(usize) -> Option<Option<Scalar>>,
        host: &mut dyn Host,
    ) -> Option<[Option<Scalar>; MAX_SLOTS]> {
        let mut run = Run { slots: [None; MAX_SLOTS], host };
        for (slot, component) in self.components.iter().enumerate() {
            let given = if slot < self.inputs { given(slot)? } else { None };
            let value = match (given, &component.binding) {
                (Some(value), _) => value,
                (None, Some(binding)) => run.value(binding)?,
                (None, None) if slot < self.inputs => return None,
                (None, None) => continue,
            };
            run.slots[slot] = Some(component.kind.convert(value)?);
        }
        run.instructions(&self.body)?;
        // Every output has a value, or the general way says which has none.
        let outputs = &run.slots[self.inputs..self.inputs + self.outputs];
        outputs.iter().all(Option::is_some).then_some(run.slots)
    }
}

/// One call.
struct Run<'h> {
    /// Values by slot; `None` where there is none yet.
    slots: [Option<Scalar>; MAX_SLOTS],
    host: &'h mut dyn Host,
}

impl Run<'_> {
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
                    match self.iteration(body)? {
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
            match self.iteration(body)? {
                Flow::Next => {}
                Flow::Break => return Some(Flow::Next),
                Flow::Return => return Some(Flow::Return),
            }
        }
        Some(Flow::Next)
    }

    /// An iteration of a loop, unless the user stops it.
    fn iteration(&mut self, body: &[Instruction]) -> Option<Flow> {
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
            Operation::Builtin(entry, operands) => {
                let result = match operands.as_slice() {
                    [only] => entry.value(&[self.value(only)?.into()]),
                    [first, second] => {
                        entry.value(&[self.value(first)?.into(), self.value(second)?.into()])
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
