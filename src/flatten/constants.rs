//! Values known at translation: constants of packages, and parameters that shape the model
//! (MLS §3.8, §4.5).

use super::errors::{NOT_CONSTANT, TOO_LARGE, TYPE_MISMATCH};
use super::instance::{Context, NodeId, NodeKind};
use super::instantiation::{Instantiation, picked};
use super::library::ClassId;
use super::lookup::Type;
use super::resolve::Local;
use super::{BaseType, Variability};
use crate::diag::{Diagnostic, Fault};
use crate::eval::{Callee, Function, Host, Scope, evaluate};
use crate::fault;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{ClassSpecifier, ComponentReference, Expression, ExpressionKind};
use crate::value::{ArrayValue, Value};
use indexmap::IndexSet;
use std::sync::Arc;

/// Enumerations of the language (MLS §4.9, §8.3.7) and their literals.
const PREDEFINED_ENUMERATIONS: &[(&str, &[&str])] = &[
    ("StateSelect", &["never", "avoid", "default", "prefer", "always"]),
    ("AssertionLevel", &["warning", "error"]),
];

impl Instantiation<'_> {
    /// The value of an expression that shapes the model; the parameters that it needs are marked.
    pub(super) fn structural_value(
        &mut self,
        e: &Expression,
        context: Context,
    ) -> Result<Value, Diagnostic> {
        let outer = std::mem::take(&mut self.read);
        let value = self.known_value(e, context);
        let read = std::mem::replace(&mut self.read, outer);
        self.structural.extend(read);
        value
    }

    /// The value of an expression whose names are resolved already.
    pub(super) fn flat_value(&mut self, e: &Expression) -> Result<Value, Diagnostic> {
        self.structural_value(e, Context { node: NodeId(1), class: None })
    }

    /// The value of an expression of constants and parameters.
    pub(super) fn known_value(
        &mut self,
        e: &Expression,
        context: Context,
    ) -> Result<Value, Diagnostic> {
        let local = Local { values: true, ..Local::default() };
        let resolved = self.resolve(e, context, &local)?;
        evaluate(&resolved, &mut Scope::script(), &mut Functions(self))
    }

    /// The value of a constant or parameter, by its place.
    pub(super) fn value(&mut self, variable: usize, span: Span) -> Result<Value, Diagnostic> {
        match self.values.get(&variable) {
            Some(Some((value, read))) => {
                self.read.extend(read.iter().copied());
                return Ok(value.clone());
            }
            Some(None) => {
                let name = &self.variables[variable].0.name;
                return Err(
                    fault!(NOT_CONSTANT, "the value of `{name}` depends on itself").at(span)
                );
            }
            None => {}
        }
        self.values.insert(variable, None);
        let outer = std::mem::take(&mut self.read);
        let found = self.found_value(variable, span);
        let mut read = std::mem::replace(&mut self.read, outer);
        read.insert(variable);
        self.read.extend(read.iter().copied());
        match found {
            Ok(value) => {
                self.values.insert(variable, Some((value.clone(), read)));
                Ok(value)
            }
            Err(error) => {
                self.values.remove(&variable);
                Err(error)
            }
        }
    }

    fn found_value(&mut self, variable: usize, span: Span) -> Result<Value, Diagnostic> {
        let (declared, node) = &self.variables[variable];
        let (name, base) = (declared.name.clone(), declared.base.clone());
        let dims = declared.dims.clone();
        if declared.variability > Variability::Parameter {
            return Err(fault!(NOT_CONSTANT, "`{name}` is not known at translation";
                help: "only constants and parameters are")
            .at(span));
        }
        let NodeKind::Variable(leaf) = &self.nodes[node.0].kind else {
            return Err(fault!(NOT_CONSTANT, "`{name}` has no value").at(span));
        };
        let bound = leaf.modifier.binding.clone();
        let Some((Some(value), bound)) = bound.map(|b| (b.value.clone(), b)) else {
            return Err(fault!(NOT_CONSTANT, "`{name}` has no value, and one is needed here";
                help: "give it one where it is declared or by a modifier")
            .at(span));
        };
        let value = picked(value, &bound.indices);
        let found = self.known_value(&value, bound.context)?;
        fitting(found, &base, &dims, bound.each).map_err(|fault| fault.at(value.span))
    }

    /// A constant of a package, or a literal of an enumeration, as its value.
    pub(super) fn constant(
        &mut self,
        reference: &ComponentReference,
        context: Context,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        if let [part, literal] = reference.parts.as_slice()
            && let Some(ordinal) = predefined_literal(part.name, literal.name)
        {
            return Ok(Expression::new(ExpressionKind::Integer(ordinal), reference.span));
        }
        for length in (1..reference.parts.len()).rev() {
            let name = Name {
                global: reference.global,
                parts: reference.parts[..length].iter().map(|part| part.name).collect(),
            };
            let Some(Type::Class(class)) = self.library.lookup(context.class, &name) else {
                continue;
            };
            let (class, scope) = (self.through_short_classes(class), &reference.parts[length..]);
            if let Some(literal) = self.literal_of(class, scope[0].name) {
                return Ok(Expression::new(ExpressionKind::Integer(literal), reference.span));
            }
            let package = self.package(class)?;
            if self.is_constant(package, scope[0].name) {
                return self.walk(package, scope, reference, context, local);
            }
            return Err(self.unknown_name(reference, context));
        }
        self.enclosing_constant(reference, context, local)
    }

    /// A constant declared in an enclosing class, or imported into one.
    fn enclosing_constant(
        &mut self,
        reference: &ComponentReference,
        context: Context,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let first = reference.parts[0].name;
        let mut scope = context.class.filter(|_| !reference.global);
        while let Some(class) = scope {
            let package = self.package(class)?;
            if self.is_constant(package, first) {
                return self.walk(package, &reference.parts, reference, context, local);
            }
            if Some(class) != context.class && self.has_component(package, first) {
                let class = &self.library.class(class).name;
                return Err(fault!(
                    NOT_CONSTANT,
                    "`{first}` is a component of the enclosing class `{class}` and no constant";
                    help: "only constants of enclosing classes can be used (MLS §5.3.1)")
                .at(reference.span));
            }
            for name in self.library.imported_name(class, first) {
                let mut imported = ComponentReference::from_name(&name, reference.span);
                imported.global = true;
                if let Some(last) = imported.parts.last_mut() {
                    last.subscripts = reference.parts[0].subscripts.clone();
                }
                imported.parts.extend(reference.parts[1..].iter().cloned());
                if let Ok(found) = self.constant(&imported, context, local) {
                    return Ok(found);
                }
            }
            let found = self.library.class(class);
            scope = found.parent.filter(|_| !found.definition.encapsulated);
        }
        Err(self.unknown_name(reference, context))
    }

    /// Whether a package's instance has a constant of this name.
    fn is_constant(&self, package: NodeId, name: Ident) -> bool {
        self.composite_of(package)
            .and_then(|composite| composite.members.get(&name))
            .is_some_and(|member| member.declaration.variability == Some(Variability::Constant))
    }

    fn has_component(&self, package: NodeId, name: Ident) -> bool {
        self.composite_of(package).is_some_and(|composite| composite.members.contains_key(&name))
    }

    fn through_short_classes(&self, mut class: ClassId) -> ClassId {
        for _ in 0..100 {
            let ClassSpecifier::Short(_) = &self.library.class(class).definition.specifier else {
                return class;
            };
            match self.library.bases(class).first() {
                Some(base) => class = *base,
                None => return class,
            }
        }
        class
    }

    fn literal_of(&self, class: ClassId, name: Ident) -> Option<i64> {
        let definition = self.library.enumeration(class, Span::NONE).ok()?;
        let at = definition.literals.iter().position(|literal| *literal == name)?;
        Some(at as i64 + 1)
    }
}

fn predefined_literal(enumeration: Ident, literal: Ident) -> Option<i64> {
    let (_, literals) = PREDEFINED_ENUMERATIONS.iter().find(|(name, _)| enumeration == *name)?;
    let at = literals.iter().position(|known| literal == *known)?;
    Some(at as i64 + 1)
}

/// A value as a variable of this type and these sizes holds it.
fn fitting(value: Value, base: &BaseType, dims: &[usize], each: bool) -> Result<Value, Fault> {
    let value = match (base, value) {
        (BaseType::Real, value) => value.promoted(),
        (BaseType::Enumeration(definition), Value::Integer(ordinal)) => {
            Value::Enumeration(crate::value::EnumerationValue {
                definition: definition.clone(),
                ordinal,
            })
        }
        (_, value) => value,
    };
    check_type(&value, base)?;
    match &value {
        Value::Array(array) if array.dims == dims => Ok(value),
        Value::Array(array) => Err(fault!(
            super::errors::SIZE_MISMATCH,
            "the value has the sizes {:?}, the declaration {dims:?}",
            array.dims
        )),
        _ if dims.is_empty() => Ok(value),
        _ if each => ArrayValue::filled(dims.to_vec(), &value).map(Value::Array),
        _ => Err(fault!(
            super::errors::SIZE_MISMATCH,
            "the value is a scalar, the declaration has the sizes {dims:?}"
        )),
    }
}

fn check_type(value: &Value, base: &BaseType) -> Result<(), Fault> {
    let found = match value {
        Value::Array(array) => array.elements.type_name(),
        scalar => scalar.type_name(),
    };
    let wanted = match base {
        BaseType::Real => "Real",
        BaseType::Integer => "Integer",
        BaseType::Boolean => "Boolean",
        BaseType::String => "String",
        BaseType::Enumeration(_) => return Ok(()),
    };
    let empty = matches!(value, Value::Array(array) if array.elements.is_empty());
    if found == wanted || empty {
        return Ok(());
    }
    Err(fault!(TYPE_MISMATCH, "the value is {found}, and {wanted} is needed"))
}

/// Answers calls of functions while constants are evaluated; variables are values already.
struct Functions<'i, 'a>(&'i mut Instantiation<'a>);

/// The most turns of loops and statements that may be run to find the values of one model.
const MAX_STEPS: usize = 10_000_000;

impl Host for Functions<'_, '_> {
    fn callee(&mut self, name: &Name) -> Result<Option<Callee>, Diagnostic> {
        Ok(self.0.functions.get(name).cloned().flatten().map(Callee::Function))
    }

    fn call_builtin(
        &mut self,
        header: &Arc<Function>,
        _arguments: Vec<Value>,
        span: Span,
    ) -> Result<Vec<Value>, Diagnostic> {
        Err(fault!(NOT_CONSTANT, "`{}` is a command, not a function of values", header.name)
            .at(span))
    }

    fn interrupted(&mut self) -> Option<Fault> {
        self.0.steps += 1;
        (self.0.steps > MAX_STEPS).then(|| {
            fault!(TOO_LARGE, "the values needed at translation take more than {MAX_STEPS} steps";
                help: "check the condition that ends the loop")
        })
    }

    fn variable(&mut self, reference: &ComponentReference) -> Result<Option<Value>, Diagnostic> {
        Err(fault!(NOT_CONSTANT, "`{}` is not known at translation", reference.name())
            .at(reference.span))
    }
}

/// Variables read while a value is found.
pub(super) type Read = IndexSet<usize>;
