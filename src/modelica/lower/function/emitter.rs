//! Writes the instructions of one function and hands out its registers.

use crate::arithmetic::Register;
use crate::bytecode::{Code, ExternalCall, Instruction};
use crate::source::Span;
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A scalar of a function being compiled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Operand {
    Constant(f64),
    Register(Register),
}

/// Instructions and registers of one function.
#[derive(Debug, Default)]
pub(super) struct Emitter {
    instructions: Vec<Instruction>,
    places: Vec<(u32, Span)>,
    messages: Vec<Arc<str>>,
    strings: Vec<Arc<str>>,
    externals: Vec<ExternalCall>,
    constants: FxHashMap<u64, Register>,
    values: Vec<(Register, f64)>,
    next: Register,
    /// Blocks of registers that can be used again, by their size.
    free: BTreeMap<u32, Vec<Register>>,
    /// Blocks of every open scope, innermost last.
    scopes: Vec<Vec<(Register, u32)>>,
}

/// A state of an emitter to go back to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Checkpoint {
    instructions: usize,
    places: usize,
    scopes: usize,
}

impl Checkpoint {
    /// The number of instructions.
    pub(super) fn length(self) -> usize {
        self.instructions
    }
}

impl Emitter {
    /// Code so far, its sizes yet to be filled in.
    pub(super) fn finish(
        self,
        name: Arc<str>,
        n_inputs: u32,
        outputs: Register,
        n_outputs: u32,
    ) -> Code {
        Code {
            name,
            instructions: self.instructions,
            n_inputs,
            outputs,
            n_outputs,
            frame: self.next,
            constants: self.values,
            messages: self.messages,
            places: self.places,
            strings: self.strings,
            externals: self.externals,
            ..Code::default()
        }
    }

    pub(super) fn len(&self) -> usize {
        self.instructions.len()
    }

    pub(super) fn emit(&mut self, instruction: Instruction) {
        self.instructions.push(instruction);
    }

    /// What follows is written there.
    pub(super) fn place(&mut self, span: Span) {
        if self.places.last().is_none_or(|(_, last)| *last != span) {
            self.places.push((self.instructions.len() as u32, span));
        }
    }

    pub(super) fn message(&mut self, text: Arc<str>) -> u32 {
        self.messages.push(text);
        self.messages.len() as u32 - 1
    }

    pub(super) fn text(&mut self, text: Arc<str>) -> u32 {
        self.strings.push(text);
        self.strings.len() as u32 - 1
    }

    /// All Strings so far.
    pub(super) fn strings(&self) -> &[Arc<str>] {
        &self.strings
    }

    pub(super) fn string_at(&self, position: u32) -> Arc<str> {
        self.strings[position as usize].clone()
    }

    pub(super) fn external(&mut self, call: ExternalCall) -> u32 {
        self.externals.push(call);
        self.externals.len() as u32 - 1
    }

    pub(super) fn checkpoint(&self) -> Checkpoint {
        Checkpoint {
            instructions: self.instructions.len(),
            places: self.places.len(),
            scopes: self.scopes.len(),
        }
    }

    /// Forgets what was written since; registers of that time stay unused.
    pub(super) fn rollback(&mut self, to: Checkpoint) {
        self.instructions.truncate(to.instructions);
        self.places.truncate(to.places);
        while self.scopes.len() > to.scopes {
            self.close();
        }
    }

    /// Temporaries from here on are free again at the end of the scope.
    pub(super) fn open(&mut self) {
        self.scopes.push(Vec::new());
    }

    pub(super) fn close(&mut self) {
        for (register, n) in self.scopes.pop().unwrap_or_default() {
            self.free.entry(n).or_default().push(register);
        }
    }

    /// Registers for the whole run of the function.
    pub(super) fn permanent(&mut self, n: u32) -> Register {
        self.next += n;
        self.next - n
    }

    /// Registers until the scope ends.
    pub(super) fn block(&mut self, n: u32) -> Register {
        let reused = self.free.get_mut(&n).and_then(Vec::pop);
        let register = reused.unwrap_or_else(|| self.permanent(n));
        if let Some(scope) = self.scopes.last_mut() {
            scope.push((register, n));
        }
        register
    }

    pub(super) fn register(&mut self, operand: Operand) -> Register {
        match operand {
            Operand::Register(register) => register,
            Operand::Constant(value) => match self.constants.get(&value.to_bits()) {
                Some(known) => *known,
                None => {
                    let register = self.permanent(1);
                    self.constants.insert(value.to_bits(), register);
                    self.values.push((register, value));
                    register
                }
            },
        }
    }

    /// Registers in a row that hold the operands: their own if they are so, else copies.
    pub(super) fn row(&mut self, operands: &[Operand]) -> Register {
        in_a_row(operands).unwrap_or_else(|| self.copies(operands))
    }

    /// Copies in a row.
    pub(super) fn copies(&mut self, operands: &[Operand]) -> Register {
        let d = self.block(operands.len() as u32);
        self.copy(d, operands);
        d
    }

    /// Copies operands to registers in a row, none of which is an operand at another place.
    pub(super) fn copy(&mut self, d: Register, operands: &[Operand]) {
        if let Some(a) = in_a_row(operands) {
            if a != d {
                self.emit(Instruction::Move { d, a, n: operands.len() as u32 });
            }
            return;
        }
        for (d, operand) in (d..).zip(operands) {
            match *operand {
                Operand::Constant(value) => self.emit(Instruction::Constant { d, value }),
                Operand::Register(a) if a == d => {}
                Operand::Register(a) => self.emit(Instruction::Move { d, a, n: 1 }),
            }
        }
    }

    /// A jump whose target is set by [`Emitter::land`].
    pub(super) fn jump(&mut self) -> usize {
        self.emit(Instruction::Jump { target: 0 });
        self.len() - 1
    }

    pub(super) fn jump_unless(&mut self, condition: Operand) -> usize {
        let a = self.register(condition);
        self.emit(Instruction::JumpUnless { a, target: 0 });
        self.len() - 1
    }

    pub(super) fn jump_to(&mut self, target: usize) {
        self.emit(Instruction::Jump { target: target as u32 });
    }

    /// A jump leads to what comes next.
    pub(super) fn land(&mut self, jump: usize) {
        let here = self.len() as u32;
        match self.instructions.get_mut(jump) {
            Some(Instruction::Jump { target } | Instruction::JumpUnless { target, .. }) => {
                *target = here;
            }
            _ => unreachable!("only jumps land"),
        }
    }
}

/// The first of registers that follow each other.
fn in_a_row(operands: &[Operand]) -> Option<Register> {
    let Some(Operand::Register(first)) = operands.first().copied() else { return None };
    let follows = |(at, operand): (u32, &Operand)| *operand == Operand::Register(first + at);
    (0..).zip(operands).all(follows).then_some(first)
}
