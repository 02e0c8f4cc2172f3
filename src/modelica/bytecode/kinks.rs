//! Whether a derivative of a function may jump, by what its instructions are.

use super::code::{Code, Functions, Instruction};
use crate::arithmetic::{Operation, Operator};

impl Functions {
    /// Whether the derivative of a function, or its value, may jump: it decides by a relation, other than
    /// that of a counted loop, calls one of the table that has kinks, or what is not known.
    pub(crate) fn has_kinks(&self, function: u32) -> bool {
        let is_smooth = |code: &Code| !code.instructions.iter().any(|own| code.is_kink(own));
        !self.holds_throughout(function, is_smooth)
    }
}

impl Code {
    fn is_kink(&self, instruction: &Instruction) -> bool {
        match instruction {
            Instruction::Operation(Operation { operator, d, a, .. }) => match operator {
                Operator::Relation(_) => !self.is_asserted(*d) && !self.counts(*a),
                other => other.function().is_some_and(|function| function.has_kinks()),
            },
            Instruction::External { external } => !self.externals[*external as usize].only_fails(),
            _ => false,
        }
    }

    /// Whether an assertion reads the register.
    fn is_asserted(&self, register: u32) -> bool {
        self.instructions.iter().any(|own| match own {
            Instruction::Assert { a, .. } | Instruction::Warn { a, .. } => *a == register,
            _ => false,
        })
    }

    /// Whether the register is the counter of a loop: it begins at 0 and increases by 1.
    fn counts(&self, register: u32) -> bool {
        let is_one = |b: u32| self.constants.contains(&(b, 1.0));
        let is_begun = self.instructions.iter().any(|own| match own {
            Instruction::Constant { d, value } => *d == register && *value == 0.0,
            _ => false,
        });
        is_begun
            && self.instructions.iter().any(|own| match own {
                Instruction::Operation(Operation { operator: Operator::Add, d, a, b }) => {
                    *d == register && *a == register && is_one(*b)
                }
                _ => false,
            })
    }
}
