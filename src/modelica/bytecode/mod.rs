//! Functions as instructions on registers, and the [`Machine`] that runs them.
//!
//! A [`Code`] is a function for arguments of known sizes: every scalar of its inputs, outputs and
//! variables is a register of its frame. Booleans are 0 and 1, Integers and ordinals whole numbers.
//! One loop runs the instructions on any [`Number`](crate::arithmetic::Number): on `f64` for values, on
//! [`Dual`](crate::arithmetic::Dual) numbers for derivatives (forward accumulation, [Griewank & Walther 2008](gapilib_base::bibliography#griewank-2008)),
//! on dual numbers of dual numbers for second derivatives. What runs often on values or on dual
//! numbers becomes machine code.
//!
//! ```text
//! frame   inputs | outputs, variables, temporaries and constants in any order
//! stack   frame of the caller | frame of the callee | …
//! ```
//!
//! A register that nothing was assigned to holds NaN; a decision by it fails, and so does returning
//! it.

#[cfg(feature = "jit")]
mod angles;
mod code;
#[cfg(feature = "jit")]
mod constants;
mod direct_calls;
mod external;
mod failure;
mod kinks;
mod machine;
mod machine_code;
mod memo;
mod range;
mod run_time_strings;
mod stacks;
#[cfg(feature = "jit")]
mod translation;
#[cfg(not(feature = "jit"))]
#[path = "without_translation.rs"]
mod translation;
mod validation;

pub use crate::external::Journal;
pub(crate) use code::ExternalCall;
pub use code::{Code, Derivative, Functions, Instruction};
pub use failure::{Failure, Reason};
pub use machine::Machine;
pub use run_time_strings::StringTable;
