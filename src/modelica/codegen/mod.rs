//! Code generation: a causalized system becomes a [`Program`] — instruction tapes for the residuals,
//! Jacobians, crossing functions and events of a model; tapes that run often become machine code.
//!
//! ```text
//! iteration_variables   which tearing variables stay unknowns of the DAE
//! jacobian, sensitivity symbolic derivatives: forward mode, column by column
//! tape_builder          expressions as instructions, common subexpressions once
//! linear_part           the Jacobian as variables of the model
//! filter                derivatives by uncertain states, for the equations of their covariance
//! linearity             whether the right-hand side is affine between events
//! hoist                 what depends on parameters alone runs once a simulation
//! compilation           all of it, in order: Program::compile
//! exchange              what other simulators need to know of a model
//! machine_code          Cranelift's code of the tapes
//! ```

mod branches;
pub(crate) mod code;
mod compilation;
mod crossing_parts;
pub mod errors;
mod event_code;
pub(crate) mod events;
mod exchange;
mod filter;
pub(crate) mod hoist;
pub(crate) mod instruction;
mod iteration_variables;
pub(crate) mod jacobian;
mod linear_part;
pub(crate) mod linear_system;
mod linearity;
#[cfg(feature = "jit")]
mod machine_code;
#[cfg(not(feature = "jit"))]
#[path = "without_machine_code.rs"]
mod machine_code;
pub(crate) mod memory;
pub(crate) mod noevent_relations;
pub(crate) mod oscillations;
#[cfg(feature = "jit")]
mod pieces;
mod places;
pub(crate) mod program;
mod queries;
#[cfg(feature = "jit")]
mod regions;
pub(crate) mod registers;
mod relation_groups;
mod routines;
pub(crate) mod sensitivity;
pub(crate) mod sequence;
mod stored;
pub(crate) mod tape;
pub(crate) mod tape_builder;
#[cfg(feature = "jit")]
mod translation;
mod unread;
#[cfg(feature = "jit")]
mod upcalls;
mod validation;

pub use exchange::{Attributes, Needs};
pub use filter::{Uncertainty, gain, rate};
pub use linear_part::{InputChain, LinearEntry, LinearPart, ORDERS};
pub use program::{Access, ParameterInfo, Program, VariableInfo};
pub use sensitivity::SensitivityCode;
pub use stored::{bytes_of, is_reader};

/// From now on nothing becomes machine code in this process: for systems that forbid memory which is
/// made executable, and to see that the results are the same to the bit.
pub fn interpret() {
    crate::jit::interpret();
}
