//! What simulations of a unit have in common.

use super::layout::Place;
use serde::{Deserialize, Serialize};

/// The kinds of units that are imported.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum InterfaceKind {
    /// The unit gives derivatives and events to the integrators of this program.
    ModelExchange,
    /// The unit integrates itself between communication points.
    CoSimulation,
    /// This program activates its parts at the ticks of their clocks.
    ScheduledExecution,
}

/// What simulations of a unit have in common.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// Who integrates.
    pub kind: InterfaceKind,
    /// Values in place of start values, structural parameters included.
    pub numbers: Vec<(Place, f64)>,
    /// Strings in place of start values, by the places of their variables.
    pub strings: Vec<(usize, Vec<String>)>,
    /// What has another value in each simulation.
    pub varied: Vec<Place>,
    /// Inputs that follow samples.
    pub inputs: Vec<Samples>,
    /// What is recorded.
    pub observed: Vec<Place>,
    /// Whether what is recorded is followed by its derivatives by what varies.
    pub differentiates: bool,
}

/// Samples that an input follows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Samples {
    /// The input.
    pub place: Place,
    /// Times, seconds, ascending; two at one time are the values before and after a jump.
    pub times: Vec<f64>,
    /// Values; before the first and after the last sample they continue as constants.
    pub values: Vec<f64>,
    /// Whether each value is held until the next sample; otherwise they are connected by lines.
    pub is_held: bool,
}
