//! The syntax tree of classes and scripts, after MLS 3.6 appendix A. Data only.
//!
//! Printing a tree and reading it again gives the same tree, spans aside.

mod class;
mod component;
mod equation;
mod expression;
mod modification;
mod script;
mod statement;

pub use class::*;
pub use component::*;
pub use equation::*;
pub use expression::*;
pub use modification::*;
pub use script::*;
pub use statement::*;
