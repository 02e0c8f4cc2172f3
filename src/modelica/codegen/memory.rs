//! What a running system writes to: its registers, and the machine that runs its functions.

use super::instruction::Call;
use super::linear_system::LinearSystem;
use super::registers::Registers;
use crate::bytecode::{Failure, Functions, Journal, Machine, Reason};
use std::ops::{Deref, DerefMut, Range};
use std::sync::Arc;

/// Registers and machine; it reads as its registers.
#[derive(Debug, Clone)]
pub(crate) struct Memory {
    pub(crate) registers: Vec<f64>,
    pub(crate) calls: Calls,
    pub(crate) systems: Vec<LinearSystem>,
    /// The first registers are those of the variables.
    pub(super) n_variables: usize,
    /// Where the last tape that was run has passed on an overflow.
    pub(crate) overflow: Option<u32>,
}

/// Runs calls of functions.
#[derive(Debug, Clone)]
pub(crate) struct Calls {
    functions: Arc<Functions>,
    machine: Machine,
    /// Calls of impure functions at this instant: an event iteration repeats them, and their values
    /// stay.
    impure: Vec<ImpureCall>,
    /// Why the last call failed.
    pub(crate) failure: Option<Failure>,
    /// Whether what a function gives no value stays without one.
    pub(crate) keeps_unassigned: bool,
}

/// An impure call that was executed.
#[derive(Debug, Clone)]
struct ImpureCall {
    function: u32,
    /// The bits of the arguments, the last of which is the place of the call.
    arguments: Vec<u64>,
    results: Result<Vec<f64>, Failure>,
    /// The requests that it made to write something.
    requests: Range<usize>,
}

impl Memory {
    /// Registers with the constants of a program in them.
    pub(crate) fn new(registers: &Registers) -> Memory {
        let calls = Calls {
            functions: registers.functions().clone(),
            machine: Machine::of_fixed_functions(),
            impure: Vec::new(),
            failure: None,
            keeps_unassigned: false,
        };
        let mut memory = Memory {
            registers: Vec::new(),
            calls,
            systems: Vec::new(),
            n_variables: registers.n_variables(),
            overflow: None,
        };
        memory.extend(registers);
        memory
    }

    /// More registers, with their constants.
    pub(crate) fn extend(&mut self, registers: &Registers) {
        self.registers.resize(registers.len(), 0.0);
        let known = self.systems.len();
        self.systems.extend(registers.systems()[known..].iter().map(|n| LinearSystem::new(*n)));
        for (register, value) in &registers.values {
            self.registers[*register as usize] = *value;
        }
    }

    /// From here on linear systems tell of solutions to come.
    pub(crate) fn forget_solutions(&mut self) {
        self.systems.iter_mut().for_each(LinearSystem::forget_solution);
    }
}

impl Calls {
    /// Before parameters are evaluated: a simulation knows nothing of the one before.
    pub(crate) fn restart(&mut self) {
        self.machine.restart();
        self.next_instant();
    }

    /// The functions that are called.
    pub(super) fn functions(&self) -> &Arc<Functions> {
        &self.functions
    }

    /// What the external function said that failed last.
    pub(crate) fn message(&self) -> &str {
        self.machine.message()
    }

    /// A text by its number.
    pub(crate) fn text(&self, number: f64) -> Option<Arc<str>> {
        self.machine.text(&self.functions, number)
    }

    /// What calls have written since the last [`Calls::restart`].
    pub(crate) fn journal(&self) -> &Journal {
        self.machine.journal()
    }

    /// What was noticed in functions.
    pub(crate) fn notices(&self) -> &[(u32, Failure)] {
        self.machine.notices()
    }

    /// The value of a component of a record that a function leaves without one, if it may have any.
    pub(super) fn default_of(&mut self, function: u32) -> Option<f64> {
        if self.keeps_unassigned {
            return None;
        }
        let at = self.end_of(function);
        self.machine.note_default(function, Failure { function, at, reason: Reason::Unassigned });
        Some(0.0)
    }

    /// Impure calls have new values from here on.
    pub(crate) fn next_instant(&mut self) {
        self.impure.clear();
    }

    /// The position after the last instruction of a function.
    pub(crate) fn end_of(&self, function: u32) -> u32 {
        self.functions.codes[function as usize].end()
    }

    /// Writes the results of a call.
    pub(super) fn run(&mut self, call: &Call, r: &mut [f64]) -> Result<(), Failure> {
        if !self.functions.codes[call.function as usize].impure {
            return self.run_again(call, r);
        }
        let n = self.functions.n_outputs(call.function);
        if !call.inputs.is_empty() {
            r[call.d as usize..][..n].fill(0.0);
            return Ok(());
        }
        let arguments: Vec<u64> = call.arguments.iter().map(|a| r[*a as usize].to_bits()).collect();
        let is_known =
            |known: &&ImpureCall| known.function == call.function && known.arguments == arguments;
        if let Some(known) = self.impure.iter().find(is_known) {
            return match &known.results {
                Ok(results) => {
                    r[call.d as usize..][..n].copy_from_slice(results);
                    Ok(())
                }
                Err(failure) => {
                    self.failure = Some(*failure);
                    Err(*failure)
                }
            };
        }
        self.take_back(call.function, &arguments);
        let before = self.machine.journal().len();
        let done = self.run_again(call, r);
        let results = done.map(|()| r[call.d as usize..][..n].to_vec());
        let requests = before..self.machine.journal().len();
        if results.is_err() {
            self.machine.take_back(requests.clone());
        }
        let function = call.function;
        self.impure.push(ImpureCall { function, arguments, results, requests });
        done
    }

    /// What a call at the same place has written at this instant was for other values.
    fn take_back(&mut self, function: u32, arguments: &[u64]) {
        let place = arguments.last();
        let machine = &mut self.machine;
        self.impure.retain(|known| {
            let is_other = known.function == function && known.arguments.last() == place;
            let is_done_again = is_other && !known.requests.is_empty();
            if is_done_again {
                machine.take_back(known.requests.clone());
            }
            !is_done_again
        });
    }

    fn run_again(&mut self, call: &Call, r: &mut [f64]) -> Result<(), Failure> {
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
                let n = self.functions.n_outputs(call.function);
                r[call.d as usize..][..n].fill(f64::NAN);
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
