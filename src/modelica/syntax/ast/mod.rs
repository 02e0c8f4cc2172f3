//! The syntax tree of classes and scripts, after MLS 3.6 appendix A. Data only.
//!
//! Printing a tree and reading it again gives the same tree, spans aside.

mod chain;
mod class;
mod expression;
mod script;
mod statements;

pub use chain::{LeftOperand, Operation};
pub use class::*;
pub use expression::*;
pub use script::*;
pub use statements::{simple_statements, targets};
