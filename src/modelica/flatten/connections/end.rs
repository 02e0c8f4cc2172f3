//! The ends of a connection: connectors, or scalars of connectors.

use crate::flatten::ids::NodeId;

/// One connector, or one scalar of a connector that is a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum End {
    /// A connector with components.
    Composite(NodeId),
    /// A scalar: the variable's node and the place of the element in it, from 0.
    Scalar(NodeId, usize),
}

impl End {
    /// The connector, or the variable that the scalar is of.
    pub(crate) fn node(self) -> NodeId {
        match self {
            End::Composite(node) | End::Scalar(node, _) => node,
        }
    }
}

/// The connectors that a reference names.
#[derive(Debug, Clone)]
pub(crate) struct Ends {
    /// Sizes of the dimensions that subscripts leave.
    pub dims: Vec<usize>,
    /// One connector for each, the last index fastest.
    pub ends: Vec<End>,
    /// Whether they are seen from the outside: connectors of the instance itself.
    pub outside: bool,
}
