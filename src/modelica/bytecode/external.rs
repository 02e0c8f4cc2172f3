//! Calls of external functions: values alone, or their differences.

use super::code::{Code, ExternalCall, Functions};
use super::failure::{LAST_C_MESSAGE, Reason};
use super::run_time_strings::RunTimeStrings;
use crate::arithmetic::{Dual, Number};
use crate::diag::Fault;
use crate::elementary;
use crate::external::{Call, Contents, Journal, Object, Outside, Random, Slot, SlotKind};
use std::sync::Arc;

/// Runs an external function on numbers with derivatives, or without.
pub(crate) trait RunExternal: Number {
    /// Reads and writes the frame `r` of `code`, one of `functions`.
    fn run_external(
        functions: &Functions,
        code: &Code,
        call: &ExternalCall,
        r: &mut [Self],
        externals: &mut Externals,
    ) -> Result<(), Reason>;
}

/// What external functions need besides their arguments.
#[derive(Clone, Default)]
pub(crate) struct Externals {
    /// Objects by handle.
    pub(super) objects: Vec<Object>,
    /// The hidden state.
    random: Random,
    /// What is to be written.
    pub(super) journal: Journal,
    /// What the last one that failed said.
    pub(super) message: String,
    /// Strings by number.
    pub(super) strings: RunTimeStrings,
    scratch: Vec<f64>,
}

impl std::fmt::Debug for Externals {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Externals").field("objects", &self.objects.len()).finish_non_exhaustive()
    }
}

/// What a simulation has of the outside world.
struct Granted<'a> {
    files: &'a Contents,
    random: &'a mut Random,
    journal: &'a mut Journal,
}

impl Granted<'_> {
    /// The name under which the journal has a file: functions that look for files name them now by
    /// their absolute paths and now by others.
    fn absolute(&self, path: &str) -> String {
        self.files.full_path(path).unwrap_or_else(|_| path.to_owned())
    }
}

impl Outside for Granted<'_> {
    fn read(&mut self, path: &str) -> Result<Vec<u8>, Fault> {
        self.journal.read(&self.absolute(path), || self.files.read(path))
    }

    fn write(&mut self, path: &str, bytes: &[u8]) -> Result<(), Fault> {
        self.journal.write(&self.absolute(path), bytes)
    }

    fn append(&mut self, path: &str, bytes: &[u8]) -> Result<(), Fault> {
        self.journal.append(&self.absolute(path), bytes)
    }

    fn remove(&mut self, path: &str) -> Result<(), Fault> {
        self.journal.remove(&self.absolute(path))
    }

    fn make_folder(&mut self, path: &str) -> Result<(), Fault> {
        self.journal.make_folder(&self.absolute(path))
    }

    fn is_folder(&mut self, path: &str) -> Result<Option<bool>, Fault> {
        self.journal.is_folder(&self.absolute(path), || self.files.is_folder(path))
    }

    fn full_path(&mut self, path: &str) -> Result<String, Fault> {
        self.files.full_path(path)
    }

    fn print(&mut self, text: &str) -> Result<(), Fault> {
        self.journal.print(text)
    }

    fn random(&mut self) -> Result<&mut Random, Fault> {
        Ok(self.random)
    }
}

impl Externals {
    /// Forgets the objects, the Strings and the hidden state.
    pub(super) fn restart(&mut self) {
        self.objects.clear();
        self.strings.clear();
        self.random = Random::default();
        self.journal.clear();
    }

    /// The hidden state.
    pub(super) fn random(&mut self) -> &mut Random {
        &mut self.random
    }

    /// Keeps what a function said that failed.
    fn failed(&mut self, call: &ExternalCall, fault: Fault) -> Reason {
        if call.keeps_words() {
            LAST_C_MESSAGE.set((call.entry.name, fault.message.clone()));
        }
        self.message = fault.message;
        Reason::External
    }
}

impl RunExternal for f64 {
    fn run_external(
        functions: &Functions,
        code: &Code,
        call: &ExternalCall,
        r: &mut [f64],
        externals: &mut Externals,
    ) -> Result<(), Reason> {
        match call.takes_string_numbers() {
            false => run(functions, call, r, &code.strings, &mut Vec::new(), externals),
            true => run_with_strings(functions, code, call, r, externals),
        }
    }
}

/// Runs a function of which some Strings stand for numbers: these follow those of the code, and the
/// Strings that it writes get numbers.
fn run_with_strings(
    functions: &Functions,
    code: &Code,
    call: &ExternalCall,
    r: &mut [f64],
    externals: &mut Externals,
) -> Result<(), Reason> {
    let mut strings = code.strings.clone();
    let mut registers = Vec::new();
    let mut with_strings = call.clone();
    let is_written = |at: usize| call.entry.signature.chars().nth(at) == Some('T');
    let arguments = with_strings.arguments.iter_mut().enumerate();
    let slots = arguments.map(|(at, slot)| (is_written(at), slot));
    for (is_written, slot) in slots.chain(with_strings.result.iter_mut().map(|slot| (true, slot))) {
        if slot.kind != SlotKind::Numbered {
            continue;
        }
        let text = externals.strings.text(&functions.strings, r[slot.first as usize]);
        let text = text.or_else(|| is_written.then(|| "".into())).ok_or_else(|| {
            externals.message = format!("`{}`: a String has no value", call.entry.name);
            Reason::External
        })?;
        registers.push((strings.len() as u32, slot.first));
        *slot = Slot { kind: SlotKind::Text, first: strings.len() as u32, dims: Box::new([]) };
        strings.push(text);
    }
    let mut written = Vec::new();
    run(functions, &with_strings, r, &strings, &mut written, externals)?;
    for (position, text) in written {
        let register = registers.iter().find(|(own, _)| *own == position);
        if let Some((_, register)) = register {
            let number = externals.strings.number(&functions.strings, text);
            r[*register as usize] = number.map_err(|fault| externals.failed(call, fault))?;
        }
    }
    Ok(())
}

/// Runs a function on the Strings at `strings`.
fn run(
    functions: &Functions,
    call: &ExternalCall,
    r: &mut [f64],
    strings: &[Arc<str>],
    written: &mut Vec<(u32, Arc<str>)>,
    externals: &mut Externals,
) -> Result<(), Reason> {
    let mut arguments = Call {
        name: call.entry.name,
        arguments: &call.arguments,
        result: call.result.as_ref(),
        numbers: r,
        strings,
        written,
        objects: &mut externals.objects,
        outside: &mut Granted {
            files: &functions.files,
            random: &mut externals.random,
            journal: &mut externals.journal,
        },
    };
    let done = match (&call.in_modelica, call.entry.makes_object()) {
        (Some(function), _) => function.call(&mut arguments),
        // Objects of C may change: everyone has its own.
        (None, true) if call.entry.c.is_none() => {
            functions.objects.remember(&mut arguments, call.entry.run)
        }
        _ => call.entry.call(&mut arguments),
    };
    done.map_err(|fault| externals.failed(call, fault))
}

impl RunExternal for Dual<f64> {
    /// The derivative in the direction of the arguments, from the values at both sides.
    fn run_external(
        functions: &Functions,
        code: &Code,
        call: &ExternalCall,
        r: &mut [Self],
        externals: &mut Externals,
    ) -> Result<(), Reason> {
        let n = code.frame as usize;
        let (mut size, mut speed) = (0.0f64, 0.0f64);
        for register in call.registers() {
            let Dual { v, d } = r[register];
            if !v.is_nan() {
                (size, speed) = (size.max(v.abs()), speed.max(d.abs()));
            }
        }
        let mut scratch = std::mem::take(&mut externals.scratch);
        let mut at = |step: f64| {
            scratch.clear();
            scratch.extend(r[..n].iter().map(|x| x.v + if step == 0.0 { 0.0 } else { step * x.d }));
            f64::run_external(functions, code, call, &mut scratch, externals)
                .map(|()| call.written().map(|register| scratch[register]).collect::<Vec<_>>())
        };
        let values = at(0.0)?;
        let derivatives = match speed {
            _ if call.entry.in_steps => vec![0.0; values.len()],
            0.0 => vec![0.0; values.len()],
            _ => {
                let step = elementary::cbrt(f64::EPSILON) * size.max(1e-3) / speed;
                let (plus, minus) = (at(step)?, at(-step)?);
                plus.iter().zip(&minus).map(|(a, b)| (a - b) / (2.0 * step)).collect()
            }
        };
        externals.scratch = scratch;
        for ((register, v), d) in call.written().zip(values).zip(derivatives) {
            r[register] = Dual { v, d };
        }
        Ok(())
    }
}

impl RunExternal for Dual<Dual<f64>> {
    /// Only where nothing depends on what is differentiated for.
    fn run_external(
        functions: &Functions,
        code: &Code,
        call: &ExternalCall,
        r: &mut [Self],
        externals: &mut Externals,
    ) -> Result<(), Reason> {
        let still = |x: &Self| x.v.d == 0.0 && x.d.v == 0.0 && x.d.d == 0.0;
        if !call.registers().all(|register| still(&r[register])) {
            return Err(Reason::Derivative);
        }
        let mut values: Vec<f64> = r[..code.frame as usize].iter().map(|x| x.value()).collect();
        f64::run_external(functions, code, call, &mut values, externals)?;
        for register in call.registers() {
            r[register] = Number::constant(values[register]);
        }
        Ok(())
    }
}

impl ExternalCall {
    /// Whether the numbers of Strings are among its arguments or its result.
    fn takes_string_numbers(&self) -> bool {
        self.arguments.iter().chain(&self.result).any(|slot| slot.kind == SlotKind::Numbered)
    }

    /// The registers that the function may write to: what it only reads keeps its derivatives.
    fn written(&self) -> impl Iterator<Item = usize> {
        let mut letters = self.entry.signature.chars();
        let is_written =
            move |_: &&Slot| letters.next().is_some_and(|letter| letter.is_uppercase());
        let slots = self.arguments.iter().filter(is_written).chain(&self.result);
        slots
            .filter(|slot| slot.kind != SlotKind::Text)
            .flat_map(|slot| slot.first as usize..slot.first as usize + slot.len())
    }

    /// All registers of numbers, those of the result last.
    fn registers(&self) -> impl Iterator<Item = usize> {
        let slots = self.arguments.iter().chain(&self.result);
        slots
            .filter(|slot| slot.kind != SlotKind::Text)
            .flat_map(|slot| slot.first as usize..slot.first as usize + slot.len())
    }
}
