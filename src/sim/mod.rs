//! Simulation: integrates a [`DaeSystem`] over time, locates events, records a [`Trajectory`].
//! Knows nothing of Modelica.
//!
//! ```text
//! initialise, record
//! until the end:
//!     make a step of the integrator, not beyond the next time event
//!     find the first change of sign of a crossing function within the step
//!     record the output points passed
//!     at an event: let the system handle it, record again, restart the integrator
//! ```
//!
//! The systems are those of [`DaeSystem`]: semi-explicit, index 1. Not handled here: index reduction
//! and the choice of states (done before), delays, sliding along a discontinuity (reported as
//! chattering).
//!
//! References: [Brenan, Campbell & Petzold 1996](crate::bibliography#brenan-campbell-petzold-1996),
//! [Shampine & Reichelt 1997](crate::bibliography#shampine-reichelt-1997).

mod error;
mod event;
mod integrators;
mod linear;
mod norm;
#[cfg(test)]
mod problems;
mod settings;
mod simulator;
mod statistics;
mod system;
#[cfg(test)]
mod tests;
mod trajectory;

pub use error::{Failure, SimError, SimErrorKind};
pub use integrators::{INTEGRATORS, Integrator, Problem, find_integrator};
pub use linear::{DenseLu, Factorization, SingularMatrix};
pub use settings::{OutputGrid, Settings};
pub use simulator::{Simulator, simulate};
pub use statistics::Statistics;
pub use system::{DaeSystem, EventOutcome, Pattern};
pub use trajectory::Trajectory;
