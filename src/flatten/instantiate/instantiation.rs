//! Builds the instance tree (MLS §5.6.1), component by component as they are needed: a parameter
//! that gives a size may be declared behind the array that it sizes.

use super::growth::Growth;
use super::instance::{
    Composite, Declaration, Inherited, Leaf, Member, MemberState, Node, NodeId, NodeKind, Shape,
};
use super::own_sizes::with_own_sizes;
use crate::diag::{Diagnostic, suggest};
use crate::eval::Function;
use crate::fault;
use crate::flatten::balance::Written;
use crate::flatten::connections::Connections;
use crate::flatten::errors::{
    CYCLIC_CLASS, NOT_CONSTANT, PARTIAL_CLASS, SIZE_MISMATCH, TOO_LARGE, TYPE_MISMATCH,
    UNKNOWN_ELEMENT,
};
use crate::flatten::expressions::constants::Read;
use crate::flatten::expressions::resolve::Local;
use crate::flatten::library::Library;
use crate::flatten::lookup::declarations::Expanded;
use crate::flatten::lookup::modification::{Bound, Modifier};
use crate::flatten::lookup::names::Type;
use crate::flatten::lookup::scope::{Nested, Scope, ScopeId, Text};
use crate::flatten::{BaseType, Variability, Variable};
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    CausalityPrefix, Expression, ExpressionKind, ReferencePart, Restriction, Subscript,
    VariabilityPrefix,
};
use crate::value::Value;
use indexmap::{IndexMap, IndexSet};
use rustc_hash::FxHashMap;
use std::rc::Rc;
use std::sync::Arc;

/// The most scalar variables, the most components and the deepest nesting that are built.
const MAX_SCALARS: usize = 2_000_000;
pub const MAX_INSTANCES: usize = 1_000_000;
const MAX_DEPTH: usize = 60;

/// The attributes of the predefined types (MLS §4.9).
pub const ATTRIBUTES: [&str; 9] =
    ["quantity", "unit", "displayUnit", "min", "max", "start", "fixed", "nominal", "stateSelect"];

/// The growing tree.
pub struct Instantiation<'a> {
    pub library: &'a Library,
    pub nodes: Vec<Node>,
    /// Variables with the node of each.
    pub variables: Vec<(Variable, NodeId)>,
    pub variable_of: FxHashMap<Arc<str>, usize>,
    /// Classes in their surroundings; the first is the top.
    pub scopes: Vec<Scope>,
    pub roots: FxHashMap<Ident, Rc<Nested>>,
    /// Classes found by name in a class and in what encloses it.
    pub nested: FxHashMap<(ScopeId, Ident), Option<Rc<Nested>>>,
    pub found: FxHashMap<(ScopeId, Ident), Option<Type>>,
    /// How many classes are looking up their bases, and how many short classes lead to another.
    pub searching: usize,
    pub renaming: usize,
    pub functions: IndexMap<Name, Option<Arc<Function>>>,
    /// The function that alone is asked for; `None` for a model.
    pub asked_function: Option<Name>,
    /// The names under which functions are known.
    pub function_names: FxHashMap<ScopeId, Name>,
    /// The classes of records by the names of their constructors.
    pub record_scopes: FxHashMap<Name, ScopeId>,
    /// The instance of the model.
    pub root_node: NodeId,
    /// The simple name of its class.
    pub model_name: Ident,
    pub warnings: Vec<Diagnostic>,
    /// All connections, as soon as the tree is whole.
    pub connections: Option<Rc<Connections>>,
    /// Which equations each instance wrote, in the order of the flat model.
    pub written: Vec<Written>,
    /// Variables whose values shaped the model.
    pub structural: IndexSet<usize>,
    /// Values found so far with the variables that they need; `None` while one is being found.
    pub values: FxHashMap<usize, Option<(Value, Read)>>,
    /// Variables read by the evaluation that is going on.
    pub read: Read,
    /// How deep expressions are being resolved.
    pub depth: usize,
    /// Statements run so far to find values.
    pub steps: u64,
    scalars: usize,
    /// The components that are being completed, outermost first.
    pub growth: Growth,
}

impl<'a> Instantiation<'a> {
    /// A tree with the node 0, which has no components: the instance of the top scope.
    pub fn new(library: &'a Library) -> Instantiation<'a> {
        let nowhere = Composite {
            scope: ScopeId::TOP,
            class: ScopeId::TOP,
            members: Some(IndexMap::new()),
            inherited: Inherited::default(),
            connector: false,
        };
        let node = Node { path: String::new(), parent: None, kind: NodeKind::Composite(nowhere) };
        Instantiation {
            library,
            nodes: vec![node],
            variables: Vec::new(),
            variable_of: FxHashMap::default(),
            scopes: vec![Self::top_scope()],
            roots: FxHashMap::default(),
            nested: FxHashMap::default(),
            found: FxHashMap::default(),
            searching: 0,
            renaming: 0,
            functions: IndexMap::new(),
            asked_function: None,
            function_names: FxHashMap::default(),
            record_scopes: FxHashMap::default(),
            root_node: NodeId(0),
            model_name: Ident::new(""),
            warnings: Vec::new(),
            connections: None,
            written: Vec::new(),
            structural: IndexSet::new(),
            values: FxHashMap::default(),
            read: Read::new(),
            depth: 0,
            steps: 0,
            scalars: 0,
            growth: Growth::default(),
        }
    }

    /// The instance of the model itself, under a modifier.
    pub fn model(&mut self, class: ScopeId, modifier: Modifier) -> Result<NodeId, Diagnostic> {
        let text = self.text(class);
        let modifier = self
            .scope(class)
            .modifier
            .clone()
            .overridden_by(modifier, text.definition.name.node)?;
        let node = self.composite(class, String::new(), None, modifier, Inherited::default())?;
        self.root_node = node;
        Ok(node)
    }

    /// An instance of a class with components at a path; its components are not built yet.
    fn composite(
        &mut self,
        class: ScopeId,
        path: String,
        holder: Option<NodeId>,
        modifier: Modifier,
        inherited: Inherited,
    ) -> Result<NodeId, Diagnostic> {
        let text = self.text(class).clone();
        if inherited.depth > MAX_DEPTH {
            return Err(fault!(
                TOO_LARGE,
                "the components of the model are nested more than {MAX_DEPTH} deep: `{}`",
                text.name
            )
            .at(text.span()));
        }
        if self.is_inside_itself(&text, holder) {
            return Err(fault!(
                CYCLIC_CLASS,
                "`{}` contains a component of its own class",
                text.name
            )
            .at(text.span()));
        }
        if self.nodes.len() > MAX_INSTANCES {
            return Err(fault!(TOO_LARGE, "the model has more than {MAX_INSTANCES} components")
                .at(text.span()));
        }
        let parent = self.scope(class).parent.unwrap_or(ScopeId::TOP);
        let names: Vec<(Ident, Option<Span>)> =
            modifier.elements.iter().map(|(name, modifier)| (*name, modifier.span)).collect();
        let span = modifier.span.unwrap_or(text.span());
        let node = self.add_node(path, holder, inherited);
        let scope = self.add_scope(text, parent, node, modifier, Modifier::default())?;
        self.set_scope(node, scope);
        self.set_class(node, class);
        self.fill(node)?;
        for (name, place) in names {
            self.check_modified(scope, name, place.unwrap_or(span))?;
        }
        Ok(node)
    }

    /// Whether a component of this class would hold itself.
    fn is_inside_itself(&self, text: &Text, holder: Option<NodeId>) -> bool {
        let mut node = holder;
        let mut times = 0;
        while let Some(id) = node {
            let known = self.scope_of(id).and_then(|scope| self.scope(scope).text.as_ref());
            if known.is_some_and(|known| known.definition.span == text.definition.span) {
                times += 1;
            }
            node = self.nodes[id.0].parent;
        }
        // A class may hold another form of itself, with the recursion ended by a condition.
        times > MAX_SELF
    }

    fn add_node(&mut self, path: String, parent: Option<NodeId>, inherited: Inherited) -> NodeId {
        let id = NodeId(self.nodes.len());
        let composite = Composite {
            scope: ScopeId::TOP,
            class: ScopeId::TOP,
            members: None,
            inherited,
            connector: false,
        };
        self.nodes.push(Node { path, parent, kind: NodeKind::Composite(composite) });
        id
    }

    /// The instance of a package or class for its constants; nothing in it is built yet.
    pub fn add_package(&mut self, name: &Name, holder: NodeId) -> NodeId {
        let path = format!("{PACKAGE_MARK}{name}");
        self.add_node(path, Some(holder), Inherited::default())
    }

    pub fn set_scope(&mut self, node: NodeId, scope: ScopeId) {
        if let NodeKind::Composite(composite) = &mut self.nodes[node.0].kind {
            composite.scope = scope;
            composite.class = scope;
        }
    }

    fn set_class(&mut self, node: NodeId, class: ScopeId) {
        if let NodeKind::Composite(composite) = &mut self.nodes[node.0].kind {
            composite.class = class;
        }
    }

    /// The class of an instance; `None` for a variable.
    pub fn scope_of(&self, node: NodeId) -> Option<ScopeId> {
        self.composite_of(node).map(|composite| composite.scope)
    }

    /// Lists the components of an instance, as far as they are not listed yet.
    fn fill(&mut self, node: NodeId) -> Result<(), Diagnostic> {
        let Some(composite) = self.composite_of(node) else { return Ok(()) };
        if composite.members.is_some() {
            return Ok(());
        }
        let scope = composite.scope;
        let elements = self.elements(scope)?;
        let mut members: IndexMap<Ident, Member> = elements
            .iter()
            .map(|(name, declaration)| {
                let state = MemberState::Pending;
                (name, Member { declaration: declaration.clone(), state })
            })
            .collect();
        if let Some(binding) = self.scope(scope).modifier.binding.clone() {
            self.split_binding(scope, &binding, &mut members)?;
        }
        if let NodeKind::Composite(composite) = &mut self.nodes[node.0].kind {
            composite.members = Some(members);
        }
        Ok(())
    }

    pub fn is_record(&self, scope: ScopeId) -> bool {
        matches!(self.text(scope).restriction(), Restriction::Record | Restriction::OperatorRecord)
    }

    /// The components of an instance, with their states.
    pub fn members(&mut self, node: NodeId) -> Result<Vec<(Ident, MemberState)>, Diagnostic> {
        self.fill(node)?;
        let members = self.composite_of(node).and_then(|composite| composite.members.as_ref());
        Ok(members.map_or(Vec::new(), |members| {
            members.iter().map(|(name, member)| (*name, member.state.clone().own())).collect()
        }))
    }

    /// The declaration of a component of an instance.
    pub fn declaration_of(&self, node: NodeId, name: Ident) -> Option<Arc<Declaration>> {
        let members = self.composite_of(node)?.members.as_ref()?;
        members.get(&name).map(|member| member.declaration.clone())
    }

    /// Gives every component of a record its part of the record's binding (MLS §7.2.2).
    fn split_binding(
        &self,
        class: ScopeId,
        binding: &Bound,
        members: &mut IndexMap<Ident, Member>,
    ) -> Result<(), Diagnostic> {
        let Some(value) = &binding.value else { return Ok(()) };
        if !self.is_record(class) {
            let name = &self.text(class).name;
            return Err(fault!(TYPE_MISMATCH, "a component of type `{name}` cannot have a value";
                help: "only records and variables can have values")
            .at(value.span));
        }
        let picked = picked(value.clone(), &binding.indices);
        let is_computed = !is_component(&picked);
        for (name, member) in members {
            let is_constant =
                member.declaration.type_prefixes.variability == Some(VariabilityPrefix::Constant);
            if is_constant && is_computed && member.declaration.modifier.binding.is_some() {
                // A constant with a value is no input of the record's constructor (MLS §12.6.1).
                continue;
            }
            let mut declaration = (*member.declaration).clone();
            declaration.modifier.binding = Some(Bound {
                value: Some(component_of(&picked, *name)),
                context: binding.context,
                each: binding.each,
                indices: Vec::new(),
            });
            member.declaration = Arc::new(declaration);
        }
        Ok(())
    }

    pub fn composite_of(&self, node: NodeId) -> Option<&Composite> {
        match &self.nodes[node.0].kind {
            NodeKind::Composite(composite) => Some(composite),
            NodeKind::Variable(_) => None,
        }
    }

    /// The component of a node, built now if it was not; `None` if there is none of that name.
    pub fn member(&mut self, node: NodeId, name: Ident) -> Result<Option<MemberState>, Diagnostic> {
        self.fill(node)?;
        let members = self.composite_of(node).and_then(|composite| composite.members.as_ref());
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
        self.set_state(node, name, MemberState::Busy);
        let built = self.build(node, &declaration);
        let state = match &built {
            Ok(state) => state.clone(),
            Err(_) => MemberState::Absent,
        };
        self.set_state(node, name, state);
        built.map(Some)
    }

    pub fn set_state(&mut self, node: NodeId, name: Ident, state: MemberState) {
        if let NodeKind::Composite(composite) = &mut self.nodes[node.0].kind
            && let Some(member) =
                composite.members.as_mut().and_then(|members| members.get_mut(&name))
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
            let inner = Box::new(self.built(node, declared)?);
            return Ok(MemberState::Both { inner, outer: Box::new(outer.seen()) });
        }
        self.built(node, declared)
    }

    pub fn built(
        &mut self,
        node: NodeId,
        declared: &Declaration,
    ) -> Result<MemberState, Diagnostic> {
        let expanded = self.expand(declared)?;
        let dims = self.dimensions(declared, &expanded)?;
        match expanded.shape.base() {
            Some(base) => {
                self.variable(node, declared, expanded, base, dims).map(MemberState::Single)
            }
            None => self.components(node, declared, expanded, dims),
        }
    }

    /// The sizes of a component, those of its type included.
    pub fn dimensions(
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
        if let Some(values) = self.type_range(size, context, &Local::default())? {
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
        let bound = expanded.modifier.binding.as_ref();
        let Some((Some(value), bound)) = bound.map(|b| (b.value.clone(), b)) else {
            return Err(fault!(NOT_CONSTANT, "the size of `{}` is unknown", declared.name;
                help: "declare its size, or give it a value")
            .at(span));
        };
        if let Some(dims) = self.bound_shape(&bound.clone())? {
            return Ok(dims);
        }
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

    fn inherited_by(&self, node: NodeId, declared: &Declaration, expanded: &Expanded) -> Inherited {
        let parent = self.composite_of(node).map_or(Inherited::default(), |c| c.inherited);
        let prefixes = declared.type_prefixes;
        Inherited {
            variability: stricter(parent.variability, prefixes.variability.map(variability)),
            causality: parent.causality.or(prefixes.causality).or(expanded.causality),
            connection: parent.connection.or(prefixes.connection).or(expanded.connection),
            is_final: parent.is_final || declared.is_final,
            protected: parent.protected || declared.protected,
            depth: parent.depth + 1,
        }
    }

    fn components(
        &mut self,
        node: NodeId,
        declared: &Declaration,
        expanded: Expanded,
        dims: Vec<usize>,
    ) -> Result<MemberState, Diagnostic> {
        let Shape::Class(class) = expanded.shape else {
            return Err(fault!(
                TYPE_MISMATCH,
                "`{}` is a function; only an input of a function can have a function type",
                declared.name
            )
            .at(declared.span));
        };
        self.check_complete(class, declared.span)?;
        let inherited = self.inherited_by(node, declared, &expanded);
        let path = self.path_of(node, declared.name);
        if dims.is_empty() {
            let built = self.composite(class, path, Some(node), expanded.modifier, inherited)?;
            self.mark_connector(built, expanded.connector);
            return Ok(MemberState::Single(built));
        }
        let count = dims.iter().try_fold(1usize, |n, d| n.checked_mul(*d)).unwrap_or(usize::MAX);
        self.count(count, declared.span)?;
        let mut nodes = Vec::with_capacity(count);
        for at in 0..count {
            let indices = indices_of(at, &dims);
            let texts: Vec<String> = indices.iter().map(usize::to_string).collect();
            let element = format!("{path}[{}]", texts.join(","));
            let modifier = expanded.modifier.at_element(&indices);
            let built = self.composite(class, element, Some(node), modifier, inherited)?;
            self.mark_connector(built, expanded.connector);
            nodes.push(built);
        }
        Ok(MemberState::Array(dims, nodes))
    }

    fn mark_connector(&mut self, node: NodeId, connector: bool) {
        if let NodeKind::Composite(composite) = &mut self.nodes[node.0].kind {
            composite.connector = connector;
        }
    }

    /// A partial class has no instances (MLS §4.7).
    pub fn check_complete(&self, class: ScopeId, span: Span) -> Result<(), Diagnostic> {
        let found = self.text(class);
        if found.definition.partial {
            return Err(
                fault!(PARTIAL_CLASS, "`{}` is partial and cannot be instantiated", found.name;
                help: "use a class that extends it")
                .at(span),
            );
        }
        Ok(())
    }

    fn variable(
        &mut self,
        node: NodeId,
        declared: &Declaration,
        expanded: Expanded,
        base: BaseType,
        dims: Vec<usize>,
    ) -> Result<NodeId, Diagnostic> {
        for (name, modifier) in &expanded.modifier.elements {
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
        let inherited = self.inherited_by(node, declared, &expanded);
        let top_level = self.nodes[node.0].path.is_empty();
        // Nobody outside can give a protected input its value: it is determined inside.
        let is_inner_input =
            inherited.protected && inherited.causality == Some(CausalityPrefix::Input);
        let name: Arc<str> = self.path_of(node, declared.name).into();
        let discrete = base != BaseType::Real;
        let default = if discrete { Variability::Discrete } else { Variability::Continuous };
        let variable = Variable {
            name: name.clone(),
            base,
            dims,
            variability: inherited.variability.unwrap_or(default).min(default),
            causality: inherited.causality.filter(|_| top_level && !is_inner_input),
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
        let leaf = Leaf {
            variable: self.variables.len(),
            modifier: expanded.modifier,
            connection: inherited.connection,
            causality: inherited.causality,
            connector: expanded.connector,
            class: expanded.class,
        };
        let id = NodeId(self.nodes.len());
        if !self.in_package(node) {
            self.variable_of.insert(name.clone(), leaf.variable);
        }
        self.variables.push((variable, id));
        let path = name.to_string();
        self.nodes.push(Node { path, parent: Some(node), kind: NodeKind::Variable(leaf) });
        Ok(id)
    }

    /// Whether a node lies in the instance of a package, whose paths begin with its full name.
    pub fn in_package(&self, node: NodeId) -> bool {
        self.nodes[node.0].path.starts_with(PACKAGE_MARK)
    }

    /// Builds all components below a node.
    pub fn complete(&mut self, node: NodeId) -> Result<(), Vec<Diagnostic>> {
        let mut errors = Vec::new();
        let mut at = 0;
        // An `outer` component without an `inner` one adds a component to the model itself.
        while let Some(name) = self.member_at(node, at) {
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
                self.growth.enter(node, at - 1, nodes.len() - number - 1, self.nodes.len());
                let completed = self.complete(one);
                if let Err(error) = self.check_growth() {
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

    fn member_at(&self, node: NodeId, at: usize) -> Option<Ident> {
        let members = self.composite_of(node)?.members.as_ref()?;
        members.get_index(at).map(|(name, _)| *name)
    }
}

fn is_endless(error: &Diagnostic) -> bool {
    [CYCLIC_CLASS, TOO_LARGE].contains(&error.code)
}

/// How many times a class may hold a component of its own class.
const MAX_SELF: usize = 20;

/// Begins the path of a package's instance; no component can be named so.
const PACKAGE_MARK: char = '.';

/// The indices, from 1, of an element in an array, the last dimension fastest.
pub fn indices_of(mut at: usize, dims: &[usize]) -> Vec<usize> {
    let mut indices = vec![0; dims.len()];
    for (index, size) in indices.iter_mut().zip(dims).rev() {
        *index = at % size + 1;
        at /= size;
    }
    indices
}

/// The element of a value that belongs to one element of an array of components.
pub fn picked(value: Expression, indices: &[usize]) -> Expression {
    if indices.is_empty() {
        return value;
    }
    let span = value.span;
    let subscript =
        |at: &usize| Subscript::Index(Expression::new(ExpressionKind::Integer(*at as i64), span));
    let subscripts = indices.iter().map(subscript).collect();
    Expression::new(ExpressionKind::Subscripted { base: Box::new(value), subscripts }, span)
}

/// Whether a value is a component, or an element or component of one.
fn is_component(value: &Expression) -> bool {
    match &value.kind {
        ExpressionKind::Reference(_) => true,
        ExpressionKind::Subscripted { base, .. } | ExpressionKind::Field { base, .. } => {
            is_component(base)
        }
        _ => false,
    }
}

/// A component of a value.
fn component_of(value: &Expression, name: Ident) -> Expression {
    let kind = match &value.kind {
        ExpressionKind::Reference(reference) => {
            let mut longer = reference.clone();
            longer.parts.push(ReferencePart { name, subscripts: Vec::new() });
            ExpressionKind::Reference(longer)
        }
        _ => ExpressionKind::Field { base: Box::new(value.clone()), name },
    };
    Expression::new(kind, value.span)
}

fn variability(prefix: VariabilityPrefix) -> Variability {
    match prefix {
        VariabilityPrefix::Constant => Variability::Constant,
        VariabilityPrefix::Parameter => Variability::Parameter,
        VariabilityPrefix::Discrete => Variability::Discrete,
    }
}

fn stricter(outer: Option<Variability>, own: Option<Variability>) -> Option<Variability> {
    match (outer, own) {
        (Some(outer), Some(own)) => Some(outer.min(own)),
        (outer, own) => outer.or(own),
    }
}
