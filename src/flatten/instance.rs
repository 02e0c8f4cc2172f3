//! The instance tree (MLS §5.6.1): components with their modifiers merged. Data only.

use super::lookup::Predefined;
use super::modification::Modifier;
use super::scope::ScopeId;
use super::{BaseType, Variability};
use crate::name::{Ident, Name};
use crate::source::Span;
use crate::syntax::ast::{
    CausalityPrefix, ConnectionPrefix, ElementPrefixes, Expression, Subscript, TypePrefixes,
    TypeSpecifier,
};
use crate::value::EnumerationDefinition;
use indexmap::IndexMap;
use std::sync::Arc;

/// A node of the tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct NodeId(pub(super) usize);

/// An instance: of a class with components, or of a predefined type.
#[derive(Debug, Clone)]
pub(super) struct Node {
    /// The path from the model, such as `pack.cell[2]`; empty for the model itself.
    pub(super) path: String,
    /// The instance that holds it.
    pub(super) parent: Option<NodeId>,
    pub(super) kind: NodeKind,
}

#[derive(Debug, Clone)]
pub(super) enum NodeKind {
    /// Components, some of them not instantiated yet.
    Composite(Composite),
    /// A variable; its place in the flat model.
    Variable(Leaf),
}

/// An instance of a class with components.
#[derive(Debug, Clone)]
pub(super) struct Composite {
    pub(super) scope: ScopeId,
    /// The class that was asked for, without the modifiers of this instance.
    pub(super) class: ScopeId,
    /// Its components; `None` as long as nobody asked for one.
    pub(super) members: Option<IndexMap<Ident, Member>>,
    pub(super) inherited: Inherited,
    /// Whether its class is a connector, which may be known from a short class only.
    pub(super) connector: bool,
}

/// What components inherit from the one that holds them.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Inherited {
    pub(super) variability: Option<Variability>,
    pub(super) causality: Option<CausalityPrefix>,
    pub(super) connection: Option<ConnectionPrefix>,
    pub(super) is_final: bool,
    pub(super) protected: bool,
    pub(super) depth: usize,
}

/// A component of a class.
#[derive(Debug, Clone)]
pub(super) struct Member {
    pub(super) declaration: Arc<Declaration>,
    pub(super) state: MemberState,
}

/// How far the instantiation of a component is.
#[derive(Debug, Clone)]
pub(super) enum MemberState {
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
    pub(super) fn own(self) -> MemberState {
        match self {
            MemberState::Outer(_) => MemberState::Absent,
            MemberState::Both { inner, .. } => *inner,
            state => state,
        }
    }

    /// What the name of the component means in its class.
    pub(super) fn seen(self) -> MemberState {
        match self {
            MemberState::Outer(state) | MemberState::Both { outer: state, .. } => *state,
            state => state,
        }
    }
}

/// The declaration of a component with its modifiers merged.
#[derive(Debug, Clone)]
pub(super) struct Declaration {
    pub(super) name: Ident,
    pub(super) type_specifier: TypeSpecifier,
    /// Where its type is looked up.
    pub(super) scope: ScopeId,
    /// Dimensions of the declaration, those of its type not included, each with its scope.
    pub(super) dims: Vec<(Subscript, ScopeId)>,
    pub(super) modifier: Modifier,
    pub(super) condition: Option<(Expression, ScopeId)>,
    pub(super) prefixes: ElementPrefixes,
    pub(super) type_prefixes: TypePrefixes,
    pub(super) is_final: bool,
    pub(super) protected: bool,
    pub(super) evaluate: bool,
    pub(super) description: Option<Arc<str>>,
    pub(super) span: Span,
}

/// What a component is made of.
#[derive(Debug, Clone)]
pub(super) enum Shape {
    Predefined(Predefined),
    Enumeration(Arc<EnumerationDefinition>),
    Class(ScopeId),
    /// A function, which only an input of a function can be (MLS §12.4.2).
    Function,
    /// An external object (MLS §12.9.7), of the class that extends `ExternalObject`.
    ExternalObject(Name),
}

/// A variable of the tree.
#[derive(Debug, Clone)]
pub(super) struct Leaf {
    /// Its place in the list of variables.
    pub(super) variable: usize,
    /// Its binding and attributes as written, resolved when the tree is whole.
    pub(super) modifier: Modifier,
    /// `flow` or `stream`.
    pub(super) connection: Option<ConnectionPrefix>,
    /// `input` or `output`, by itself or from what holds it.
    pub(super) causality: Option<CausalityPrefix>,
    /// Whether its type is a connector.
    pub(super) connector: bool,
    /// The class of its type, if that is not predefined.
    pub(super) class: Option<ScopeId>,
}

impl Shape {
    /// The predefined type of a variable of this shape; `None` for a class.
    pub(super) fn base(&self) -> Option<BaseType> {
        Some(match self {
            Shape::Predefined(Predefined::Real) => BaseType::Real,
            Shape::Predefined(Predefined::Integer) => BaseType::Integer,
            Shape::Predefined(Predefined::Boolean) => BaseType::Boolean,
            Shape::Predefined(Predefined::String) => BaseType::String,
            Shape::Enumeration(definition) => BaseType::Enumeration(definition.clone()),
            Shape::ExternalObject(name) => BaseType::ExternalObject(name.clone()),
            Shape::Predefined(_) | Shape::Function | Shape::Class(_) => return None,
        })
    }
}
