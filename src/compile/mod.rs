//! Compilation: a sorted system becomes a [`Program`] of instruction tapes, and every thread runs
//! its own [`System`] of it.

pub mod errors;
mod event_iteration;
mod events;
mod history;
mod hoist;
mod jacobian;
mod least_squares;
mod linear_system;
mod lower;
mod memory;
mod newton;
mod program;
mod relations;
mod selection;
mod system;
mod tape;

pub use program::{Access, ParameterInfo, Program, VariableInfo};
pub use system::System;
