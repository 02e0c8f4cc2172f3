//! Builds the instance tree (MLS §5.6.1), component by component as they are needed: a parameter
//! that gives a size may be declared after the array that it sizes.

use super::instance::{Declaration, MemberState};
use super::own_sizes::with_own_sizes;
use crate::diag::Diagnostic;
use crate::fault;
use crate::flatten::errors::{
    CYCLIC_CLASS, NOT_CONSTANT, SIZE_MISMATCH, TOO_LARGE, TYPE_MISMATCH, UNKNOWN_ELEMENT,
    VALUE_NEEDED,
};
use crate::flatten::expressions::local::Local;
use crate::flatten::ids::NodeId;
use crate::flatten::ids::ScopeId;
use crate::flatten::instantiate::instance::Expanded;
use crate::flatten::instantiate::instantiation::Instantiation;
use crate::flatten::lookup::modification::Bound;
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{Expression, Subscript};
use crate::value::Value;

impl Instantiation<'_> {
    /// The component of a node, built now if it was not; `None` if there is none of that name.
    pub(crate) fn member(
        &mut self,
        node: NodeId,
        name: Ident,
    ) -> Result<Option<MemberState>, Diagnostic> {
        self.classes.fill(node)?;
        let members =
            self.classes.tree.composite_of(node).and_then(|composite| composite.members.as_ref());
        let Some(member) = members.and_then(|members| members.get(&name)) else {
            return Ok(None);
        };
        let declaration = member.declaration.clone();
        match &member.state {
            MemberState::Pending => {}
            MemberState::Busy => {
                return Err(fault!(
                    NOT_CONSTANT,
                    "the size or condition of `{name}` depends on `{name}` itself"
                )
                .at(declaration.span));
            }
            done => return Ok(Some(done.clone())),
        }
        self.classes.tree.set_state(node, name, MemberState::Busy);
        let built = self.build(node, &declaration);
        let state = match &built {
            Ok(state) => state.clone(),
            Err(_) => MemberState::Absent,
        };
        self.classes.tree.set_state(node, name, state);
        built.map(Some)
    }

    fn build(&mut self, node: NodeId, declared: &Declaration) -> Result<MemberState, Diagnostic> {
        if let Some((condition, context)) = &declared.condition {
            match self.structural_value(condition, *context)? {
                Value::Boolean(true) => {}
                Value::Boolean(false) => return Ok(MemberState::Absent),
                other => {
                    let found = other.type_name();
                    return Err(fault!(
                        TYPE_MISMATCH,
                        "a condition must be Boolean, but this is {found}"
                    )
                    .at(condition.span));
                }
            }
        }
        if declared.prefixes.outer {
            let outer = self.outer(node, declared)?;
            if !declared.prefixes.inner {
                return Ok(outer);
            }
            if self.classes.is_merged_output(node, declared)? {
                return Ok(outer);
            }
            let inner = Box::new(self.built(node, declared)?);
            return Ok(MemberState::Both { inner, outer: Box::new(outer.seen()) });
        }
        self.built(node, declared)
    }

    pub(crate) fn built(
        &mut self,
        node: NodeId,
        declared: &Declaration,
    ) -> Result<MemberState, Diagnostic> {
        let mut expanded = self.classes.expand(declared)?;
        self.take_value(declared, &mut expanded);
        let dims = self.dimensions(declared, &expanded)?;
        match expanded.shape.base() {
            Some(base) => self
                .classes
                .tree
                .variable(node, declared, expanded, base, dims)
                .map(MemberState::Single),
            None => self.classes.components(node, declared, expanded, dims),
        }
    }

    /// `y(value = 3)`, which other tools take as `y = 3`; no attribute of the language has this name.
    fn take_value(&mut self, declared: &Declaration, expanded: &mut Expanded) {
        let is_variable = expanded.shape.base().is_some() && expanded.modifier.binding.is_none();
        if !is_variable || self.classes.library.is_strict() {
            return;
        }
        let name = Ident::new("value");
        let Some(modifier) = expanded.modifier.elements.shift_remove(&name) else { return };
        expanded.modifier.binding = modifier.binding;
        let warning = fault!(UNKNOWN_ELEMENT, "`{}` has no attribute `value`: it is taken as its \
            value", declared.name; help: "write `{} = …`", declared.name);
        self.warnings.add_once(warning.at(modifier.span.unwrap_or(declared.span)));
    }

    /// The sizes of a component, those of its type included.
    pub(crate) fn dimensions(
        &mut self,
        declared: &Declaration,
        expanded: &Expanded,
    ) -> Result<Vec<usize>, Diagnostic> {
        let rank = declared.dims.len() + expanded.dims.len();
        let mut dims = Vec::with_capacity(rank);
        let mut of_binding: Option<Vec<usize>> = None;
        for (at, (subscript, context)) in declared.dims.iter().chain(&expanded.dims).enumerate() {
            match subscript {
                Subscript::Index(size) => {
                    let size = with_own_sizes(size, declared.name, &dims);
                    dims.push(self.size(&size, *context)?);
                }
                Subscript::All(span) => {
                    if of_binding.is_none() {
                        of_binding = Some(self.binding_dims(declared, expanded, *span)?);
                    }
                    let sizes = of_binding.as_deref().unwrap_or_default();
                    let size = sizes.get(at).copied().ok_or_else(|| {
                        fault!(
                            SIZE_MISMATCH,
                            "`{}` has {rank} dimensions, but its value has {}",
                            declared.name,
                            sizes.len()
                        )
                        .at(*span)
                    })?;
                    dims.push(size);
                }
            }
        }
        Ok(dims)
    }

    fn size(&mut self, size: &Expression, context: ScopeId) -> Result<usize, Diagnostic> {
        if let Some(values) = self.classes.type_range(size, context, &Local::default())? {
            return Ok(self.shape_of(&values).and_then(|dims| dims.first().copied()).unwrap_or(0));
        }
        match self.structural_value(size, context)? {
            Value::Integer(n) if n >= 0 => Ok(n as usize),
            Value::Integer(n) => {
                Err(fault!(SIZE_MISMATCH, "{n} is not a valid array size").at(size.span))
            }
            other => {
                let found = other.type_name();
                Err(fault!(TYPE_MISMATCH, "an array size must be Integer, but this is {found}")
                    .at(size.span))
            }
        }
    }

    /// The sizes of the value of `x[:] = value`.
    fn binding_dims(
        &mut self,
        declared: &Declaration,
        expanded: &Expanded,
        span: Span,
    ) -> Result<Vec<usize>, Diagnostic> {
        // The value decides, or an attribute that is an array (MLS §10.1).
        let attributes =
            expanded.modifier.elements.values().filter(|_| expanded.shape.base().is_some());
        let of_array = |b: &&Bound| !b.each && b.value.is_some();
        let of_attributes = attributes.filter_map(|one| one.binding.as_ref()).find(of_array);
        let bound = expanded.modifier.binding.as_ref().or(of_attributes);
        let Some((Some(value), bound)) = bound.map(|b| (b.value.clone(), b.clone())) else {
            return Err(fault!(VALUE_NEEDED, "the size of `{}` is unknown", declared.name;
                help: "declare its size, or give it a value")
            .at(span));
        };
        if let Some(dims) = self.bound_shape(&bound)? {
            return Ok(dims);
        }
        let value = self.part_of(&value, &bound)?;
        match self.structural_value(&value, bound.context)? {
            Value::Array(array) => Ok(array.dims),
            _ => Ok(Vec::new()),
        }
    }

    /// Builds all components below a node.
    pub(crate) fn complete(&mut self, node: NodeId) -> Result<(), Vec<Diagnostic>> {
        let mut errors = Vec::new();
        let mut at = 0;
        // An `outer` component without an `inner` one adds a component to the model itself.
        while let Some(name) = self.classes.tree.member_at(node, at) {
            at += 1;
            let state = self.member(node, name).map(|state| state.map(MemberState::own));
            let nodes = match state {
                Ok(Some(MemberState::Single(one))) => vec![one],
                Ok(Some(MemberState::Array(_, nodes))) => nodes,
                Ok(_) => Vec::new(),
                Err(error) => {
                    errors.push(error);
                    Vec::new()
                }
            };
            for (number, one) in nodes.iter().copied().enumerate() {
                // Whatever holds itself or is too large would only be found again and again.
                if errors.iter().any(is_endless) {
                    break;
                }
                self.growth.enter(
                    node,
                    at - 1,
                    nodes.len() - number - 1,
                    self.classes.tree.nodes.len(),
                );
                let completed = self.complete(one);
                if let Err(error) = self.growth.check(&mut self.classes) {
                    errors.push(error);
                }
                self.growth.leave();
                if let Err(more) = completed {
                    errors.extend(more);
                }
            }
            if errors.iter().any(is_endless) {
                break;
            }
        }
        if errors.is_empty() { Ok(()) } else { Err(errors) }
    }
}

fn is_endless(error: &Diagnostic) -> bool {
    [CYCLIC_CLASS, TOO_LARGE].contains(&error.code)
}
