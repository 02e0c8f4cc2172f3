//! Units of others: simulated in processes of their own, because what they do is not known.
//!
//! ```text
//! Pool ──Request──▶ worker: Unit ──▶ Component (functions of the shared library)
//!      ◀──Answer───         │
//!                           ├─ model exchange: ExchangeSystem, a system for `sim`
//!                           ├─ co-simulation: CoSimulation, steps between communication points
//!                           └─ scheduled execution: Scheduled, parts at the ticks of clocks
//! ```
//!
//! Each simulation has an instance of its own: nothing of the one before remains, so that results do
//! not depend on which process simulates. Not imported: clocks, scheduled execution, values of type
//! Binary; Strings can be set and are not recorded. Terminals, icons and layered standards have no
//! effect on a simulation.

#[cfg(feature = "host")]
mod binary;
#[cfg(feature = "host")]
mod calls;
#[cfg(feature = "host")]
mod component;
#[cfg(feature = "host")]
mod cosimulation;
mod directions;
#[cfg(feature = "host")]
mod exchange;
mod failure;
#[cfg(feature = "host")]
mod functions;
mod imported;
#[cfg(feature = "host")]
mod inputs;
mod layout;
#[cfg(feature = "host")]
mod log;
mod message;
mod plan;
mod platform;
mod pool;
#[cfg(feature = "host")]
mod scheduled;
mod sources;
#[cfg(feature = "host")]
mod stepped;
#[cfg(feature = "host")]
mod unit;
#[cfg(feature = "host")]
mod values;
mod worker;

#[cfg(feature = "host")]
pub use calls::CallWatch;
pub use directions::{Direction, Directions};
pub use failure::{FailureClass, SimulationFailure};
pub use imported::{Imported, is_parameter, why_not_set};
pub use layout::{Layout, Place, Scalar, is_recorded, refusal, starts};
pub use message::LogMessage;
pub use plan::{InterfaceKind, Plan, Samples};
pub use platform::{library_path, unusable};
pub use pool::{Ended, Host, NumberedPlan, Pool, Process, Start};
pub use sources::{Sources, sources};
#[cfg(feature = "host")]
pub use unit::Unit;
#[cfg(feature = "host")]
pub use worker::serve;
pub use worker::{Answer, Request, receive, send};
