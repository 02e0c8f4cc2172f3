//! Instructions and the functions made of them. Data only.

use super::failure::{Failure, Reason, said};
use super::machine_code::MachineCode;
use super::run_time_strings::StringTable;
use crate::arithmetic::{Operation, Operator, Register};
use crate::external::{Callable, Contents, Effect, Entry, FAIL, Objects, Slot, SlotKind};
use crate::source::Span;
use crate::symbolic::Inverse;
use std::sync::Arc;

/// Stands for a message that is put together where it fails.
const UNKNOWN: &str = "…";

/// One instruction; `d` is the register written, `a` and `b` are read.
#[derive(Debug, Clone, Copy, serde::Serialize, serde::Deserialize)]
#[allow(missing_docs, reason = "the fields are the registers named above")]
pub enum Instruction {
    /// A number.
    Constant { d: Register, value: f64 },
    /// `n` registers without value.
    Unassign { d: Register, n: u32 },
    /// `n` registers from others.
    Move { d: Register, a: Register, n: u32 },
    /// A number from one or two others.
    Operation(Operation),
    /// The offset of a subscript (from 1, at most `size`) times `stride` is added to `d`.
    Offset { d: Register, subscript: Register, size: u32, stride: u32 },
    /// The register `base` plus an offset.
    Load { d: Register, base: Register, offset: Register },
    /// To the register `base` plus an offset.
    Store { base: Register, offset: Register, a: Register },
    /// The number of iterations of a loop over `start : step : stop`, three registers from `range` on.
    Iterations { d: Register, range: Register },
    /// On to another instruction.
    Jump { target: u32 },
    /// On to another instruction unless `a` holds.
    JumpUnless { a: Register, target: u32 },
    /// Another function: its inputs are copied from `a` on, its outputs to `d` and on.
    Call { function: u32, d: Register, a: Register },
    /// The external function of this number.
    External { external: u32 },
    /// Fails if one of `n` registers has no value.
    Check { a: Register, n: u32 },
    /// Fails unless `a` holds.
    Assert { a: Register, message: u32 },
    /// Warns unless `a` holds.
    Warn { a: Register, message: u32 },
    /// Fails unless `a` is finite.
    Finite { a: Register },
}

impl From<Operation> for Instruction {
    fn from(operation: Operation) -> Instruction {
        Instruction::Operation(operation)
    }
}

/// A function for arguments of known sizes.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub struct Code {
    /// Full name of the function.
    pub name: Arc<str>,
    /// The instructions; execution ends after the last one.
    pub instructions: Vec<Instruction>,
    /// Number of scalars of the inputs, which stand first in the frame.
    pub(crate) n_inputs: u32,
    /// The first register of the outputs, which are contiguous.
    pub outputs: Register,
    /// Number of scalars of the outputs.
    pub(crate) n_outputs: u32,
    /// Number of registers.
    pub frame: u32,
    /// Registers with their numbers.
    pub constants: Vec<(Register, f64)>,
    /// Whether numbers of Strings are among its outputs.
    pub(crate) returns_strings: bool,
    /// Messages of assertions.
    pub messages: Vec<Arc<str>>,
    /// Strings that external functions take.
    pub strings: Vec<Arc<str>>,
    /// External functions.
    pub(crate) externals: Vec<ExternalCall>,
    /// First instruction of every place, ascending.
    pub places: Vec<(u32, Span)>,
    /// Whether equal arguments may give different results: it has a hidden state. Calls have one
    /// more argument, the number of the place where they are written.
    pub impure: bool,
    /// Whether calls write files or print, so that they are made for that and not for their values.
    pub writes: bool,
    /// Whether outputs may be NaN: components of records that have no value.
    pub(crate) may_lack: bool,
    /// A function for its derivative, `annotation(derivative = …)` (MLS §12.7.1).
    pub derivative: Option<Derivative>,
    /// Inputs, and how equations are solved for them, `annotation(inverse(…))` (MLS §12.8).
    pub inverses: Vec<(u32, Inverse)>,
    /// Its machine code for values and for dual numbers.
    #[serde(skip)]
    pub(crate) machine_code: [MachineCode; 2],
}

impl Code {
    /// Whether the interpreter carries it out.
    pub(crate) fn is_interpreted(&self) -> bool {
        self.externals.iter().any(|call| call.in_modelica.is_some())
    }

    /// The position after the last instruction.
    pub fn end(&self) -> u32 {
        self.instructions.len() as u32
    }
}

/// A call of an external function; slots are registers of the frame.
#[derive(Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct ExternalCall {
    /// The function.
    #[serde(with = "crate::external::by_name")]
    pub entry: &'static Entry,
    /// Its arguments.
    pub arguments: Vec<Slot>,
    /// Its result.
    pub result: Option<Slot>,
    /// What is called in the place of the function, if it is written in Modelica.
    #[serde(with = "crate::external::none")]
    pub(crate) in_modelica: Option<Arc<dyn Callable>>,
}

impl ExternalCall {
    /// A call of a function in Rust or in C.
    pub fn new(entry: &'static Entry, arguments: Vec<Slot>, result: Option<Slot>) -> ExternalCall {
        ExternalCall { entry, arguments, result, in_modelica: None }
    }

    /// Whether it does nothing but to fail with a message.
    pub(super) fn only_fails(&self) -> bool {
        std::ptr::eq(self.entry, &FAIL)
    }

    /// Whether what it says when it fails is kept.
    pub(super) fn keeps_words(&self) -> bool {
        self.entry.c.is_some() || self.in_modelica.is_some()
    }
}

impl std::fmt::Debug for ExternalCall {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ExternalCall").field("name", &self.entry.name).finish_non_exhaustive()
    }
}

/// A function that computes the derivatives of another.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize)]
pub struct Derivative {
    /// Its code: inputs are those of the function, followed by derivatives of inputs.
    pub function: u32,
    /// The inputs of the function whose derivatives follow.
    pub(crate) tangents: Vec<u32>,
    /// Inputs whose derivatives must be zero (`zeroDerivative`).
    pub zero: Vec<u32>,
    /// The output of `function` that is the derivative of each output; `None` for outputs that
    /// have none (Integers).
    pub outputs: Vec<Option<u32>>,
    /// The function for the derivative of `function` (`order = 2`): its inputs are those of
    /// `function`, followed by second derivatives; its outputs are in the same order.
    pub second: Option<u32>,
}

/// All functions of a model; calls name them by position.
#[derive(Debug, Clone, Default, serde::Serialize, serde::Deserialize)]
pub struct Functions {
    /// The functions.
    pub codes: Vec<Code>,
    /// The Strings of the model that stand for numbers, in this order.
    pub strings: StringTable,
    /// Whether zero is taken for variables that are used before they are assigned.
    pub(crate) takes_defaults: bool,
    /// Files that external functions read.
    pub files: Contents,
    /// External objects made so far.
    #[serde(skip)]
    pub objects: Objects,
}

impl Functions {
    /// Whether all that a function does besides giving results, itself or by what it calls, is to draw
    /// random numbers.
    pub(crate) fn draws_alone(&self, function: u32) -> bool {
        let is_drawn = |call: &ExternalCall| {
            call.entry.c.is_none() && matches!(call.entry.effect, Effect::None | Effect::State)
        };
        self.holds_throughout(function, |code| code.externals.iter().all(is_drawn))
    }

    /// Whether something holds for a function and all that it calls.
    pub(super) fn holds_throughout(&self, function: u32, holds: impl Fn(&Code) -> bool) -> bool {
        let mut seen = vec![false; self.codes.len()];
        let mut stack = vec![function as usize];
        while let Some(at) = stack.pop() {
            if std::mem::replace(&mut seen[at], true) {
                continue;
            }
            let code = &self.codes[at];
            if !holds(code) {
                return false;
            }
            stack.extend(code.instructions.iter().filter_map(|instruction| match instruction {
                Instruction::Call { function, .. } => Some(*function as usize),
                _ => None,
            }));
        }
        true
    }

    /// Number of scalars that a call of a function returns.
    pub(crate) fn n_outputs(&self, function: u32) -> usize {
        self.codes[function as usize].n_outputs as usize
    }

    /// The text of an assertion that failed, or that a function failed with on purpose.
    pub fn message(&self, failure: &Failure) -> Option<&str> {
        let code = self.codes.get(failure.function as usize)?;
        match (failure.reason, code.instructions.get(failure.at as usize)?) {
            (
                Reason::Assertion,
                Instruction::Assert { message, .. } | Instruction::Warn { message, .. },
            ) => Some(&code.messages[*message as usize]),
            (Reason::External, Instruction::External { external }) => {
                let call = &code.externals[*external as usize];
                let is_message = call.only_fails() || call.entry.name == "ModelicaError";
                let text = call.arguments.first().filter(|_| is_message)?;
                match text.kind {
                    SlotKind::Text => {
                        code.strings.get(text.first as usize).map(|text| text.trim_end())
                    }
                    _ => Some(UNKNOWN),
                }
            }
            _ => None,
        }
    }

    /// What a machine noticed while it ran a function, in words, with its place.
    pub(crate) fn notice(&self, (called, failure): &(u32, Failure)) -> (String, Span) {
        let name = |function: u32| self.codes.get(function as usize).map_or("", |code| &code.name);
        let (words, span) = self.explain(failure);
        if failure.reason == Reason::Assertion {
            let known = format!(
                "{words} (in a call of `{}`, maybe on the way to a solution)",
                name(*called)
            );
            return (known, span);
        }
        let noticed = match failure.function == *called {
            true => String::new(),
            false => format!(", noticed in `{}`", name(failure.function)),
        };
        let words = format!(
            "`{}` uses or returns a variable before it is assigned{noticed}: zero is taken",
            name(*called)
        );
        (words, span)
    }

    /// A failure in words, with its place.
    pub fn explain(&self, failure: &Failure) -> (String, Span) {
        let Some(code) = self.codes.get(failure.function as usize) else {
            return (failure.reason.words().to_owned(), Span::NONE);
        };
        let position = code.places.partition_point(|(first, _)| *first <= failure.at);
        let span = position.checked_sub(1).map_or(Span::NONE, |at| code.places[at].1);
        if let Some(message) = self.message(failure) {
            return (message.to_owned(), span);
        }
        let words = match (failure.reason, code.instructions.get(failure.at as usize)) {
            (Reason::NotFinite, Some(Instruction::Operation(operation))) => not_finite(operation),
            (Reason::External, Some(Instruction::External { external })) => {
                let call = &code.externals[*external as usize];
                let entry = call.entry;
                if let Some(message) = said(entry.name).filter(|_| call.keeps_words()) {
                    return (message, span);
                }
                format!("the external function `{}` has no result", entry.name)
            }
            (Reason::Budget, _) => {
                let words = crate::budget::exceeded();
                let allows = "`--instruction-limit` allows more";
                return (format!("{words} in the function `{}` ({allows})", code.name), span);
            }
            (reason, _) => reason.words().to_owned(),
        };
        (format!("{words} in the function `{}`", code.name), span)
    }
}

/// Why an operation has no finite value.
fn not_finite(operation: &Operation) -> String {
    match (operation.operator, operation.operator.function()) {
        (_, Some(function)) => {
            let why = function.domain.map_or("the result is not finite", |d| d.words);
            format!("`{}` has no value: {why}", function.name)
        }
        (Operator::Div, None) => "a division by zero or an overflow of a division".to_owned(),
        (_, None) => Reason::NotFinite.words().to_owned(),
    }
}
