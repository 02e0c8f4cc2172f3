//! Functions that the interpreter calls again and again, compiled for the sizes at hand.

use super::instances::{Instance, Instances};
use crate::bytecode::Machine;
use crate::eval::{Function, FunctionComponent, RunCompiled, ValueType};
use crate::flatten::FlatModel;
use crate::lower::errors::NO_CONSTANT_VALUE;
use crate::lower::expressions::{Array, Lowered};
use crate::lower::number_values::{append_numbers, value_of};
use crate::lower::shape::Shape;
use crate::source::Span;
use crate::value::Value;
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// The call of a function with the same sizes that makes it worth compiling.
const WORTH_COMPILING: u32 = 3;
/// A compiled function is left to the interpreter once it has failed, warned or given NaN so many times
/// more often than it answered. A run takes about a hundredth of the time of the statements, so that
/// these add one call to a hundred, and a few arguments without a value take the others nothing.
const GIVEN_UP: u32 = 100;
/// Statements of a call after which the functions in it are compiled.
const LONG: u64 = 10_000;
/// Most combinations of functions, sizes and Integers.
const MAX_KEPT: usize = 2_000;
/// Most instructions of a function that a script calls, with those that it calls. Compiled code has
/// instructions for each element of an array: 8 for `sum(2*x + x .* x)`, 7 for
/// `y[2:end - 1] := (x[1:end - 2] + x[2:end - 1] + x[3:end])/3`, 4 for each element of a matrix that is made
/// and multiplied by a vector, none in a loop over `x[i]`. Counted with 10 to 30,000 elements: up to this
/// limit statements on arrays take 1.5 to 4 times as long as compiled code, and compiling takes as long as 3
/// to 10 calls; a loop takes 40 times as long (debug build).
const MAX_INSTRUCTIONS_IN_SCRIPTS: usize = 100_000;
/// Most numbers in the arguments of a function that a script calls: with two instructions for each, as for
/// `max(x) - min(x)`, which has the fewest of those measured above, it has as many as it may.
const MAX_NUMBERS_IN_SCRIPTS: usize = MAX_INSTRUCTIONS_IN_SCRIPTS / 2;

/// From greater Integers sums with small ones may lead beyond 2^53, where scripts are exact and compiled
/// functions are not.
const LARGEST_IN_SCRIPTS: f64 = 4_503_599_627_370_496.0;

/// Compiled functions of a model with nothing but functions.
pub(in crate::lower) struct OnDemand {
    library: Arc<FlatModel>,
    compiled: CompiledFunctions,
}

impl OnDemand {
    /// The compiler of a call that has taken so many statements, if these are enough.
    pub(in crate::lower) fn of_long_call(
        compiler: &mut Option<OnDemand>,
        statements: u64,
        library: impl FnOnce() -> Arc<FlatModel>,
    ) -> Option<&mut dyn RunCompiled> {
        if compiler.is_none() && statements >= LONG {
            let compiled = CompiledFunctions::new(Instances::new(true), false);
            *compiler = Some(OnDemand { library: library(), compiled });
        }
        compiler.as_mut().map(|compiler| compiler as &mut dyn RunCompiled)
    }
}

impl RunCompiled for OnDemand {
    fn run_compiled(&mut self, function: &Arc<Function>, inputs: &[&Value]) -> Option<Vec<Value>> {
        let OnDemand { library, compiled } = self;
        compiled.call(function, inputs, || Some(library.clone()))
    }
}

/// Functions compiled for the interpreter, and how often it called those that are not.
pub struct CompiledFunctions {
    instances: Instances,
    machine: Machine,
    kept: FxHashMap<Key, State>,
    /// The functions among the keys, whose places in memory no others take.
    functions: FxHashMap<usize, Arc<Function>>,
    in_scripts: bool,
    /// How many calls they answered.
    calls: u64,
    /// How many calls were tried.
    runs: u64,
}

/// A function, by its place in memory, the sizes of its arguments, and the Integers that it is compiled
/// for, if any.
type Key = (usize, Box<[u64]>);

enum State {
    Called(u32),
    /// With how many more of its runs failed than answered.
    Compiled(Instance, u32),
    /// Sizes depend on the values of Integers.
    NeedsIntegers,
    Refused,
}

impl CompiledFunctions {
    fn new(instances: Instances, in_scripts: bool) -> CompiledFunctions {
        CompiledFunctions {
            instances,
            machine: Machine::default(),
            kept: FxHashMap::default(),
            functions: FxHashMap::default(),
            in_scripts,
            calls: 0,
            runs: 0,
        }
    }

    /// Those that scripts call, where results beyond the largest Real are faults, as long as no name
    /// changes what it stands for.
    pub fn of_scripts() -> CompiledFunctions {
        let mut instances = Instances::new(true);
        instances.refuses_overflow = true;
        CompiledFunctions::new(instances, true)
    }

    /// The outputs of a pure function for values of all its inputs, the same that its statements give.
    /// `None` if it is not compiled, fails, gives NaN or warns: then the statements are executed, and
    /// say why. `library`: a model with the function and all that it calls.
    pub fn call(
        &mut self,
        function: &Arc<Function>,
        inputs: &[&Value],
        library: impl FnMut() -> Option<Arc<FlatModel>>,
    ) -> Option<Vec<Value>> {
        let (key, instance, before) = self.instance(function, inputs, library)?;
        self.runs += 1;
        let outputs = self.run(function, &instance, inputs);
        let failures = match &outputs {
            Some(_) => before.saturating_sub(1),
            None => before + 1,
        };
        if failures >= GIVEN_UP {
            self.kept.insert(key, State::Refused);
        } else if failures != before {
            self.kept.insert(key, State::Compiled(instance, failures));
        }
        self.calls += u64::from(outputs.is_some());
        outputs
    }

    /// How many calls they answered.
    pub fn calls(&self) -> u64 {
        self.calls
    }

    /// How many calls were tried.
    pub fn runs(&self) -> u64 {
        self.runs
    }

    /// The compiled function, if it is worth it and possible.
    fn instance(
        &mut self,
        function: &Arc<Function>,
        inputs: &[&Value],
        mut library: impl FnMut() -> Option<Arc<FlatModel>>,
    ) -> Option<(Key, Instance, u32)> {
        let numbers = |input: &&Value| dims_of(input).iter().product::<usize>();
        let is_large = inputs.iter().map(numbers).sum::<usize>() > MAX_NUMBERS_IN_SCRIPTS;
        if is_large && self.in_scripts {
            return None;
        }
        let mut sizes = Vec::new();
        inputs.iter().for_each(|input| sizes.extend(dims_of(input).iter().map(|n| *n as u64)));
        let address = Arc::as_ptr(function).addr();
        let key = (address, sizes.clone().into_boxed_slice());
        match self.state(&key, function, inputs, false, &mut library)? {
            State::Compiled(instance, failures) => {
                let found = (instance.clone(), *failures);
                return Some((key, found.0, found.1));
            }
            State::NeedsIntegers => {}
            State::Called(_) | State::Refused => return None,
        }
        for (input, value) in function.inputs.iter().zip(inputs) {
            sizes.extend(whole(input, value).map(f64::to_bits));
        }
        let key = (address, sizes.into_boxed_slice());
        match self.state(&key, function, inputs, true, &mut library)? {
            State::Compiled(instance, failures) => {
                let found = (instance.clone(), *failures);
                Some((key, found.0, found.1))
            }
            _ => None,
        }
    }

    /// What is known of a combination, after one more call.
    fn state(
        &mut self,
        key: &Key,
        function: &Arc<Function>,
        inputs: &[&Value],
        with_integers: bool,
        library: &mut dyn FnMut() -> Option<Arc<FlatModel>>,
    ) -> Option<&State> {
        if self.kept.len() >= MAX_KEPT && !self.kept.contains_key(key) {
            return None;
        }
        let calls = match self.kept.get(key) {
            None => 0,
            Some(State::Called(calls)) => *calls,
            Some(_) => WORTH_COMPILING,
        };
        if calls + 1 < WORTH_COMPILING {
            self.functions.entry(key.0).or_insert_with(|| function.clone());
            self.kept.insert(key.clone(), State::Called(calls + 1));
        } else if calls + 1 == WORTH_COMPILING {
            let state = match library() {
                Some(library) => self.compiled(&library, function, inputs, with_integers),
                None => State::Refused,
            };
            self.kept.insert(key.clone(), state);
        }
        self.kept.get(key)
    }

    fn compiled(
        &mut self,
        library: &Arc<FlatModel>,
        function: &Arc<Function>,
        inputs: &[&Value],
        with_integers: bool,
    ) -> State {
        let mut known = Vec::with_capacity(inputs.len());
        for (input, value) in function.inputs.iter().zip(inputs) {
            if !is_numeric(input) {
                return State::Refused;
            }
            let dims = dims_of(value).to_vec();
            let integer = whole(input, value).filter(|_| with_integers);
            let elements = vec![integer; dims.iter().product()];
            known.push(Lowered::Array(Array { dims, elements }));
        }
        if !function.outputs.iter().all(is_numeric) {
            return State::Refused;
        }
        if self.in_scripts {
            self.instances.allow(MAX_INSTRUCTIONS_IN_SCRIPTS);
        }
        match self.instances.instance(library, function, &known, Span::NONE) {
            Ok(instance) if instance.impure || instance.writes => State::Refused,
            // A file may be rewritten between two calls.
            Ok(instance) if self.instances.reads_files(instance.code) => State::Refused,
            Ok(instance) if self.in_scripts && self.instances.leaves_program(instance.code) => {
                State::Refused
            }
            Ok(instance) => State::Compiled(instance, 0),
            Err(e) if e.code == NO_CONSTANT_VALUE && !with_integers => State::NeedsIntegers,
            Err(_) => State::Refused,
        }
    }

    /// The outputs of a compiled function; `None` if it fails, warns, or gives NaN.
    fn run(
        &mut self,
        function: &Function,
        instance: &Instance,
        inputs: &[&Value],
    ) -> Option<Vec<Value>> {
        let mut numbers = Vec::new();
        for (input, value) in function.inputs.iter().zip(inputs) {
            let first = numbers.len();
            append_numbers(value, &mut numbers)?;
            let bounded = self.in_scripts && matches!(input.value_type, ValueType::Integer);
            if bounded && numbers[first..].iter().any(|x| x.abs() > LARGEST_IN_SCRIPTS) {
                return None;
            }
        }
        let passed = numbers.iter().zip(&instance.passed);
        let passed = passed.filter(|(_, passed)| **passed).map(|(number, _)| *number);
        let functions = &self.instances.functions;
        let results = self.machine.call(functions, instance.code, passed).ok()?.to_vec();
        if self.machine.take_notices() || results.iter().any(|x| x.is_nan()) {
            return None;
        }
        let mut rest = results.as_slice();
        let outputs = function.outputs.iter().zip(&instance.outputs).map(|(output, shape)| {
            let Shape::Array(dims) = shape else { return None };
            let (own, others) = rest.split_at_checked(shape.len())?;
            rest = others;
            value_of(own, dims, &output.value_type)
        });
        outputs.collect()
    }
}

fn dims_of(value: &Value) -> &[usize] {
    match value {
        Value::Array(array) => &array.dims,
        _ => &[],
    }
}

/// The number of a scalar that sizes may depend on.
fn whole(input: &FunctionComponent, value: &Value) -> Option<f64> {
    match (&input.value_type, value) {
        (ValueType::Integer, Value::Integer(value)) => Some(*value as f64),
        (ValueType::Boolean, Value::Boolean(value)) => Some(f64::from(u8::from(*value))),
        _ => None,
    }
}

fn is_numeric(component: &FunctionComponent) -> bool {
    matches!(component.value_type, ValueType::Real | ValueType::Integer | ValueType::Boolean)
}
