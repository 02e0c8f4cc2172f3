//! The run time of compiled models: every thread runs its own [`System`] of a
//! [`Program`](crate::codegen::Program).
//!
//! The methods of a system lie in layers; those of a file call none of the files above it:
//!
//! ```text
//! dae_system             what integrators see: Residual, Sensitive, Events, Modes; above it exchange and
//!                        linearization, what other simulators and control engineers ask
//! given_start            simulations that begin where another one has ended
//! initialization         the first instant; parameter_path, where parameters that were set are far from
//!                        those of the model; initial_system
//! event_handling         an event with its sensitivities
//! event_iteration        discrete equations until pre(v) = v, mode_search where that does not end
//! sliding                both sides of relations that chatter; noevent_relations
//! other_variables        observation where some variables have no value
//! log_messages           warnings and printed strings; assertions, failure_messages
//! loading                unknowns to and from registers, loops solved inside
//! parameters             values set from outside, and what follows from them
//! relations              values of relations between events; postponement, roundings
//! sensitivity            forward sensitivities carried along
//! delays, transports     the past of delayed expressions; recordings, where the recorded inputs are
//! system                 registers, and blocks solved one after the other
//!
//! newton                 torn loops: Newton, then global_newton and levenberg_marquardt; zeros that
//!                        are isolated though the Jacobian is singular: multiple_roots; a start
//!                        where the residual is flat: bracketing
//! state_selection        dynamic state selection
//! ```

mod assertions;
mod bracketing;
mod dae_system;
mod declared_ranges;
mod delay_buffer;
mod delays;
mod difference_quotients;
mod event_handling;
mod event_iteration;
mod exchange;
mod execution;
mod failure_messages;
mod given_start;
mod global_newton;
mod initial_system;
mod initialization;
mod instants;
mod levenberg_marquardt;
mod linearization;
mod loading;
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
mod parameters;
mod partial_observation;
mod postponement;
mod profile;
mod recordings;
mod relations;
mod roundings;
mod sensitivity;
mod sensitivity_at_events;
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

pub use declared_ranges::DeclaredRange;
pub use exchange::{Along, Snapshot};
pub use loop_effort::LoopEffort;
pub use modes::Treated;
pub use simulation_log::LogMessage;
pub use singular_systems::Undetermined;
pub use state::GivenStart;
pub use system::System;
