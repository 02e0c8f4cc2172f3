//! Strings in parts, made by functions of their own or in functions being compiled.

use super::emitter::{Emitter, Operand};
use super::instances::Instances;
use super::statements::Body;
use crate::arithmetic::Register;
use crate::bytecode::{Code, ExternalCall, Instruction};
use crate::external::{COMPOSE, Slot, SlotKind};
use crate::lower::expressions::StringPart;
use std::sync::Arc;

impl Instances {
    /// The number of a text of the model.
    pub(in crate::lower) fn number_of(&mut self, text: &Arc<str>) -> f64 {
        // A variable that nothing was assigned to is empty where it is zero.
        let strings = &mut self.functions.strings;
        strings.insert("".into());
        strings.insert_full(text.clone()).0 as f64
    }

    /// A function that makes a text of parts: its number and its arguments.
    pub(in crate::lower) fn composer<S: Copy>(&mut self, parts: &[StringPart<S>]) -> (u32, Vec<S>) {
        self.number_of(&"".into());
        let mut emitter = Emitter::default();
        let mut inputs = Vec::new();
        let arguments = slots(&mut emitter, parts, |emitter, row| {
            inputs.extend(row);
            emitter.permanent(row.len() as u32)
        });
        let key = (arguments.clone(), emitter.strings().to_vec());
        let code = match self.composers.get(&key) {
            Some(known) => *known,
            None => {
                let code = compose(emitter, arguments, inputs.len() as u32);
                let number = self.add(code);
                self.composers.insert(key, number);
                number
            }
        };
        (code, inputs)
    }
}

impl Body<'_, '_> {
    /// Parts of a text as arguments of a call.
    pub(super) fn slots(&mut self, parts: &[StringPart<Operand>]) -> Vec<Slot> {
        slots(&mut self.emitter, parts, Emitter::copies)
    }

    /// The number of a text of parts.
    pub(super) fn composed(&mut self, parts: &[StringPart<Operand>]) -> Operand {
        let arguments = self.slots(parts);
        let d = self.emitter.block(1);
        make(&mut self.emitter, arguments, d);
        Operand::Register(d)
    }
}

/// Parts as arguments, the scalars of each in a row.
fn slots<S: Copy>(
    emitter: &mut Emitter,
    parts: &[StringPart<S>],
    mut row: impl FnMut(&mut Emitter, &[S]) -> Register,
) -> Vec<Slot> {
    let mut slots = Vec::with_capacity(parts.len());
    let text = |emitter: &mut Emitter, text: &Arc<str>| Slot {
        kind: SlotKind::Text,
        first: emitter.text(text.clone()),
        dims: Box::new([]),
    };
    for part in parts {
        match part {
            StringPart::Text(known) => slots.push(text(emitter, known)),
            StringPart::Numbered(number) => {
                let first = row(emitter, std::slice::from_ref(number));
                slots.push(Slot { kind: SlotKind::Numbered, first, dims: Box::new([]) });
            }
            StringPart::Written(scalars, format) => {
                let first = row(emitter, scalars);
                let dims = Box::new([scalars.len() as u32]);
                slots.push(Slot { kind: SlotKind::Number, first, dims });
                slots.extend(format.iter().map(|format| text(emitter, format)));
            }
        }
    }
    slots
}

/// The text of parts, its number to the register `d`.
fn make(emitter: &mut Emitter, arguments: Vec<Slot>, d: Register) {
    let result = Some(Slot { kind: SlotKind::Numbered, first: d, dims: Box::new([]) });
    // No text was there before.
    emitter.emit(Instruction::Unassign { d, n: 1 });
    let external = emitter.external(ExternalCall::new(&COMPOSE, arguments, result));
    emitter.emit(Instruction::External { external });
}

fn compose(mut emitter: Emitter, arguments: Vec<Slot>, n_inputs: u32) -> Code {
    let d = emitter.permanent(1);
    make(&mut emitter, arguments, d);
    Code { returns_strings: true, ..emitter.finish("String".into(), n_inputs, d, 1) }
}
