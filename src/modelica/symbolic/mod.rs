//! Scalar expressions as shared nodes of a [`Pool`]: building, differentiating, solving.
//!
//! A [`Pool`] keeps every node once, so equal expressions have equal ids and common subexpressions
//! are found by construction. An operand always has a smaller id than its node; hence every
//! algorithm here is one loop over [`Pool::reachable`] and none recurses, however deep the
//! expression is. Boolean values are the numbers 0 and 1.
//!
//! ```
//! use gapilib_modelica::symbolic::{Pool, VarId, derivative, evaluate};
//! let mut pool = Pool::new();
//! let x = pool.variable(VarId(0));
//! let sine = pool.function("sin", &[x]);
//! let product = pool.mul(x, sine);
//! let partial = derivative(&mut pool, product, VarId(0));
//! let expected = 0.5f64.sin() + 0.5 * 0.5f64.cos();
//! assert!((evaluate(&pool, partial,  &[0.5][..]) - expected).abs() < 1e-15);
//! ```

mod derivative;
mod evaluate;
pub mod function;
mod node;
mod pool;
mod print;
mod rounding;
mod simplify;
mod solve;
mod stored;
mod substitute;
#[cfg(test)]
mod tests;

pub use derivative::{derivative, differentiate};
pub(crate) use derivative::{differentiate_all, differentiate_forward};
pub use evaluate::{Environment, evaluate};
pub use node::{Arguments, Expr, Inverse, Node, Number, RelationOperator, VarId};
pub use pool::Pool;
pub(crate) use pool::{Containing, VariableCollection};
pub use print::print;
pub(crate) use rounding::up_to_rounding;
pub(crate) use solve::linear_in;
pub use solve::{Linear, Solution, solve};
pub(crate) use stored::{read_by_matrix, reading_variables};
pub(crate) use substitute::Substitution;
pub use substitute::substitute;
