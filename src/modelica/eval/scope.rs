//! The variables of a script or of a function being executed.

use super::errors::{NOT_ASSIGNABLE, UNKNOWN_VARIABLE};
use super::variable::{Declared, Variable, named};
use super::{Function, FunctionComponent, ValueType};
use crate::diag::{Fault, suggest};
use crate::name::Ident;
use crate::source::Span;
use crate::value::Value;
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
    pub(super) callees: FxHashMap<usize, super::function::Target>,
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
        let count = function.inputs.len() + function.outputs.len() + function.locals.len();
        let variables = IndexMap::with_capacity_and_hasher(count, FxBuildHasher);
        Scope { variables, owner: Owner::Function(function), given, call_span, ..Scope::default() }
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

    /// The function whose scope it is.
    pub(super) fn function_name(&self) -> Option<String> {
        match &self.owner {
            Owner::Function(function) => Some(function.name.to_string()),
            Owner::Script | Owner::Record(_) => None,
        }
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

    /// The type that a variable is declared with; `None` for iterators and what an assignment made.
    pub(super) fn declared_type(&self, name: Ident) -> Option<ValueType> {
        if self.iterators.iter().any(|(iterator, _)| *iterator == name) {
            return None;
        }
        Some(self.variables.get(&name)?.declared.as_ref()?.value_type.clone())
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

    /// Declares a variable of a script, again if it exists. Sizes are `None` where any is accepted;
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

    /// Takes the value of a variable away; one that was declared keeps its type.
    pub fn forget(&mut self, name: Ident) {
        let Some(variable) = self.variables.get_mut(&name) else { return };
        if variable.read_only {
            return;
        }
        match variable.declared.clone().map(Variable::without_value) {
            Some(Ok(without)) => *variable = without,
            Some(Err(_)) | None => drop(self.variables.shift_remove(&name)),
        }
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
