//! What instructions compute, once for tapes and functions, values and derivatives, interpreters and
//! machine code.
//!
//! ```text
//! operation    the operators, and their values for any number
//! number       numbers, without derivatives
//! dual         with a derivative, with two
//! elementary   functions of the table
//! partial      their derivatives for any number
//! translation  operations as code of Cranelift
//! ```

mod dual;
mod elementary;
mod number;
mod operation;
mod partial;
#[cfg(feature = "jit")]
pub(crate) mod translation;

pub use dual::Dual;
pub use elementary::Elementary;
pub use number::Number;
pub(crate) use operation::Register;
pub use operation::{Operation, Operator};
