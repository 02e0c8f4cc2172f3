//! References followed through the components of instances, to variables, to the elements of arrays
//! of components, and to records as a whole (MLS §5.3.2, §10.5).

use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::{
    CONDITIONAL_COMPONENT, NOT_CONSTANT, NOT_SUPPORTED, PROTECTED_ACCESS, SIZE_MISMATCH,
    UNKNOWN_NAME,
};
use crate::flatten::expressions::local::Local;
use crate::flatten::flat_expression::{flat_reference, literal, subscripted};
use crate::flatten::ids::NodeId;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instance::MemberState;
use crate::flatten::instantiate::instance::NodeKind;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::instantiate::tree::Tree;
use crate::flatten::lookup::classes::Classes;
use crate::flatten::unknown;
use crate::inference::at_end;
use crate::name::{Ident, Name};
use crate::source::{Span, Spanned};
use crate::syntax::ast::{
    Arguments, ComponentReference, Expression, ExpressionKind, NamedArgument, ReferencePart,
    Subscript,
};
use crate::value::Value;
use std::sync::Arc;

impl Instantiation<'_> {
    /// Follows a reference through the components of a node.
    pub(crate) fn walk(
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
            return Err(self.classes.unknown_component(node, part.name, whole.span));
        };
        if let (MemberState::Outer(_), Some(next)) = (&state, rest.first()) {
            self.classes.check_outer_element(node, part.name, next.name, whole.span)?;
        }
        if !local.flat {
            let access = self.classes.check_access(node, parts, whole);
            self.tolerate_protected(access)?;
        }
        let name = part.name;
        match state.seen() {
            MemberState::Single(id) => self.walk_single(id, parts, whole, context, local),
            MemberState::Array(dims, nodes) => {
                self.walk_elements(&dims, &nodes, parts, whole, context, local)
            }
            MemberState::Absent => Err(fault!(
                CONDITIONAL_COMPONENT,
                "`{}` does not exist: its condition is false or its declaration has an error",
                name
            )
            .at(whole.span)),
            MemberState::Pending | MemberState::Busy => {
                Err(fault!(NOT_CONSTANT, "`{}` depends on itself", name).at(whole.span))
            }
            MemberState::Outer(_) | MemberState::Both { .. } => Err(fault!(
                NOT_CONSTANT,
                "`{}` is an outer component inside another outer component",
                name
            )
            .at(whole.span)),
        }
    }

    /// A protected variable that is read is a warning: libraries do it.
    fn tolerate_protected(&mut self, access: Result<(), Diagnostic>) -> Result<(), Diagnostic> {
        match access {
            Err(error) if error.code == PROTECTED_ACCESS && !self.classes.library.is_strict() => {
                self.warnings.add_once(error);
                Ok(())
            }
            access => access,
        }
    }

    /// Follows a reference through a component that is not an array of components.
    fn walk_single(
        &mut self,
        id: NodeId,
        parts: &[ReferencePart],
        whole: &ComponentReference,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let (part, rest) = (&parts[0], &parts[1..]);
        if let NodeKind::Variable(_) = self.classes.tree.nodes[id.0].kind {
            if let Some(next) = rest.first() {
                let path = &self.classes.tree.nodes[id.0].path;
                return Err(unknown::component_of_variable(path, next.name, whole.span));
            }
            let subscripts = self.subscripts(&part.subscripts, context, local)?;
            return self.variable_reference(id, subscripts, whole.span, local);
        }
        if !part.subscripts.is_empty() {
            return Err(fault!(SIZE_MISMATCH, "`{}` is not an array", part.name).at(whole.span));
        }
        self.walk(id, rest, whole, context, local)
    }

    /// Follows a reference through the elements of an array of components that it chooses.
    fn walk_elements(
        &mut self,
        dims: &[usize],
        nodes: &[NodeId],
        parts: &[ReferencePart],
        whole: &ComponentReference,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        let (part, rest) = (&parts[0], &parts[1..]);
        let subscripts = self.subscripts(&part.subscripts, context, local)?;
        let is_constant = nodes.first().is_some_and(|node| self.classes.tree.in_package(*node));
        // The index is known where the function is evaluated.
        let is_open = is_constant && subscripts.iter().any(|s| local.is_open(s));
        let chosen = match is_open {
            true => None,
            false => match self.choose(dims, &subscripts, part.name, whole.span) {
                // The index varies.
                Err(e) if e.code == NOT_CONSTANT && !rest.is_empty() && !local.values => None,
                chosen => Some(chosen?),
            },
        };
        if let Some(chosen) = chosen {
            return self.walk_array(&chosen, dims, nodes, rest, whole, context, local);
        }
        // It chooses among what all elements have of this name.
        let all = self.choose(dims, &[], part.name, whole.span)?;
        let all = self.walk_array(&all, dims, nodes, rest, whole, context, local)?;
        Ok(subscripted(all, subscripts, whole.span))
    }

    /// The elements of an array of components that subscripts choose: for every dimension the
    /// indices, and whether the dimension stays.
    pub(crate) fn choose(
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
            _ => Err(fault!(
                SIZE_MISMATCH,
                "`{name}` has {size} elements; index {index} is out of range"
            )
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
                            "an index must be Integer, but this is {}",
                            other.type_name()
                        )
                        .at(e.span)),
                    })
                    .collect();
                Ok((all?, true))
            }
            other => Err(fault!(
                SIZE_MISMATCH,
                "an index must be Integer, but this is {}",
                other.type_name()
            )
            .at(e.span)),
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
        let Some(class) = self.classes.tree.composite_of(node).map(|composite| composite.class)
        else {
            return self.variable_reference(node, Vec::new(), whole.span, local);
        };
        if !self.classes.is_record(class) {
            let path = &self.classes.tree.nodes[node.0].path;
            return Err(
                fault!(NOT_SUPPORTED, "`{path}` is not a record and has no value").at(whole.span)
            );
        }
        let members = self.classes.members(node)?;
        let mut named = Vec::with_capacity(members.len());
        let outer = self.classes.tree.outer_members(node);
        for (name, _) in members {
            // What an `outer` component of a record is belongs to another instance.
            if outer.contains(&name) {
                continue;
            }
            let part = ReferencePart { name, subscripts: Vec::new() };
            let value = self.walk(node, &[part], whole, context, local)?;
            let name = Spanned { node: name, span: whole.span };
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
        let NodeKind::Variable(leaf) = &self.classes.tree.nodes[node.0].kind else {
            return Err(fault!(UNKNOWN_NAME, "not a variable").at(span));
        };
        let variable = leaf.variable;
        if local.values || self.classes.tree.in_package(node) {
            let value = self.value(variable, span)?;
            if matches!(value, Value::External(_)) {
                // It cannot be written as an expression.
                let name = Ident::new(&self.classes.tree.variables[variable].0.name);
                self.values.objects.insert(name, value);
                let reference = ComponentReference::from_name(&Name::from(name), span);
                return Ok(Expression::new(ExpressionKind::Reference(reference), span));
            }
            return Ok(subscripted(literal(&value, span), subscripts, span));
        }
        let mut reference = flat_reference(&self.classes.tree.nodes[node.0].path, span);
        if let Some(last) = reference.parts.last_mut() {
            last.subscripts = subscripts;
        }
        Ok(Expression::new(ExpressionKind::Reference(reference), span))
    }

    /// A component of a value.
    pub(crate) fn field_of(
        &mut self,
        base: &Expression,
        name: Ident,
        span: Span,
        context: ScopeId,
        local: &Local,
    ) -> Result<Expression, Diagnostic> {
        // A component of a named record is that component; anything else is computed first.
        if let Some(mut longer) = self.component_named(base, context, local)? {
            longer.parts.push(ReferencePart { name, subscripts: Vec::new() });
            return self.reference(&longer, context, local);
        }
        let base = self.resolve(base, context, local)?;
        Ok(Expression::new(ExpressionKind::Field { base: Arc::new(base), name }, span))
    }

    /// Elements and components of a component as a reference.
    fn component_named(
        &mut self,
        value: &Expression,
        context: ScopeId,
        local: &Local,
    ) -> Result<Option<ComponentReference>, Diagnostic> {
        match &value.kind {
            ExpressionKind::Reference(reference) => Ok(Some(reference.clone())),
            ExpressionKind::Subscripted { base, subscripts } => {
                match self.component_named(base, context, local)? {
                    Some(reference) => self.element_of(&reference, subscripts, context, local),
                    None => Ok(None),
                }
            }
            ExpressionKind::Field { base, name } => {
                let mut reference = self.component_named(base, context, local)?;
                if let Some(reference) = &mut reference {
                    reference.parts.push(ReferencePart { name: *name, subscripts: Vec::new() });
                }
                Ok(reference)
            }
            _ => Ok(None),
        }
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
        let mut node = match is_component && self.classes.has_component(context, first)? {
            true => Some(self.classes.node_of(context)),
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
            let count = if is_last { usize::MAX } else { rank.unwrap_or(0) };
            if part.subscripts.is_empty() {
                part.subscripts = given.by_ref().take(count).collect();
                continue;
            }
            // A dimension that stays: `a[:].b` has the elements `a[i].b`.
            let stay = part.subscripts.iter_mut().filter(|s| matches!(s, Subscript::All(_)));
            for (subscript, index) in stay.zip(given.by_ref()) {
                *subscript = index;
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
}

impl Tree {
    /// Whether a component is protected in the class of its node.
    fn is_protected(&self, node: NodeId, name: Ident) -> bool {
        self.declaration_of(node, name).is_some_and(|declaration| declaration.protected)
    }

    pub(crate) fn component_names(&self, node: NodeId) -> Vec<Ident> {
        let members = self.composite_of(node).and_then(|composite| composite.members.as_ref());
        members.map_or(Vec::new(), |members| members.keys().copied().collect())
    }
}

impl Classes<'_> {
    /// Refuses a protected component after a dot, and subscripts of other types than those of the
    /// dimensions.
    fn check_access(
        &mut self,
        node: NodeId,
        parts: &[ReferencePart],
        whole: &ComponentReference,
    ) -> Result<(), Diagnostic> {
        let part = &parts[0];
        if parts.len() < whole.parts.len() && self.tree.is_protected(node, part.name) {
            let path = &self.tree.nodes[node.0].path;
            return Err(fault!(
                PROTECTED_ACCESS,
                "`{}` is protected in `{}`",
                part.name,
                path.trim_start_matches('.')
            )
            .at(whole.span));
        }
        if !part.subscripts.is_empty() {
            self.check_subscript_types(node, part)?;
        }
        Ok(())
    }

    pub(crate) fn unknown_component(&self, node: NodeId, name: Ident, span: Span) -> Diagnostic {
        let text = self.tree.scope_of(node).and_then(|scope| self.scope(scope).text.as_ref());
        let Some(text) = text else {
            return fault!(UNKNOWN_NAME, "`{name}` is unknown").at(span);
        };
        unknown::component(&text.name, name, &self.tree.component_names(node), span)
    }
}
