//! A variable: its value, its declared type, and which of its scalars have no value yet.

use super::ValueType;
use super::errors::{NO_VALUE_YET, NOT_ASSIGNABLE};
use crate::diag::Fault;
use crate::fault;
use crate::name::Ident;
use crate::value::{ArrayValue, Elements, RecordValue, Step, Value};

/// A value, and the same shape with `true` where it has one.
pub(super) struct Storage {
    pub(super) value: Value,
    pub(super) shadow: Value,
}

/// A variable.
#[derive(Debug, Clone)]
pub(super) struct Variable {
    pub(super) value: Value,
    /// Which scalars have no value yet: the shape of `value` with `true` where one was assigned.
    /// `None` once all have.
    pub(super) unassigned: Option<Box<Unassigned>>,
    /// Its declared type; `None` for a variable made by an assignment in a script.
    pub(super) declared: Option<Declared>,
    /// Inputs of functions and constants.
    pub(super) read_only: bool,
}

#[derive(Debug, Clone)]
pub(super) struct Unassigned {
    shadow: Value,
    left: usize,
}

/// A type with evaluated sizes; `None` where any size is accepted.
#[derive(Debug, Clone)]
pub(super) struct Declared {
    pub(super) value_type: ValueType,
    pub(super) dims: Vec<Option<usize>>,
}

impl Variable {
    pub(super) fn undeclared(value: Value) -> Variable {
        Variable { value, unassigned: None, declared: None, read_only: false }
    }

    pub(super) fn without_value(declared: Declared) -> Result<Variable, Fault> {
        let (value, shadow) = declared.storage()?;
        Ok(Variable::partly_assigned(value, shadow, declared))
    }

    /// `shadow` has the shape of `value` and is true where a scalar has been assigned.
    pub(super) fn partly_assigned(value: Value, shadow: Value, declared: Declared) -> Variable {
        let left = count_false(&shadow);
        let unassigned = (left > 0).then(|| Box::new(Unassigned { shadow, left }));
        Variable { value, unassigned, declared: Some(declared), read_only: false }
    }

    /// What of its value has been assigned: `None` if all has.
    pub(super) fn shadow(&self) -> Option<&Value> {
        self.unassigned.as_ref().map(|unassigned| &unassigned.shadow)
    }

    pub(super) fn set(&mut self, name: Ident, value: Value) -> Result<(), Fault> {
        if self.read_only {
            return Err(read_only(name));
        }
        self.value = match (&self.declared, value) {
            (Some(declared), value) => {
                declared.convert(value).map_err(|fault| named(name, fault))?
            }
            (None, value) => value,
        };
        self.unassigned = None;
        Ok(())
    }

    /// Overwrites a part.
    pub(super) fn set_part(
        &mut self,
        name: Ident,
        path: &[Step],
        value: Value,
    ) -> Result<(), Fault> {
        if self.read_only {
            return Err(read_only(name));
        }
        if self.declared.is_none() {
            self.widen_for(path, &value);
        }
        self.value.set_part(path, value)?;
        if let Some(unassigned) = &mut self.unassigned {
            let before = unassigned.shadow.part(path)?;
            unassigned.left -= count_false(&before);
            unassigned.shadow.set_part(path, all_true(before))?;
            if unassigned.left == 0 {
                self.unassigned = None;
            }
        }
        Ok(())
    }

    /// In a script `v := {1, 2}; v[1] := 0.5` makes `v` an array of Reals: it has no declaration.
    fn widen_for(&mut self, path: &[Step], new: &Value) {
        let is_real = match new {
            Value::Real(_) => true,
            Value::Array(array) => matches!(array.elements, Elements::Real(_)),
            _ => false,
        };
        if let ([Step::Index(_)], true, Value::Array(array)) = (path, is_real, &mut self.value)
            && let Elements::Integer(_) = array.elements
        {
            let elements = std::mem::replace(&mut array.elements, Elements::Real(Vec::new()));
            array.elements = elements.promoted();
        }
    }

    /// The value of the part named by the path, which the caller has taken out of this variable.
    ///
    /// A record that was assigned in part is a value: its Real scalars that were not are NaN.
    ///
    /// # Errors
    /// The part, or one of its scalars that cannot be NaN, has no value yet; with the default of its
    /// type.
    pub(super) fn assigned(
        &self,
        name: Ident,
        path: &[Step],
        mut part: Value,
    ) -> Result<Value, Box<(Fault, Value)>> {
        let Some(unassigned) = &self.unassigned else { return Ok(part) };
        let shadow = match unassigned.shadow.part(path) {
            Ok(shadow) => shadow,
            Err(fault) => return Err(Box::new((fault, part))),
        };
        let left = count_false(&shadow);
        if left == 0 {
            return Ok(part);
        }
        let is_partly_assigned = matches!(part, Value::Record(_)) && left < count(&shadow);
        let defaults = part.clone();
        if is_partly_assigned && fill_with_nan(&mut part, &shadow) {
            return Ok(part);
        }
        Err(Box::new((no_value(name), defaults)))
    }
}

/// Makes the Real scalars without a value NaN; whether these were all that had none.
fn fill_with_nan(value: &mut Value, shadow: &Value) -> bool {
    match (value, shadow) {
        (Value::Real(value), Value::Boolean(false)) => {
            *value = f64::NAN;
            true
        }
        (Value::Record(record), Value::Record(shadow)) => {
            let mut fields = record.fields.values_mut().zip(shadow.fields.values());
            fields.all(|(field, shadow)| fill_with_nan(field, shadow))
        }
        (Value::Array(array), Value::Array(shadow)) => {
            match (&mut array.elements, &shadow.elements) {
                (Elements::Real(values), Elements::Boolean(assigned)) => {
                    let without = values.iter_mut().zip(assigned).filter(|(_, known)| !**known);
                    without.for_each(|(value, _)| *value = f64::NAN);
                    true
                }
                _ => count_false(&Value::Array(shadow.clone())) == 0,
            }
        }
        (_, shadow) => count_false(shadow) == 0,
    }
}

fn no_value(name: Ident) -> Fault {
    fault!(NO_VALUE_YET, "`{name}` is used before it has a value")
}

fn read_only(name: Ident) -> Fault {
    fault!(NOT_ASSIGNABLE, "`{name}` is an input or a constant and cannot be assigned")
}

pub(super) fn named(name: Ident, mut fault: Fault) -> Fault {
    fault.message = format!("`{name}`: {}", fault.message);
    fault
}

fn count_false(shadow: &Value) -> usize {
    let in_record = |record: &RecordValue| record.fields.values().map(count_false).sum::<usize>();
    match shadow {
        Value::Boolean(assigned) => usize::from(!assigned),
        Value::Record(record) => in_record(record),
        Value::Array(array) => match &array.elements {
            Elements::Boolean(assigned) => assigned.iter().filter(|assigned| !**assigned).count(),
            Elements::Record(records) => records.iter().map(in_record).sum(),
            _ => 0,
        },
        _ => 0,
    }
}

/// The number of scalars.
fn count(shadow: &Value) -> usize {
    let in_record = |record: &RecordValue| record.fields.values().map(count).sum::<usize>();
    match shadow {
        Value::Record(record) => in_record(record),
        Value::Array(array) => match &array.elements {
            Elements::Record(records) => records.iter().map(in_record).sum(),
            elements => elements.len(),
        },
        _ => 1,
    }
}

/// The same shape, true everywhere.
fn all_true(shadow: Value) -> Value {
    let in_record = |mut record: RecordValue| {
        for field in record.fields.values_mut() {
            *field = all_true(std::mem::replace(field, Value::Boolean(true)));
        }
        record
    };
    match shadow {
        Value::Record(record) => Value::Record(in_record(record)),
        Value::Array(ArrayValue { dims, elements, .. }) => {
            let elements = match elements {
                Elements::Record(records) => {
                    Elements::Record(records.into_iter().map(in_record).collect())
                }
                other => Elements::Boolean(vec![true; other.len()]),
            };
            Value::Array(ArrayValue::new(dims, elements))
        }
        _ => Value::Boolean(true),
    }
}

/// The same shape, `assigned` everywhere.
pub(super) fn shadow_of(value: &Value, assigned: bool) -> Value {
    let in_record = |record: &RecordValue| RecordValue {
        type_name: record.type_name.clone(),
        fields: record.fields.iter().map(|(name, v)| (*name, shadow_of(v, assigned))).collect(),
    };
    match value {
        Value::Record(record) => Value::Record(in_record(record)),
        Value::Array(array) => {
            let elements = match &array.elements {
                Elements::Record(records) => {
                    Elements::Record(records.iter().map(in_record).collect())
                }
                other => Elements::Boolean(vec![assigned; other.len()]),
            };
            Value::Array(ArrayValue::new(array.dims.clone(), elements))
        }
        _ => Value::Boolean(assigned),
    }
}
