//! Whether a derivative of a function may jump, by what its instructions are.

use super::code::{Code, Functions, Instruction};

impl Functions {
    /// Whether the derivative of a function, or its value, may jump: it decides by a relation, other than
    /// that of a counted loop, calls one of the table that has kinks, or what is not known.
    pub(crate) fn has_kinks(&self, function: u32) -> bool {
        let mut seen = vec![false; self.codes.len()];
        let mut stack = vec![function as usize];
        while let Some(at) = stack.pop() {
            if std::mem::replace(&mut seen[at], true) {
                continue;
            }
            let code = &self.codes[at];
            if code.instructions.iter().any(|instruction| code.is_kink(instruction)) {
                return true;
            }
            stack.extend(code.instructions.iter().filter_map(|instruction| match instruction {
                Instruction::Call { function, .. } => Some(*function as usize),
                _ => None,
            }));
        }
        false
    }
}

impl Code {
    fn is_kink(&self, instruction: &Instruction) -> bool {
        match instruction {
            Instruction::Unary { function, .. } | Instruction::Binary { function, .. } => {
                function.id.get().has_kinks()
            }
            Instruction::Relation { d, a, .. } => !self.is_asserted(*d) && !self.counts(*a),
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

    /// Whether the register is the counter of a loop, which increases by itself.
    fn counts(&self, register: u32) -> bool {
        self.instructions.iter().any(|own| match own {
            Instruction::Add { d, a, .. } => *d == register && *a == register,
            _ => false,
        })
    }
}
