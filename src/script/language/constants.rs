//! Constants and types of loaded packages, as scripts name them.

use crate::Session;
use crate::diag::{Diagnostic, Fault};
use crate::eval::{self, Function, FunctionComponent, ValueType};
use crate::name::{Ident, Name};
use crate::source::{SourceId, Span};
use crate::syntax;
use crate::syntax::ast::ComponentReference;
use crate::value::{EnumerationDefinition, EnumerationValue, Step, Value, construct};
use std::sync::Arc;

/// The name of the function through which the library is asked: it knows the scopes of packages.
const ASKING: &str = "'a question'";

impl Session {
    /// What a dotted name or the name of an import stands for, if that is a constant of a package,
    /// a field of one, a literal of an enumeration, or an enumeration: all its values.
    pub fn constant(&mut self, reference: &ComponentReference) -> Result<Option<Value>, Fault> {
        if reference.parts.iter().any(|part| !part.subscripts.is_empty()) {
            return Ok(None);
        }
        for candidate in self.workspace.candidates(&reference.name()) {
            if let Some(value) = crate::builtins::constant(&candidate) {
                return Ok(Some(value));
            }
            if let Some(value) = self.constant_in_package(&candidate)? {
                return Ok(Some(value));
            }
            if let Some(definition) = self.enumeration(&candidate) {
                return all_values(&definition).map(Some);
            }
        }
        Ok(None)
    }

    /// A constant that is in a class, or a field of one: `Package.constant.field`.
    fn constant_in_package(&mut self, name: &Name) -> Result<Option<Value>, Fault> {
        // A class in one that does not exist is not looked for: names may be very long.
        let owner_at = |at: usize| Name::new(name.parts[..at].iter().copied());
        let mut at = 0;
        while at + 1 < name.parts.len() && self.class_exists(&owner_at(at + 1)) {
            at += 1;
        }
        if at > 0 {
            let owner = owner_at(at);
            let constant = owner.child(name.parts[at]);
            let found = match self.enumeration(&owner) {
                Some(definition) => literal(&definition, name.parts[at]),
                None => self.package_constant(&constant),
            };
            let fields: Vec<Step> = name.parts[at + 1..].iter().copied().map(Step::Field).collect();
            return found.map(|value| value.part(&fields)).transpose();
        }
        // A package may inherit what it does not declare.
        match name.parts.len() > 1 && self.class_exists(&name.parts[0].into()) {
            true => Ok(self.package_constant(name)),
            false => Ok(None),
        }
    }

    /// The type that a name stands for where a script declares a variable: its element type, and
    /// the dimensions of an array type.
    ///
    /// # Errors
    /// There is no such class, or it is no type with values.
    pub(crate) fn declared_type(
        &mut self,
        name: &Name,
        span: Span,
    ) -> Result<FunctionComponent, Diagnostic> {
        let mut wrong = None;
        for candidate in self.workspace.candidates(name) {
            if !self.class_exists(&candidate.parts[0].into()) {
                continue;
            }
            match self.asked_type(&candidate) {
                Ok(found) => return Ok(found),
                Err(error) => _ = wrong.get_or_insert(error),
            }
        }
        let unknown = || self.classes.class_to_load(name);
        Err(wrong.map_or_else(unknown, first_fault).at(span))
    }

    fn asked_type(&mut self, name: &Name) -> Result<FunctionComponent, Diagnostic> {
        if let Some(Some(known)) = self.classes.constants.types.get(name) {
            return Ok(known.clone());
        }
        let shown = Name::new(name.parts.iter().copied());
        let function = self.asked(&format!("output .{shown} y;"))?;
        let component = function.and_then(|function| function.outputs.first().cloned());
        component
            .ok_or_else(|| self.classes.class_to_load(name).at(Span::NONE))
            .inspect(|found| self.keep_type(name, Some(found.clone())))
    }

    fn keep_type(&mut self, name: &Name, found: Option<FunctionComponent>) {
        self.classes.constants.types.insert(name.clone(), found);
    }

    /// The enumeration of this name, which may be another one's under a new name.
    fn enumeration(&mut self, name: &Name) -> Option<Arc<EnumerationDefinition>> {
        if !self.class_exists(name) {
            return None;
        }
        if !self.classes.constants.types.contains_key(name) {
            let is_type = self.is_type(name);
            let found = is_type.then(|| self.asked_type(name).ok()).flatten();
            self.keep_type(name, found);
        }
        match &self.classes.constants.types.get(name)?.as_ref()?.value_type {
            ValueType::Enumeration(definition) => Some(definition.clone()),
            _ => None,
        }
    }

    fn is_type(&mut self, name: &Name) -> bool {
        let class = self.library().definition(name);
        class.is_some_and(|class| class.restriction == syntax::ast::Restriction::Type)
    }

    fn package_constant(&mut self, name: &Name) -> Option<Value> {
        if let Some(known) = self.classes.constants.constants.get(name) {
            return known.clone();
        }
        let value = self.asked_constant(name);
        self.classes.constants.constants.insert(name.clone(), value.clone());
        value
    }

    /// The value of the function whose output is the constant, of whatever type it is.
    fn asked_constant(&mut self, name: &Name) -> Option<Value> {
        let shown = Name::new(name.parts.iter().copied());
        let asked =
            self.asked(&format!("output Real y; algorithm y := .{shown};")).ok().flatten()?;
        let mut function = Function::clone(&asked);
        function.outputs.first_mut()?.value_type = ValueType::Any;
        let values = eval::call_function(&function.into(), Vec::new().into(), Span::NONE, self);
        values.ok()?.pop()
    }

    /// A function with this content, seen from the top level.
    fn asked(&mut self, content: &str) -> Result<Option<Arc<Function>>, Diagnostic> {
        let text = format!("function {ASKING} {content} end {ASKING};");
        let asking = syntax::parse_stored_definition(SourceId::NONE, &text)?;
        self.classes.library.load(&asking)?;
        let function = self.function_named(&Name::parse(ASKING));
        self.classes.library.remove(Ident::new(ASKING));
        function
    }
}

fn literal(definition: &Arc<EnumerationDefinition>, name: Ident) -> Option<Value> {
    let at = definition.literals.iter().position(|literal| *literal == name)?;
    Some(value_at(definition, at))
}

fn value_at(definition: &Arc<EnumerationDefinition>, at: usize) -> Value {
    let definition = definition.clone();
    Value::Enumeration(EnumerationValue { definition, ordinal: at as i64 + 1 })
}

fn all_values(definition: &Arc<EnumerationDefinition>) -> Result<Value, Fault> {
    let values = (0..definition.literals.len()).map(|at| value_at(definition, at));
    construct::array(values.collect())
}

/// The message of a diagnostic, for places where only that of the caller is known.
fn first_fault(diagnostic: Diagnostic) -> Fault {
    let mut fault = Fault::new(diagnostic.code, diagnostic.message.clone());
    fault.helps.clone_from(&diagnostic.helps);
    fault
}
