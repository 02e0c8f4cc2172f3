//! The instance tree (MLS §5.6.1): components with their modifiers merged. Data only.

use crate::flatten::ids::NodeId;
use crate::flatten::ids::ScopeId;
use crate::flatten::lookup::modification::Modifier;
use crate::flatten::lookup::types::Predefined;
use crate::flatten::{BaseType, Variability};
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    CausalityPrefix, ConnectionPrefix, ElementPrefixes, Expression, Subscript, TypePrefixes,
    TypeSpecifier,
};
use crate::value::EnumerationDefinition;
use indexmap::IndexMap;
use std::sync::Arc;

/// An instance: of a class with components, or of a predefined type.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    /// The path from the model, such as `pack.cell[2]`; empty for the model itself.
    pub path: String,
    /// The instance that holds it.
    pub parent: Option<NodeId>,
    pub kind: NodeKind,
}

#[allow(clippy::large_enum_variant, reason = "most nodes are variables: a box would cost more")]
#[derive(Debug, Clone)]
pub(crate) enum NodeKind {
    /// Components, some of them not instantiated yet.
    Composite(Composite),
    /// A variable; its place in the flat model.
    Variable(Leaf),
}

/// An instance of a class with components.
#[derive(Debug, Clone)]
pub(crate) struct Composite {
    pub scope: ScopeId,
    /// The class that was asked for, without the modifiers of this instance.
    pub class: ScopeId,
    /// Its components; `None` as long as none is needed.
    pub members: Option<IndexMap<Ident, Member>>,
    pub inherited: Inherited,
    /// Whether its class is a connector, which may be known from a short class only.
    pub connector: bool,
}

/// What components inherit from the one that holds them.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Inherited {
    pub variability: Option<Variability>,
    pub causality: Option<CausalityPrefix>,
    pub connection: Option<ConnectionPrefix>,
    pub is_final: bool,
    pub protected: bool,
    pub depth: usize,
}

/// A component of a class.
#[derive(Debug, Clone)]
pub(crate) struct Member {
    pub declaration: Arc<Declaration>,
    pub state: MemberState,
}

/// How far the instantiation of a component is.
#[derive(Debug, Clone)]
pub(crate) enum MemberState {
    Pending,
    Busy,
    /// A component without dimensions, or whose type is predefined.
    Single(NodeId),
    /// An array of components, the last index fastest.
    Array(Vec<usize>, Vec<NodeId>),
    /// Its condition is false (MLS §4.4.5).
    Absent,
    /// An `outer` component: what its `inner` one is (MLS §5.4).
    Outer(Box<MemberState>),
    /// An `inner outer` component: its own instance, which encloses others, and what its name
    /// means in its own class (MLS §5.4).
    Both {
        inner: Box<MemberState>,
        outer: Box<MemberState>,
    },
}

impl MemberState {
    /// What belongs to the instance that holds the component.
    pub(crate) fn own(self) -> MemberState {
        match self {
            MemberState::Outer(_) => MemberState::Absent,
            MemberState::Both { inner, .. } => *inner,
            state => state,
        }
    }

    /// What the name of the component means in its class.
    pub(crate) fn seen(self) -> MemberState {
        match self {
            MemberState::Outer(state) | MemberState::Both { outer: state, .. } => *state,
            state => state,
        }
    }
}

/// The declaration of a component with its modifiers merged.
#[derive(Debug, Clone)]
pub(crate) struct Declaration {
    pub name: Ident,
    pub type_specifier: TypeSpecifier,
    /// Where its type is looked up.
    pub scope: ScopeId,
    /// Dimensions of the declaration, those of its type not included, each with its scope.
    pub dims: Vec<(Subscript, ScopeId)>,
    pub modifier: Modifier,
    pub condition: Option<(Expression, ScopeId)>,
    pub prefixes: ElementPrefixes,
    pub type_prefixes: TypePrefixes,
    pub is_final: bool,
    pub protected: bool,
    pub evaluate: bool,
    /// `annotation(absoluteValue = …)` (MLS §18).
    pub absolute: Option<bool>,
    pub description: Option<Arc<str>>,
    pub span: Span,
}

/// What a component is made of.
#[derive(Debug, Clone)]
pub(crate) enum Shape {
    Predefined(Predefined),
    Enumeration(Arc<EnumerationDefinition>),
    Class(ScopeId),
    /// A function, which only an input of a function can be (MLS §12.4.2).
    Function,
    /// An external object (MLS §12.9.7), of the class that extends `ExternalObject`.
    ExternalObject(Name),
}

/// What the type of a component is made of.
pub(crate) struct Expanded {
    pub shape: Shape,
    pub dims: Vec<(Subscript, ScopeId)>,
    pub modifier: Modifier,
    pub causality: Option<CausalityPrefix>,
    pub connection: Option<ConnectionPrefix>,
    pub connector: bool,
    /// The class that the type names, if it is not predefined.
    pub class: Option<ScopeId>,
    /// `annotation(absoluteValue = …)` of the outermost type that has it.
    pub absolute: Option<bool>,
}

/// A variable of the tree.
#[derive(Debug, Clone)]
pub(crate) struct Leaf {
    /// Its place in the list of variables.
    pub variable: usize,
    /// Its binding and attributes as written, resolved when the tree is whole.
    pub modifier: Modifier,
    /// `flow` or `stream`.
    pub connection: Option<ConnectionPrefix>,
    /// `input` or `output`, by itself or from what holds it.
    pub causality: Option<CausalityPrefix>,
    /// Whether its type is a connector.
    pub connector: bool,
    /// The class of its type, if that is not predefined.
    pub class: Option<ScopeId>,
}

impl Shape {
    /// The predefined type of a variable of this shape; `None` for a class.
    pub(crate) fn base(&self) -> Option<BaseType> {
        Some(match self {
            Shape::Predefined(Predefined::Real) => BaseType::Real,
            Shape::Predefined(Predefined::Integer) => BaseType::Integer,
            Shape::Predefined(Predefined::Boolean) => BaseType::Boolean,
            Shape::Predefined(Predefined::String) => BaseType::String,
            Shape::Predefined(Predefined::Clock) => BaseType::Clock,
            Shape::Enumeration(definition) => BaseType::Enumeration(definition.clone()),
            Shape::ExternalObject(name) => BaseType::ExternalObject(name.clone()),
            Shape::Predefined(_) | Shape::Function | Shape::Class(_) => return None,
        })
    }
}
