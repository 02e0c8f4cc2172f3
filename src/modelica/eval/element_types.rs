//! The types of the elements of expressions that are not evaluated, because there are no elements.

use super::{Callee, Evaluator, ValueType};
use crate::inference::TypesOfNames;
use crate::syntax::ast::{Arguments, ComponentReference};
use crate::value::{Elements, Value};

impl TypesOfNames for Evaluator<'_> {
    type Type = ValueType;

    fn of_reference(&mut self, reference: &ComponentReference) -> Option<ValueType> {
        let declared = match reference.as_ident().or_else(|| Some(reference.parts.first()?.name)) {
            Some(name) if !reference.global => self.scope.declared_type(name),
            _ => None,
        };
        if let Some(declared) = declared {
            let parts = reference.parts.iter().skip(1);
            return parts
                .into_iter()
                .try_fold(declared, |record, part| record.component(part.name));
        }
        let mut whole = reference.clone();
        whole.parts.iter_mut().for_each(|part| part.subscripts = Vec::new());
        type_of_value(&self.reference(&whole).ok()?)
    }

    fn of_function(
        &mut self,
        function: &ComponentReference,
        _: &Arguments,
    ) -> Option<Option<ValueType>> {
        match self.host.callee(&function.name()).ok()?? {
            Callee::Function(declared) | Callee::Builtin(declared) => {
                Some(declared.outputs.first().map(|output| output.value_type.clone()))
            }
        }
    }
}

/// The type of the elements of a value; `None` for types that have no extremes.
fn type_of_value(value: &Value) -> Option<ValueType> {
    match value {
        Value::Real(_) => Some(ValueType::Real),
        Value::Integer(_) => Some(ValueType::Integer),
        Value::Boolean(_) => Some(ValueType::Boolean),
        Value::Enumeration(value) => Some(ValueType::Enumeration(value.definition.clone())),
        Value::Array(array) => match &array.elements {
            Elements::Real(_) => Some(ValueType::Real),
            Elements::Integer(_) => Some(ValueType::Integer),
            Elements::Boolean(_) => Some(ValueType::Boolean),
            Elements::Enumeration(values) => {
                Some(ValueType::Enumeration(values.first()?.definition.clone()))
            }
            _ => None,
        },
        _ => None,
    }
}
