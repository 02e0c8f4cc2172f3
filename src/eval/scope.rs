//! The variables of a script or of a function being executed.

use super::errors::{NO_VALUE_YET, NOT_ASSIGNABLE, UNKNOWN_VARIABLE};
use super::{Function, FunctionComponent, ValueType};
use crate::diag::{Fault, suggest};
use crate::name::Ident;
use crate::source::Span;
use crate::value::{ArrayValue, Elements, RecordValue, Step, Value};
use crate::{bail, fault};
use indexmap::IndexMap;
use rustc_hash::{FxBuildHasher, FxHashMap};
use std::sync::Arc;

/// Variables by name, the running loops' variables, and what a function needs while it runs.
pub struct Scope {
    pub(super) variables: IndexMap<Ident, Variable, FxBuildHasher>,
    /// Variables of the loops and iterators being run, innermost last.
    pub(super) iterators: Vec<(Ident, Value)>,
    /// Sizes of the dimensions whose subscripts are being evaluated, innermost last.
    pub(super) ends: Vec<usize>,
    /// Whose variables these are.
    pub(super) owner: Owner,
    /// The caller's values for the function's inputs, taken out as they are declared.
    pub(super) given: Vec<Option<Value>>,
    /// Where the function is called.
    pub(super) call_span: Span,
    /// Components of the function whose bindings are being evaluated.
    pub(super) in_progress: Vec<Ident>,
    /// Functions already looked up, by the address of the reference: in a function only, whose
    /// tree does not move while it runs.
    pub(super) callees: FxHashMap<usize, super::call::Target>,
    /// How many loops of this scope are running.
    pub(super) loops: usize,
}

/// Whose variables a scope holds.
#[derive(Clone, Default)]
pub(super) enum Owner {
    /// A script's: assignments make variables.
    #[default]
    Script,
    /// A function's.
    Function(Arc<Function>),
    /// A record's components, while their bindings are evaluated.
    Record(Arc<IndexMap<Ident, FunctionComponent>>),
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

impl Default for Scope {
    fn default() -> Scope {
        Scope {
            variables: IndexMap::default(),
            iterators: Vec::new(),
            ends: Vec::new(),
            owner: Owner::Script,
            given: Vec::new(),
            call_span: Span::NONE,
            in_progress: Vec::new(),
            callees: FxHashMap::default(),
            loops: 0,
        }
    }
}

impl Scope {
    /// The scope of a script: assigning to an unknown simple name makes a variable.
    pub fn script() -> Scope {
        Scope::default()
    }

    pub(super) fn of_function(
        function: Arc<Function>,
        given: Vec<Option<Value>>,
        call_span: Span,
    ) -> Scope {
        Scope { owner: Owner::Function(function), given, call_span, ..Scope::default() }
    }

    pub(super) fn of_record(
        components: Arc<IndexMap<Ident, FunctionComponent>>,
        call_span: Span,
    ) -> Scope {
        Scope { owner: Owner::Record(components), call_span, ..Scope::default() }
    }

    /// Whether it is the scope of a script, not of a function.
    pub fn is_script(&self) -> bool {
        matches!(self.owner, Owner::Script)
    }

    /// The value of a variable; `None` if there is no such variable or it has no value yet.
    pub fn get(&self, name: Ident) -> Option<&Value> {
        let found = self.iterators.iter().rev().find(|(iterator, _)| *iterator == name);
        match found {
            Some((_, value)) => Some(value),
            None => {
                let variable = self.variables.get(&name)?;
                variable.unassigned.is_none().then_some(&variable.value)
            }
        }
    }

    /// Whether a variable of this name exists, with or without a value.
    pub fn contains(&self, name: Ident) -> bool {
        self.variables.contains_key(&name)
    }

    /// Gives a variable a value. A declared variable keeps its type: an Integer becomes Real, any
    /// other difference is a fault. In a script an unknown variable is made.
    pub fn set(&mut self, name: Ident, value: Value) -> Result<(), Fault> {
        if self.iterators.iter().any(|(iterator, _)| *iterator == name) {
            bail!(NOT_ASSIGNABLE, "the loop variable `{name}` cannot be assigned");
        }
        let is_script = self.is_script();
        match self.variables.get_mut(&name) {
            Some(variable) => variable.set(name, value),
            None if is_script => {
                self.variables.insert(name, Variable::undeclared(value));
                Ok(())
            }
            None => Err(self.unknown(name)),
        }
    }

    /// Declares a variable of a script, anew if it exists. Sizes are `None` where any is accepted;
    /// without a value, reading it before an assignment is a fault.
    pub fn declare(
        &mut self,
        name: Ident,
        value_type: ValueType,
        dims: Vec<Option<usize>>,
        value: Option<Value>,
    ) -> Result<(), Fault> {
        let declared = Declared { value_type, dims };
        let variable = match value {
            Some(value) => Variable {
                value: declared.convert(value).map_err(|fault| named(name, fault))?,
                unassigned: None,
                declared: Some(declared),
                read_only: false,
            },
            None => Variable::without_value(declared)?,
        };
        self.variables.insert(name, variable);
        Ok(())
    }

    /// Makes a variable that cannot be assigned, such as a constant of a script.
    pub fn freeze(&mut self, name: Ident) {
        if let Some(variable) = self.variables.get_mut(&name) {
            variable.read_only = true;
        }
    }

    /// Removes a variable and returns its value, if it had one.
    pub fn remove(&mut self, name: Ident) -> Option<Value> {
        let variable = self.variables.shift_remove(&name)?;
        variable.unassigned.is_none().then_some(variable.value)
    }

    /// Removes all variables.
    pub fn clear(&mut self) {
        self.variables.clear();
    }

    /// The variables that have a value, in the order they were made.
    pub fn iter(&self) -> impl Iterator<Item = (Ident, &Value)> {
        let complete = |(_, variable): &(&Ident, &Variable)| variable.unassigned.is_none();
        self.variables.iter().filter(complete).map(|(name, variable)| (*name, &variable.value))
    }

    /// The declared type of a variable and its sizes; `None` if it has none.
    pub fn declaration(&self, name: Ident) -> Option<(&ValueType, &[Option<usize>])> {
        let declared = self.variables.get(&name)?.declared.as_ref()?;
        Some((&declared.value_type, &declared.dims))
    }

    pub(super) fn unknown(&self, name: Ident) -> Fault {
        let known = self.variables.keys().chain(self.iterators.iter().map(|(name, _)| name));
        fault!(UNKNOWN_VARIABLE, "there is no variable `{name}` here")
            .help_if(suggest::did_you_mean(name.as_str(), known.map(|known| known.as_str())))
    }
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

    /// In a script `v := {1, 2}; v[1] := 0.5` makes `v` an array of Reals: nobody declared it.
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

    /// A fault if the part named by the path has no value yet.
    pub(super) fn check_assigned(&self, name: Ident, path: &[Step]) -> Result<(), Fault> {
        match &self.unassigned {
            Some(unassigned) if count_false(&unassigned.shadow.part(path)?) > 0 => {
                Err(no_value(name))
            }
            _ => Ok(()),
        }
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
        Value::Array(ArrayValue { dims, elements }) => {
            let elements = match elements {
                Elements::Record(records) => {
                    Elements::Record(records.into_iter().map(in_record).collect())
                }
                other => Elements::Boolean(vec![true; other.len()]),
            };
            Value::Array(ArrayValue { dims, elements })
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
            Value::Array(ArrayValue { dims: array.dims.clone(), elements })
        }
        _ => Value::Boolean(assigned),
    }
}
