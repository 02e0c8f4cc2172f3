//! Values of declared types: which value a declared variable takes, and what it holds before one
//! is assigned.

use super::ValueType;
use super::variable::{Declared, shadow_of};
use crate::bail;
use crate::diag::Fault;
use crate::value::errors::{SIZE_MISMATCH, TYPE_MISMATCH};
use crate::value::{
    ArrayValue, Elements, EnumerationDefinition, EnumerationValue, RecordValue, Value,
    element_count,
};

impl Declared {
    /// The value as the declared type holds it: Integers become Reals; another type or other sizes
    /// are a fault.
    pub(super) fn convert(&self, value: Value) -> Result<Value, Fault> {
        self.check_sizes(&value)?;
        self.value_type.convert(value)
    }

    fn check_sizes(&self, value: &Value) -> Result<(), Fault> {
        if matches!(self.value_type, ValueType::Any) && self.dims.is_empty() {
            return Ok(());
        }
        let dims = value.dims();
        if dims == [0] && self.dims.len() > 1 && self.dims.iter().any(|d| d.is_none_or(|n| n == 0))
        {
            return Ok(());
        }
        let fits = dims.len() == self.dims.len()
            && dims
                .iter()
                .zip(&self.dims)
                .all(|(size, declared)| declared.is_none_or(|d| d == *size));
        if fits {
            return Ok(());
        }
        bail!(SIZE_MISMATCH, "expected {}, got {}", self.description(), value.type_name())
    }

    fn description(&self) -> String {
        if self.dims.is_empty() {
            return format!("a single {}", self.value_type.name());
        }
        let size = |dim: &Option<usize>| dim.map_or(":".to_owned(), |size| size.to_string());
        let sizes: Vec<String> = self.dims.iter().map(size).collect();
        format!("{}[{}]", self.value_type.name(), sizes.join(", "))
    }

    /// Room for a value, and the same shape with `false` where nothing has been assigned. A size
    /// that is not declared is 0 until an assignment sets it (MLS §12.4.5). Records are made where
    /// the bindings of their components can be evaluated.
    pub(super) fn storage(&self) -> Result<(Value, Value), Fault> {
        let scalar = match &self.value_type {
            ValueType::Real => Value::Real(0.0),
            ValueType::Integer => Value::Integer(0),
            ValueType::Boolean => Value::Boolean(false),
            ValueType::String => Value::string(""),
            ValueType::Enumeration(definition) => {
                Value::Enumeration(EnumerationValue { definition: definition.clone(), ordinal: 1 })
            }
            _ => Value::Boolean(false),
        };
        self.repeated(scalar.clone(), shadow_of(&scalar, false))
    }

    /// The scalar and its shadow, repeated to the declared sizes.
    pub(super) fn repeated(&self, scalar: Value, shadow: Value) -> Result<(Value, Value), Fault> {
        if self.dims.is_empty() {
            return Ok((scalar, shadow));
        }
        let dims: Vec<usize> = self.dims.iter().map(|dim| dim.unwrap_or(0)).collect();
        element_count(&dims)?;
        let value = ArrayValue::filled(dims.clone(), &scalar)?;
        Ok((Value::Array(value), Value::Array(ArrayValue::filled(dims, &shadow)?)))
    }
}

impl ValueType {
    /// Its name in Modelica.
    pub fn name(&self) -> String {
        match self {
            ValueType::Real => "Real".into(),
            ValueType::Integer => "Integer".into(),
            ValueType::Boolean => "Boolean".into(),
            ValueType::String => "String".into(),
            ValueType::Enumeration(definition) => definition.name.to_string(),
            ValueType::Record(name, _) => name.to_string(),
            ValueType::ExternalObject(name) => name.to_string(),
            ValueType::Function => "function".into(),
            ValueType::TypeName => "TypeName".into(),
            ValueType::VariableName => "VariableName".into(),
            ValueType::Expression => "expression".into(),
            ValueType::Any => "value".into(),
        }
    }

    /// The scalar or array with elements of this type; sizes are not looked at.
    pub(super) fn convert(&self, value: Value) -> Result<Value, Fault> {
        match (self, value) {
            (ValueType::Any, value)
            | (ValueType::Real, value @ Value::Real(_))
            | (ValueType::Integer, value @ Value::Integer(_))
            | (ValueType::Boolean, value @ Value::Boolean(_))
            | (ValueType::String, value @ Value::String(_))
            | (ValueType::Function, value @ Value::Function(_))
            | (ValueType::TypeName, value @ Value::TypeName(_))
            | (ValueType::VariableName | ValueType::Expression, value @ Value::VariableName(_)) => {
                Ok(value)
            }
            (ValueType::ExternalObject(class), Value::External(object))
                if *class == object.class =>
            {
                Ok(Value::External(object))
            }
            (ValueType::Real, Value::Integer(value)) => Ok(Value::Real(value as f64)),
            (ValueType::Enumeration(definition), Value::Enumeration(value))
                if *definition == value.definition =>
            {
                Ok(Value::Enumeration(value))
            }
            // In the functions of loaded classes literals are ordinals.
            (ValueType::Enumeration(definition), Value::Integer(ordinal))
                if is_literal(ordinal, definition) =>
            {
                let definition = definition.clone();
                Ok(Value::Enumeration(EnumerationValue { definition, ordinal }))
            }
            (ValueType::Record(..), Value::Record(record)) => {
                self.convert_record(record).map(Value::Record)
            }
            (_, Value::Array(ArrayValue { dims, elements, marks })) => {
                let elements = self.convert_elements(elements)?;
                Ok(Value::Array(ArrayValue { dims, elements, marks }))
            }
            (_, value) => Err(self.refuse(&value.type_name(), matches!(value, Value::Real(_)))),
        }
    }

    fn convert_elements(&self, elements: Elements) -> Result<Elements, Fault> {
        Ok(match (self, elements) {
            (ValueType::Any, elements)
            | (ValueType::Real, elements @ Elements::Real(_))
            | (ValueType::Integer, elements @ Elements::Integer(_))
            | (ValueType::Boolean, elements @ Elements::Boolean(_))
            | (ValueType::String, elements @ Elements::String(_))
            | (ValueType::TypeName | ValueType::VariableName, elements @ Elements::String(_)) => {
                elements
            }
            (ValueType::Real, elements @ Elements::Integer(_)) => elements.promoted(),
            (_, elements) if elements.is_empty() => self.no_elements(),
            (ValueType::Enumeration(definition), Elements::Enumeration(values))
                if values.iter().all(|value| value.definition == *definition) =>
            {
                Elements::Enumeration(values)
            }
            // In the functions of loaded classes literals are ordinals.
            (ValueType::Enumeration(definition), Elements::Integer(ordinals))
                if ordinals.iter().all(|ordinal| is_literal(*ordinal, definition)) =>
            {
                let literal =
                    |ordinal| EnumerationValue { definition: definition.clone(), ordinal };
                Elements::Enumeration(ordinals.into_iter().map(literal).collect())
            }
            (ValueType::Record(..), Elements::Record(records)) => Elements::Record(
                records.into_iter().map(|r| self.convert_record(r)).collect::<Result<_, _>>()?,
            ),
            (_, elements) => {
                let is_real = matches!(elements, Elements::Real(_));
                return Err(self.refuse(&elements.type_name(), is_real));
            }
        })
    }

    fn no_elements(&self) -> Elements {
        match self {
            ValueType::Integer => Elements::Integer(Vec::new()),
            ValueType::Boolean => Elements::Boolean(Vec::new()),
            ValueType::String => Elements::String(Vec::new()),
            ValueType::Enumeration(_) => Elements::Enumeration(Vec::new()),
            ValueType::Record(..) => Elements::Record(Vec::new()),
            _ => Elements::Real(Vec::new()),
        }
    }

    /// A record of the declared type: one with the same components, which are converted.
    fn convert_record(&self, mut record: RecordValue) -> Result<RecordValue, Fault> {
        let ValueType::Record(name, components) = self else {
            return Err(self.refuse(&record.type_name.to_string(), false));
        };
        let same_components = record.fields.len() == components.len()
            && components.keys().all(|component| record.fields.contains_key(component));
        if !same_components {
            return Err(self.refuse(&record.type_name.to_string(), false));
        }
        for (component, declared) in components.iter() {
            if let Some(field) = record.fields.get_mut(component) {
                let value = std::mem::replace(field, Value::Boolean(false));
                *field = declared.value_type.convert(value)?;
            }
        }
        record.type_name = name.clone();
        Ok(record)
    }

    fn refuse(&self, got: &str, got_real: bool) -> Fault {
        let message = format!("expected a value of type {}, got {got}", self.name());
        let rounding = "use `integer(x)` for the largest Integer not above `x`";
        let to_string = "use `String(x)` to convert a number to a string";
        let help = match self {
            ValueType::Integer if got_real => Some(rounding.to_owned()),
            ValueType::String if ["Integer", "Real"].contains(&got) => Some(to_string.to_owned()),
            _ => None,
        };
        Fault::new(TYPE_MISMATCH, message).help_if(help)
    }
}

fn is_literal(ordinal: i64, definition: &EnumerationDefinition) -> bool {
    (1..=definition.literals.len() as i64).contains(&ordinal)
}
