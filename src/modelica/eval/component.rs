//! Components of functions and records: their sizes, bindings and storage (MLS §12.4.4).

use super::errors::MISPLACED;
use super::scope::Owner;
use super::variable::{Declared, Storage, Variable, named, shadow_of};
use super::{Evaluator, Function, FunctionComponent, Given, Scope, ValueType};
use crate::diag::{At, Diagnostic};
use crate::fault;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{Expression, ExpressionKind, Subscript};
use crate::value::errors::{DOMAIN_ERROR, TYPE_MISMATCH};
use crate::value::{RecordValue, Value};
use indexmap::IndexMap;
use std::sync::Arc;

impl Evaluator<'_> {
    /// Declares the component of this name if the function or record has one that is not declared
    /// yet: bindings and sizes may refer to components in any order, as long as they do not need
    /// each other.
    pub(super) fn prepare(&mut self, name: Ident) -> Result<(), Diagnostic> {
        if self.scope.variables.contains_key(&name) {
            return Ok(());
        }
        match self.scope.owner.clone() {
            Owner::Script => Ok(()),
            Owner::Function(function) => {
                if let Some(at) = function.inputs.iter().position(|input| input.name == name) {
                    let given = self.scope.given.get_mut(at).and_then(Option::take);
                    return self.declare(&function.inputs[at], given, true);
                }
                let mut others = function.outputs.iter().chain(&function.locals);
                match others.find(|component| component.name == name) {
                    Some(component) => self.declare(component, None, false),
                    None => Ok(()),
                }
            }
            Owner::Record(components) => match components.get_full(&name) {
                Some((at, _, component)) => {
                    let given = self.scope.given.get_mut(at).and_then(Option::take);
                    self.declare(component, given, false)
                }
                None => Ok(()),
            },
        }
    }

    /// Declares all inputs of a function.
    pub(super) fn prepare_inputs(&mut self, function: &Function) -> Result<(), Diagnostic> {
        for (at, input) in function.inputs.iter().enumerate() {
            if !self.scope.variables.contains_key(&input.name) {
                let given = self.scope.given.get_mut(at).and_then(Option::take);
                self.declare(input, given, true)?;
            }
        }
        Ok(())
    }

    /// Declares all outputs and local variables of a function.
    pub(super) fn prepare_variables(&mut self, function: &Function) -> Result<(), Diagnostic> {
        for component in function.outputs.iter().chain(&function.locals) {
            if !self.scope.variables.contains_key(&component.name) {
                self.declare(component, None, false)?;
            }
        }
        Ok(())
    }

    /// Declares a component with the value given by the caller, that of its binding, or none yet.
    fn declare(
        &mut self,
        component: &FunctionComponent,
        given: Option<Value>,
        is_input: bool,
    ) -> Result<(), Diagnostic> {
        if self.scope.in_progress.contains(&component.name) {
            let fault =
                fault!(MISPLACED, "the declaration of `{}` depends on itself", component.name);
            return Err(fault.at(component.span));
        }
        self.scope.in_progress.push(component.name);
        let variable = self.new_variable(component, given, is_input);
        self.scope.in_progress.pop();
        self.scope.variables.insert(component.name, variable?);
        Ok(())
    }

    fn new_variable(
        &mut self,
        component: &FunctionComponent,
        given: Option<Value>,
        is_input: bool,
    ) -> Result<Variable, Diagnostic> {
        let (dims, given) = self.dimensions_with(component, given)?;
        let value_type = self.sized_type(component)?;
        let declared = Declared { value_type, dims };
        if given.is_none()
            && !is_input
            && is_given_in_part(component)
            && let Some(own) = self.fields_given(component)?
        {
            return self.partly_given(declared, own);
        }
        // Numbers for a String after the first argument are for another function, such as one that
        // has formats, and so are arrays.
        let is_for_another = match &given {
            Some(Value::Array(_)) => true,
            given => given.is_some() && !self.scope.variables.is_empty(),
        } && declared.value_type == ValueType::String;
        let (value, span) = match (given, &component.binding) {
            (Some(value), _) => (Some(value), self.scope.call_span),
            (None, Some(binding)) => (Some(self.argument(component, binding)?), binding.span),
            (None, None) => (None, component.span),
        };
        match value {
            Some(value) => {
                let value = declared.convert(value).map_err(|mut fault| {
                    if is_for_another {
                        fault.helps.clear();
                    }
                    named(component.name, fault).at(span)
                })?;
                Ok(Variable {
                    value,
                    unassigned: None,
                    declared: Some(declared),
                    read_only: is_input,
                })
            }
            None => self.unassigned(declared).map_err(|d| d.related(component.span, "")),
        }
    }

    /// The type of a component, the sizes of a record's components with it.
    fn sized_type(&mut self, component: &FunctionComponent) -> Result<ValueType, Diagnostic> {
        Ok(match &component.value_type {
            ValueType::Record(name, fields) => {
                let fields = component.sized_fields(fields, |size| self.dimension(size))?;
                ValueType::Record(name.clone(), fields)
            }
            other => other.clone(),
        })
    }

    /// The sizes of a component and its value: a size may be another one of the value given, as in
    /// `input Real A[:, size(A, 1)]`.
    fn dimensions_with(
        &mut self,
        component: &FunctionComponent,
        given: Option<Value>,
    ) -> Result<(Vec<Option<usize>>, Option<Value>), Diagnostic> {
        let are_open = component.dims.iter().all(|dim| matches!(dim, Subscript::All(_)));
        let value = match given {
            Some(value) if !are_open => value,
            given => return Ok((self.dimensions(&component.dims)?, given)),
        };
        self.scope.variables.insert(component.name, Variable::undeclared(value));
        let dims = self.dimensions(&component.dims);
        let given = self.scope.variables.swap_remove(&component.name);
        Ok((dims?, given.map(|variable| variable.value)))
    }

    fn unassigned(&mut self, declared: Declared) -> Result<Variable, Diagnostic> {
        let span = self.scope.call_span;
        if let ValueType::Record(name, components) = &declared.value_type {
            let Storage { value, shadow } = self.record_with(name, components, Vec::new(), span)?;
            let (value, shadow) = declared.repeated(value, shadow).at(span)?;
            return Ok(Variable::partly_assigned(value, shadow, declared));
        }
        Variable::without_value(declared).at(span)
    }

    /// A record of which modifiers give some components.
    fn partly_given(
        &mut self,
        declared: Declared,
        own: Vec<(Ident, Given)>,
    ) -> Result<Variable, Diagnostic> {
        let ValueType::Record(name, components) = &declared.value_type else {
            return self.unassigned(declared);
        };
        let span = self.scope.call_span;
        let Storage { value, shadow } = self.record_with(name, components, own, span)?;
        Ok(Variable::partly_assigned(value, shadow, declared))
    }

    /// A record whose components have the values given or else those of their bindings.
    pub(super) fn record_with(
        &mut self,
        name: &Name,
        components: &Arc<IndexMap<Ident, FunctionComponent>>,
        given: Vec<(Ident, Given)>,
        span: Span,
    ) -> Result<Storage, Diagnostic> {
        let mut scope = Scope::of_record(components.clone(), self.scope.call_span);
        let mut inner = Evaluator { scope: &mut scope, host: self.host };
        inner.give(given, span)?;
        let mut values = IndexMap::new();
        let mut shadows = IndexMap::new();
        for component in components.keys() {
            inner.prepare(*component)?;
            if let Some(variable) = inner.scope.variables.get(component) {
                let shadow = match variable.shadow() {
                    Some(shadow) => shadow.clone(),
                    None => shadow_of(&variable.value, true),
                };
                values.insert(*component, variable.value.clone());
                shadows.insert(*component, shadow);
            }
        }
        Ok(Storage {
            value: Value::Record(RecordValue { type_name: name.clone(), fields: values }),
            shadow: Value::Record(RecordValue { type_name: name.clone(), fields: shadows }),
        })
    }

    /// The sizes that declared dimensions stand for; `None` for `:`.
    pub(super) fn dimensions(
        &mut self,
        dims: &[Subscript],
    ) -> Result<Vec<Option<usize>>, Diagnostic> {
        dims.iter()
            .map(|subscript| match subscript {
                Subscript::All(_) => Ok(None),
                Subscript::Index(expression) => self.dimension(expression).map(Some),
            })
            .collect()
    }

    fn dimension(&mut self, expression: &Expression) -> Result<usize, Diagnostic> {
        if let ExpressionKind::Reference(reference) = &expression.kind
            && reference.as_ident().is_some_and(|name| name == "Boolean")
        {
            return Ok(2);
        }
        match self.expression(expression)? {
            Value::Integer(size) => usize::try_from(size).map_err(|_| {
                fault!(DOMAIN_ERROR, "the size {size} of a dimension is negative")
                    .at(expression.span)
            }),
            // The name of an enumeration stands for all its literals.
            Value::Array(literals) if literals.rank() == 1 => Ok(literals.elements.len()),
            other => Err(fault!(
                TYPE_MISMATCH,
                "the size of a dimension must be an Integer, not a {}",
                other.type_name()
            )
            .at(expression.span)),
        }
    }
}

/// Whether the modifiers of a record leave a component without a value: `R r(n = 2)`.
fn is_given_in_part(component: &FunctionComponent) -> bool {
    let (ValueType::Record(_, fields), Some(binding)) = (&component.value_type, &component.binding)
    else {
        return false;
    };
    let ExpressionKind::Call { arguments, .. } = &binding.kind else { return false };
    let gives = |name: Ident| arguments.named.iter().any(|argument| argument.name.node == name);
    arguments.positional.is_empty()
        && fields.values().any(|field| field.binding.is_none() && !gives(field.name))
}
