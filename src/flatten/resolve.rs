//! Resolves the names in expressions: components become their flat paths, constants of packages
//! their values, functions their full names (MLS §5.3, §5.6.2).

use super::errors::{
    NOT_CONSTANT, NOT_SUPPORTED, PROTECTED_ACCESS, SIZE_MISMATCH, TOO_LARGE, UNKNOWN_NAME,
};
use super::instance::{MemberState, NodeId, NodeKind};
use super::instantiation::Instantiation;
use super::lookup::Type;
use super::scope::ScopeId;
use crate::diag::{Diagnostic, suggest};
use crate::eval::ValueType;
use crate::fault;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    Arguments, ComponentReference, Expression, ExpressionKind, NamedArgument, ReferencePart,
    Subscript, UnaryOperator,
};
use crate::value::Value;
use std::rc::Rc;

/// The deepest nesting of expressions, bindings that lead to one another included.
const MAX_DEPTH: usize = 400;

/// What the resolution of an expression knows besides its scope.
#[derive(Clone, Default)]
pub(super) struct Local {
    /// Loop variables and variables of a function, innermost last; those of an unrolled loop with
    /// their value.
    pub(super) names: Vec<(Ident, Option<Expression>)>,
    /// Inputs of a function.
    pub(super) read_only: Vec<Ident>,
    /// Types of the variables of a function.
    pub(super) types: Rc<Vec<(Ident, ValueType)>>,
    /// Whether variables are replaced by their values, which must be constant.
    pub(super) values: bool,
    /// Whether impure functions may be called: in parameters, initial sections and when-clauses
    /// (MLS §12.3).
    pub(super) impure: bool,
    /// Whether names are flat paths, to which protected components are no secret.
    pub(super) flat: bool,
}

impl Local {
    fn get(&self, name: Ident) -> Option<&Option<Expression>> {
        self.names.iter().rev().find(|(known, _)| *known == name).map(|(_, value)| value)
    }

    /// This with more names that stay as they are.
    pub(super) fn with(&self, names: impl IntoIterator<Item = Ident>) -> Local {
        let mut local = self.clone();
        local.names.extend(names.into_iter().map(|name| (name, None)));
        local
    }
}

impl Instantiation<'_> {
    /// The expression with its names resolved.
    pub(super) fn resolve(
        &mut self,
        e: &Expression,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        if self.depth >= MAX_DEPTH {
            return Err(fault!(TOO_LARGE, "expressions are nested too deeply").at(e.span));
        }
        self.depth += 1;
        let resolved = self.resolve_kind(e, context, local);
        self.depth -= 1;
        resolved
    }

    fn resolve_kind(
        &mut self,
        e: &Expression,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let sub = |this: &mut Self, inner: &Expression| this.resolve(inner, context, local);
        let kind = match &e.kind {
            ExpressionKind::Real(_)
            | ExpressionKind::Integer(_)
            | ExpressionKind::Boolean(_)
            | ExpressionKind::String(_)
            | ExpressionKind::TypeName(_)
            | ExpressionKind::Code(_)
            | ExpressionKind::End => e.kind.clone(),
            ExpressionKind::Reference(reference) => {
                return self.reference(reference, context, local);
            }
            ExpressionKind::Call { function, arguments } => {
                return self.call(e.span, function, arguments, context, local);
            }
            ExpressionKind::PartialApplication { function, named } => {
                let function = self.function_name(function, context, e.span)?;
                let named = self.named_arguments(named, context, local)?;
                ExpressionKind::PartialApplication { function, named }
            }
            ExpressionKind::Unary { operator, operand } => {
                let operand = sub(self, operand)?;
                let sign = match operator {
                    UnaryOperator::Minus | UnaryOperator::ElementwiseMinus => "'-'",
                    UnaryOperator::Not => "'not'",
                    UnaryOperator::Plus | UnaryOperator::ElementwisePlus => "'+'",
                };
                if let Some(call) = self.overloaded_unary(sign, &operand, local, e.span)? {
                    return Ok(call);
                }
                ExpressionKind::Unary { operator: *operator, operand: Box::new(operand) }
            }
            ExpressionKind::Binary { operator, left, right } => {
                let (left, right) = (sub(self, left)?, sub(self, right)?);
                let call = self.overloaded_binary(*operator, &left, &right, local, e.span)?;
                if let Some(call) = call {
                    return Ok(call);
                }
                ExpressionKind::Binary {
                    operator: *operator,
                    left: Box::new(left),
                    right: Box::new(right),
                }
            }
            ExpressionKind::If { branches, otherwise } => {
                return self.if_expression(e.span, branches, otherwise, context, local);
            }
            ExpressionKind::Range { start, step: None, stop }
                if is_boolean(start) && is_boolean(stop) =>
            {
                ExpressionKind::Array(booleans(start, stop))
            }
            ExpressionKind::Range { start, step, stop } => ExpressionKind::Range {
                start: Box::new(sub(self, start)?),
                step: step.as_ref().map(|step| sub(self, step).map(Box::new)).transpose()?,
                stop: Box::new(sub(self, stop)?),
            },
            ExpressionKind::Array(elements) => {
                ExpressionKind::Array(self.all(elements, context, local)?)
            }
            ExpressionKind::Comprehension { element, indices } => {
                return self.comprehension(element, indices, e.span, context, local);
            }
            ExpressionKind::Matrix(rows) => ExpressionKind::Matrix(
                rows.iter()
                    .map(|row| self.all(row, context, local))
                    .collect::<Result<_, Diagnostic>>()?,
            ),
            ExpressionKind::Tuple(parts) => ExpressionKind::Tuple(
                parts
                    .iter()
                    .map(|part| part.as_ref().map(|part| sub(self, part)).transpose())
                    .collect::<Result<_, Diagnostic>>()?,
            ),
            ExpressionKind::Subscripted { base, subscripts } => {
                let base = sub(self, base)?;
                let subscripts = self.subscripts(subscripts, context, local)?;
                return Ok(subscripted(base, subscripts, e.span));
            }
            ExpressionKind::Field { base, name } => {
                return self.field_of(base, *name, e.span, context, local);
            }
        };
        Ok(Expression::new(kind, e.span))
    }

    /// Branches whose conditions hold no variables are chosen at once: the others may name what
    /// does not exist, such as the element before the first one.
    fn if_expression(
        &mut self,
        span: Span,
        branches: &[(Expression, Expression)],
        otherwise: &Expression,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let mut resolved = Vec::with_capacity(branches.len());
        for (condition, value) in branches {
            let condition = self.resolve(condition, context, local)?;
            match self.literal_condition(&condition) {
                Some(true) if resolved.is_empty() => return self.resolve(value, context, local),
                Some(false) => continue,
                _ => resolved.push((condition, self.resolve(value, context, local)?)),
            }
        }
        let otherwise = self.resolve(otherwise, context, local)?;
        if resolved.is_empty() {
            return Ok(otherwise);
        }
        let kind = ExpressionKind::If { branches: resolved, otherwise: Box::new(otherwise) };
        Ok(Expression::new(kind, span))
    }

    /// The value of a resolved condition without references.
    fn literal_condition(&mut self, condition: &Expression) -> Option<bool> {
        if let ExpressionKind::Boolean(truth) = condition.kind {
            return Some(truth);
        }
        if !super::types::has_only_literals(condition) {
            return None;
        }
        match self.flat_value(condition) {
            Ok(Value::Boolean(truth)) => Some(truth),
            _ => None,
        }
    }

    pub(super) fn all(
        &mut self,
        expressions: &[Expression],
        context: ScopeId,
        local: &Local,
    ) -> Result<Vec<Expression>, Diagnostic> {
        expressions.iter().map(|e| self.resolve(e, context, local)).collect()
    }

    pub(super) fn named_arguments(
        &mut self,
        named: &[NamedArgument],
        context: ScopeId,
        local: &Local,
    ) -> Result<Vec<NamedArgument>, Diagnostic> {
        named
            .iter()
            .map(|argument| {
                let value = self.resolve(&argument.value, context, local)?;
                Ok(NamedArgument { name: argument.name, value })
            })
            .collect()
    }

    pub(super) fn subscripts(
        &mut self,
        subscripts: &[Subscript],
        context: ScopeId,
        local: &Local,
    ) -> Result<Vec<Subscript>, Diagnostic> {
        subscripts
            .iter()
            .map(|subscript| match subscript {
                Subscript::All(span) => Ok(Subscript::All(*span)),
                Subscript::Index(e) => {
                    let index = match self.type_range(e, context, local)? {
                        Some(values) => values,
                        None => self.resolve(e, context, local)?,
                    };
                    Ok(Subscript::Index(self.boolean_subscript(index, local)))
                }
            })
            .collect()
    }

    fn call(
        &mut self,
        span: Span,
        function: &ComponentReference,
        arguments: &Arguments,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        if let Some(value) = self.connection_operator(span, function, arguments, context, local)? {
            return Ok(value);
        }
        if let Some(value) = self.conversion(span, function, arguments, context, local)? {
            return Ok(value);
        }
        if let Some(name) = function.as_ident()
            && let Some(size) = self.size_call(name.as_str(), arguments, context, local, span)?
        {
            return Ok(size);
        }
        if function.as_ident().is_some_and(|name| name == "getInstanceName")
            && context != ScopeId::TOP
            && !self.in_package(self.node_of(context))
        {
            let name = self.instance_name(context);
            return Ok(Expression::new(ExpressionKind::String(name.into()), span));
        }
        if self.is_array_constructor(function, arguments, context)? {
            let elements = self.all(&arguments.positional, context, local)?;
            return Ok(Expression::new(ExpressionKind::Array(elements), span));
        }
        let arguments = self.arguments(arguments, context, local)?;
        let name = if function.as_ident().is_some_and(|name| local.get(name).is_some()) {
            function.name()
        } else {
            self.function_name(&function.name(), context, function.span)?
        };
        let name = match self.lookup(context, &function.name())? {
            Some(Type::Class(class)) => {
                self.overloaded_constructor(class, &arguments, local)?.unwrap_or(name)
            }
            _ => name,
        };
        let impure =
            self.functions.get(&name).is_some_and(|f| f.as_ref().is_some_and(|f| f.impure));
        if impure
            && !local.impure
            && !self.in_package(self.node_of(context))
            && context != ScopeId::TOP
        {
            return Err(
                fault!(NOT_SUPPORTED, "`{name}` is impure and cannot be called in a model yet";
                help: "declare it `pure` if equal arguments always give equal values")
                .at(span),
            );
        }
        let arguments = self.with_defaults(&name, arguments, span);
        let (name, arguments) = self.specialized(name, arguments, span, 0)?;
        if let Some(calls) = self.vectorized(&name, &arguments, span)? {
            return Ok(calls);
        }
        let function = ComponentReference::from_name(&name, function.span);
        let kind = ExpressionKind::Call { function, arguments: Box::new(arguments) };
        Ok(Expression::new(kind, span))
    }

    /// Whether a call is `array(a, b)`, another form of `{a, b}` (MLS §10.4).
    fn is_array_constructor(
        &mut self,
        function: &ComponentReference,
        arguments: &Arguments,
        context: ScopeId,
    ) -> Result<bool, Diagnostic> {
        let is_named = function.as_ident().is_some_and(|name| name == "array");
        let lists = arguments.iterators.is_empty()
            && arguments.named.is_empty()
            && !arguments.positional.is_empty();
        Ok(is_named && lists && self.lookup(context, &function.name())?.is_none())
    }

    /// The class that is simulated, and the path to the instance (MLS §3.7.4.4).
    fn instance_name(&self, context: ScopeId) -> String {
        match self.nodes[self.node_of(context).0].path.as_str() {
            "" => self.model_name.to_string(),
            path => format!("{}.{path}", self.model_name),
        }
    }

    /// A reference as an expression: `time`, a loop variable, a component or a constant.
    fn reference(
        &mut self,
        reference: &ComponentReference,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let first = &reference.parts[0];
        if !reference.global {
            if let Some(value) = local.get(first.name) {
                return match value {
                    Some(value) if reference.as_ident().is_some() => Ok(value.clone()),
                    _ => self.local_reference(reference, context, local),
                };
            }
            if self.has_component(context, first.name)? {
                let node = self.node_of(context);
                return self.walk(node, &reference.parts, reference, context, local);
            }
            if reference.as_ident().is_some_and(|name| name == "time") {
                if local.values {
                    return Err(fault!(NOT_CONSTANT, "`time` is not known at translation")
                        .at(reference.span));
                }
                return Ok(Expression::new(
                    ExpressionKind::Reference(reference.clone()),
                    reference.span,
                ));
            }
        }
        self.constant(reference, context, local)
    }

    fn local_reference(
        &mut self,
        reference: &ComponentReference,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let mut parts = Vec::with_capacity(reference.parts.len());
        for part in &reference.parts {
            let subscripts = self.subscripts(&part.subscripts, context, local)?;
            parts.push(ReferencePart { name: part.name, subscripts });
        }
        let resolved = ComponentReference { global: false, parts, span: reference.span };
        Ok(Expression::new(ExpressionKind::Reference(resolved), reference.span))
    }

    /// Follows a reference through the components of a node.
    pub(super) fn walk(
        &mut self,
        node: NodeId,
        parts: &[ReferencePart],
        whole: &ComponentReference,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let Some((part, rest)) = parts.split_first() else {
            return self.whole_instance(node, whole, context, local);
        };
        let Some(state) = self.member(node, part.name)? else {
            return Err(self.unknown_component(node, part.name, whole.span));
        };
        if let (MemberState::Outer(_), Some(next)) = (&state, rest.first()) {
            self.check_outer_element(node, part.name, next.name, whole.span)?;
        }
        let state = state.seen();
        if !local.flat && parts.len() < whole.parts.len() && self.is_protected(node, part.name) {
            let path = &self.nodes[node.0].path;
            return Err(fault!(
                PROTECTED_ACCESS,
                "`{}` is protected in `{}`",
                part.name,
                path.trim_start_matches('.')
            )
            .at(whole.span));
        }
        if !local.flat && !part.subscripts.is_empty() {
            self.check_subscript_types(node, part)?;
        }
        match state {
            MemberState::Single(id) => {
                if let NodeKind::Variable(_) = self.nodes[id.0].kind {
                    if let Some(next) = rest.first() {
                        let path = &self.nodes[id.0].path;
                        return Err(fault!(
                            UNKNOWN_NAME,
                            "`{path}` is a variable and has no component `{}`",
                            next.name
                        )
                        .at(whole.span));
                    }
                    let subscripts = self.subscripts(&part.subscripts, context, local)?;
                    return self.variable_reference(id, subscripts, whole.span, local);
                }
                if !part.subscripts.is_empty() {
                    return Err(
                        fault!(SIZE_MISMATCH, "`{}` is not an array", part.name).at(whole.span)
                    );
                }
                self.walk(id, rest, whole, context, local)
            }
            MemberState::Array(dims, nodes) => {
                let subscripts = self.subscripts(&part.subscripts, context, local)?;
                let chosen = self.choose(&dims, &subscripts, part.name, whole.span)?;
                self.walk_array(&chosen, &dims, &nodes, rest, whole, context, local)
            }
            MemberState::Absent => Err(fault!(
                UNKNOWN_NAME,
                "`{}` does not exist, because its condition is false or it has an error",
                part.name
            )
            .at(whole.span)),
            MemberState::Pending | MemberState::Busy => {
                Err(fault!(NOT_CONSTANT, "`{}` depends on itself", part.name).at(whole.span))
            }
            MemberState::Outer(_) | MemberState::Both { .. } => Err(fault!(
                NOT_CONSTANT,
                "`{}` is an outer component of one that is outer itself",
                part.name
            )
            .at(whole.span)),
        }
    }

    /// The elements of an array of components that subscripts choose: for every dimension the
    /// indices, and whether the dimension stays.
    pub(super) fn choose(
        &mut self,
        dims: &[usize],
        subscripts: &[Subscript],
        name: Ident,
        span: Span,
    ) -> Result<Vec<(Vec<usize>, bool)>, Diagnostic> {
        if subscripts.len() > dims.len() {
            return Err(fault!(SIZE_MISMATCH, "`{name}` has {} dimensions", dims.len()).at(span));
        }
        let mut chosen = Vec::with_capacity(dims.len());
        for (at, size) in dims.iter().enumerate() {
            chosen.push(match subscripts.get(at) {
                None | Some(Subscript::All(_)) => ((1..=*size).collect(), true),
                Some(Subscript::Index(e)) => self.indices(e, *size, name)?,
            });
        }
        Ok(chosen)
    }

    fn indices(
        &mut self,
        e: &Expression,
        size: usize,
        name: Ident,
    ) -> Result<(Vec<usize>, bool), Diagnostic> {
        let e = at_end(e, size);
        let value = match &e.kind {
            ExpressionKind::Integer(index) => Value::Integer(*index),
            // The expression is resolved already: its references are flat paths.
            _ => self.flat_value(&e)?,
        };
        let checked = |index: i64| match usize::try_from(index) {
            Ok(index) if (1..=size).contains(&index) => Ok(index),
            _ => Err(fault!(SIZE_MISMATCH, "`{name}` has {size} elements, not one number {index}")
                .at(e.span)),
        };
        match value {
            Value::Integer(index) => Ok((vec![checked(index)?], false)),
            Value::Array(array) => {
                let all: Result<Vec<usize>, Diagnostic> = (0..array.elements.len())
                    .map(|at| match array.elements.get(at) {
                        Value::Integer(index) => checked(index),
                        other => Err(fault!(
                            SIZE_MISMATCH,
                            "an index must be Integer, not {}",
                            other.type_name()
                        )
                        .at(e.span)),
                    })
                    .collect();
                Ok((all?, true))
            }
            other => {
                Err(fault!(SIZE_MISMATCH, "an index must be Integer, not {}", other.type_name())
                    .at(e.span))
            }
        }
    }

    #[allow(clippy::too_many_arguments, reason = "the state of one recursion")]
    fn walk_array(
        &mut self,
        chosen: &[(Vec<usize>, bool)],
        dims: &[usize],
        nodes: &[NodeId],
        rest: &[ReferencePart],
        whole: &ComponentReference,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let Some(((indices, stays), more)) = chosen.split_first() else {
            return self.walk(nodes[0], rest, whole, context, local);
        };
        let stride: usize = dims[1..].iter().product();
        let mut elements = Vec::with_capacity(indices.len());
        for index in indices {
            let part = &nodes[(index - 1) * stride..index * stride];
            elements.push(self.walk_array(more, &dims[1..], part, rest, whole, context, local)?);
        }
        Ok(match (*stays, elements.len()) {
            (false, 1) => elements.remove(0),
            _ => Expression::new(ExpressionKind::Array(elements), whole.span),
        })
    }

    /// An instance named as a whole: a record becomes a call of its constructor.
    fn whole_instance(
        &mut self,
        node: NodeId,
        whole: &ComponentReference,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let Some(class) = self.composite_of(node).map(|composite| composite.class) else {
            return self.variable_reference(node, Vec::new(), whole.span, local);
        };
        if !self.is_record(class) {
            let path = &self.nodes[node.0].path;
            return Err(
                fault!(NOT_SUPPORTED, "`{path}` is no record and has no value").at(whole.span)
            );
        }
        let members = self.members(node)?;
        let mut named = Vec::with_capacity(members.len());
        for (name, _) in members {
            let part = ReferencePart { name, subscripts: Vec::new() };
            let value = self.walk(node, &[part], whole, context, local)?;
            let name = crate::source::Spanned { node: name, span: whole.span };
            named.push(NamedArgument { name, value });
        }
        let constructor = self.record_constructor(class, whole.span)?;
        let arguments = Box::new(Arguments { named, ..Arguments::default() });
        let function = ComponentReference::from_name(&constructor, whole.span);
        Ok(Expression::new(ExpressionKind::Call { function, arguments }, whole.span))
    }

    fn variable_reference(
        &mut self,
        node: NodeId,
        subscripts: Vec<Subscript>,
        span: Span,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let NodeKind::Variable(leaf) = &self.nodes[node.0].kind else {
            return Err(fault!(UNKNOWN_NAME, "not a variable").at(span));
        };
        let variable = leaf.variable;
        if local.values || self.in_package(node) {
            let value = self.value(variable, span)?;
            return Ok(subscripted(literal(&value, span), subscripts, span));
        }
        let mut reference = flat_reference(&self.nodes[node.0].path, span);
        if let Some(last) = reference.parts.last_mut() {
            last.subscripts = subscripts;
        }
        Ok(Expression::new(ExpressionKind::Reference(reference), span))
    }

    fn field_of(
        &mut self,
        base: &Expression,
        name: Ident,
        span: Span,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        // A component of a named record is that component; anything else is computed first.
        if let ExpressionKind::Reference(reference) = &base.kind {
            let mut longer = reference.clone();
            longer.parts.push(ReferencePart { name, subscripts: Vec::new() });
            return self.reference(&longer, context, local);
        }
        if let ExpressionKind::Subscripted { base: inner, subscripts } = &base.kind
            && let ExpressionKind::Reference(reference) = &inner.kind
            && let Some(mut longer) = self.element_of(reference, subscripts, context, local)?
        {
            longer.parts.push(ReferencePart { name, subscripts: Vec::new() });
            return self.reference(&longer, context, local);
        }
        let base = self.resolve(base, context, local)?;
        Ok(Expression::new(ExpressionKind::Field { base: Box::new(base), name }, span))
    }

    /// `(a.b)[i]` as a reference, with the subscripts at the parts that are arrays: `a[i].b` if `a`
    /// is one.
    fn element_of(
        &mut self,
        reference: &ComponentReference,
        subscripts: &[Subscript],
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<ComponentReference>, Diagnostic> {
        let mut found = reference.clone();
        let mut given = subscripts.iter().cloned();
        let first = reference.parts[0].name;
        let is_component = !reference.global && local.get(first).is_none();
        let mut node = match is_component && self.has_component(context, first)? {
            true => Some(self.node_of(context)),
            false => None,
        };
        let count = found.parts.len();
        for (at, part) in found.parts.iter_mut().enumerate() {
            let rank = match node {
                Some(holder) => {
                    let (rank, next) = self.rank_of_member(holder, part.name)?;
                    node = next;
                    rank
                }
                None => None,
            };
            let is_last = at + 1 == count;
            let wanted = if is_last { usize::MAX } else { rank.unwrap_or(0) };
            if part.subscripts.is_empty() {
                part.subscripts = given.by_ref().take(wanted).collect();
            }
        }
        Ok(given.next().is_none().then_some(found))
    }

    /// How many dimensions a component has, and the instance in which those of its components are
    /// looked for.
    fn rank_of_member(
        &mut self,
        node: NodeId,
        name: Ident,
    ) -> Result<(Option<usize>, Option<NodeId>), Diagnostic> {
        Ok(match self.member(node, name)?.map(MemberState::seen) {
            Some(MemberState::Single(one)) => (Some(0), Some(one)),
            Some(MemberState::Array(dims, nodes)) => (Some(dims.len()), nodes.first().copied()),
            _ => (None, None),
        })
    }

    /// Whether a component is protected in the class of its node.
    fn is_protected(&self, node: NodeId, name: Ident) -> bool {
        self.declaration_of(node, name).is_some_and(|declaration| declaration.protected)
    }

    pub(super) fn unknown_component(&self, node: NodeId, name: Ident, span: Span) -> Diagnostic {
        let text = self.scope_of(node).and_then(|scope| self.scope(scope).text.as_ref());
        let Some(text) = text else {
            return fault!(UNKNOWN_NAME, "`{name}` is unknown").at(span);
        };
        let class = &text.name;
        let known = self.component_names(node);
        let known = known.iter().map(|known| known.as_str());
        fault!(UNKNOWN_NAME, "`{class}` has no component `{name}`")
            .help_if(suggest::did_you_mean(name.as_str(), known))
            .at(span)
    }

    fn component_names(&self, node: NodeId) -> Vec<Ident> {
        let members = self.composite_of(node).and_then(|composite| composite.members.as_ref());
        members.map_or(Vec::new(), |members| members.keys().copied().collect())
    }

    /// The diagnostic for a name that is neither a component nor a constant.
    pub(super) fn unknown_name(
        &self,
        reference: &ComponentReference,
        context: ScopeId,
    ) -> Diagnostic {
        let name = reference.name();
        let known = self.component_names(self.node_of(context));
        let first = name.first().map_or("", Ident::as_str);
        fault!(UNKNOWN_NAME, "`{name}` is not declared")
            .help_if(suggest::did_you_mean(first, known.iter().map(|known| known.as_str())))
            .at(reference.span)
    }
}

/// A flat path as a reference.
pub(super) fn flat_reference(path: &str, span: Span) -> ComponentReference {
    let mut parts = Vec::new();
    let mut rest = path;
    while !rest.is_empty() {
        let (text, after) = next_part(rest);
        rest = after;
        let (name, indices) = match text.strip_suffix(']').and_then(|t| t.rsplit_once('[')) {
            Some((name, indices)) => (name, indices),
            None => (text, ""),
        };
        let subscripts = indices
            .split(',')
            .filter_map(|index| index.parse().ok())
            .map(|index| Subscript::Index(Expression::new(ExpressionKind::Integer(index), span)))
            .collect();
        parts.push(ReferencePart { name: Ident::new(name), subscripts });
    }
    ComponentReference { global: false, parts, span }
}

/// The path up to the next dot outside quotes, and what follows.
fn next_part(path: &str) -> (&str, &str) {
    let mut quoted = false;
    for (at, character) in path.char_indices() {
        match character {
            '\'' => quoted = !quoted,
            '.' if !quoted => return (&path[..at], &path[at + 1..]),
            _ => {}
        }
    }
    (path, "")
}

/// A value written as an expression.
pub(super) fn literal(value: &Value, span: Span) -> Expression {
    let kind = match value {
        Value::Real(number) => ExpressionKind::Real(*number),
        Value::Integer(number) => ExpressionKind::Integer(*number),
        Value::Boolean(truth) => ExpressionKind::Boolean(*truth),
        Value::String(text) => ExpressionKind::String(text.clone()),
        Value::Enumeration(value) => ExpressionKind::Integer(value.ordinal),
        Value::Array(array) => return array_literal(&array.dims, 0, array, span),
        Value::Record(record) => {
            let named = record.fields.iter().map(|(name, value)| NamedArgument {
                name: crate::source::Spanned { node: *name, span },
                value: literal(value, span),
            });
            let arguments = Arguments { named: named.collect(), ..Arguments::default() };
            ExpressionKind::Call {
                function: ComponentReference::from_name(&record.type_name, span),
                arguments: Box::new(arguments),
            }
        }
        Value::TypeName(name) => {
            ExpressionKind::Reference(ComponentReference::from_name(name, span))
        }
        Value::VariableName(name) => {
            ExpressionKind::Reference(ComponentReference::from_name(&Name::parse(name), span))
        }
        Value::Function(function) => {
            ExpressionKind::Reference(ComponentReference::from_name(&function.name, span))
        }
        Value::External(object) => {
            ExpressionKind::Reference(ComponentReference::from_name(&object.class, span))
        }
        Value::Tuple(values) => {
            ExpressionKind::Tuple(values.iter().map(|value| Some(literal(value, span))).collect())
        }
    };
    Expression::new(kind, span)
}

fn array_literal(
    dims: &[usize],
    offset: usize,
    array: &crate::value::ArrayValue,
    span: Span,
) -> Expression {
    let Some((size, inner)) = dims.split_first() else {
        return literal(&array.elements.get(offset), span);
    };
    let stride: usize = inner.iter().product();
    let elements: Vec<Expression> =
        (0..*size).map(|at| array_literal(inner, offset + at * stride, array, span)).collect();
    if elements.is_empty() {
        // An empty constructor has no size: `zeros` has (MLS §10.3.3).
        let sizes = dims.iter().map(|n| Expression::new(ExpressionKind::Integer(*n as i64), span));
        let arguments = Arguments { positional: sizes.collect(), ..Arguments::default() };
        let function = ComponentReference::from_name(&Name::parse("zeros"), span);
        let kind = ExpressionKind::Call { function, arguments: Box::new(arguments) };
        return Expression::new(kind, span);
    }
    Expression::new(ExpressionKind::Array(elements), span)
}

/// `base[subscripts]`, written shortly where the base allows it.
pub(super) fn subscripted(base: Expression, subscripts: Vec<Subscript>, span: Span) -> Expression {
    if subscripts.is_empty() {
        return base;
    }
    let mut base = base;
    let literals: Option<Vec<usize>> = subscripts
        .iter()
        .map(|subscript| match subscript {
            Subscript::Index(Expression { kind: ExpressionKind::Integer(n), .. }) => {
                usize::try_from(*n).ok()
            }
            _ => None,
        })
        .collect();
    if let Some(indices) = literals
        && let Some(element) = element_at(&base, &indices)
    {
        return element.clone();
    }
    if let ExpressionKind::Reference(reference) = &mut base.kind
        && let Some(last) = reference.parts.last_mut()
        && last.subscripts.is_empty()
    {
        last.subscripts = subscripts;
        return base;
    }
    Expression::new(ExpressionKind::Subscripted { base: Box::new(base), subscripts }, span)
}

/// The element of an array constructor.
fn element_at<'e>(base: &'e Expression, indices: &[usize]) -> Option<&'e Expression> {
    let Some((first, rest)) = indices.split_first() else { return Some(base) };
    match &base.kind {
        ExpressionKind::Array(elements) => element_at(elements.get(first.checked_sub(1)?)?, rest),
        _ => None,
    }
}

/// The expression with `end` replaced by a size, where it is the whole of it.
pub(super) fn at_end(e: &Expression, size: usize) -> Expression {
    let mut e = e.clone();
    replace_end(&mut e, size);
    e
}

fn replace_end(e: &mut Expression, size: usize) {
    match &mut e.kind {
        ExpressionKind::End => e.kind = ExpressionKind::Integer(size as i64),
        ExpressionKind::Unary { operand, .. } => replace_end(operand, size),
        ExpressionKind::Binary { left, right, .. } => {
            replace_end(left, size);
            replace_end(right, size);
        }
        ExpressionKind::Range { start, step, stop } => {
            replace_end(start, size);
            if let Some(step) = step {
                replace_end(step, size);
            }
            replace_end(stop, size);
        }
        ExpressionKind::Array(elements) => {
            elements.iter_mut().for_each(|element| replace_end(element, size));
        }
        _ => {}
    }
}

fn is_boolean(e: &Expression) -> bool {
    matches!(e.kind, ExpressionKind::Boolean(_))
}

/// The literals of a range of Booleans (MLS §10.4.3).
fn booleans(start: &Expression, stop: &Expression) -> Vec<Expression> {
    let is_in = |truth: &bool| {
        let below = matches!(start.kind, ExpressionKind::Boolean(true)) && !*truth;
        let above = matches!(stop.kind, ExpressionKind::Boolean(false)) && *truth;
        !below && !above
    };
    let literal = |truth| Expression::new(ExpressionKind::Boolean(truth), start.span.to(stop.span));
    [false, true].into_iter().filter(is_in).map(literal).collect()
}
