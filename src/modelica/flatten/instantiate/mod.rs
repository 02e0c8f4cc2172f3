//! The instance tree: components with merged modifiers, built as they are needed (MLS §5.6.1).

pub mod build;
pub mod components;
pub mod growth;
pub(crate) mod inner_outer;
pub mod instance;
pub(crate) mod instantiation;
pub(crate) mod own_sizes;
pub(crate) mod state_outputs;
pub mod tree;
