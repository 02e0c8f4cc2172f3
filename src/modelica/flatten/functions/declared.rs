//! Functions made ready to be called: inherited elements collected, names resolved (MLS ch. 12).

use crate::diag::Diagnostic;
use crate::eval::{Function, FunctionBody, FunctionComponent, ValueType};
use crate::fault;
use crate::flatten::errors::{NOT_SUPPORTED, PROTECTED_ACCESS, TYPE_MISMATCH, UNKNOWN_CLASS};
use crate::flatten::expressions::local::Local;
use crate::flatten::flat_expression::literal;
use crate::flatten::functions::outer_names::names_any;
use crate::flatten::functions::printing::PRINT;
use crate::flatten::functions::table::FunctionTable;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instance::{Declaration, MemberState, Shape};
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::library::{LegacyConstruct, Library};
use crate::flatten::lookup::classes::Classes;
use crate::flatten::lookup::modification::{Modifier, Replacement};
use crate::flatten::lookup::scope::Text;
use crate::flatten::lookup::types::Predefined;
use crate::flatten::lookup::types::Type;
use crate::name::{Ident, Name};
use crate::names::Names as _;
use crate::source::{Span, Spanned};
use crate::syntax::ast::{
    Annotation, Argument, Arguments, Binding, CausalityPrefix, ClassSpecifier, ComponentReference,
    Element, ElementModification, Expression, ExpressionKind, External, ForIndex, NamedArgument,
    Purity, Restriction, Section, Statement, StatementKind, Subscript, Visibility,
};
use crate::syntax::visit::Visit;
use indexmap::IndexMap;
use std::rc::Rc;
use std::sync::Arc;

/// Packages of the standard library whose functions the language has under bare names too.
const INTRINSIC_PACKAGES: &[&str] = &["Modelica.Math"];

/// Whether a name with dots is one of a function that the language has under its bare name too.
pub(crate) fn is_intrinsic(name: &Name) -> bool {
    let package = Name::new(name.parent().parts).to_string();
    INTRINSIC_PACKAGES.contains(&package.as_str())
}

impl Library {
    /// The function that a name means at the top level, with the functions that it calls; `None`
    /// if the name means nothing here. A record's name means its constructor.
    pub fn function(
        &self,
        name: &Name,
    ) -> Result<Option<IndexMap<Name, Arc<Function>>>, Diagnostic> {
        // What follows the first name may be inherited, which only the instantiation knows.
        if name.first().is_none_or(|first| self.find(&Name::from(first)).is_none()) {
            return Ok(None);
        }
        crate::flatten::on_deep_stack(|| self.ready_function(name))?
    }

    fn ready_function(
        &self,
        name: &Name,
    ) -> Result<Option<IndexMap<Name, Arc<Function>>>, Diagnostic> {
        let mut instantiation = Instantiation::new(self);
        instantiation.functions.asked = Some(name.clone());
        let Some(Type::Class(id)) = instantiation.classes.class_named(name)? else {
            return Ok(None);
        };
        let Some(full) = instantiation.function(id)? else { return Ok(None) };
        let mut functions: IndexMap<Name, Arc<Function>> = IndexMap::new();
        let own = instantiation.functions.table.shift_remove(&full).flatten();
        functions.extend(own.map(|function| (full, function)));
        for (name, function) in instantiation.functions.table {
            functions.extend(function.map(|function| (name, function)));
        }
        Ok(Some(functions))
    }
}

impl Instantiation<'_> {
    /// The full name of a called function, which is made ready; a name that no class declares is
    /// left for evaluation (operators and intrinsics).
    pub(crate) fn function_name(
        &mut self,
        name: &Name,
        context: ScopeId,
        span: Span,
    ) -> Result<Name, Diagnostic> {
        match self.classes.lookup(context, name)? {
            Some(Type::Class(id)) => match self.function(id)? {
                Some(full) => Ok(full),
                None => Err(fault!(TYPE_MISMATCH, "`{name}` is not a function").at(span)),
            },
            _ => match self.function_of_component(name, context, span)? {
                Some(full) => Ok(full),
                None if name.is_simple() && name.parts[0] == PRINT => Ok(self.bare_print()),
                None => Ok(self.intrinsic_name(name)),
            },
        }
    }

    /// A function of the class of a component: `component.f` (MLS §5.3.2).
    fn function_of_component(
        &mut self,
        name: &Name,
        context: ScopeId,
        span: Span,
    ) -> Result<Option<Name>, Diagnostic> {
        let Some((first, rest)) = name.parts.split_first() else { return Ok(None) };
        if rest.is_empty() || name.global || !self.classes.has_component(context, *first)? {
            return Ok(None);
        }
        let mut node = self.classes.node_of(context);
        for (at, part) in name.parts.iter().enumerate() {
            match self.member(node, *part)?.map(MemberState::seen) {
                Some(MemberState::Single(next)) => node = next,
                _ => {
                    let Some(scope) = self.classes.tree.scope_of(node) else { return Ok(None) };
                    if at > 0 && self.classes.is_protected_class(scope, *part) {
                        let path = &self.classes.tree.nodes[node.0].path;
                        return Err(
                            fault!(PROTECTED_ACCESS, "`{part}` is protected in `{path}`").at(span)
                        );
                    }
                    let found = Some(Type::Class(scope));
                    return match self.classes.followed(found, &name.parts[at..])? {
                        Some(Type::Class(id)) => self.function(id),
                        _ => Ok(None),
                    };
                }
            }
        }
        Ok(None)
    }

    /// `Modelica.Math.sin` is `sin` where no library declares it.
    fn intrinsic_name(&self, name: &Name) -> Name {
        match name.last() {
            Some(last) if is_intrinsic(name) => Name::from(last),
            _ => name.clone(),
        }
    }

    /// Makes a function ready and returns its full name; `None` if the class is not a function.
    pub(crate) fn function(&mut self, id: ScopeId) -> Result<Option<Name>, Diagnostic> {
        if let Some(known) = self.functions.names.get(&id) {
            return Ok(Some(known.clone()));
        }
        let class = self.classes.long_class(id)?;
        let is_function = matches!(
            self.classes.text(class).restriction(),
            Restriction::Function { .. } | Restriction::Record | Restriction::OperatorRecord
        );
        if !is_function {
            return self.object_constructor(class);
        }
        // Known by name before its body is read, which may call the function itself.
        let name = self.free_name(id, class);
        self.functions.table.insert(name.clone(), None);
        self.functions.names.insert(id, name.clone());
        if self.classes.is_record(class) {
            self.functions.record_scopes.insert(name.clone(), class);
        }
        let specifier = self.classes.text(class).definition.specifier.clone();
        let function = match specifier {
            ClassSpecifier::Derivative(derivative) => {
                self.partial_derivative(&name, class, &derivative)
            }
            _ if self.classes.is_record(class) => self.constructor(&name, class),
            _ => self.ready(&name, class),
        };
        match function {
            Ok(function) => Ok(Some(self.keep_function(id, name, function))),
            Err(error) => {
                self.functions.table.shift_remove(&name);
                self.functions.names.remove(&id);
                Err(error)
            }
        }
    }

    /// The function `constructor` of an external object (MLS §12.9.7), which its class stands for.
    fn object_constructor(&mut self, class: ScopeId) -> Result<Option<Name>, Diagnostic> {
        let text = self.classes.text(class).clone();
        let base = self.classes.predefined_base(class, &text)?.map(|(base, _)| base);
        if !matches!(base, Some(Type::Predefined(Predefined::ExternalObject))) {
            return Ok(None);
        }
        // It is not called by name, but must be there when the object is freed.
        if let Some(Type::Class(id)) =
            self.classes.lookup(class, &Name::from(Ident::new("destructor")))?
        {
            self.function(id)?;
        }
        match self.classes.lookup(class, &Name::from(Ident::new("constructor")))? {
            Some(Type::Class(id)) => self.function(id),
            _ => Ok(None),
        }
    }

    /// Makes the functions of `derivative` and `inverse` annotations ready and writes their full
    /// names; those that cannot be made ready are left out (MLS §12.7.1, §12.8).
    fn named_functions(&mut self, arguments: Vec<Argument>, context: ScopeId) -> Vec<Argument> {
        let mut kept = Vec::with_capacity(arguments.len());
        for mut argument in arguments {
            let is_ready = match &mut argument {
                Argument::Element(element) => match element.name.node.last().map(Ident::as_str) {
                    Some("derivative") => self.name_function(element, context),
                    Some("inverse") => self.name_inverses(element, context),
                    _ => true,
                },
                Argument::Redeclaration(_) => true,
            };
            if is_ready {
                kept.push(argument);
            }
        }
        kept
    }

    /// Writes the full name of the function after `=`, alone or called; whether there is one.
    fn name_function(&mut self, element: &mut ElementModification, context: ScopeId) -> bool {
        let Some(modification) = &mut element.modification else { return true };
        let Some(Binding::Expression(e)) = &mut modification.binding else { return true };
        let span = e.span;
        let (ExpressionKind::Reference(reference)
        | ExpressionKind::Call { function: reference, .. }) = &mut e.kind
        else {
            return true;
        };
        match self.function_name(&reference.name(), context, span) {
            Ok(full) => {
                *reference = ComponentReference::from_name(&full, span);
                true
            }
            Err(_) => false,
        }
    }

    /// The same of each input of `inverse(x = f(y), ...)`.
    fn name_inverses(&mut self, element: &mut ElementModification, context: ScopeId) -> bool {
        let Some(modification) = &mut element.modification else { return false };
        modification.arguments.retain_mut(|argument| match argument {
            Argument::Element(of_input) => self.name_function(of_input, context),
            Argument::Redeclaration(_) => false,
        });
        !modification.arguments.is_empty()
    }

    /// The name of a function, with a number if another function has it: the same text in another
    /// environment.
    fn free_name(&mut self, id: ScopeId, class: ScopeId) -> Name {
        let name = self.classes.text(id).name.clone();
        let is_plain = self.functions.asked.is_none() || self.classes.is_record(class);
        if !self.functions.table.contains_key(&name)
            && (is_plain || self.classes.is_found_as(&name, id))
        {
            return name;
        }
        // The function that is asked for keeps the name that it has there.
        if let Some(asked) =
            self.functions.asked.as_ref().filter(|_| self.functions.table.is_empty())
        {
            return asked.clone();
        }
        let numbered = (2..).map(|number| self.functions.numbered(&name, number));
        numbered
            .into_iter()
            .find(|name| !self.functions.table.contains_key(name))
            .unwrap_or(name.clone())
    }

    /// Stores a function, unless one that differs in the name alone is known already.
    fn keep_function(&mut self, id: ScopeId, name: Name, function: Function) -> Name {
        let text = self.classes.text(id).name.clone();
        if name != text && self.functions.asked.as_ref() != Some(&name) {
            let mut at = 1;
            let mut candidate = text.clone();
            while candidate != name {
                let renamed = Function { name: candidate.clone(), ..function.clone() };
                let known = self.functions.table.get(&candidate).cloned().flatten();
                if known.is_some_and(|known| same_function(&known, &renamed)) {
                    self.functions.table.shift_remove(&name);
                    self.functions.names.insert(id, candidate.clone());
                    return candidate;
                }
                at += 1;
                candidate = self.functions.numbered(&text, at);
            }
        }
        self.functions.table.insert(name.clone(), Some(Arc::new(function)));
        name
    }

    /// The name of a record's constructor, made ready.
    pub(crate) fn record_constructor(
        &mut self,
        class: ScopeId,
        span: Span,
    ) -> Result<Name, Diagnostic> {
        self.function(class)?.ok_or_else(|| {
            fault!(UNKNOWN_CLASS, "`{}` has no constructor", self.classes.text(class).name).at(span)
        })
    }

    fn ready(&mut self, name: &Name, class: ScopeId) -> Result<Function, Diagnostic> {
        let components = self.components_of(class)?;
        let names: Vec<Ident> = components.iter().map(|c| c.component.name).collect();
        let inputs_of = |c: &Declared| c.causality == Some(CausalityPrefix::Input);
        let read_only = components.iter().filter(|c| inputs_of(c)).map(|c| c.component.name);
        let types = components.iter().map(|c| (c.component.name, c.component.value_type.clone()));
        let local = Local {
            read_only: read_only.collect(),
            types: Rc::new(types.collect()),
            ..Local::default().with(names)
        };
        let (mut inputs, mut outputs, mut locals) = (Vec::new(), Vec::new(), Vec::new());
        for declared in components {
            let list = match declared.causality {
                Some(CausalityPrefix::Input) => &mut inputs,
                Some(CausalityPrefix::Output) => &mut outputs,
                None => &mut locals,
            };
            list.push(declared.component);
        }
        let lineage: Vec<ScopeId> = self.classes.elements(class)?.lineage().collect();
        let text = self.classes.text(class).clone();
        self.classes.check_complete(class, text.span())?;
        let purity = match text.restriction() {
            Restriction::Function { purity, .. } => purity,
            _ => None,
        };
        let mut annotations = Vec::new();
        for scope in &lineage {
            let own = annotation(self.classes.text(*scope).sections());
            annotations.extend(self.named_functions(own, *scope));
        }
        Ok(Function {
            name: name.clone(),
            inputs,
            outputs,
            locals,
            body: self.body(&lineage, &local)?,
            description: description(&text.definition.specifier),
            annotation: annotations,
            impure: purity == Some(Purity::Impure),
            span: text.span(),
        })
    }

    fn constructor(&mut self, name: &Name, class: ScopeId) -> Result<Function, Diagnostic> {
        let fields: Vec<FunctionComponent> =
            self.components_of(class)?.into_iter().map(|declared| declared.component).collect();
        let span = self.classes.text(class).span();
        let table = fields.iter().map(|field| (field.name, field.clone())).collect();
        let output = FunctionComponent {
            name: Ident::new("'constructed record'"),
            value_type: ValueType::Record(name.clone(), Arc::new(table)),
            dims: Vec::new(),
            field_dims: Vec::new(),
            binding: None,
            description: None,
            span,
        };
        Ok(Function {
            name: name.clone(),
            inputs: fields,
            outputs: vec![output],
            locals: Vec::new(),
            body: FunctionBody::RecordConstructor,
            description: None,
            annotation: Vec::new(),
            impure: false,
            span,
        })
    }

    /// The components of a function or record, inherited ones included.
    fn components_of(&mut self, class: ScopeId) -> Result<Vec<Declared>, Diagnostic> {
        let elements = self.classes.elements(class)?;
        let mut local = Local::default().with(elements.names());
        let is_function = !self.classes.is_record(class);
        let lineage: Vec<ScopeId> = elements.lineage().collect();
        let is_outer = |declared: &&Arc<Declaration>| !is_function && declared.prefixes.outer;
        let outer = elements.iter().map(|(_, declared)| declared).filter(is_outer);
        let outer: Vec<Ident> = outer.map(|declared| declared.name).collect();
        let mut components = Vec::new();
        for (_, declared) in elements.iter() {
            // An `outer` component of a record is not part of it: bindings refer to it.
            if outer.contains(&declared.name) {
                continue;
            }
            let expanded = self.classes.expand(declared)?;
            let dims = declared.dims.iter().chain(&expanded.dims);
            let dims = dims.map(|(size, context)| self.declared_size(size, *context, &local));
            let dims = dims.collect::<Result<Vec<Subscript>, Diagnostic>>()?;
            let field_dims = self.field_dims(&expanded.modifier, &lineage, &local)?;
            let value_type = self.value_type(&expanded.shape, declared.span)?;
            let bound = expanded.modifier.binding.as_ref();
            let binding = match bound.and_then(|b| b.value.as_ref().map(|value| (value, b.context)))
            {
                // What a modifier gives from outside does not see the function's own names.
                Some((value, written)) if !lineage.contains(&written) => {
                    Some(self.resolve(value, written, &Local::default())?)
                }
                // Only an instance of the record has it.
                Some((value, _)) if names_any(value, &outer) => None,
                Some((value, written)) => Some(self.resolve(value, written, &local)?),
                None => {
                    self.value_of_fields(&value_type, &expanded.modifier, &local, declared.span)?
                }
            };
            let binding = match binding {
                None if !is_function => self.value_of_defaults(&value_type, &dims, declared.span),
                binding => binding,
            };
            Rc::make_mut(&mut local.types).push((declared.name, value_type.clone()));
            let causality = declared.type_prefixes.causality.or(expanded.causality);
            if is_function && !declared.protected && causality.is_none() {
                self.meet_public_variable(class, declared.name, declared.span)?;
            }
            components.push(Declared {
                causality: causality.filter(|_| !declared.protected),
                component: FunctionComponent {
                    name: declared.name,
                    value_type,
                    dims,
                    field_dims,
                    binding,
                    description: declared.description.clone(),
                    span: declared.span,
                },
            });
        }
        Ok(components)
    }

    /// The sizes that redeclarations in the declaration of a record give its components: their
    /// names are those of the class that contains it (MLS §7.3).
    fn field_dims(
        &mut self,
        modifier: &Modifier,
        lineage: &[ScopeId],
        local: &Local,
    ) -> Result<Vec<(Ident, Vec<Subscript>)>, Diagnostic> {
        let mut given = Vec::new();
        for (name, modifier) in &modifier.elements {
            let Some(redeclaration) = &modifier.redeclaration else { continue };
            let Replacement::Component(clause) = &redeclaration.replacement else { continue };
            let own = clause.components.first().map_or(&[][..], |one| &one.subscripts);
            let context = redeclaration.context;
            let outside = Local::default();
            let local = if lineage.contains(&context) { local } else { &outside };
            let dims = own.iter().chain(&clause.subscripts);
            let dims = dims.map(|size| self.declared_size(size, context, local));
            let dims = dims.collect::<Result<Vec<Subscript>, Diagnostic>>()?;
            if !dims.is_empty() {
                given.push((*name, dims));
            }
        }
        Ok(given)
    }

    /// A dimension with its names resolved; the number of values of a type that is one.
    fn declared_size(
        &mut self,
        size: &Subscript,
        context: ScopeId,
        local: &Local,
    ) -> Result<Subscript, Diagnostic> {
        let Subscript::Index(e) = size else { return Ok(size.clone()) };
        Ok(Subscript::Index(match self.classes.type_range(e, context, local)? {
            Some(values) => {
                let dims = self.shape_of(&values).unwrap_or_default();
                let size = dims.first().copied().unwrap_or(0) as i64;
                Expression::new(ExpressionKind::Integer(size), e.span)
            }
            None => self.resolve(e, context, local)?,
        }))
    }

    /// A variable of a function that should be protected (MLS §12.2); old libraries forget it.
    fn meet_public_variable(
        &self,
        class: ScopeId,
        name: Ident,
        span: Span,
    ) -> Result<(), Diagnostic> {
        if self.classes.library.is_strict() {
            return Err(fault!(
                TYPE_MISMATCH,
                "`{name}` is public in a function but neither input nor output";
                help: "declare it `input` or `output`, or move it after `protected`")
            .at(span));
        }
        let class = &self.classes.text(class).name;
        self.classes.library.meet(class, LegacyConstruct::PublicVariable, span);
        Ok(())
    }

    /// The value of a record whose components are given by modifiers: `R r(a = 1, b = 2)`. Those
    /// that are not given have no value yet.
    fn value_of_fields(
        &mut self,
        value_type: &ValueType,
        modifier: &Modifier,
        local: &Local,
        span: Span,
    ) -> Result<Option<Expression>, Diagnostic> {
        let ValueType::Record(record, _) = value_type else { return Ok(None) };
        let mut named = Vec::new();
        for (name, modifier) in &modifier.elements {
            let Some(bound) = &modifier.binding else { continue };
            let Some(value) = &bound.value else { continue };
            let value = self.resolve(value, bound.context, local)?;
            named.push(NamedArgument { name: Spanned { node: *name, span }, value });
        }
        if named.is_empty() {
            return Ok(None);
        }
        let function = ComponentReference::from_name(record, span);
        let arguments = Box::new(Arguments { named, ..Arguments::default() });
        Ok(Some(Expression::new(ExpressionKind::Call { function, arguments }, span)))
    }

    /// The value of a component of a record whose type has defaults for all of its components (MLS
    /// §12.6): what its constructor makes of no arguments.
    fn value_of_defaults(
        &self,
        value_type: &ValueType,
        dims: &[Subscript],
        span: Span,
    ) -> Option<Expression> {
        let ValueType::Record(record, fields) = value_type else { return None };
        if !fields.values().all(|field| field.binding.is_some()) {
            return None;
        }
        let function = ComponentReference::from_name(record, span);
        let kind = ExpressionKind::Call { function, arguments: Box::default() };
        dims.iter().rev().try_fold(Expression::new(kind, span), |element, size| {
            let Subscript::Index(size) = size else { return None };
            let one = Box::new(Expression::new(ExpressionKind::Integer(1), span));
            let range =
                ExpressionKind::Range { start: one, step: None, stop: Box::new(size.clone()) };
            let name = Spanned { node: Ident::new("'element'"), span };
            let index = ForIndex { name, range: Some(Expression::new(range, span)) };
            let (element, indices) = (Box::new(element), vec![index]);
            Some(Expression::new(ExpressionKind::ArrayIteration { element, indices }, span))
        })
    }

    fn value_type(&mut self, shape: &Shape, span: Span) -> Result<ValueType, Diagnostic> {
        let class = match shape {
            Shape::Predefined(Predefined::Real) => return Ok(ValueType::Real),
            Shape::Predefined(Predefined::Integer) => return Ok(ValueType::Integer),
            Shape::Predefined(Predefined::Boolean) => return Ok(ValueType::Boolean),
            Shape::Predefined(Predefined::String) => return Ok(ValueType::String),
            Shape::Enumeration(definition) => {
                return Ok(ValueType::Enumeration(definition.clone()));
            }
            Shape::Class(class) => *class,
            Shape::ExternalObject(name) => return Ok(ValueType::ExternalObject(name.clone())),
            Shape::Function => return Ok(ValueType::Function),
            Shape::Predefined(_) => {
                return Err(fault!(
                    TYPE_MISMATCH,
                    "a component of a function needs a type with values"
                )
                .at(span));
            }
        };
        let name = self.record_constructor(class, span)?;
        match self.functions.table.get(&name) {
            Some(Some(constructor)) => {
                let fields = constructor.inputs.iter().map(|f| (f.name, f.clone())).collect();
                Ok(ValueType::Record(name, Arc::new(fields)))
            }
            _ => Err(fault!(NOT_SUPPORTED, "`{name}` contains itself").at(span)),
        }
    }

    fn body(&mut self, lineage: &[ScopeId], local: &Local) -> Result<FunctionBody, Diagnostic> {
        let mut statements = Vec::new();
        let mut has_algorithm = false;
        for context in lineage.iter().copied() {
            let text: Text = self.classes.text(context).clone();
            for section in text.sections() {
                match section {
                    Section::Algorithm { initial: false, statements: own, span } => {
                        if std::mem::replace(&mut has_algorithm, true) {
                            let name = &text.name;
                            return Err(fault!(
                                TYPE_MISMATCH,
                                "function `{name}` has more than one algorithm"
                            )
                            .at(*span));
                        }
                        statements.extend(self.statements(own, context, local)?);
                    }
                    Section::Algorithm { span, .. } | Section::Equations { span, .. } => {
                        let name = &text.name;
                        return Err(fault!(
                            TYPE_MISMATCH,
                            "function `{name}` has equations; write an algorithm"
                        )
                        .at(*span));
                    }
                    Section::External(external) => {
                        let mut external = external.clone();
                        external.annotation = annotation_of(&external, &text);
                        for argument in &mut external.arguments {
                            *argument = self.resolve(argument, context, local)?;
                        }
                        return Ok(FunctionBody::External(external));
                    }
                    Section::Elements { .. } | Section::Annotation(_) => {}
                }
            }
        }
        Ok(FunctionBody::Algorithm(statements))
    }

    /// Statements with their names resolved.
    pub(crate) fn statements(
        &mut self,
        statements: &[Statement],
        context: ScopeId,
        local: &Local,
    ) -> Result<Vec<Statement>, Diagnostic> {
        let mut resolved = Vec::with_capacity(statements.len());
        for statement in statements {
            match self.statement(statement, context, local) {
                Ok(one) if self.runs_over_values(&one, local) => {
                    match self.iterations_of_statement(statement, context, local) {
                        Some(iterations) => resolved.extend(iterations?),
                        None => resolved.push(one),
                    }
                }
                Ok(one) => resolved.push(one),
                Err(error) => match self.iterations_of_statement(statement, context, local) {
                    Some(iterations) => resolved.extend(iterations?),
                    None => return Err(error),
                },
            }
        }
        Ok(resolved)
    }

    fn statement(
        &mut self,
        statement: &Statement,
        context: ScopeId,
        local: &Local,
    ) -> Result<Statement, Diagnostic> {
        let kind = match &statement.kind {
            StatementKind::Assign { target, value } => StatementKind::Assign {
                target: self.target(target, context, local)?,
                value: self.resolve(value, context, local)?,
            },
            StatementKind::MultiAssign { targets, value } => StatementKind::MultiAssign {
                targets: targets
                    .iter()
                    .map(|t| t.as_ref().map(|t| self.target(t, context, local)).transpose())
                    .collect::<Result<_, Diagnostic>>()?,
                value: self.resolve(value, context, local)?,
            },
            StatementKind::Call(call) => StatementKind::Call(self.resolve(call, context, local)?),
            StatementKind::If { branches, otherwise } => StatementKind::If {
                branches: self.statement_branches(branches, context, local)?,
                otherwise: self.statements(otherwise, context, local)?,
            },
            StatementKind::For { indices, body } => {
                let visit =
                    |uses: &mut dyn Visit| body.iter().for_each(|inner| uses.statement(inner));
                self.check_range_stays(indices, body, context)?;
                let indices = self.with_ranges(indices, context, local, &visit)?;
                let (mut indices, inner) = self.iterators(&indices, context, local)?;
                if self.classes.is_in_model(context) {
                    indices.iter_mut().for_each(|index| self.evaluate_range(index));
                }
                StatementKind::For { indices, body: self.statements(body, context, &inner)? }
            }
            StatementKind::While { condition, body } => StatementKind::While {
                condition: self.resolve(condition, context, local)?,
                body: self.statements(body, context, local)?,
            },
            StatementKind::When { branches } => {
                let acting = Local { impure: true, ..local.clone() };
                StatementKind::When {
                    branches: self.statement_branches(branches, context, &acting)?,
                }
            }
            StatementKind::Break => StatementKind::Break,
            StatementKind::Return => StatementKind::Return,
        };
        Ok(Statement { kind, comment: statement.comment.clone(), span: statement.span })
    }

    /// Writes the values of a loop variable out where parameters give them: an algorithm of a model
    /// is unrolled, as loops of equations are.
    fn evaluate_range(&mut self, index: &mut ForIndex) {
        let Some(range) = &mut index.range else { return };
        if let Ok(values) = self.range_values(range) {
            let span = range.span;
            let values = values.iter().map(|value| literal(value, span)).collect();
            *range = Expression::new(ExpressionKind::Array(values), span);
        }
    }

    fn statement_branches(
        &mut self,
        branches: &[(Expression, Vec<Statement>)],
        context: ScopeId,
        local: &Local,
    ) -> Result<Vec<(Expression, Vec<Statement>)>, Diagnostic> {
        branches
            .iter()
            .map(|(condition, body)| {
                let condition = self.resolve(condition, context, local)?;
                Ok((condition, self.statements(body, context, local)?))
            })
            .collect()
    }

    fn target(
        &mut self,
        target: &ComponentReference,
        context: ScopeId,
        local: &Local,
    ) -> Result<ComponentReference, Diagnostic> {
        let span = target.span;
        if let Some(first) = target.parts.first().map(|part| part.name)
            && local.read_only.contains(&first)
        {
            return Err(fault!(TYPE_MISMATCH, "`{first}` is an input and cannot be assigned to";
                help: "assign to a protected variable instead")
            .at(span));
        }
        let e = Expression::new(ExpressionKind::Reference(target.clone()), span);
        let resolved = self.resolve(&e, context, local)?;
        let resolved = match &resolved.kind {
            ExpressionKind::Array(elements) => {
                self.array_of_records(target, elements, context, local)?
            }
            _ => record_or_variable(resolved),
        };
        match resolved {
            Some(resolved) => Ok(resolved),
            None => {
                Err(fault!(TYPE_MISMATCH, "`{}` cannot be assigned to", target.name()).at(span))
            }
        }
    }
}

impl Instantiation<'_> {
    /// The flat name of an array of records, or of a component of its elements: that of an element,
    /// with the subscripts that are written. `None` without elements.
    fn array_of_records(
        &mut self,
        written: &ComponentReference,
        elements: &[Expression],
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<ComponentReference>, Diagnostic> {
        let Some(mut found) = elements.first().cloned().and_then(record_or_variable) else {
            return Ok(None);
        };
        let Some(before) = found.parts.len().checked_sub(written.parts.len()) else {
            return Ok(None);
        };
        for (part, written) in found.parts[before..].iter_mut().zip(&written.parts) {
            part.subscripts = self.subscripts(&written.subscripts, context, local)?;
        }
        found.span = written.span;
        Ok(Some(found))
    }
}

impl Classes<'_> {
    /// Whether a class declares another one after `protected`.
    fn is_protected_class(&self, scope: ScopeId, name: Ident) -> bool {
        let class = self.text(scope).id.map(|id| self.library.class(id));
        class.is_some_and(|class| {
            class.elements().any(|(visibility, element)| match element {
                Element::Class(nested) => {
                    nested.class.name.node == name && visibility == Visibility::Protected
                }
                _ => false,
            })
        })
    }

    /// Whether the library has this very function under its name, not the same text in another
    /// environment: a package that extends others modifies what their functions see.
    fn is_found_as(&mut self, name: &Name, id: ScopeId) -> bool {
        !matches!(self.class_named(name), Ok(Some(Type::Class(found))) if found != id)
    }

    fn long_class(&mut self, mut id: ScopeId) -> Result<ScopeId, Diagnostic> {
        for _ in 0..100 {
            let ClassSpecifier::Short(_) = &self.text(id).definition.specifier else { break };
            match self.bases(id)?.first() {
                Some(base) => id = *base,
                None => break,
            }
        }
        Ok(id)
    }

    /// Whether a scope is of a model, not of a function.
    pub(crate) fn is_in_model(&self, context: ScopeId) -> bool {
        context != ScopeId::TOP && !self.tree.in_package(self.node_of(context))
    }
}

impl FunctionTable {
    /// The name with a number. Functions of one instantiation alone differ by it; those
    /// asked for one by one meet, so that their names say for which one they were made.
    fn numbered(&self, name: &Name, number: usize) -> Name {
        let last = name.last().map_or("", Ident::as_str).trim_matches('\'').to_owned();
        let origin = self.asked.as_ref().map_or(String::new(), |name| format!(" in {name}"));
        name.parent().child(Ident::new(&format!("'{last}${number}{origin}'")))
    }
}

/// The path of a variable, or of a record, whose components a constructor lists.
fn record_or_variable(e: Expression) -> Option<ComponentReference> {
    match e.kind {
        ExpressionKind::Reference(reference) => Some(reference),
        ExpressionKind::Call { arguments, .. } => arguments.named.into_iter().find_map(|one| {
            let mut path = record_or_variable(one.value)?;
            let component = path.parts.pop()?;
            let is_record = component.name == one.name.node && !path.parts.is_empty();
            is_record.then_some(path)
        }),
        // A component that is an array of records.
        ExpressionKind::Array(elements) => record_or_variable(elements.into_iter().next()?),
        _ => None,
    }
}

/// Whether two functions of one name do the same; of one that calls itself nothing is known.
fn same_function(known: &Function, other: &Function) -> bool {
    known == other
}

/// A component of a function with what it is.
struct Declared {
    causality: Option<CausalityPrefix>,
    component: FunctionComponent,
}

fn description(specifier: &ClassSpecifier) -> Option<Arc<str>> {
    match specifier {
        ClassSpecifier::Long(long) => long.description.clone(),
        ClassSpecifier::Short(short) => short.comment.text.clone(),
        _ => None,
    }
}

fn annotation(sections: &[Section]) -> Vec<Argument> {
    let arguments = sections.iter().filter_map(|section| match section {
        Section::Annotation(annotation) => Some(annotation.arguments.clone()),
        _ => None,
    });
    arguments.flatten().collect()
}

/// The annotation of an external clause; what names code may be in that of the function, after a
/// semicolon (`external "C"; annotation(Include = …);`, as older libraries write it).
fn annotation_of(external: &External, text: &Text) -> Option<Annotation> {
    let own = external.annotation.clone();
    if own.is_some() {
        return own;
    }
    let names_code = |argument: &Argument| match argument {
        Argument::Element(element) => element.name.node.last().is_some_and(|name| {
            ["Include", "IncludeDirectory", "Library", "LibraryDirectory"].contains(&name.as_str())
        }),
        Argument::Redeclaration(_) => false,
    };
    text.sections().iter().find_map(|section| match section {
        Section::Annotation(annotation) if annotation.arguments.iter().any(names_code) => {
            Some(annotation.clone())
        }
        _ => None,
    })
}
