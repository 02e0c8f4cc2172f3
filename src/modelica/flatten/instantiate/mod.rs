//! The instance tree: components with merged modifiers, built as they are needed (MLS §5.6.1).

pub mod build;
pub mod components;
pub mod growth;
pub mod inner_outer;
pub mod instance;
pub mod instantiation;
pub mod own_sizes;
pub mod state_outputs;
pub mod tree;
