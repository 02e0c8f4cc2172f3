//! Compilation: a sorted system becomes a [`Program`] of instruction tapes, and every thread runs
//! its own [`System`] of it. Tapes that run often become machine code.

mod branches;
mod combinations;
mod continuation;
mod difference_quotients;
pub mod errors;
mod event_iteration;
mod events;
mod explanation;
mod held;
mod history;
mod hoist;
mod inquiry;
mod jacobian;
mod least_squares;
mod linear_system;
mod literal_relations;
mod lower;
mod machine_code;
mod memory;
mod newton;
mod notices;
mod program;
mod regions;
mod relations;
mod routines;
mod selection;
mod sensitivity;
mod sliding;
mod slopes;
mod system;
mod tape;
mod translation;
mod undetermined;

pub use machine_code::interpret;
pub use notices::Told;
pub use program::{Access, ParameterInfo, Program, VariableInfo};
pub use sensitivity::SensitivityCode;
pub use sliding::Treated;
pub use system::System;
pub use undetermined::Undetermined;
