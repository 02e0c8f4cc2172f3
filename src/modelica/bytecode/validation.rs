//! Whether functions that were read from a file can be run: it may have been damaged.
//!
//! What a function computes is not checked, but that every register, text and function which it names
//! is there. Jumps back are paid from the budget, so that no function runs for ever.

use super::code::{Code, Derivative, ExternalCall, Functions, Instruction};
use super::machine::MAX_STACK;
use crate::arithmetic::Operation;
use crate::external::{Slot, SlotKind};

impl Functions {
    /// Whether all that the functions refer to is there.
    pub(crate) fn are_valid(&self) -> bool {
        self.codes.iter().all(|code| self.is_valid(code))
    }

    /// Whether all that a function refers to is there.
    pub(super) fn is_valid(&self, code: &Code) -> bool {
        code.frame as usize <= MAX_STACK
            && code.has(0, code.n_inputs)
            && code.has(code.outputs, code.n_outputs)
            && code.constants.iter().all(|(register, _)| code.has(*register, 1))
            && code.externals.iter().all(|call| code.can_call(call))
            && code.instructions.iter().all(|instruction| self.can_run(code, instruction))
            && code.derivative.iter().all(|derivative| self.fits(code, derivative))
            && code.inverses.iter().all(|(_, inverse)| self.has(inverse.function))
    }

    fn has(&self, function: u32) -> bool {
        (function as usize) < self.codes.len()
    }

    fn can_run(&self, code: &Code, instruction: &Instruction) -> bool {
        let all = |registers: &[u32]| registers.iter().all(|register| code.has(*register, 1));
        match *instruction {
            Instruction::Constant { d: a, .. }
            | Instruction::JumpUnless { a, .. }
            | Instruction::Finite { a } => all(&[a]),
            Instruction::Unassign { d: a, n } | Instruction::Check { a, n } => code.has(a, n),
            Instruction::Move { d, a, n } => code.has(d, n) && code.has(a, n),
            // Where an offset leads to is checked when it is known.
            Instruction::Offset { d, subscript: a, .. }
            | Instruction::Load { d, offset: a, .. }
            | Instruction::Store { offset: d, a, .. } => all(&[d, a]),
            Instruction::Operation(Operation { operator, d, a, b }) => {
                operator.is_valid() && all(&[d, a, b])
            }
            Instruction::Iterations { d, range } => all(&[d]) && code.has(range, 3),
            Instruction::Jump { .. } => true,
            Instruction::Call { function, d, a } => {
                let called = self.codes.get(function as usize);
                called.is_some_and(|c| code.has(a, c.n_inputs) && code.has(d, c.n_outputs))
            }
            Instruction::External { external } => (external as usize) < code.externals.len(),
            Instruction::Assert { a, message } | Instruction::Warn { a, message } => {
                all(&[a]) && (message as usize) < code.messages.len()
            }
        }
    }

    /// Whether a function can take the place of the derivative of another.
    fn fits(&self, code: &Code, derivative: &Derivative) -> bool {
        let n_inputs = code.n_inputs as usize;
        let taken = n_inputs + derivative.tangents.len();
        let takes = |function: u32, n: usize| {
            self.codes.get(function as usize).is_some_and(|c| n <= c.n_inputs as usize)
        };
        let given = self.codes.get(derivative.function as usize).map_or(0, |c| c.n_outputs);
        let mut inputs = derivative.tangents.iter().chain(&derivative.zero);
        takes(derivative.function, taken)
            && derivative.second.iter().all(|f| takes(*f, taken + derivative.tangents.len()))
            && inputs.all(|input| (*input as usize) < n_inputs)
            && derivative.outputs.iter().flatten().all(|output| *output < given)
    }
}

impl Code {
    /// Whether the frame has so many registers from one on.
    fn has(&self, first: u32, n: u32) -> bool {
        first.checked_add(n).is_some_and(|end| end <= self.frame)
    }

    fn can_call(&self, call: &ExternalCall) -> bool {
        call.entry.check(&call.arguments, call.result.as_ref()).is_ok()
            && call.arguments.iter().chain(&call.result).all(|slot| self.has_slot(slot))
    }

    fn has_slot(&self, slot: &Slot) -> bool {
        let size = slot.dims.iter().try_fold(1u32, |size, n| size.checked_mul(*n));
        let Some(end) = size.and_then(|n| slot.first.checked_add(n)) else { return false };
        match slot.kind {
            SlotKind::Text => end as usize <= self.strings.len(),
            SlotKind::Number | SlotKind::Numbered | SlotKind::Object => end <= self.frame,
        }
    }
}
