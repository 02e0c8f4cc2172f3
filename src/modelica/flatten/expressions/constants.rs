//! Values known at translation: constants of packages, and parameters that shape the model
//! (MLS §3.8, §4.5).

use crate::budget;
use crate::diag::{Diagnostic, Fault};
use crate::eval::{Callee, Host, Scope, evaluate};
use crate::external::Outside;
use crate::fault;
use crate::flatten::errors::{NOT_CONSTANT, TOO_LARGE, TYPE_MISMATCH, VALUE_NEEDED};
use crate::flatten::expressions::local::Local;
use crate::flatten::ids::NodeId;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instance::NodeKind;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::lookup::classes::Classes;
use crate::flatten::lookup::modification::Bound;
use crate::flatten::lookup::types::Type;
use crate::flatten::{BaseType, Variability};
use crate::name::{Ident, Name};
use crate::names::Names;
use crate::source::Span;
use crate::syntax::ast::{
    ComponentReference, Expression, ExpressionKind, ImportKind, ReferencePart, Restriction,
    VariabilityPrefix,
};
use crate::value::{ArrayValue, Value};

/// The constants and literals that a reference may mean, looked up by its first part and followed to
/// the end.
struct Constants<'i, 'a, 'r> {
    instantiation: &'i mut Instantiation<'a>,
    reference: &'r ComponentReference,
    context: ScopeId,
    local: &'r Local,
}

impl Constants<'_, '_, '_> {
    fn inside_class(&mut self, found: Option<Type>) -> Result<Option<Expression>, Diagnostic> {
        let Constants { instantiation, reference, context, local } = self;
        let rest = &reference.parts[1..];
        instantiation.inside_class(found, rest, reference, *context, local).map(Some)
    }
}

impl Names for Constants<'_, '_, '_> {
    type Class = ScopeId;
    type Meaning = Expression;
    type Fault = Diagnostic;

    fn element(&mut self, scope: ScopeId, name: Ident) -> Result<Option<Expression>, Diagnostic> {
        let Constants { instantiation, reference, context, local } = self;
        if scope != *context && instantiation.classes.has_component(scope, name)? {
            let found = instantiation.enclosing_constant(scope, reference, *context, local);
            return found.map(Some);
        }
        match instantiation.classes.element(scope, name)? {
            Some(found) => self.inside_class(Some(found)),
            None => Ok(None),
        }
    }

    fn imports(&self, scope: ScopeId) -> &[ImportKind] {
        self.instantiation.classes.imports(scope)
    }

    fn around(&self, scope: ScopeId) -> Option<ScopeId> {
        self.instantiation.classes.around(scope)
    }

    fn top(&mut self, name: Ident) -> Result<Option<Expression>, Diagnostic> {
        let found = self.instantiation.classes.lookup(ScopeId::TOP, &Name::from(name))?;
        self.inside_class(found)
    }

    fn global(&mut self, name: &Name) -> Result<Option<Expression>, Diagnostic> {
        let Constants { instantiation, reference, context, local } = self;
        let name = Name { global: true, ..name.clone() };
        instantiation.imported_constant(&name, reference, *context, local)
    }
}

impl Instantiation<'_> {
    /// The value of an expression that shapes the model; the parameters that it needs are marked.
    pub(crate) fn structural_value(
        &mut self,
        e: &Expression,
        context: ScopeId,
    ) -> Result<Value, Diagnostic> {
        let outer = std::mem::take(&mut self.values.read);
        let value = self.known_value(e, context);
        let read = std::mem::replace(&mut self.values.read, outer);
        self.values.structural.extend(read);
        value
    }

    /// The value of an expression whose names are resolved already.
    pub(crate) fn flat_value(&mut self, e: &Expression) -> Result<Value, Diagnostic> {
        let outer = std::mem::take(&mut self.values.read);
        let value = self.known_flat_value(e);
        let read = std::mem::replace(&mut self.values.read, outer);
        self.values.structural.extend(read);
        value
    }

    /// The value of an expression of flat names of constants and parameters.
    pub(crate) fn known_flat_value(&mut self, e: &Expression) -> Result<Value, Diagnostic> {
        let local = Local { values: true, flat: true, ..Local::default() };
        let resolved = self.resolve(e, self.classes.flat_scope(), &local)?;
        evaluate(&resolved, &mut Scope::script(), &mut Functions(self))
    }

    /// Whether an expression has a value at translation: no variable but constants and
    /// parameters, no operator of time.
    pub(crate) fn is_fixed(&mut self, resolved: &Expression) -> bool {
        let read = std::mem::take(&mut self.values.read);
        let fixed = self.known_flat_value(resolved).is_ok();
        self.values.read = read;
        fixed
    }

    /// The value of an expression of constants and parameters.
    pub(crate) fn known_value(
        &mut self,
        e: &Expression,
        context: ScopeId,
    ) -> Result<Value, Diagnostic> {
        let local = Local { values: true, ..Local::default() };
        let resolved = self.resolve(e, context, &local)?;
        evaluate(&resolved, &mut Scope::script(), &mut Functions(self))
    }

    /// The value of a constant or parameter, by its place.
    pub(crate) fn value(&mut self, variable: usize, span: Span) -> Result<Value, Diagnostic> {
        match self.values.known.get(&variable) {
            Some(Some((value, read))) => {
                self.values.read.extend(read.iter().copied());
                return Ok(value.clone());
            }
            Some(None) => {
                let name = &self.classes.tree.variables[variable].0.name;
                return Err(
                    fault!(NOT_CONSTANT, "the value of `{name}` depends on itself").at(span)
                );
            }
            None => {}
        }
        self.values.known.insert(variable, None);
        let outer = std::mem::take(&mut self.values.read);
        let draws = self.values.outside.draws();
        let found = self.found_value(variable, span);
        if self.values.outside.draws() > draws {
            self.values.drawn.insert(variable);
        }
        let mut read = std::mem::replace(&mut self.values.read, outer);
        read.insert(variable);
        self.values.read.extend(read.iter().copied());
        match found {
            Ok(value) => {
                self.values.known.insert(variable, Some((value.clone(), read)));
                Ok(value)
            }
            Err(error) => {
                self.values.known.remove(&variable);
                Err(error)
            }
        }
    }

    fn found_value(&mut self, variable: usize, span: Span) -> Result<Value, Diagnostic> {
        let (declared, node) = &self.classes.tree.variables[variable];
        let (name, base) = (declared.name.clone(), declared.base.clone());
        let dims = declared.dims.clone();
        if declared.variability > Variability::Parameter {
            return Err(fault!(NOT_CONSTANT, "`{name}` is not known at translation";
                help: "only constants and parameters are known at translation")
            .at(span));
        }
        let NodeKind::Variable(leaf) = &self.classes.tree.nodes[node.0].kind else {
            return Err(fault!(NOT_CONSTANT, "`{name}` has no value").at(span));
        };
        let of_elements = leaf.modifier.of_elements.iter();
        let own: Vec<(Vec<usize>, Bound)> =
            of_elements.filter_map(|(at, one)| Some((at.clone(), one.binding.clone()?))).collect();
        let given = |bound: Option<Bound>| bound.and_then(|b| Some((b.value.clone()?, b)));
        let start = leaf.modifier.elements.iter().find(|(name, _)| **name == "start");
        let start = given(start.and_then(|(_, modifier)| modifier.binding.clone()));
        let (value, bound) = match (given(leaf.modifier.binding.clone()), start) {
            (Some(binding), _) => binding,
            // A parameter without a value has its start value (MLS §8.6).
            (None, Some(start)) => {
                self.warnings.add_once(
                    fault!(VALUE_NEEDED, "`{name}` has no value, but its value is needed here: \
                                          its start value is taken";
                    help: "give it a value in its declaration or by a modifier")
                    .at(span),
                );
                start
            }
            (None, None) => {
                return Err(fault!(VALUE_NEEDED, "`{name}` has no value, but its value is needed \
                                                 here";
                    help: "give it a value in its declaration or by a modifier")
                .at(span));
            }
        };
        let named = |error: Diagnostic| {
            let name = format!("the value of `{name}` ");
            error.with_words(|text| match text.strip_prefix("the value ") {
                Some(rest) => format!("{name}{rest}"),
                None => text.to_owned(),
            })
        };
        let mut whole = self.bound_constant(&value, &bound, &base, &dims).map_err(named)?;
        for (indices, bound) in own {
            let (Some(value), Value::Array(array)) = (&bound.value, &mut whole) else { continue };
            let element = self.bound_constant(value, &bound, &base, &[]).map_err(named)?;
            let offset =
                indices.iter().zip(&dims).fold(0, |at, (index, size)| at * size + index - 1);
            array.elements.set(offset, element).map_err(|fault| fault.at(value.span))?;
        }
        Ok(whole)
    }

    /// The value that a modifier gives to a constant or parameter of this type and these sizes.
    fn bound_constant(
        &mut self,
        value: &Expression,
        bound: &Bound,
        base: &BaseType,
        dims: &[usize],
    ) -> Result<Value, Diagnostic> {
        let value = self.part_of(value, bound)?;
        // Parameters may be read from files (MLS §12.3).
        let local = Local { values: true, impure: true, ..Local::default() };
        let resolved = self.resolve(&value, bound.context, &local)?;
        let found = evaluate(&resolved, &mut Scope::script(), &mut Functions(self))?;
        fitting(found, base, dims, bound.each).map_err(|fault| fault.at(value.span))
    }

    /// A constant of a package, or a literal of an enumeration, as its value.
    pub(crate) fn constant(
        &mut self,
        reference: &ComponentReference,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let scope = Some(context).filter(|scope| !reference.global && *scope != ScopeId::TOP);
        let mut constants = Constants { instantiation: self, reference, context, local };
        match constants.simple(scope, reference.parts[0].name)? {
            Some(found) => Ok(found),
            None => Err(self.classes.unknown_name(reference, context)),
        }
    }

    /// A component of an enclosing class, which must be a constant.
    fn enclosing_constant(
        &mut self,
        scope: ScopeId,
        reference: &ComponentReference,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let first = reference.parts[0].name;
        let node = self.classes.node_of(scope);
        if self.classes.is_constant(node, first) {
            // A function is not part of the model whose constant it uses, and takes its value.
            let is_whole = reference.parts.iter().all(|part| part.subscripts.is_empty());
            let values = local.values || (is_whole && !local.types.is_empty());
            let local = Local { values, ..local.clone() };
            return self.walk(node, &reference.parts, reference, context, &local);
        }
        let class = &self.classes.text(scope).name;
        Err(fault!(
            NOT_CONSTANT,
            "`{first}` is a component of the enclosing class `{class}`, not a constant";
            help: "only constants of enclosing classes can be used (MLS §5.3.1)")
        .at(reference.span))
    }

    /// What an import makes of the first part of a reference, followed to the end.
    fn imported_constant(
        &mut self,
        name: &Name,
        reference: &ComponentReference,
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<Expression>, Diagnostic> {
        if let Some(found) = self.classes.lookup(ScopeId::TOP, name)? {
            let rest = &reference.parts[1..];
            return self.inside_class(Some(found), rest, reference, context, local).map(Some);
        }
        let package = Name { global: true, ..name.parent() };
        let Some(Type::Class(package)) = self.classes.lookup(ScopeId::TOP, &package)? else {
            return Ok(None);
        };
        let (Some(last), node) = (name.last(), self.classes.node_of(package)) else {
            return Ok(None);
        };
        if self.classes.enumeration(Type::Class(package), reference.span)?.is_some() {
            let mut path = reference.parts.clone();
            path[0].name = last;
            let enumeration = Some(Type::Class(package));
            return self.inside_class(enumeration, &path, reference, context, local).map(Some);
        }
        if !self.classes.has_component(package, last)? || !self.classes.is_constant(node, last) {
            return Ok(None);
        }
        let mut parts = reference.parts.clone();
        parts[0].name = last;
        self.walk(node, &parts, reference, context, local).map(Some)
    }

    /// The constant at the end of a path inside a class.
    fn inside_class(
        &mut self,
        found: Option<Type>,
        path: &[ReferencePart],
        reference: &ComponentReference,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let mut found = found;
        for (at, part) in path.iter().enumerate() {
            let Some(class) = found else { break };
            if let Some(definition) = self.classes.enumeration(class, reference.span)? {
                let literal = definition.literals.iter().position(|known| *known == part.name);
                let Some(ordinal) = literal.filter(|_| at + 1 == path.len()) else { break };
                let kind = ExpressionKind::Integer(ordinal as i64 + 1);
                return Ok(Expression::new(kind, reference.span));
            }
            let Type::Class(scope) = class else { break };
            if self.classes.has_component(scope, part.name)? {
                let node = self.classes.node_of(scope);
                if self.classes.is_constant(node, part.name) {
                    return self.walk(node, &path[at..], reference, context, local);
                }
                let local = self.as_of_class(scope, part.name, reference, local)?;
                return self.walk(node, &path[at..], reference, context, &local);
            }
            found = self.classes.inside(class, part.name)?;
            if at + 1 == path.len()
                && let Some(function) = self.function_reference(found, reference.span)?
            {
                return Ok(function);
            }
        }
        if path.is_empty()
            && let Some(function) = self.function_reference(found, reference.span)?
        {
            return Ok(function);
        }
        Err(self.classes.unknown_name(reference, context))
    }

    /// How a component of a class is looked up that is not a constant: a parameter has the value of
    /// its declaration, as in OpenModelica, with a warning (MLS §5.3.2 allows constants only).
    fn as_of_class(
        &mut self,
        scope: ScopeId,
        name: Ident,
        reference: &ComponentReference,
        local: &Local,
    ) -> Result<Local, Diagnostic> {
        let node = self.classes.node_of(scope);
        let variability = self.classes.variability(node, name);
        let (shown, class) = (reference.name(), self.classes.text(scope).name.clone());
        if variability != Some(VariabilityPrefix::Parameter) || self.classes.library.is_strict() {
            return Err(fault!(NOT_CONSTANT, "`{name}` is a component of the class `{class}`, not a \
                                             constant";
                help: "declare a component of this class and use its `{name}`, or declare it `constant`")
            .at(reference.span));
        }
        let warning = fault!(NOT_CONSTANT, "`{shown}` is a parameter of the class `{class}`, not of a \
                                            component: the value of its declaration is used";
            help: "declare it `constant` (MLS §5.3.2)");
        let warning = warning.at(reference.span);
        if !self.warnings.has_message(&warning.message) {
            self.warnings.add_once(warning);
        }
        Ok(Local { values: true, ..local.clone() })
    }

    /// The name of a function, to be passed to another one (MLS §12.4.2).
    fn function_reference(
        &mut self,
        found: Option<Type>,
        span: Span,
    ) -> Result<Option<Expression>, Diagnostic> {
        let Some(Type::Class(class)) = found else { return Ok(None) };
        if !matches!(self.classes.text(class).restriction(), Restriction::Function { .. }) {
            return Ok(None);
        }
        let Some(name) = self.function(class)? else { return Ok(None) };
        let reference = ComponentReference::from_name(&name, span);
        Ok(Some(Expression::new(ExpressionKind::Reference(reference), span)))
    }
}

impl Classes<'_> {
    /// Whether a class has a component of this name, itself or inherited.
    pub(crate) fn has_component(
        &mut self,
        scope: ScopeId,
        name: Ident,
    ) -> Result<bool, Diagnostic> {
        if scope == ScopeId::TOP {
            return Ok(false);
        }
        Ok(self.elements(scope)?.contains(name))
    }

    /// Whether a package's instance has a constant of this name.
    fn is_constant(&mut self, package: NodeId, name: Ident) -> bool {
        self.variability(package, name) == Some(VariabilityPrefix::Constant)
    }

    /// The variability that a class declares for a component of its own.
    fn variability(&mut self, class: NodeId, name: Ident) -> Option<VariabilityPrefix> {
        self.members(class).ok()?;
        self.tree.declaration_of(class, name)?.type_prefixes.variability
    }

    /// The scope in which flat names mean variables.
    pub(crate) fn flat_scope(&self) -> ScopeId {
        self.tree.scope_of(self.tree.root).unwrap_or(ScopeId::TOP)
    }
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
            crate::flatten::errors::SIZE_MISMATCH,
            "the value has the sizes {:?}, but the declaration has {dims:?}",
            array.dims
        )),
        _ if dims.is_empty() => Ok(value),
        _ if each => ArrayValue::filled(dims.to_vec(), &value).map(Value::Array),
        _ => Err(fault!(
            crate::flatten::errors::SIZE_MISMATCH,
            "the value is a scalar, but the declaration has the sizes {dims:?}"
        )),
    }
}

fn check_type(value: &Value, base: &BaseType) -> Result<(), Fault> {
    let found = match value {
        Value::Array(array) => array.elements.type_name(),
        scalar => scalar.type_name(),
    };
    let expected = match base {
        BaseType::Real => "Real",
        BaseType::Integer => "Integer",
        BaseType::Boolean => "Boolean",
        BaseType::String => "String",
        BaseType::Enumeration(_) | BaseType::ExternalObject(_) | BaseType::Clock => return Ok(()),
    };
    let empty = matches!(value, Value::Array(array) if array.elements.is_empty());
    if found == expected || empty {
        return Ok(());
    }
    Err(fault!(TYPE_MISMATCH, "the value is {found}, expected {expected}"))
}

/// Answers calls of functions while constants are evaluated; variables are values already.
struct Functions<'i, 'a>(&'i mut Instantiation<'a>);

impl Host for Functions<'_, '_> {
    fn callee(&mut self, name: &Name) -> Result<Option<Callee>, Diagnostic> {
        Ok(self.0.functions.table.get(name).cloned().flatten().map(Callee::Function))
    }

    fn outside(&mut self) -> Option<&mut dyn Outside> {
        Some(&mut self.0.values.outside)
    }

    fn takes_default(&mut self, warning: Diagnostic) -> bool {
        if self.0.classes.library.is_strict() {
            return false;
        }
        self.0.warnings.add_once(warning);
        true
    }

    fn interrupted(&mut self) -> Option<Fault> {
        self.0.values.steps += 1;
        let limit = budget::step_limit();
        (self.0.values.steps > limit).then(|| {
            fault!(TOO_LARGE, "evaluating the values needed at translation takes more than {} \
                               steps",
                budget::in_millions(limit); help: "{}", budget::REMEDY)
        })
    }

    fn variable(&mut self, reference: &ComponentReference) -> Result<Option<Value>, Diagnostic> {
        let object = reference.as_ident().and_then(|name| self.0.values.objects.get(&name));
        if let Some(object) = object {
            return Ok(Some(object.clone()));
        }
        Err(fault!(NOT_CONSTANT, "`{}` is not known at translation", reference.name())
            .at(reference.span))
    }
}
