//! What a running system writes to: its registers, and the machine that runs its functions.

use super::linear_system::LinearSystem;
use super::lower::Registers;
use super::tape::Call;
use crate::bytecode::{Failure, Functions, Machine};
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

/// Registers and machine; it reads as its registers.
#[derive(Debug, Clone)]
pub(super) struct Memory {
    pub(super) registers: Vec<f64>,
    pub(super) calls: Calls,
    pub(super) systems: Vec<LinearSystem>,
}

/// Runs calls of functions.
#[derive(Debug, Clone)]
pub(super) struct Calls {
    functions: Arc<Functions>,
    machine: Machine,
    /// Why the last call failed.
    pub(super) failure: Option<Failure>,
}

impl Memory {
    /// Registers with the constants of a program in them.
    pub(super) fn new(registers: &Registers) -> Memory {
        let calls = Calls {
            functions: registers.functions().clone(),
            machine: Machine::default(),
            failure: None,
        };
        let mut memory = Memory { registers: Vec::new(), calls, systems: Vec::new() };
        memory.extend(registers);
        memory
    }

    /// More registers, with their constants.
    pub(super) fn extend(&mut self, registers: &Registers) {
        self.registers.resize(registers.len(), 0.0);
        let known = self.systems.len();
        self.systems.extend(registers.systems()[known..].iter().map(|n| LinearSystem::new(*n)));
        for (register, value) in &registers.values {
            self.registers[*register as usize] = *value;
        }
    }
}

impl Calls {
    /// Forgets the external objects, which parameters make anew.
    pub(super) fn clear_objects(&mut self) {
        self.machine.clear_objects();
    }

    pub(super) fn run(&mut self, call: &Call, r: &mut [f64]) -> Result<(), Failure> {
        let arguments = call.arguments.iter().map(|a| r[*a as usize]);
        let results = match call.inputs.is_empty() {
            true => self.machine.call(&self.functions, call.function, arguments),
            false => self.machine.partial(&self.functions, call.function, &call.inputs, arguments),
        };
        match results {
            Ok(results) => {
                r[call.d as usize..][..results.len()].copy_from_slice(results);
                Ok(())
            }
            Err(failure) => {
                self.failure = Some(failure);
                Err(failure)
            }
        }
    }
}

impl Deref for Memory {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.registers
    }
}

impl DerefMut for Memory {
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.registers
    }
}
