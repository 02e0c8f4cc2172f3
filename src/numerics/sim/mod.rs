//! Simulation: integrates a [`DaeSystem`] over time, locates events, records a [`Trajectory`].
//! Knows nothing of Modelica.
//!
//! ```text
//! initialize, record
//! until the end:
//!     make a step of the integrator, not beyond the next time event
//!     find the first change of sign of a crossing function within the step
//!     record the output points passed
//!     at an event: let the system handle it, record again, restart the integrator
//! ```
//!
//! ```
//! use gapilib_numerics::sim::{Events, Failure, Modes, Pattern, Residual, Sensitive, Settings, simulate};
//!
//! /// x' = −x, x(0) = 1
//! struct Decay(Pattern);
//!
//! impl Residual for Decay {
//!     fn n_differential(&self) -> usize { 1 }
//!     fn n_algebraic(&self) -> usize { 0 }
//!     fn nominal(&self, out: &mut [f64]) { out[0] = 1.0; }
//!     fn rhs(&mut self, _: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
//!         out[0] = -y[0];
//!         Ok(())
//!     }
//!     fn pattern(&self) -> &Pattern { &self.0 }
//!     fn jacobian(&mut self, _: f64, _: &[f64], out: &mut [f64]) -> Result<(), Failure> {
//!         out[0] = -1.0;
//!         Ok(())
//!     }
//!     fn initialize(&mut self, _: f64, y: &mut [f64]) -> Result<(), Failure> {
//!         y[0] = 1.0;
//!         Ok(())
//!     }
//!     fn n_observed(&self) -> usize { 1 }
//!     fn observe(&mut self, _: f64, y: &[f64], out: &mut [f64]) -> Result<(), Failure> {
//!         out[0] = y[0];
//!         Ok(())
//!     }
//! }
//! // Neither parameters nor events.
//! impl Sensitive for Decay {}
//! impl Events for Decay {}
//! impl Modes for Decay {}
//!
//! let pattern = Pattern { n: 1, column_starts: vec![0, 1], rows: vec![0] };
//! let (trajectory, _) = simulate(&mut Decay(pattern), &Settings::default())?;
//! assert!((trajectory.at(0, 1.0).unwrap() - (-1f64).exp()).abs() < 1e-4);
//! # Ok::<(), gapilib_numerics::sim::SimError>(())
//! ```
//!
//! The methods of a run lie in layers; those of a file call none of the files above it:
//!
//! ```text
//! simulator              the workspace of simulations
//! simulation_loop        steps up to their ends or to events; curves, where there is nothing to integrate
//! branch_switch          where no step can be made
//! event_handling         what follows from an event; chattering, literal_relations
//! displacement           which slides persist after an event; accumulation, which begin by impacts
//! slides                 where slides begin and end; event_chain, continuation, explicit_steps, inner_loops
//! run                    the state of a run, restarts; recording, event_location
//! ```
//!
//! The systems are those of [`DaeSystem`]: semi-explicit, index 1. Not handled here: index reduction
//! and the choice of states (done before).
//!
//! References: [Brenan, Campbell & Petzold 1996](gapilib_base::bibliography#brenan-campbell-petzold-1996),
//! [Shampine & Reichelt 1997](gapilib_base::bibliography#shampine-reichelt-1997).

mod accumulation;
mod before_event;
mod branch_switch;
mod chattering;
mod continuation;
mod curves;
mod displacement;
mod effort;
mod error;
mod event;
mod event_chain;
mod event_handling;
mod event_location;
mod event_rush;
mod explicit_steps;
mod inner_loops;
mod instants;
mod integrators;
mod linear;
mod literal_relations;
mod newton;
mod nominals;
mod norm;
mod portable;
#[cfg(test)]
mod problems;
mod progress;
mod recorder;
mod recording;
mod run;
mod settings;
mod simulation_loop;
mod simulator;
mod slides;
mod sliding;
mod statistics;
mod step_budget;
mod switches;
mod system;
#[cfg(test)]
mod tests;
mod trajectory;

pub use effort::Effort;
pub use error::{Failure, Offending, SimError, SimErrorKind};
pub use instants::{AT_ONCE, same_time};
#[cfg(test)]
pub(crate) use integrators::INTEGRATORS;
pub use integrators::{Integrator, Problem, find_integrator};
pub use linear::{DenseLu, Factorization, SingularMatrix, interpret};
pub use newton::{Equations, Newton, NewtonFailure, gather};
pub use portable::PortableSettings;
pub use run::Ended;
pub use settings::{OutputGrid, Settings, TimeBudget};
pub use simulator::{End, Simulator, simulate};
pub use statistics::Statistics;
pub use system::{
    DaeSystem, EventOutcome, Events, Linearity, Modes, Pattern, Residual, Sensitive, Side,
    Treatment,
};
pub use trajectory::Trajectory;
