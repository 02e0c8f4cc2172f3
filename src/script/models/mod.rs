//! The models of a session: classes and libraries, translation, simulation, linearization.

mod along;
mod c_functions;
pub mod changes;
pub mod checking;
pub mod classes;
pub mod compiled;
pub mod constant_cache;
mod continuation;
pub mod documents;
pub mod hardest;
mod left_open;
mod libraries;
pub mod library_files;
pub(in crate::script) mod linearization;
mod loading;
mod measured_units;
pub mod modification;
mod parameters;
mod resources;
pub mod simulation;
pub(in crate::script) mod static_curve;
pub mod stored;
pub mod translated;
pub mod verification;
mod warnings;
