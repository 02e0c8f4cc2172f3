//! Declarations of variables in scripts.

use crate::Session;
use crate::diag::Diagnostic;
use crate::errors::BAD_ARGUMENT;
use crate::eval::{self, Given, ValueType};
use crate::fault;
use crate::name::Name;
use crate::source::Span;
use crate::syntax::ast::{
    Argument, Binding, ComponentClause, ComponentDeclaration, Modification, Subscript,
    TypeSpecifier, VariabilityPrefix,
};

impl Session {
    /// Declares the variables of a clause, as a function declares its own: records have the values
    /// that their classes and the modifiers give them (MLS §12.4.4).
    pub fn declare(&mut self, clause: &ComponentClause) -> Result<(), Diagnostic> {
        let (value_type, own_dims) = self.type_of_clause(&clause.type_specifier)?;
        for component in &clause.components {
            let dims = [component.subscripts.as_slice(), &clause.subscripts, &own_dims].concat();
            self.declare_one(component, value_type.clone(), &dims)?;
            if clause.type_prefixes.variability == Some(VariabilityPrefix::Constant) {
                self.workspace.variables.freeze(component.name.node);
            }
            self.models.note_own(component.name.node);
            self.follow_ups.found(component.name.node);
        }
        Ok(())
    }

    fn declare_one(
        &mut self,
        component: &ComponentDeclaration,
        value_type: ValueType,
        dims: &[Subscript],
    ) -> Result<(), Diagnostic> {
        let dims =
            self.with_scope(|scope, session| eval::evaluate_dimensions(dims, scope, session))?;
        let is_record = matches!(value_type, ValueType::Record(..));
        let given = match &component.modification {
            Some(modification) => self.given(modification, is_record)?,
            None => None,
        };
        let (name, span) = (component.name.node, component.span);
        self.with_scope(|scope, session| {
            eval::declare(name, (value_type, dims), given, span, scope, session)
        })
    }

    /// The value that a modification gives, or those of the components of a record. What it says
    /// about attributes, such as a unit, concerns no value.
    fn given(
        &mut self,
        modification: &Modification,
        is_record: bool,
    ) -> Result<Option<Given>, Diagnostic> {
        if let Some(Binding::Expression(value)) = &modification.binding {
            return Ok(Some(Given::Value(self.evaluate(value)?)));
        }
        if !is_record || modification.arguments.is_empty() {
            return Ok(None);
        }
        let mut components = Vec::with_capacity(modification.arguments.len());
        for argument in &modification.arguments {
            let Argument::Element(element) = argument else {
                let message = "a script variable accepts values, not redeclarations";
                return Err(fault!(BAD_ARGUMENT, "{message}").at(modification.span));
            };
            let inner = element.modification.as_ref();
            let given = inner.map(|inner| self.given(inner, true)).transpose()?.flatten();
            let Some((first, rest)) = element.name.node.parts.split_first() else { continue };
            let wrap = |given, name: &_| Given::Components(vec![(*name, given)]);
            if let Some(given) = given {
                components.push((*first, rest.iter().rev().fold(given, wrap)));
            }
        }
        Ok(Some(Given::Components(components)))
    }

    fn type_of_clause(
        &mut self,
        specifier: &TypeSpecifier,
    ) -> Result<(ValueType, Vec<Subscript>), Diagnostic> {
        match predefined(&specifier.name) {
            Some(predefined) => Ok((predefined, Vec::new())),
            None => self.type_with_dims(&specifier.name, specifier.span),
        }
    }

    fn type_with_dims(
        &mut self,
        name: &Name,
        span: Span,
    ) -> Result<(ValueType, Vec<Subscript>), Diagnostic> {
        let found = self.declared_type(name, span)?;
        Ok((found.value_type, found.dims))
    }
}

fn predefined(name: &Name) -> Option<ValueType> {
    match name.last().filter(|_| name.is_simple())?.as_str() {
        "Real" => Some(ValueType::Real),
        "Integer" => Some(ValueType::Integer),
        "Boolean" => Some(ValueType::Boolean),
        "String" => Some(ValueType::String),
        _ => None,
    }
}
