//! The numbers of the scopes and of the nodes of one instantiation.

/// A class in its enclosing scope.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct ScopeId(pub u32);

impl ScopeId {
    /// The scope of the whole library, in which the top-level classes stand.
    pub(crate) const TOP: ScopeId = ScopeId(0);
}

/// A node of the instance tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct NodeId(pub usize);
