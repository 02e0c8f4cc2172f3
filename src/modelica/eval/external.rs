//! Calling external functions: arguments become numbers in a row, results become values again
//! (MLS §12.9).

use super::errors::{EXTERNAL_FUNCTION, WRONG_ARGUMENTS};
use super::{Evaluator, Function, FunctionComponent, ValueType, c_function};
use crate::diag::{At, Diagnostic, Fault};
use crate::external::{Call, Entry, MAX_INTEGER, Object, Slot, SlotKind};
use crate::fault;
use crate::name::Ident;
use crate::syntax::ast;
use crate::value::{ArrayValue, Elements, EnumerationValue, ExternalObject, Value, element_count};
use std::sync::Arc;

impl Evaluator<'_> {
    /// Runs an external function; its inputs are declared.
    pub(super) fn external(
        &mut self,
        function: &Arc<Function>,
        clause: &ast::External,
    ) -> Result<(), Diagnostic> {
        for component in function.outputs.iter().chain(&function.locals) {
            self.prepare(component.name)?;
        }
        let entry = match c_function::in_rust(function, clause) {
            Some(entry) => entry,
            None if c_function::brings_code(clause) => self.in_c(function, clause)?,
            None => {
                let name = c_function::external_name(function, clause);
                return self.external_intrinsic(function, clause, name.as_str());
            }
        };
        self.external_call(function, &c_function::call_of(function, clause), entry)
    }

    /// A function in C that a library brings along.
    fn in_c(
        &mut self,
        function: &Arc<Function>,
        clause: &ast::External,
    ) -> Result<&'static Entry, Diagnostic> {
        let others = self.host.c_companions(function);
        match self.host.outside() {
            Some(outside) => c_function::in_c(function, clause, others.iter(), outside),
            None => c_function::in_c(function, clause, others.iter(), &mut ()),
        }
    }

    fn external_call(
        &mut self,
        function: &Arc<Function>,
        clause: &ast::External,
        entry: &'static Entry,
    ) -> Result<(), Diagnostic> {
        let mut memory = Memory::default();
        let mut slots = Vec::with_capacity(clause.arguments.len());
        for argument in &clause.arguments {
            let slot = match self.writable(function, argument) {
                Some(component) => {
                    let value = self.stored(component.name);
                    let slot = memory.add(value).at(argument.span)?;
                    memory.written.push((component.clone(), slot.clone()));
                    slot
                }
                None => memory.add(self.expression(argument)?).at(argument.span)?,
            };
            slots.push(slot);
        }
        let output = clause.output.as_ref().and_then(|output| output.as_ident());
        let output = function.outputs.iter().find(|component| Some(component.name) == output);
        let result = match output {
            Some(component) => {
                let slot = memory.result(component, self.stored(component.name));
                let slot = slot.at(clause.span)?;
                memory.written.push((component.clone(), slot.clone()));
                Some(slot)
            }
            None => None,
        };
        entry.check(&slots, result.as_ref()).at(clause.span)?;
        let mut strings = Vec::new();
        let mut call = Call {
            name: entry.name,
            arguments: &slots,
            result: result.as_ref(),
            numbers: &mut memory.numbers,
            strings: &memory.strings,
            written: &mut strings,
            objects: &mut memory.objects,
            outside: &mut (),
        };
        if let Some(outside) = self.host.outside() {
            call.outside = outside;
            entry.call(&mut call).at(clause.span)?;
        } else {
            entry.call(&mut call).at(clause.span)?;
        }
        for (position, text) in strings {
            memory.strings[position as usize] = text;
        }
        for (component, slot) in std::mem::take(&mut memory.written) {
            let value = memory.value(&component, &slot).at(clause.span)?;
            self.scope.set(component.name, value).at(clause.span)?;
        }
        Ok(())
    }

    /// The output or local variable that an argument is.
    fn writable<'f>(
        &self,
        function: &'f Function,
        argument: &ast::Expression,
    ) -> Option<&'f FunctionComponent> {
        let ast::ExpressionKind::Reference(reference) = &argument.kind else { return None };
        let name = reference.as_ident()?;
        function.outputs.iter().chain(&function.locals).find(|component| component.name == name)
    }

    /// What a variable holds, assigned or not.
    fn stored(&self, name: Ident) -> Value {
        let variable = self.scope.variables.get(&name);
        variable.map_or(Value::Boolean(false), |variable| variable.value.clone())
    }

    /// A mathematical function of the language that a library declares again.
    fn external_intrinsic(
        &mut self,
        function: &Arc<Function>,
        clause: &ast::External,
        name: &str,
    ) -> Result<(), Diagnostic> {
        let Some(entry) = crate::functions::find(name) else {
            return Err(fault!(
                EXTERNAL_FUNCTION,
                "`{}` calls the external function `{name}`, which this program does not implement",
                function.name;
                help: "write its algorithm in Modelica"
            )
            .at(clause.span));
        };
        let values = match clause.arguments.is_empty() {
            true => function.inputs.iter().map(|input| self.stored(input.name)).collect(),
            false => self.expressions(&clause.arguments)?,
        };
        let value = entry.value(&values).at(clause.span)?;
        match function.outputs.as_slice() {
            [output] => self.scope.set(output.name, value).at(clause.span),
            _ => Err(fault!(WRONG_ARGUMENTS, "`{name}` has one output").at(clause.span)),
        }
    }
}

/// The arguments of a call.
#[derive(Default)]
struct Memory {
    numbers: Vec<f64>,
    strings: Vec<Arc<str>>,
    objects: Vec<Object>,
    /// Components that the call may write to.
    written: Vec<(FunctionComponent, Slot)>,
}

impl Memory {
    fn add(&mut self, value: Value) -> Result<Slot, Fault> {
        let first = self.numbers.len() as u32;
        let scalar = |kind, first| Slot { kind, first, dims: Box::new([]) };
        Ok(match value {
            Value::String(text) => {
                self.strings.push(text);
                scalar(SlotKind::Text, self.strings.len() as u32 - 1)
            }
            Value::External(object) => {
                self.objects.push(object.object);
                self.numbers.push((self.objects.len() - 1) as f64);
                scalar(SlotKind::Object, first)
            }
            Value::Array(array) => {
                let dims = array.dims.iter().map(|size| *size as u32).collect();
                match array.elements {
                    Elements::Real(values) => self.numbers.extend(values),
                    Elements::Integer(values) => {
                        for value in values {
                            self.numbers.push(number(value)?);
                        }
                    }
                    Elements::Boolean(values) => {
                        self.numbers.extend(values.into_iter().map(|v| f64::from(u8::from(v))));
                    }
                    Elements::Enumeration(values) => {
                        self.numbers.extend(values.iter().map(|value| value.ordinal as f64));
                    }
                    Elements::String(values) => {
                        let first = self.strings.len() as u32;
                        self.strings.extend(values);
                        return Ok(Slot { kind: SlotKind::Text, first, dims });
                    }
                    Elements::Record(_) => return Err(refused("an array of records")),
                }
                Slot { kind: SlotKind::Number, first, dims }
            }
            other => {
                self.numbers.push(match other {
                    Value::Real(value) => value,
                    Value::Integer(value) => number(value)?,
                    Value::Boolean(value) => f64::from(u8::from(value)),
                    Value::Enumeration(value) => value.ordinal as f64,
                    other => return Err(refused(&other.type_name())),
                });
                scalar(SlotKind::Number, first)
            }
        })
    }

    /// Room for the result of a call.
    fn result(&mut self, output: &FunctionComponent, stored: Value) -> Result<Slot, Fault> {
        match &output.value_type {
            ValueType::ExternalObject(_) => {
                self.numbers.push(-1.0);
                let first = self.numbers.len() as u32 - 1;
                Ok(Slot { kind: SlotKind::Object, first, dims: Box::new([]) })
            }
            _ => self.add(stored),
        }
    }

    /// The content of a slot, as the component's type has it.
    fn value(&self, component: &FunctionComponent, slot: &Slot) -> Result<Value, Fault> {
        let first = slot.first as usize;
        if slot.kind == SlotKind::Text && !slot.dims.is_empty() {
            return Err(refused("an array of Strings to be written"));
        }
        if slot.kind == SlotKind::Text {
            return Ok(Value::String(self.strings[first].clone()));
        }
        let numbers = &self.numbers[first..first + slot.len()];
        let whole = || numbers.iter().map(|value| *value as i64);
        let elements = match &component.value_type {
            ValueType::ExternalObject(class) => {
                let object = self.objects.get(numbers[0] as usize);
                let object = object.ok_or_else(|| refused("no object"))?.clone();
                return Ok(Value::External(ExternalObject { class: class.clone(), object }));
            }
            ValueType::Real => Elements::Real(numbers.to_vec()),
            ValueType::Integer => Elements::Integer(whole().collect()),
            ValueType::Boolean => Elements::Boolean(numbers.iter().map(|v| *v != 0.0).collect()),
            ValueType::Enumeration(definition) => {
                let literals = 1..=definition.literals.len() as i64;
                if let Some(wrong) = whole().find(|ordinal| !literals.contains(ordinal)) {
                    return Err(fault!(
                        EXTERNAL_FUNCTION,
                        "`{}` has no literal number {wrong}",
                        definition.name
                    ));
                }
                let literal =
                    |ordinal| EnumerationValue { definition: definition.clone(), ordinal };
                Elements::Enumeration(whole().map(literal).collect())
            }
            other => return Err(refused(&other.name())),
        };
        let dims: Vec<usize> = slot.dims.iter().map(|size| *size as usize).collect();
        element_count(&dims)?;
        let scalar = match (&elements, dims.is_empty()) {
            (Elements::Real(v), true) => Value::Real(v[0]),
            (Elements::Integer(v), true) => Value::Integer(v[0]),
            (Elements::Boolean(v), true) => Value::Boolean(v[0]),
            (Elements::Enumeration(v), true) => Value::Enumeration(v[0].clone()),
            _ => return Ok(Value::Array(ArrayValue::new(dims, elements))),
        };
        Ok(scalar)
    }
}

fn number(value: i64) -> Result<f64, Fault> {
    match (-MAX_INTEGER..=MAX_INTEGER).contains(&value) {
        true => Ok(value as f64),
        false => Err(fault!(
            EXTERNAL_FUNCTION,
            "the Integer {value} is too large for an external function"
        )),
    }
}

fn refused(what: &str) -> Fault {
    fault!(EXTERNAL_FUNCTION, "external functions do not accept {what}")
}
