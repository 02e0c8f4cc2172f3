//! Simulation: integrates a [`DaeSystem`] over time, locates events, records a [`Trajectory`].
//! Knows nothing of Modelica.

mod error;
mod system;

pub use error::{Failure, SimError, SimErrorKind};
pub use system::{DaeSystem, EventOutcome, Pattern};
