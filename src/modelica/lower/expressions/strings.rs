//! Functions of Strings: called while the model is compiled, by the interpreter.

use super::records::string_value;
use super::{Array, Choice, Lowered, Lowering, Target};
use crate::budget;
use crate::diag::{Diagnostic, Fault};
use crate::eval::{self, Callee, Function, Host, RunCompiled, Scope, ValueType, c_function};
use crate::external::{AtTranslation, Outside, Resources};
use crate::fault;
use crate::lower::errors::{NO_CONSTANT_VALUE, NOT_SUPPORTED};
use crate::lower::function::{OnDemand, library_of};
use crate::lower::number_values::{append_numbers, value_of};
use crate::lower::shape::UNKNOWN_TEXT;
use crate::lower::string_array::StringArray;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{Arguments, ComponentReference, Expression, ExpressionKind, Subscript};
use crate::value::{ArrayValue, Elements, RecordValue, Value};
use indexmap::IndexMap;
use std::cell::Cell;
use std::sync::Arc;

/// Functions that find files: their locations are known at translation (MLS §13.5).
const FIND_FILES: &[&str] = &[
    "Modelica.Utilities.Files.loadResource",
    "ModelicaServices.ExternalReferences.loadResource",
    "Modelica.Utilities.Files.fullPathName",
];

impl<T: Target> Lowering<'_, T> {
    /// The outputs of a function with Strings as inputs or outputs, if all its arguments are known
    /// and it can be run now; parameters on which a String depends are evaluated.
    pub(super) fn string_call(
        &mut self,
        function: &Arc<Function>,
        arguments: &[Lowered<T::Scalar>],
        span: Span,
    ) -> Result<Option<Vec<Lowered<T::Scalar>>>, Diagnostic> {
        let is_text = |c: &eval::FunctionComponent| c.value_type == ValueType::String;
        let gives_text = function.outputs.iter().any(is_text);
        if !gives_text && !function.inputs.iter().any(is_text) {
            return Ok(None);
        }
        if !gives_text && function.impure && c_function::is_in_c(function) {
            return Ok(None);
        }
        let mut values = Vec::with_capacity(arguments.len());
        for (input, argument) in function.inputs.iter().zip(arguments) {
            match self.known_argument(argument, input, gives_text) {
                Some(value) => values.push(value),
                None if gives_text && self.composes => return Ok(None),
                None if gives_text => {
                    return Err(fault!(
                        NOT_SUPPORTED,
                        "`{}` returns a String, but `{}` is unknown at translation",
                        function.name,
                        input.name
                    )
                    .at(span));
                }
                None => return Ok(None),
            }
        }
        if let ([Value::String(name)], true) =
            (values.as_slice(), FIND_FILES.contains(&function.name.to_string().as_str()))
        {
            let path = self.target.flat().resources.path(name).map_err(|fault| fault.at(span))?;
            return Ok(Some(vec![Lowered::Text(path.into())]));
        }
        match self.interpreted(function, values, span) {
            Err(_) if !gives_text => Ok(None),
            outputs => outputs,
        }
    }

    /// The outputs of a function that cannot be compiled, run now. Parameters among the arguments are
    /// evaluated.
    ///
    /// # Errors
    /// An argument is not known, or the interpreter cannot run it either and says why.
    pub(super) fn evaluated_call(
        &mut self,
        function: &Arc<Function>,
        arguments: &[Lowered<T::Scalar>],
        span: Span,
    ) -> Result<Vec<Lowered<T::Scalar>>, Option<Diagnostic>> {
        if function.impure && (!self.target.runs_once() || c_function::is_in_c(function)) {
            return Err(None);
        }
        let is_external = matches!(function.body, eval::FunctionBody::External(_));
        if (function.impure || is_external) && function.outputs.is_empty() {
            // What it does, such as to set the state of random numbers, it does to a simulation.
            return Err(None);
        }
        let known = function
            .inputs
            .iter()
            .zip(arguments)
            .map(|(input, argument)| self.known_argument(argument, input, true));
        let values = known.collect::<Option<Vec<Value>>>().ok_or(None)?;
        self.interpreted(function, values, span).map_err(Some)?.ok_or(None)
    }

    /// The outputs of a function as numbers and Strings; `None` if one of them is neither.
    fn interpreted(
        &mut self,
        function: &Arc<Function>,
        arguments: Vec<Value>,
        span: Span,
    ) -> Result<Option<Vec<Lowered<T::Scalar>>>, Diagnostic> {
        let mut host = Compiling::new(&*self.target);
        let outputs = eval::call_function(function, arguments.into(), span, &mut host);
        let (notes, warnings) = (host.outside.notes(), host.warnings);
        let outputs = outputs?;
        self.target.warn(notes.into_iter().map(|note| note.at(span).note()).collect());
        self.target.warn(warnings);
        Ok(outputs.iter().map(|value| self.lowered_value(value)).collect())
    }

    /// `String(x, …)` (MLS §3.7.1), [`UNKNOWN_TEXT`] if that is not known.
    pub(super) fn string_operator(
        &mut self,
        callee: &ComponentReference,
        arguments: &Arguments,
        span: Span,
    ) -> Arc<str> {
        let (function, arguments) = (callee.clone(), Box::new(arguments.clone()));
        let call = Expression::new(ExpressionKind::Call { function, arguments }, span);
        match eval::evaluate(&call, &mut Scope::script(), &mut Reading { lowering: self }) {
            Ok(Value::String(text)) => text,
            _ => UNKNOWN_TEXT.into(),
        }
    }

    /// The Strings that subscripts select; a single one at a position that is not known is selected
    /// by its number.
    pub(super) fn string_elements(
        &mut self,
        strings: StringArray,
        subscripts: &[Subscript],
        span: Span,
    ) -> Result<Lowered<T::Scalar>, Diagnostic> {
        let mut dims = Vec::new();
        let mut positions = vec![0];
        let mut choices = self.choices(&strings.dims, subscripts, span)?;
        if self.target.evaluates_string_parameters().is_some_and(|evaluates| *evaluates) {
            self.evaluate_choices(&mut choices, &strings.dims);
        }
        if choices.iter().any(|choice| matches!(choice, Choice::Computed(_)))
            && let Some(numbers) = self.string_numbers(&strings)
        {
            let chosen = self.chosen_by(numbers, choices, span)?;
            return match chosen.elements.as_slice() {
                [number] if chosen.dims.is_empty() => Ok(Lowered::Numbered(*number)),
                _ => Err(unknown_subscript(span)),
            };
        }
        let mut choices = choices.into_iter();
        for size in &strings.dims {
            let (chosen, keeps) = match choices.next() {
                Some(Choice::Known { positions, keeps }) => (positions, keeps),
                Some(Choice::Computed(_) | Choice::ComputedVector(_)) => {
                    return Err(unknown_subscript(span));
                }
                None => ((0..*size).collect(), true),
            };
            let step = |at: &usize| chosen.iter().map(|c| at * size + c).collect::<Vec<_>>();
            positions = positions.iter().flat_map(step).collect();
            dims.extend(keeps.then_some(chosen.len()));
        }
        let chosen = positions.into_iter().map(|at| strings.strings[at].clone()).collect();
        Ok(string_value(StringArray { dims, strings: chosen }))
    }

    /// Evaluates the parameters that positions depend on.
    fn evaluate_choices(&mut self, choices: &mut [Choice<T::Scalar>], dims: &[usize]) {
        for (choice, size) in choices.iter_mut().zip(dims) {
            let Choice::Computed(position) = choice else { continue };
            match self.target.structural_value(*position) {
                Some(known) if known >= 1.0 && known <= *size as f64 => {
                    *choice = Choice::Known { positions: vec![known as usize - 1], keeps: false };
                }
                _ => {}
            }
        }
    }

    /// The numbers of Strings, if all are known and the Strings of the model have numbers.
    fn string_numbers(&mut self, strings: &StringArray) -> Option<Array<T::Scalar>> {
        if strings.strings.iter().any(|text| text.contains(UNKNOWN_TEXT)) {
            return None;
        }
        let elements = strings.strings.iter().map(|text| self.target.string_number(text));
        Some(Array { dims: strings.dims.clone(), elements: elements.collect::<Option<_>>()? })
    }

    /// What a reference stands for, if that is known.
    fn known_reference(&mut self, reference: &ComponentReference) -> Option<Value> {
        let variable = reference.as_ident().and_then(|name| self.loop_variable(name));
        let expected = match variable {
            Some(variable) => variable.value_type.clone(),
            None => {
                let path = self.path(reference).ok()?;
                self.target.value_type(&path)?
            }
        };
        let e = Expression::new(ExpressionKind::Reference(reference.clone()), reference.span);
        let value = self.lower(&e).ok()?;
        let evaluates =
            self.target.evaluates_string_parameters().is_some_and(|evaluates| *evaluates);
        self.known_value(&value, &expected, evaluates)
    }

    /// The value of an argument; of arrays of Strings too little is known.
    fn known_argument(
        &mut self,
        argument: &Lowered<T::Scalar>,
        input: &eval::FunctionComponent,
        evaluates: bool,
    ) -> Option<Value> {
        match argument {
            Lowered::Text(_) if !input.dims.is_empty() => None,
            Lowered::Record(fields) if !input.dims.is_empty() => {
                self.known_records(fields, &input.value_type, evaluates)
            }
            _ => self.known_value(argument, &input.value_type, evaluates),
        }
    }

    fn known_value(
        &mut self,
        argument: &Lowered<T::Scalar>,
        expected: &ValueType,
        evaluates: bool,
    ) -> Option<Value> {
        match argument {
            Lowered::Text(text) => {
                (!text.contains(UNKNOWN_TEXT)).then(|| Value::String(text.clone()))
            }
            Lowered::Strings(strings) => {
                let is_known = strings.strings.iter().all(|text| !text.contains(UNKNOWN_TEXT));
                let elements = Elements::String(strings.strings.to_vec());
                is_known.then(|| Value::Array(ArrayValue::new(strings.dims.clone(), elements)))
            }
            Lowered::Record(fields) => self.known_record(fields, expected, evaluates),
            Lowered::Numbered(_) => None,
            Lowered::Array(array) if matches!(expected, ValueType::ExternalObject(_)) => {
                self.known_object(array)
            }
            Lowered::Array(array) => {
                let mut numbers = Vec::with_capacity(array.elements.len());
                for element in &array.elements {
                    let known = self.target.as_constant(*element);
                    let known = match evaluates {
                        true => known.or_else(|| self.target.structural_value(*element)),
                        false => known,
                    };
                    numbers.push(known?);
                }
                value_of(&numbers, &array.dims, expected)
            }
        }
    }

    /// An external object, made now by the constructor that the variable is bound to.
    fn known_object(&mut self, array: &Array<T::Scalar>) -> Option<Value> {
        let ([object], true) = (array.elements.as_slice(), array.dims.is_empty()) else {
            return None;
        };
        let binding = self.target.constructor_of(*object)?;
        let ExpressionKind::Call { function, arguments } = &binding.kind else { return None };
        let constructor = self.target.function(&function.name())?;
        let given = self.inputs(&constructor, arguments, binding.span).ok()?;
        let mut values = Vec::with_capacity(given.len());
        for (input, argument) in constructor.inputs.iter().zip(&given) {
            values.push(self.known_argument(argument, input, true)?);
        }
        let mut host = Compiling::new(&*self.target);
        let made = eval::call_function(&constructor, values.into(), binding.span, &mut host);
        made.ok()?.into_iter().next()
    }

    fn known_record(
        &mut self,
        fields: &[(Ident, Lowered<T::Scalar>)],
        expected: &ValueType,
        evaluates: bool,
    ) -> Option<Value> {
        let ValueType::Record(type_name, types) = expected else { return None };
        let mut known = IndexMap::with_capacity(fields.len());
        for (name, value) in fields {
            let field = self.known_value(value, &types.get(name)?.value_type, evaluates)?;
            known.insert(*name, field);
        }
        Some(Value::Record(RecordValue { type_name: type_name.clone(), fields: known }))
    }

    /// An array of records of scalars, whose fields are arrays here.
    fn known_records(
        &mut self,
        fields: &[(Ident, Lowered<T::Scalar>)],
        expected: &ValueType,
        evaluates: bool,
    ) -> Option<Value> {
        let Value::Record(of_arrays) = self.known_record(fields, expected, evaluates)? else {
            return None;
        };
        let Value::Array(first) = of_arrays.fields.values().next()? else { return None };
        let dims = first.dims.clone();
        let record = |at: usize| {
            let field = |(name, value): (&Ident, &Value)| match value {
                Value::Array(array) if array.dims == dims => Some((*name, array.elements.get(at))),
                _ => None,
            };
            let fields = of_arrays.fields.iter().map(field).collect::<Option<_>>()?;
            Some(RecordValue { type_name: of_arrays.type_name.clone(), fields })
        };
        let records = (0..dims.iter().product()).map(record).collect::<Option<Vec<_>>>()?;
        Some(Value::Array(ArrayValue::new(dims, Elements::Record(records))))
    }

    /// A value of the interpreter; `None` for arrays of records and external objects.
    fn lowered_value(&mut self, value: &Value) -> Option<Lowered<T::Scalar>> {
        if let Value::String(text) = value {
            return Some(Lowered::Text(text.clone()));
        }
        if let Value::Record(record) = value {
            let field = |(name, value): (&Ident, &Value)| Some((*name, self.lowered_value(value)?));
            return record.fields.iter().map(field).collect::<Option<_>>().map(Lowered::Record);
        }
        if let Value::Array(ArrayValue { dims, elements: Elements::String(strings), .. }) = value {
            let strings = strings.as_slice().into();
            return Some(Lowered::Strings(StringArray { dims: dims.clone(), strings }));
        }
        let mut numbers = Vec::new();
        append_numbers(value, &mut numbers)?;
        let dims = value.dims().to_vec();
        let elements = numbers.into_iter().map(|number| self.target.constant(number)).collect();
        Some(Lowered::Array(Array { dims, elements }))
    }
}

fn unknown_subscript(span: Span) -> Diagnostic {
    fault!(NO_CONSTANT_VALUE, "a subscript of an array of Strings must be known at translation")
        .at(span)
}

/// Answers the interpreter while a model is compiled.
struct Compiling<'a, T> {
    target: &'a T,
    resources: Resources,
    outside: AtTranslation,
    warnings: Vec<Diagnostic>,
    /// How many statements the interpreter had run before.
    before: u64,
    compiler: Option<OnDemand>,
}

impl<'a, T: Target> Compiling<'a, T> {
    fn new(target: &'a T) -> Compiling<'a, T> {
        let resources = target.flat().resources.clone();
        let outside = AtTranslation::new(resources.clone());
        let before = target.interpreted().get();
        Compiling { target, outside, resources, warnings: Vec::new(), before, compiler: None }
    }
}

impl<T: Target> Host for Compiling<'_, T> {
    fn callee(&mut self, name: &Name) -> Result<Option<Callee>, Diagnostic> {
        Ok(self.target.function(name).map(Callee::Function))
    }

    fn variable(&mut self, reference: &ComponentReference) -> Result<Option<Value>, Diagnostic> {
        let _ = reference;
        Ok(None)
    }

    /// What is printed at every event is not printed at translation.
    fn outside(&mut self) -> Option<&mut dyn Outside> {
        match self.target.runs_once() {
            true => Some(&mut self.outside),
            false => Some(&mut self.resources),
        }
    }

    fn c_companions(&mut self, _: &Function) -> Vec<Arc<Function>> {
        self.target.flat().functions.values().cloned().collect()
    }

    fn takes_default(&mut self, warning: Diagnostic) -> bool {
        if self.target.flat().strict {
            return false;
        }
        if !self.warnings.iter().any(|known| known.message == warning.message) {
            self.warnings.push(warning);
        }
        true
    }

    fn interrupted(&mut self) -> Option<Fault> {
        exhausted(self.target.interpreted())
    }

    fn overflows(&self) -> bool {
        true
    }

    fn compiler(&mut self) -> Option<&mut dyn RunCompiled> {
        let statements = self.target.interpreted().get() - self.before;
        let library = || library_of(self.target.flat(), true);
        OnDemand::of_long_call(&mut self.compiler, statements, library)
    }
}

/// Answers the interpreter with what is known of variables while a model is compiled.
struct Reading<'r, 'a, T: Target> {
    lowering: &'r mut Lowering<'a, T>,
}

impl<T: Target> Host for Reading<'_, '_, T> {
    fn callee(&mut self, name: &Name) -> Result<Option<Callee>, Diagnostic> {
        Ok(self.lowering.target.function(name).map(Callee::Function))
    }

    fn variable(&mut self, reference: &ComponentReference) -> Result<Option<Value>, Diagnostic> {
        Ok(self.lowering.known_reference(reference))
    }

    fn interrupted(&mut self) -> Option<Fault> {
        exhausted(self.lowering.target.interpreted())
    }
}

/// Counts a statement or an iteration of a loop, and says when there were too many.
fn exhausted(steps: &Cell<u64>) -> Option<Fault> {
    steps.set(steps.get() + 1);
    let limit = budget::step_limit() / 2;
    (steps.get() > limit).then(|| {
        fault!(NOT_SUPPORTED, "the functions evaluated at translation take more than {} steps",
            budget::in_millions(limit); help: "{}", budget::REMEDY)
    })
}
