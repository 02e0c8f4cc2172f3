//! Evaluates syntax trees to values: expressions (MLS ch. 3, 10), statements (MLS ch. 11) and
//! functions written in Modelica (MLS ch. 12). Who answers calls and names that are not local is
//! the [`Host`].

mod function;
mod host;

pub use function::{Function, FunctionBody, FunctionComponent, ValueType};
pub use host::{Callee, Host, Intrinsic};
