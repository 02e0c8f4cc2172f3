//! The instance tree: components with merged modifiers, built as they are needed (MLS §5.6.1).

pub(crate) mod build;
pub(crate) mod components;
pub(crate) mod growth;
pub(crate) mod inner_outer;
pub(crate) mod instance;
pub(crate) mod instantiation;
pub(crate) mod own_sizes;
pub(crate) mod state_outputs;
pub(crate) mod tree;
