//! The run time of compiled models: every thread runs its own [`System`] of a
//! [`Program`](crate::codegen::Program).
//!
//! ```text
//! system                 registers, parameter values, evaluation: the DaeSystem of the integrators
//! initialization         the initial system and the first instant; parameter_path, where parameters
//!                        that were set are far from those of the model; given_start, where another
//!                        simulation has ended
//! event_iteration        discrete equations until pre(v) = v, mode_search where that does not end
//! newton                 torn loops: Newton, then global_newton and levenberg_marquardt; zeros that
//!                        are isolated though the Jacobian is singular: multiple_roots; a start
//!                        where the residual is flat: bracketing
//! delay_buffer           the past of delayed expressions
//! recordings             where the recorded inputs are
//! state_selection        dynamic state selection
//! sliding                both sides of relations that chatter
//! sensitivity            forward sensitivities carried along
//! exchange               what other simulators ask of a system
//! log_messages           warnings and printed strings; failure_messages, singular_systems
//! ```

mod bracketing;
mod delay_buffer;
mod delays;
mod difference_quotients;
mod event_iteration;
mod exchange;
mod execution;
mod failure_messages;
mod given_start;
mod global_newton;
mod initialization;
mod instants;
mod levenberg_marquardt;
mod linearization;
mod log_messages;
mod loop_effort;
mod mode_search;
mod modes;
mod multiple_roots;
mod newton;
mod noevent_relations;
mod open_loops;
mod other_variables;
mod parameter_path;
mod partial_observation;
mod postponement;
mod profile;
mod recordings;
mod relations;
mod sensitivity;
mod sensitivity_state;
mod simulation_log;
mod singular_systems;
mod sliding;
mod solution_at_event;
mod state;
mod state_selection;
mod stuck_loops;
mod system;
mod transport_record;
mod transports;

pub use exchange::{Along, Snapshot};
pub use loop_effort::LoopEffort;
pub use modes::Treated;
pub use simulation_log::LogMessage;
pub use singular_systems::Undetermined;
pub use state::GivenStart;
pub use system::System;
