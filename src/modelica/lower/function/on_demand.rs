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
/// Statements of a call after which the functions in it are compiled.
const LONG: u64 = 10_000;
/// Most combinations of functions, sizes and Integers.
const MAX_KEPT: usize = 2_000;

/// Functions compiled for the interpreter, and how often it called those that are not.
pub(in crate::lower) struct OnDemand {
    /// A model with nothing but functions.
    library: Arc<FlatModel>,
    instances: Instances,
    machine: Machine,
    kept: FxHashMap<Key, State>,
}

/// A function, by its place in memory, the sizes of its arguments, and the Integers that it is compiled
/// for, if any.
type Key = (usize, Box<[u64]>);

enum State {
    Called(u32),
    Compiled(Instance),
    /// Sizes depend on the values of Integers.
    NeedsIntegers,
    Refused,
}

impl OnDemand {
    /// Compiles functions of a model that is used for nothing else.
    fn new(library: Arc<FlatModel>) -> OnDemand {
        OnDemand {
            instances: Instances::new(true),
            machine: Machine::default(),
            kept: FxHashMap::default(),
            library,
        }
    }

    /// The compiler of a call that has taken so many statements, if these are enough.
    pub(in crate::lower) fn of_long_call(
        compiler: &mut Option<OnDemand>,
        statements: u64,
        library: impl FnOnce() -> Arc<FlatModel>,
    ) -> Option<&mut dyn RunCompiled> {
        if compiler.is_none() && statements >= LONG {
            *compiler = Some(OnDemand::new(library()));
        }
        compiler.as_mut().map(|compiler| compiler as &mut dyn RunCompiled)
    }

    /// The compiled function, if it is worth it and possible.
    fn instance(&mut self, function: &Arc<Function>, inputs: &[&Value]) -> Option<Instance> {
        let mut sizes = Vec::new();
        inputs.iter().for_each(|input| sizes.extend(dims_of(input).iter().map(|n| *n as u64)));
        let address = Arc::as_ptr(function).addr();
        let key = (address, sizes.clone().into_boxed_slice());
        match self.state(key, function, inputs, false)? {
            State::Compiled(instance) => return Some(instance.clone()),
            State::NeedsIntegers => {}
            State::Called(_) | State::Refused => return None,
        }
        for (input, value) in function.inputs.iter().zip(inputs) {
            sizes.extend(whole(input, value).map(f64::to_bits));
        }
        match self.state((address, sizes.into()), function, inputs, true)? {
            State::Compiled(instance) => Some(instance.clone()),
            _ => None,
        }
    }

    /// What is known of a combination, after one more call.
    fn state(
        &mut self,
        key: Key,
        function: &Arc<Function>,
        inputs: &[&Value],
        with_integers: bool,
    ) -> Option<&State> {
        if self.kept.len() >= MAX_KEPT && !self.kept.contains_key(&key) {
            return None;
        }
        let calls = match self.kept.get(&key) {
            None => 0,
            Some(State::Called(calls)) => *calls,
            Some(_) => WORTH_COMPILING,
        };
        if calls + 1 < WORTH_COMPILING {
            self.kept.insert(key.clone(), State::Called(calls + 1));
        } else if calls + 1 == WORTH_COMPILING {
            let state = self.compiled(function, inputs, with_integers);
            self.kept.insert(key.clone(), state);
        }
        self.kept.get(&key)
    }

    fn compiled(
        &mut self,
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
        match self.instances.instance(&self.library, function, &known, Span::NONE) {
            Ok(instance) if instance.impure || instance.writes => State::Refused,
            // A file may be rewritten between two calls.
            Ok(instance) if self.instances.reads_files(instance.code) => State::Refused,
            Ok(instance) => State::Compiled(instance),
            Err(e) if e.code == NO_CONSTANT_VALUE && !with_integers => State::NeedsIntegers,
            Err(_) => State::Refused,
        }
    }

    /// The outputs of a compiled function; `None` if it fails, or gives NaN.
    fn run(
        &mut self,
        function: &Function,
        instance: &Instance,
        inputs: &[&Value],
    ) -> Option<Vec<Value>> {
        let mut numbers = Vec::new();
        inputs.iter().try_for_each(|input| append_numbers(input, &mut numbers))?;
        let passed = numbers.iter().zip(&instance.passed);
        let passed = passed.filter(|(_, passed)| **passed).map(|(number, _)| *number);
        let functions = &self.instances.functions;
        let results = self.machine.call(functions, instance.code, passed).ok()?;
        if results.iter().any(|x| x.is_nan()) {
            return None;
        }
        let mut rest = results;
        let outputs = function.outputs.iter().zip(&instance.outputs).map(|(output, shape)| {
            let Shape::Array(dims) = shape else { return None };
            let (own, others) = rest.split_at_checked(shape.len())?;
            rest = others;
            value_of(own, dims, &output.value_type)
        });
        outputs.collect()
    }
}

impl RunCompiled for OnDemand {
    fn run_compiled(&mut self, function: &Arc<Function>, inputs: &[&Value]) -> Option<Vec<Value>> {
        let instance = self.instance(function, inputs)?;
        self.run(function, &instance, inputs)
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
