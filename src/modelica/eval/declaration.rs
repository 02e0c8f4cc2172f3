//! Declarations of variables in scripts, where a record's components may be given one by one.

use super::errors::UNKNOWN_VARIABLE;
use super::variable::{Declared, Storage, Variable};
use super::{Evaluator, FunctionComponent, Host, Scope, ValueType, depth};
use crate::diag::{At, Diagnostic, suggest};
use crate::fault;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{ExpressionKind, NamedArgument};
use crate::value::errors::TYPE_MISMATCH;
use crate::value::{Step, Value};

/// What a declaration gives a variable.
#[derive(Debug, Clone, PartialEq)]
pub enum Given {
    /// A value.
    Value(Value),
    /// Values of some components of a record; the others have those of their class.
    Components(Vec<(Ident, Given)>),
}

/// Declares a variable of a script, again if it exists, with its value. A record has the
/// values that its class declares; other types without a value wait for an assignment.
///
/// # Errors
/// What is given does not fit the type, or names a component that the record does not have.
pub fn declare(
    name: Ident,
    declared: (ValueType, Vec<Option<usize>>),
    given: Option<Given>,
    span: Span,
    scope: &mut Scope,
    host: &mut dyn Host,
) -> Result<(), Diagnostic> {
    let _entry = depth::Entry::new();
    let (value_type, dims) = declared;
    let components = match given {
        Some(Given::Value(value)) => {
            return scope.declare(name, value_type, dims, Some(value)).at(span);
        }
        Some(Given::Components(components)) => components,
        None => Vec::new(),
    };
    let ValueType::Record(record, fields) = &value_type else {
        return scope.declare(name, value_type, dims, None).at(span);
    };
    if !components.is_empty() && !dims.is_empty() {
        let fault = fault!(TYPE_MISMATCH, "the components of an array of records cannot be set \
            here";
            help: "assign them after the declaration: `{name}[1].x := 2`");
        return Err(fault.at(span));
    }
    let call_span = std::mem::replace(&mut scope.call_span, span);
    let storage =
        Evaluator { scope: &mut *scope, host }.record_with(record, fields, components, span);
    scope.call_span = call_span;
    let Storage { value, shadow } = storage?;
    let declared = Declared { value_type, dims };
    let (value, shadow) = declared.repeated(value, shadow).at(span)?;
    scope.variables.insert(name, Variable::partly_assigned(value, shadow, declared));
    Ok(())
}

impl Evaluator<'_> {
    /// Declares the components of a record that are given, before those that may refer to them.
    pub(super) fn give(
        &mut self,
        given: Vec<(Ident, Given)>,
        span: Span,
    ) -> Result<(), Diagnostic> {
        let super::scope::Owner::Record(fields) = self.scope.owner.clone() else { return Ok(()) };
        self.scope.given.resize(fields.len(), None);
        let mut nested = Vec::new();
        for (name, given) in given {
            let Some(at) = fields.get_index_of(&name) else {
                let known = fields.keys().map(|field| field.as_str());
                let fault = fault!(UNKNOWN_VARIABLE, "the record has no component `{name}`")
                    .help_if(suggest::did_you_mean(name.as_str(), known));
                return Err(fault.at(span));
            };
            match given {
                Given::Value(value) => self.scope.given[at] = Some(value),
                Given::Components(components) => nested.push((name, components)),
            }
        }
        for (name, components) in nested {
            match self.fields_given(&fields[&name])? {
                Some(own) => self.declare_part(&fields[&name], own, components, span)?,
                None => {
                    self.prepare(name)?;
                    self.give_within(name, &[], components, span)?;
                }
            }
        }
        Ok(())
    }

    /// The components that the declaration of a record gives it itself, so that what depends on
    /// others follows them; `None` where it is not declared by its components.
    pub(super) fn fields_given(
        &mut self,
        component: &FunctionComponent,
    ) -> Result<Option<Vec<(Ident, Given)>>, Diagnostic> {
        let ValueType::Record(record, _) = &component.value_type else { return Ok(None) };
        if !component.dims.is_empty() {
            return Ok(None);
        }
        let Some(binding) = &component.binding else { return Ok(Some(Vec::new())) };
        match &binding.kind {
            ExpressionKind::Call { function, arguments }
                if function.name().parts == record.parts && arguments.positional.is_empty() =>
            {
                let value = |argument: &NamedArgument| {
                    Ok((argument.name.node, Given::Value(self.expression(&argument.value)?)))
                };
                arguments.named.iter().map(value).collect::<Result<_, _>>().map(Some)
            }
            _ => Ok(None),
        }
    }

    /// Declares a record within a record: what the outer declaration gives comes first.
    fn declare_part(
        &mut self,
        component: &FunctionComponent,
        mut own: Vec<(Ident, Given)>,
        given: Vec<(Ident, Given)>,
        span: Span,
    ) -> Result<(), Diagnostic> {
        let ValueType::Record(record, fields) = &component.value_type else { return Ok(()) };
        own.retain(|(name, _)| given.iter().all(|(other, _)| other != name));
        own.extend(given);
        let Storage { value, shadow } = self.record_with(record, fields, own, span)?;
        let declared = Declared { value_type: component.value_type.clone(), dims: Vec::new() };
        let variable = Variable::partly_assigned(value, shadow, declared);
        self.scope.variables.insert(component.name, variable);
        Ok(())
    }

    /// Overwrites components of a record that is a component itself.
    fn give_within(
        &mut self,
        root: Ident,
        path: &[Step],
        given: Vec<(Ident, Given)>,
        span: Span,
    ) -> Result<(), Diagnostic> {
        for (name, given) in given {
            let path = [path, &[Step::Field(name)]].concat();
            match given {
                Given::Components(inner) => self.give_within(root, &path, inner, span)?,
                Given::Value(value) => {
                    let Some(variable) = self.scope.variables.get_mut(&root) else { continue };
                    variable.set_part(root, &path, value).at(span)?;
                }
            }
        }
        Ok(())
    }
}
