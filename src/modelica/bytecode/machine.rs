//! Runs functions on a stack that is kept between calls.

use super::code::{Code, Derivative, Functions, Instruction};
use super::direct_calls::{self, Call, MakesCalls};
use super::external::{Externals, RunExternal};
use super::failure::{Failure, Reason};
use super::machine_code::Next;
use super::memo::{Kept, Memos, worth_keeping};
use super::range::iterations;
use super::stacks::{Stacked, Stacks};
use super::translation::translated;
use crate::arithmetic::{Dual, Number, Operation};
use crate::budget::instruction_limit;
use crate::external::Journal;
use std::ops::Range;
use std::sync::Arc;

/// Deepest nesting of calls.
const MAX_CALLS: usize = 2_000;
/// Deepest nesting of calls that machine code makes itself: each takes some of the stack of the thread.
const MAX_DIRECT_CALLS: usize = 16;
/// Largest number of registers of all frames.
pub(super) const MAX_STACK: usize = 20_000_000;

/// Runs functions; every thread has its own.
#[derive(Debug, Clone, Default)]
pub struct Machine {
    stacks: Stacks,
    /// Callers, innermost last.
    callers: Vec<Caller>,
    /// How many calls of machine code have not returned to it yet.
    direct_calls: usize,
    /// Why the last of these failed.
    failure: Option<Failure>,
    derivatives: Vec<f64>,
    externals: Externals,
    budget: u64,
    /// The last calls between functions, where these are always the same.
    memos: Option<Box<Memos>>,
    /// For each function whether its calls are kept; found when the first is called.
    kept: Option<Box<[bool]>>,
    /// Whether variables that nothing was assigned to are zero.
    has_defaults: bool,
    /// Functions that were called, and where variables were used that nothing was assigned to, once for
    /// each function; functions with warnings, and where these are given.
    notices: Vec<(u32, Failure)>,
}

/// Where to continue when a function ends.
#[derive(Debug, Clone, Copy)]
struct Caller {
    function: u32,
    at: u32,
    base: u32,
    arguments: u32,
    results: u32,
    /// What was left of the budget.
    budget: u64,
}

impl Machine {
    /// A machine that always runs the same functions: it keeps results of calls between them.
    pub(crate) fn of_fixed_functions() -> Machine {
        Machine { memos: Some(Box::default()), ..Machine::default() }
    }

    /// Forgets all external objects and the hidden state of random numbers.
    pub fn restart(&mut self) {
        self.externals.restart();
        self.notices.clear();
    }

    /// How many instructions the call before this took.
    pub(crate) fn spent(&self) -> u64 {
        instruction_limit().saturating_sub(self.budget)
    }

    /// How many calls between functions had the results of the call before.
    #[cfg(test)]
    pub(crate) fn recalled(&self) -> u64 {
        self.memos.as_ref().map_or(0, |memos| memos.recalled)
    }

    /// What the external function said that failed last.
    pub fn message(&self) -> &str {
        &self.externals.message
    }

    /// A text of the program or of the simulation, by its number.
    pub fn text(&self, functions: &Functions, number: f64) -> Option<Arc<str>> {
        self.externals.strings.text(&functions.strings, number)
    }

    /// Functions that were called, and where zero was taken for variables that nothing was assigned to
    /// or an assertion of level warning did not hold.
    pub fn notices(&self) -> &[(u32, Failure)] {
        &self.notices
    }

    /// Whether there are notices, which are forgotten.
    pub(crate) fn take_notices(&mut self) -> bool {
        !std::mem::take(&mut self.notices).is_empty()
    }

    /// Notes that zero was taken in the call of a function, and where.
    pub(crate) fn note_default(&mut self, called: u32, failure: Failure) {
        let is_it = |(known, noted): &(u32, Failure)| {
            *known == called && noted.reason == Reason::Unassigned
        };
        if !self.notices.iter().any(is_it) {
            self.notices.push((called, failure));
        }
    }

    /// Notes that an assertion of level warning does not hold.
    fn note_warning(&mut self, warning: Failure) {
        if !self.notices.contains(&(warning.function, warning)) {
            self.notices.push((warning.function, warning));
        }
    }

    /// What calls would have written since the last [`Machine::restart`].
    pub fn journal(&self) -> &Journal {
        &self.externals.journal
    }

    /// Takes back what the requests in this range would have written.
    pub(crate) fn take_back(&mut self, requests: Range<usize>) {
        self.externals.journal.take_back(requests);
    }

    /// Calls a function; returns its scalar outputs, NaN for components of records without value.
    pub fn call(
        &mut self,
        functions: &Functions,
        function: u32,
        arguments: impl Iterator<Item = f64>,
    ) -> Result<&[f64], Failure> {
        self.prepare::<f64>(functions, function, arguments);
        self.run::<f64>(functions, function)?;
        let code = &functions.codes[function as usize];
        Ok(&self.stacks.values[code.outputs as usize..][..code.n_outputs as usize])
    }

    /// The partial derivatives of all scalar outputs for one input, or for two.
    ///
    /// # Errors
    /// [`Reason::Derivative`] for derivatives of a higher order, and those that are not finite.
    pub fn partial(
        &mut self,
        functions: &Functions,
        function: u32,
        inputs: &[u32],
        arguments: impl Iterator<Item = f64>,
    ) -> Result<&[f64], Failure> {
        let code = &functions.codes[function as usize];
        let outputs = code.outputs as usize..(code.outputs + code.n_outputs) as usize;
        self.derivatives.clear();
        match *inputs {
            [x] => {
                let seed = |(at, v): (usize, f64)| Dual { v, d: unit(at, x) };
                self.prepare(functions, function, arguments.enumerate().map(seed));
                self.run::<Dual<f64>>(functions, function)?;
                self.derivatives.extend(self.stacks.first[outputs].iter().map(|output| output.d));
            }
            [x, y] => {
                let seed = |(at, v): (usize, f64)| Dual {
                    v: Dual { v, d: unit(at, x) },
                    d: Dual { v: unit(at, y), d: 0.0 },
                };
                self.prepare(functions, function, arguments.enumerate().map(seed));
                self.run::<Dual<Dual<f64>>>(functions, function)?;
                self.derivatives
                    .extend(self.stacks.second[outputs].iter().map(|output| output.d.d));
            }
            _ => return Err(Failure { function, at: 0, reason: Reason::Derivative }),
        }
        match self.derivatives.iter().all(|derivative| derivative.is_finite()) {
            true => Ok(&self.derivatives),
            false => Err(Failure { function, at: 0, reason: Reason::Derivative }),
        }
    }

    /// The first frame, with the arguments.
    fn prepare<T: Stacked>(
        &mut self,
        functions: &Functions,
        function: u32,
        arguments: impl Iterator<Item = T>,
    ) {
        let code = &functions.codes[function as usize];
        let stack = T::stack(&mut self.stacks);
        grow(stack, code.frame as usize);
        for (register, argument) in stack[..code.n_inputs as usize].iter_mut().zip(arguments) {
            *register = argument;
        }
        self.callers.clear();
        self.budget = instruction_limit();
    }

    /// Runs a function whose frame stands at the bottom of the stack; once more with zeros if it uses
    /// variables before they are assigned.
    fn run<T: Differentiate>(
        &mut self,
        functions: &Functions,
        function: u32,
    ) -> Result<(), Failure> {
        let made = self.externals.strings.len();
        let result = self.run_with_defaults::<T>(functions, function);
        if !functions.codes[function as usize].returns_strings {
            // The numbers of the Strings that it made are not used anywhere else.
            self.externals.strings.truncate(made);
        }
        result
    }

    fn run_with_defaults<T: Differentiate>(
        &mut self,
        functions: &Functions,
        function: u32,
    ) -> Result<(), Failure> {
        let (depth, budget) = (self.callers.len(), self.budget);
        let code = &functions.codes[function as usize];
        let random = (code.impure && !self.has_defaults).then(|| self.externals.random().clone());
        let result = self.run_once::<T>(functions, function);
        let failure = match result {
            Err(failure) if failure.reason == Reason::Unassigned => failure,
            other => return other,
        };
        let may_repeat = !code.impure || functions.draws_alone(function);
        if !functions.takes_defaults || self.has_defaults || code.writes || !may_repeat {
            return Err(failure);
        }
        if let Some(random) = random {
            *self.externals.random() = random;
        }
        self.callers.truncate(depth);
        self.budget = budget;
        self.has_defaults = true;
        let result = self.run_once::<T>(functions, function);
        self.has_defaults = false;
        if result.is_ok() {
            self.note_default(function, failure);
        }
        result
    }

    fn run_once<T: Differentiate>(
        &mut self,
        functions: &Functions,
        function: u32,
    ) -> Result<(), Failure> {
        let mut stack = std::mem::take(T::stack(&mut self.stacks));
        let code = &functions.codes[function as usize];
        let mut result = Ok(false);
        if let Some(derivative) = &code.derivative {
            let (arguments, results) = (0..code.n_inputs as usize, code.outputs as usize);
            let stack = &mut stack;
            result =
                T::differentiate(self, functions, function, derivative, stack, arguments, results);
        }
        if matches!(result, Ok(false)) {
            result = self.run_at(functions, function, 0, &mut stack).map(|()| true);
        }
        *T::stack(&mut self.stacks) = stack;
        result.map(|_| ())
    }

    /// Runs a function on a stack of its own, while others run on numbers of another kind.
    fn nested<T: Differentiate>(
        &mut self,
        functions: &Functions,
        function: u32,
        arguments: &[T],
    ) -> Result<Vec<T>, Failure> {
        let code = &functions.codes[function as usize];
        let before = std::mem::take(T::stack(&mut self.stacks));
        grow(T::stack(&mut self.stacks), code.frame as usize);
        T::stack(&mut self.stacks)[..arguments.len()].copy_from_slice(arguments);
        let result = self.run::<T>(functions, function);
        let stack = std::mem::replace(T::stack(&mut self.stacks), before);
        result.map(|()| stack[code.outputs as usize..][..code.n_outputs as usize].to_vec())
    }

    fn run_at<T: Differentiate>(
        &mut self,
        functions: &Functions,
        mut function: u32,
        mut base: usize,
        stack: &mut Vec<T>,
    ) -> Result<(), Failure> {
        let outermost = self.callers.len();
        let mut code = &functions.codes[function as usize];
        let mut at = 0usize;
        loop {
            let request = self.advance((functions, code), &mut at, base, stack);
            if let Some(failure) = self.failure.take() {
                return Err(failure);
            }
            match request {
                Ok(None) => {
                    if self.callers.len() == outermost {
                        return Ok(());
                    }
                    let Some(caller) = self.callers.pop() else { return Ok(()) };
                    self.end((functions, function, base), caller, stack);
                    (function, at, base) =
                        (caller.function, caller.at as usize, caller.base as usize);
                    code = &functions.codes[function as usize];
                }
                Ok(Some(MachineRequest::External(external))) => {
                    let external = &code.externals[external as usize];
                    let here = |reason| Failure { function, at: at as u32 - 1, reason };
                    let frame = &mut stack[base..];
                    T::run_external(functions, code, external, frame, &mut self.externals)
                        .map_err(here)?;
                }
                Ok(Some(MachineRequest::Call(call))) => {
                    let callee = &functions.codes[call.function as usize];
                    let next = base + code.frame as usize;
                    if self.is_too_deep(callee, next) {
                        let reason = Reason::Depth;
                        return Err(Failure { function, at: at as u32 - 1, reason });
                    }
                    if self.begin((functions, callee), &call, (base, next), stack)? {
                        self.callers.push(self.caller(function, at as u32, base, &call));
                        (function, at, base, code) = (call.function, 0, next, callee);
                    }
                }
                Ok(Some(MachineRequest::Warning)) => {
                    let reason = Reason::Assertion;
                    self.note_warning(Failure { function, at: at as u32 - 1, reason });
                }
                // No function pauses before its machine code runs.
                Ok(Some(MachineRequest::Pause)) => {}
                Err(reason) => {
                    return Err(Failure { function, at: at as u32 - 1, reason });
                }
            }
        }
    }

    /// Who is to continue after a call by the instruction before `at`.
    fn caller(&self, function: u32, at: u32, base: usize, call: &Call) -> Caller {
        Caller {
            function,
            at,
            base: base as u32,
            arguments: call.arguments,
            results: call.results,
            budget: self.budget,
        }
    }

    /// Whether calls would be nested too deep with one whose frame begins there.
    fn is_too_deep(&self, callee: &Code, next: usize) -> bool {
        self.callers.len() + self.direct_calls >= MAX_CALLS
            || next + callee.frame as usize > MAX_STACK
    }

    /// Begins a call from a frame at `base` to one at `next`, where its arguments are then; whether it
    /// must be run: else its results are known.
    fn begin<T: Differentiate>(
        &mut self,
        (functions, callee): (&Functions, &Code),
        call: &Call,
        (base, next): (usize, usize),
        stack: &mut Vec<T>,
    ) -> Result<bool, Failure> {
        grow(stack, next + callee.frame as usize);
        let first = base + call.arguments as usize;
        let arguments = first..first + callee.n_inputs as usize;
        let results = base + call.results as usize;
        let function = call.function;
        if self.recall(functions, function, stack, arguments.clone(), results) {
            return Ok(false);
        }
        if let Some(derivative) = &callee.derivative {
            let arguments = arguments.clone();
            if T::differentiate(self, functions, function, derivative, stack, arguments, results)? {
                return Ok(false);
            }
        }
        stack.copy_within(arguments, next);
        Ok(true)
    }

    /// Ends a call of a function whose frame begins at `base`: its results go to the caller.
    fn end<T: Differentiate>(
        &mut self,
        (functions, function, base): (&Functions, u32, usize),
        caller: Caller,
        stack: &mut [T],
    ) {
        let code = &functions.codes[function as usize];
        let first = base + code.outputs as usize;
        let outputs = first..first + code.n_outputs as usize;
        self.keep(functions, function, caller, stack, outputs.clone());
        stack.copy_within(outputs, (caller.base + caller.results) as usize);
    }

    /// What registers hold that nothing was assigned to.
    fn value_of_unassigned(&self) -> f64 {
        if self.has_defaults { 0.0 } else { f64::NAN }
    }

    /// Runs one frame up to the end or to a call, by machine code as far as there is any; `at` is the
    /// position after the last instruction run, 0 before the first.
    fn advance<T: Differentiate>(
        &mut self,
        (functions, code): (&Functions, &Code),
        at: &mut usize,
        base: usize,
        stack: &mut Vec<T>,
    ) -> Result<Option<MachineRequest>, Reason> {
        let unassigned = self.value_of_unassigned();
        let mut has_constants = *at > 0;
        loop {
            let machine_code = code.machine_code.get(T::PARTS - 1);
            let next = machine_code.map_or(Next::Everything, |machine_code| {
                let call = direct_calls::call::<Machine, T>;
                machine_code.next(code.instructions.len(), || translated(functions, code, call))
            });
            if let Next::MachineCode(translated) = next {
                if !has_constants && translated.reads_constants() {
                    enter(code, stack, base);
                    has_constants = true;
                }
                *at = direct_calls::run(translated, (self, functions), stack, (base, *at));
                if *at >= code.instructions.len() || self.failure.is_some() {
                    return Ok(None);
                }
            }
            if !has_constants {
                enter(code, stack, base);
                has_constants = true;
            }
            let frame = &mut stack[base..];
            let (Next::AtMost(instructions), Some(machine_code)) = (next, machine_code) else {
                return execute(code, at, frame, unassigned, &mut self.budget, 0);
            };
            let (first, before) = (*at, self.budget);
            let pause = before.saturating_sub(instructions);
            let request = execute(code, at, frame, unassigned, &mut self.budget, pause);
            machine_code.count(before - self.budget + at.saturating_sub(first) as u64);
            if !matches!(request, Ok(Some(MachineRequest::Pause))) {
                return request;
            }
        }
    }
}

impl<T: Differentiate> MakesCalls<T> for Machine {
    #[inline]
    fn make_call(
        &mut self,
        functions: &Functions,
        call: &Call,
        at: u32,
        (base, size): (usize, usize),
        stack: &mut Vec<T>,
    ) -> bool {
        let callee = &functions.codes[call.function as usize];
        let next = base + size;
        let is_left = self.direct_calls >= MAX_DIRECT_CALLS || self.is_too_deep(callee, next);
        if is_left || spend(&mut self.budget, at as usize + 1, 0).is_err() {
            return false;
        }
        let caller = self.caller(call.function, at, base, call);
        let result = match self.begin((functions, callee), call, (base, next), stack) {
            Ok(true) => {
                self.direct_calls += 1;
                let result = self.run_at(functions, call.function, next, stack);
                self.direct_calls -= 1;
                result.map(|()| self.end((functions, call.function, next), caller, stack))
            }
            other => other.map(|_| ()),
        };
        self.failure = result.err();
        self.failure.is_none()
    }

    fn unassigned(&self) -> f64 {
        self.value_of_unassigned()
    }

    fn budget_mut(&mut self) -> &mut u64 {
        &mut self.budget
    }
}

impl Machine {
    /// Whether calls of a function are kept.
    fn keeps(&mut self, functions: &Functions, function: u32) -> bool {
        self.memos.is_some()
            && self.kept.get_or_insert_with(|| worth_keeping(functions))[function as usize]
    }

    /// Writes the results of a call that is known; whether it is, and the budget suffices.
    fn recall<T: Kept>(
        &mut self,
        functions: &Functions,
        function: u32,
        stack: &mut [T],
        arguments: std::ops::Range<usize>,
        results: usize,
    ) -> bool {
        if !self.keeps(functions, function) {
            return false;
        }
        let Some(memos) = &mut self.memos else { return false };
        let found = T::memo(memos).find(function, &stack[arguments]);
        let Some((known, cost)) = found else { return false };
        let Some(left) = self.budget.checked_sub(cost) else { return false };
        self.budget = left;
        stack[results..results + known.len()].copy_from_slice(known);
        memos.recalled += 1;
        true
    }

    /// Keeps a call that has ended.
    fn keep<T: Kept>(
        &mut self,
        functions: &Functions,
        function: u32,
        caller: Caller,
        stack: &[T],
        outputs: std::ops::Range<usize>,
    ) {
        if !self.keeps(functions, function) {
            return;
        }
        let cost = caller.budget.saturating_sub(self.budget);
        let n_inputs = functions.codes[function as usize].n_inputs as usize;
        let arguments = &stack[(caller.base + caller.arguments) as usize..][..n_inputs];
        if let Some(memos) = &mut self.memos {
            T::memo(memos).keep(function, arguments, &stack[outputs], cost);
        }
    }
}

/// What a function requests of its machine.
#[derive(Debug, PartialEq)]
pub(super) enum MachineRequest {
    Call(Call),
    External(u32),
    /// To take the warning of the instruction before.
    Warning,
    /// To continue at the head of a loop after a number of instructions.
    Pause,
}

/// Numbers whose derivatives another function may compute.
trait Differentiate: RunExternal + Kept + Stacked {
    /// Calls a function with its derivative function, from and to the stack; whether this is
    /// possible.
    fn differentiate(
        machine: &mut Machine,
        functions: &Functions,
        function: u32,
        derivative: &Derivative,
        stack: &mut [Self],
        arguments: std::ops::Range<usize>,
        results: usize,
    ) -> Result<bool, Failure>;

    /// What a derivative function gives for arguments and their derivatives.
    fn derivatives(
        machine: &mut Machine,
        functions: &Functions,
        derivative: &Derivative,
        values: &[Self],
        tangents: &[Self],
    ) -> Result<Vec<Self>, Failure> {
        machine.nested(functions, derivative.function, &[values, tangents].concat())
    }
}

impl Differentiate for f64 {
    fn differentiate(
        _: &mut Machine,
        _: &Functions,
        _: u32,
        _: &Derivative,
        _: &mut [f64],
        _: std::ops::Range<usize>,
        _: usize,
    ) -> Result<bool, Failure> {
        Ok(false)
    }
}

impl<T: Differentiate> Differentiate for Dual<T>
where
    Dual<T>: RunExternal + Kept + Stacked,
{
    fn differentiate(
        machine: &mut Machine,
        functions: &Functions,
        function: u32,
        derivative: &Derivative,
        stack: &mut [Self],
        arguments: std::ops::Range<usize>,
        results: usize,
    ) -> Result<bool, Failure> {
        let given: Vec<Self> = stack[arguments].to_vec();
        if derivative.zero.iter().any(|input| !given[*input as usize].d.is_zero()) {
            return Ok(false);
        }
        let values: Vec<T> = given.iter().map(|x| x.v).collect();
        let tangents: Vec<T> =
            derivative.tangents.iter().map(|input| given[*input as usize].d).collect();
        let derivatives = T::derivatives(machine, functions, derivative, &values, &tangents)?;
        let values = machine.nested(functions, function, &values)?;
        for (at, (v, output)) in values.into_iter().zip(&derivative.outputs).enumerate() {
            let d = output.map_or(T::constant(0.0), |output| derivatives[output as usize]);
            stack[results + at] = Dual { v, d };
        }
        Ok(true)
    }

    /// The second derivative function gives f''[a, a] + f'·e; the derivative of f'·a in the
    /// direction (b, c) is f''[a, b] + f'·c, a quarter of its values at a + b, 2c less those at
    /// a − b, −2c.
    fn derivatives(
        machine: &mut Machine,
        functions: &Functions,
        derivative: &Derivative,
        values: &[Self],
        tangents: &[Self],
    ) -> Result<Vec<Self>, Failure> {
        let Some(second) = derivative.second else {
            return machine.nested(functions, derivative.function, &[values, tangents].concat());
        };
        let at: Vec<T> = values.iter().map(|u| u.v).collect();
        let along: Vec<T> = tangents.iter().map(|a| a.v).collect();
        let mut beside = |sign: f64| {
            let sign = T::constant(sign);
            let moved = derivative.tangents.iter().zip(&along);
            let moved: Vec<T> =
                moved.map(|(input, a)| a.add(sign.mul(values[*input as usize].d))).collect();
            let two = sign.add(sign);
            let bent: Vec<T> = tangents.iter().map(|a| two.mul(a.d)).collect();
            machine.nested(functions, second, &[at.as_slice(), &moved, &bent].concat())
        };
        let (plus, minus) = (beside(1.0)?, beside(-1.0)?);
        let derivatives = T::derivatives(machine, functions, derivative, &at, &along)?;
        let quarter = T::constant(0.25);
        let parts = derivatives.into_iter().zip(plus.into_iter().zip(minus));
        Ok(parts.map(|(v, (a, b))| Dual { v, d: quarter.mul(a.sub(b)) }).collect())
    }
}

fn unit(at: usize, input: u32) -> f64 {
    f64::from(u8::from(at == input as usize))
}

fn grow<T: Number>(stack: &mut Vec<T>, size: usize) {
    if stack.len() < size {
        stack.resize(size, T::constant(f64::NAN));
    }
}

fn enter<T: Number>(code: &Code, stack: &mut [T], base: usize) {
    for (register, value) in &code.constants {
        stack[base + *register as usize] = T::constant(*value);
    }
}

/// Interprets instructions of one frame up to the end or to a call, or to the head of a loop when the
/// budget is not more than `pause`; `at` is the position after the last one run.
pub(super) fn execute<T: Number>(
    code: &Code,
    at: &mut usize,
    r: &mut [T],
    unassigned: f64,
    budget: &mut u64,
    pause: u64,
) -> Result<Option<MachineRequest>, Reason> {
    while let Some(instruction) = code.instructions.get(*at) {
        *at += 1;
        match *instruction {
            Instruction::Constant { d, value } => r[d as usize] = T::constant(value),
            Instruction::Unassign { d, n } => {
                r[d as usize..(d + n) as usize].fill(T::constant(unassigned));
            }
            Instruction::Move { d, a, n: 1 } => r[d as usize] = r[a as usize],
            Instruction::Move { d, a, n } => {
                r.copy_within(a as usize..(a + n) as usize, d as usize);
            }
            Instruction::Operation(operation) => r[operation.d as usize] = computed(operation, r)?,
            Instruction::Offset { d, subscript, size, stride } => {
                let subscript = r[subscript as usize].value();
                if !(1.0..=f64::from(size)).contains(&subscript) || subscript.fract() != 0.0 {
                    return Err(Reason::Subscript);
                }
                let offset = (subscript - 1.0) * f64::from(stride);
                r[d as usize] = r[d as usize].add(T::constant(offset));
            }
            Instruction::Load { d, base, offset } => {
                let position = place(base, r[offset as usize]);
                r[d as usize] = *r.get(position).ok_or(Reason::Subscript)?;
            }
            Instruction::Store { base, offset, a } => {
                let position = place(base, r[offset as usize]);
                let value = r[a as usize];
                *r.get_mut(position).ok_or(Reason::Subscript)? = value;
            }
            Instruction::Iterations { d, range } => {
                let of = |at: u32| r[(range + at) as usize].value();
                r[d as usize] = T::constant(iterations(of(0), of(1), of(2))?);
            }
            Instruction::Jump { target } => {
                let from = std::mem::replace(at, target as usize);
                spend(budget, from, *at).inspect_err(|_| *at = from)?;
                if *at < from && *budget < pause {
                    return Ok(Some(MachineRequest::Pause));
                }
            }
            Instruction::JumpUnless { a, target } => {
                if !decided(r[a as usize])? {
                    spend(budget, *at, target as usize)?;
                    *at = target as usize;
                }
            }
            Instruction::Call { function, d, a } => {
                spend(budget, *at, 0)?;
                return Ok(Some(MachineRequest::Call(Call { function, arguments: a, results: d })));
            }
            Instruction::External { external } => {
                return Ok(Some(MachineRequest::External(external)));
            }
            Instruction::Check { a, n } => {
                if r[a as usize..(a + n) as usize].iter().any(|value| value.value().is_nan()) {
                    return Err(Reason::Unassigned);
                }
            }
            Instruction::Finite { a } => drop(finite(r[a as usize])?),
            Instruction::Assert { a, .. } => {
                if !decided(r[a as usize])? {
                    return Err(Reason::Assertion);
                }
            }
            Instruction::Warn { a, .. } => {
                if !decided(r[a as usize])? {
                    return Ok(Some(MachineRequest::Warning));
                }
            }
        }
    }
    Ok(None)
}

/// The register `base` plus an offset.
fn place<T: Number>(base: u32, offset: T) -> usize {
    (base as usize).saturating_add(offset.value() as usize)
}

/// Takes the instructions between a jump back and its target from the budget.
fn spend(budget: &mut u64, from: usize, to: usize) -> Result<(), Reason> {
    let cost = from.saturating_sub(to) as u64 + 1;
    *budget = budget.checked_sub(cost).ok_or(Reason::Budget)?;
    Ok(())
}

fn decided<T: Number>(condition: T) -> Result<bool, Reason> {
    match condition.value() {
        value if value.is_nan() => Err(Reason::Unassigned),
        value => Ok(value != 0.0),
    }
}

/// The value of an operation, which must be finite unless it overflows; NaN from an operand without
/// value is that operand's fault.
#[inline(always)]
fn computed<T: Number>(operation: Operation, r: &[T]) -> Result<T, Reason> {
    let Operation { operator, a, b, .. } = operation;
    if operator.hides_nan() {
        given(r, a, b)?;
    }
    let result = operation.value(r);
    match operator.may_fail() && !result.value().is_finite() {
        true if operator.overflows_at(r[a as usize].value()) => Ok(result),
        true => given(r, a, b).and(Err(Reason::NotFinite)),
        false => Ok(result),
    }
}

/// Whether two operands have values.
fn given<T: Number>(r: &[T], a: u32, b: u32) -> Result<(), Reason> {
    match r[a as usize].value().is_nan() || r[b as usize].value().is_nan() {
        true => Err(Reason::Unassigned),
        false => Ok(()),
    }
}

/// A result that must be finite.
fn finite<T: Number>(result: T) -> Result<T, Reason> {
    match result.value().is_finite() {
        true => Ok(result),
        false => Err(Reason::NotFinite),
    }
}

#[cfg(test)]
mod tests {
    use super::super::code::ExternalCall;
    use super::*;
    use crate::arithmetic::Operator;
    use crate::external::{COMPOSE, Slot, SlotKind};

    /// `y = x*x`, after `String(x)` was made.
    fn making_a_string(returns_strings: bool) -> Functions {
        let slot = |kind, first, dims: &[u32]| Slot { kind, first, dims: dims.into() };
        let arguments = vec![slot(SlotKind::Number, 0, &[5])];
        let call = ExternalCall::new(&COMPOSE, arguments, Some(slot(SlotKind::Numbered, 5, &[])));
        let instructions = vec![
            Instruction::External { external: 0 },
            Operation::binary(Operator::Mul, 6, 0, 0).into(),
        ];
        let code = Code {
            n_inputs: 1,
            outputs: 6,
            n_outputs: 1,
            frame: 7,
            constants: vec![(1, 0.0), (2, 6.0), (3, 0.0), (4, 1.0), (5, f64::NAN)],
            instructions,
            externals: vec![call],
            returns_strings,
            ..Code::default()
        };
        Functions { codes: vec![code], ..Functions::default() }
    }

    #[test]
    fn values_and_derivatives_leave_no_strings() {
        let functions = making_a_string(false);
        let mut machine = Machine::default();
        assert_eq!(machine.call(&functions, 0, [3.0].into_iter()), Ok(&[9.0][..]));
        assert_eq!(machine.externals.strings.len(), 0);
        assert_eq!(machine.partial(&functions, 0, &[0], [3.0].into_iter()), Ok(&[6.0][..]));
        assert_eq!(machine.externals.strings.len(), 0);
        let functions = making_a_string(true);
        machine.call(&functions, 0, [3.0].into_iter()).expect("a value");
        assert_eq!(machine.externals.strings.len(), 1);
    }
}
