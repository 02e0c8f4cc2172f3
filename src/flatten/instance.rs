//! The instance tree (MLS §5.6.1): components with their modifiers merged. Data only.

use super::library::ClassId;
use super::lookup::Predefined;
use super::modification::Modifier;
use super::{BaseType, Variability};
use crate::name::Ident;
use crate::source::Span;
use crate::syntax::ast::{CausalityPrefix, Expression, Subscript};
use crate::value::EnumerationDefinition;
use indexmap::IndexMap;
use std::sync::Arc;

/// A node of the tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct NodeId(pub(super) usize);

/// Where an expression was written: the instance whose components its names mean, and the class
/// from which other names are looked up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Context {
    pub(super) node: NodeId,
    pub(super) class: Option<ClassId>,
}

/// An instance: of a class with components, or of a predefined type.
#[derive(Debug, Clone)]
pub(super) struct Node {
    /// The path from the model, such as `pack.cell[2]`; empty for the model itself.
    pub(super) path: String,
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
    pub(super) class: ClassId,
    /// Whether it is a record: its binding is split over its components.
    pub(super) record: bool,
    pub(super) members: IndexMap<Ident, Member>,
    /// The classes whose equations it has: bases first, the class itself last.
    pub(super) lineage: Vec<ClassId>,
    pub(super) inherited: Inherited,
}

/// What components inherit from the one that holds them.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Inherited {
    pub(super) variability: Option<Variability>,
    pub(super) causality: Option<CausalityPrefix>,
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
}

/// The declaration of a component with its modifiers merged.
#[derive(Debug, Clone)]
pub(super) struct Declaration {
    pub(super) name: Ident,
    pub(super) shape: Shape,
    /// Dimensions of the declaration, then those of its type, each with its scope.
    pub(super) dims: Vec<(Subscript, Context)>,
    pub(super) modifier: Modifier,
    pub(super) condition: Option<(Expression, Context)>,
    pub(super) variability: Option<Variability>,
    pub(super) causality: Option<CausalityPrefix>,
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
    Class(ClassId),
}

/// A variable of the tree.
#[derive(Debug, Clone)]
pub(super) struct Leaf {
    /// Its place in the list of variables.
    pub(super) variable: usize,
    /// Its binding and attributes as written, resolved when the tree is whole.
    pub(super) modifier: Modifier,
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
            Shape::Class(_) => return None,
        })
    }
}
