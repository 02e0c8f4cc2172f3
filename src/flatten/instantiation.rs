//! Builds the instance tree (MLS §5.6.1), component by component as they are needed: a parameter
//! that gives a size may be declared behind the array that it sizes.

use super::constants::Read;
use super::errors::{
    CYCLIC_CLASS, NOT_CONSTANT, PARTIAL_CLASS, SIZE_MISMATCH, TOO_LARGE, TYPE_MISMATCH,
    UNKNOWN_ELEMENT,
};
use super::instance::{
    Composite, Context, Declaration, Inherited, Leaf, Member, MemberState, Node, NodeId, NodeKind,
    Shape,
};
use super::library::{ClassId, Library};
use super::modification::{Bound, Modifier};
use super::{BaseType, Variability, Variable};
use crate::diag::{Diagnostic, suggest};
use crate::eval::Function;
use crate::fault;
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{Expression, ExpressionKind, Restriction, Subscript};
use crate::value::Value;
use indexmap::{IndexMap, IndexSet};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// The most scalar variables, the most components and the deepest nesting that are built.
const MAX_SCALARS: usize = 2_000_000;
const MAX_INSTANCES: usize = 100_000;
const MAX_DEPTH: usize = 60;

/// The attributes of the predefined types (MLS §4.9).
pub(super) const ATTRIBUTES: [&str; 9] =
    ["quantity", "unit", "displayUnit", "min", "max", "start", "fixed", "nominal", "stateSelect"];

/// The growing tree.
pub(super) struct Instantiation<'a> {
    pub(super) library: &'a Library,
    pub(super) nodes: Vec<Node>,
    /// Variables with the node of each.
    pub(super) variables: Vec<(Variable, NodeId)>,
    pub(super) variable_of: FxHashMap<Arc<str>, usize>,
    /// Instances of packages, for their constants.
    pub(super) packages: FxHashMap<ClassId, NodeId>,
    pub(super) functions: IndexMap<Name, Option<Arc<Function>>>,
    /// Variables whose values shaped the model.
    pub(super) structural: IndexSet<usize>,
    /// Values found so far with the variables that they need; `None` while one is being found.
    pub(super) values: FxHashMap<usize, Option<(Value, Read)>>,
    /// Variables read by the evaluation that is going on.
    pub(super) read: Read,
    /// How deep expressions are being resolved.
    pub(super) depth: usize,
    /// Statements run so far to find values.
    pub(super) steps: usize,
    scalars: usize,
}

impl<'a> Instantiation<'a> {
    /// A tree with the node 0, which has no components: the scope of what lies in packages.
    pub(super) fn new(library: &'a Library) -> Instantiation<'a> {
        let nowhere = Composite {
            class: ClassId::default(),
            record: false,
            members: IndexMap::new(),
            lineage: Vec::new(),
            inherited: Inherited::default(),
        };
        let node = Node { path: String::new(), kind: NodeKind::Composite(nowhere) };
        Instantiation {
            library,
            nodes: vec![node],
            variables: Vec::new(),
            variable_of: FxHashMap::default(),
            packages: FxHashMap::default(),
            functions: IndexMap::new(),
            structural: IndexSet::new(),
            values: FxHashMap::default(),
            read: Read::new(),
            depth: 0,
            steps: 0,
            scalars: 0,
        }
    }

    /// An instance of a class with components at a path; its components are not built yet.
    pub(super) fn composite(
        &mut self,
        class: ClassId,
        path: String,
        modifier: Modifier,
        inherited: Inherited,
    ) -> Result<NodeId, Diagnostic> {
        let definition = &self.library.class(class).definition;
        if inherited.depth > MAX_DEPTH {
            let name = &self.library.class(class).name;
            return Err(fault!(CYCLIC_CLASS, "`{name}` contains a component of its own class")
                .at(definition.name.span));
        }
        if self.nodes.len() > MAX_INSTANCES {
            return Err(fault!(TOO_LARGE, "the model has more than {MAX_INSTANCES} components")
                .at(definition.name.span));
        }
        let record =
            matches!(definition.restriction, Restriction::Record | Restriction::OperatorRecord);
        let node = NodeId(self.nodes.len());
        let binding = modifier.binding.clone();
        let mut collected = self.library.collect(class, node, modifier)?;
        if let Some(binding) = binding {
            self.split_binding(class, record, &binding, &mut collected.members)?;
        }
        let composite = Composite {
            class,
            record,
            members: collected.members,
            lineage: collected.lineage,
            inherited,
        };
        self.nodes.push(Node { path, kind: NodeKind::Composite(composite) });
        Ok(node)
    }

    /// Gives every component of a record its part of the record's binding (MLS §7.2.2).
    fn split_binding(
        &self,
        class: ClassId,
        record: bool,
        binding: &Bound,
        members: &mut IndexMap<Ident, Member>,
    ) -> Result<(), Diagnostic> {
        let Some(value) = &binding.value else { return Ok(()) };
        if !record {
            let name = &self.library.class(class).name;
            return Err(fault!(TYPE_MISMATCH, "a component of `{name}` cannot be given a value";
                help: "only records and variables have values")
            .at(value.span));
        }
        let picked = picked(value.clone(), &binding.indices);
        for (name, member) in members {
            let span = value.span;
            let part = ExpressionKind::Field { base: Box::new(picked.clone()), name: *name };
            let mut declaration = (*member.declaration).clone();
            declaration.modifier.binding = Some(Bound {
                value: Some(Expression::new(part, span)),
                context: binding.context,
                each: binding.each,
                indices: Vec::new(),
            });
            member.declaration = Arc::new(declaration);
        }
        Ok(())
    }

    pub(super) fn composite_of(&self, node: NodeId) -> Option<&Composite> {
        match &self.nodes[node.0].kind {
            NodeKind::Composite(composite) => Some(composite),
            NodeKind::Variable(_) => None,
        }
    }

    /// The component of a node, built now if it was not; `None` if there is none of that name.
    pub(super) fn member(
        &mut self,
        node: NodeId,
        name: Ident,
    ) -> Result<Option<MemberState>, Diagnostic> {
        let Some(composite) = self.composite_of(node) else { return Ok(None) };
        let Some(member) = composite.members.get(&name) else { return Ok(None) };
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
        self.set_state(node, name, MemberState::Busy);
        let built = self.build(node, &declaration);
        let state = match &built {
            Ok(state) => state.clone(),
            Err(_) => MemberState::Absent,
        };
        self.set_state(node, name, state);
        built.map(Some)
    }

    fn set_state(&mut self, node: NodeId, name: Ident, state: MemberState) {
        if let NodeKind::Composite(composite) = &mut self.nodes[node.0].kind
            && let Some(member) = composite.members.get_mut(&name)
        {
            member.state = state;
        }
    }

    fn build(&mut self, node: NodeId, declared: &Declaration) -> Result<MemberState, Diagnostic> {
        if let Some((condition, context)) = &declared.condition {
            match self.structural_value(condition, *context)? {
                Value::Boolean(true) => {}
                Value::Boolean(false) => return Ok(MemberState::Absent),
                other => {
                    let found = other.type_name();
                    return Err(fault!(TYPE_MISMATCH, "a condition must be Boolean, not {found}")
                        .at(condition.span));
                }
            }
        }
        let dims = self.dimensions(declared)?;
        match declared.shape.base() {
            Some(base) => self.variable(node, declared, base, dims).map(MemberState::Single),
            None => self.components(node, declared, dims),
        }
    }

    fn dimensions(&mut self, declared: &Declaration) -> Result<Vec<usize>, Diagnostic> {
        let mut dims = Vec::with_capacity(declared.dims.len());
        let mut of_binding: Option<Vec<usize>> = None;
        for (at, (subscript, context)) in declared.dims.iter().enumerate() {
            match subscript {
                Subscript::Index(size) => dims.push(self.size(size, *context)?),
                Subscript::All(span) => {
                    if of_binding.is_none() {
                        of_binding = Some(self.binding_dims(declared, *span)?);
                    }
                    let sizes = of_binding.as_deref().unwrap_or_default();
                    let size = sizes.get(at).copied().ok_or_else(|| {
                        let rank = declared.dims.len();
                        fault!(
                            SIZE_MISMATCH,
                            "`{}` has {rank} dimensions, its value {}",
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

    fn size(&mut self, size: &Expression, context: Context) -> Result<usize, Diagnostic> {
        match self.structural_value(size, context)? {
            Value::Integer(n) if n >= 0 => Ok(n as usize),
            Value::Integer(n) => {
                Err(fault!(SIZE_MISMATCH, "an array cannot have the size {n}").at(size.span))
            }
            other => {
                let found = other.type_name();
                Err(fault!(TYPE_MISMATCH, "an array size must be Integer, not {found}")
                    .at(size.span))
            }
        }
    }

    /// The sizes of the value of `x[:] = value`.
    fn binding_dims(
        &mut self,
        declared: &Declaration,
        span: Span,
    ) -> Result<Vec<usize>, Diagnostic> {
        let bound = declared.modifier.binding.as_ref();
        let Some((Some(value), bound)) = bound.map(|b| (b.value.clone(), b)) else {
            return Err(fault!(NOT_CONSTANT, "the size of `{}` is not given", declared.name;
                help: "write its size, or give it a value")
            .at(span));
        };
        let value = picked(value, &bound.indices);
        match self.structural_value(&value, bound.context)? {
            Value::Array(array) => Ok(array.dims),
            _ => Ok(Vec::new()),
        }
    }

    fn path_of(&self, node: NodeId, name: Ident) -> String {
        let parent = &self.nodes[node.0].path;
        if parent.is_empty() { name.to_string() } else { format!("{parent}.{name}") }
    }

    fn count(&mut self, scalars: usize, span: Span) -> Result<(), Diagnostic> {
        self.scalars = self.scalars.saturating_add(scalars.max(1));
        if self.scalars > MAX_SCALARS {
            return Err(fault!(
                TOO_LARGE,
                "the model has more than {MAX_SCALARS} scalar variables"
            )
            .at(span));
        }
        Ok(())
    }

    fn inherited_by(&self, node: NodeId, declared: &Declaration) -> Inherited {
        let parent = self.composite_of(node).map_or(Inherited::default(), |c| c.inherited);
        Inherited {
            variability: stricter(parent.variability, declared.variability),
            causality: parent.causality.or(declared.causality),
            is_final: parent.is_final || declared.is_final,
            protected: parent.protected || declared.protected,
            depth: parent.depth + 1,
        }
    }

    fn components(
        &mut self,
        node: NodeId,
        declared: &Declaration,
        dims: Vec<usize>,
    ) -> Result<MemberState, Diagnostic> {
        let Shape::Class(class) = declared.shape else {
            return Err(fault!(TYPE_MISMATCH, "`{}` has no class", declared.name).at(declared.span));
        };
        self.check_complete(class, declared.span)?;
        let inherited = self.inherited_by(node, declared);
        let path = self.path_of(node, declared.name);
        if dims.is_empty() {
            let built = self.composite(class, path, declared.modifier.clone(), inherited)?;
            return Ok(MemberState::Single(built));
        }
        let count = dims.iter().try_fold(1usize, |n, d| n.checked_mul(*d)).unwrap_or(usize::MAX);
        self.count(count, declared.span)?;
        let mut nodes = Vec::with_capacity(count);
        for at in 0..count {
            let indices = indices_of(at, &dims);
            let texts: Vec<String> = indices.iter().map(usize::to_string).collect();
            let element = format!("{path}[{}]", texts.join(","));
            let modifier = declared.modifier.at_element(&indices);
            nodes.push(self.composite(class, element, modifier, inherited)?);
        }
        Ok(MemberState::Array(dims, nodes))
    }

    /// A partial class has no instances (MLS §4.7).
    pub(super) fn check_complete(&self, class: ClassId, span: Span) -> Result<(), Diagnostic> {
        let found = self.library.class(class);
        if found.definition.partial {
            return Err(fault!(PARTIAL_CLASS, "`{}` is partial and has no instances", found.name;
                help: "use a class that extends it")
            .at(span));
        }
        Ok(())
    }

    fn variable(
        &mut self,
        node: NodeId,
        declared: &Declaration,
        base: BaseType,
        dims: Vec<usize>,
    ) -> Result<NodeId, Diagnostic> {
        for (name, modifier) in &declared.modifier.elements {
            if !ATTRIBUTES.contains(&name.as_str()) {
                return Err(fault!(
                    UNKNOWN_ELEMENT,
                    "`{}` has no attribute `{name}` to modify",
                    declared.name
                )
                .help_if(suggest::did_you_mean(name.as_str(), ATTRIBUTES))
                .at(modifier.span.unwrap_or(declared.span)));
            }
        }
        let scalars = dims.iter().try_fold(1usize, |n, d| n.checked_mul(*d)).unwrap_or(usize::MAX);
        self.count(scalars, declared.span)?;
        let inherited = self.inherited_by(node, declared);
        let top_level = self.nodes[node.0].path.is_empty();
        let name: Arc<str> = self.path_of(node, declared.name).into();
        let discrete = base != BaseType::Real;
        let default = if discrete { Variability::Discrete } else { Variability::Continuous };
        let variable = Variable {
            name: name.clone(),
            base,
            dims,
            variability: inherited.variability.unwrap_or(default).min(default),
            causality: inherited.causality.filter(|_| top_level),
            is_final: inherited.is_final,
            protected: inherited.protected,
            evaluate: declared.evaluate,
            structural: false,
            top_level,
            attributes: IndexMap::new(),
            binding: None,
            description: declared.description.clone(),
            span: declared.span,
        };
        let leaf = Leaf { variable: self.variables.len(), modifier: declared.modifier.clone() };
        let id = NodeId(self.nodes.len());
        if !self.in_package(node) {
            self.variable_of.insert(name.clone(), leaf.variable);
        }
        self.variables.push((variable, id));
        self.nodes.push(Node { path: name.to_string(), kind: NodeKind::Variable(leaf) });
        Ok(id)
    }

    /// Whether a node lies in the instance of a package, whose paths begin with its full name.
    pub(super) fn in_package(&self, node: NodeId) -> bool {
        self.nodes[node.0].path.starts_with(PACKAGE_MARK)
    }

    /// Builds all components below a node.
    pub(super) fn complete(&mut self, node: NodeId) -> Result<(), Vec<Diagnostic>> {
        let Some(composite) = self.composite_of(node) else { return Ok(()) };
        let names: Vec<Ident> = composite.members.keys().copied().collect();
        let mut errors = Vec::new();
        for name in names {
            let nodes = match self.member(node, name) {
                Ok(Some(MemberState::Single(one))) => vec![one],
                Ok(Some(MemberState::Array(_, nodes))) => nodes,
                Ok(_) => Vec::new(),
                Err(error) => {
                    errors.push(error);
                    continue;
                }
            };
            for one in nodes {
                if let Err(more) = self.complete(one) {
                    errors.extend(more);
                }
            }
        }
        if errors.is_empty() { Ok(()) } else { Err(errors) }
    }

    /// The instance of a package or class for its constants, made once.
    pub(super) fn package(&mut self, class: ClassId) -> Result<NodeId, Diagnostic> {
        if let Some(node) = self.packages.get(&class) {
            return Ok(*node);
        }
        let path = format!("{PACKAGE_MARK}{}", self.library.class(class).name);
        let inherited = Inherited::default();
        let node = self.composite(class, path, Modifier::default(), inherited)?;
        self.packages.insert(class, node);
        Ok(node)
    }
}

/// Begins the path of a package's instance; no component can be named so.
const PACKAGE_MARK: char = '.';

/// The indices, from 1, of an element in an array, the last dimension fastest.
pub(super) fn indices_of(mut at: usize, dims: &[usize]) -> Vec<usize> {
    let mut indices = vec![0; dims.len()];
    for (index, size) in indices.iter_mut().zip(dims).rev() {
        *index = at % size + 1;
        at /= size;
    }
    indices
}

/// The element of a value that belongs to one element of an array of components.
pub(super) fn picked(value: Expression, indices: &[usize]) -> Expression {
    if indices.is_empty() {
        return value;
    }
    let span = value.span;
    let subscript =
        |at: &usize| Subscript::Index(Expression::new(ExpressionKind::Integer(*at as i64), span));
    let subscripts = indices.iter().map(subscript).collect();
    Expression::new(ExpressionKind::Subscripted { base: Box::new(value), subscripts }, span)
}

fn stricter(outer: Option<Variability>, own: Option<Variability>) -> Option<Variability> {
    match (outer, own) {
        (Some(outer), Some(own)) => Some(outer.min(own)),
        (outer, own) => outer.or(own),
    }
}
