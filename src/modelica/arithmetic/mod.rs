//! What instructions compute, once for tapes and functions, values and derivatives, interpreters and
//! machine code.
//!
//! ```text
//! operation    the operators, and their values for any number
//! number       numbers: values (f64), with a derivative (dual), with two
//! elementary   functions of the table for any number
//! translation  operations as code of Cranelift
//! ```

mod elementary;
mod number;
mod operation;
#[cfg(feature = "jit")]
pub(crate) mod translation;

pub use elementary::Elementary;
pub use number::{Dual, Number};
pub(crate) use operation::Register;
pub use operation::{Operation, Operator};
