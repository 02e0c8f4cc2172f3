//! The models of a session: classes and libraries, translation, simulation, linearization.

pub(in crate::script) mod along;
pub mod checking;
pub(in crate::script) mod classes;
pub(in crate::script) mod continuation;
pub(in crate::script) mod libraries;
pub(in crate::script) mod linearization;
pub(in crate::script) mod measured_units;
pub(in crate::script) mod resources;
pub(in crate::script) mod retranslation;
pub mod simulation;
pub(in crate::script) mod static_curve;
pub mod verification;
