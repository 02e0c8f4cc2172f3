//! One simulation as it is asked for and answered, by a thread of this process or by another rank.

use crate::problem::{Failed, FailureKind, Simulate};
use serde::{Deserialize, Serialize};

/// What is requested of an individual.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Asked {
    /// Its points.
    Points,
    /// Exact derivatives, or its points where there are none.
    DerivativesOrPoints,
    /// Exact derivatives, or nothing.
    Derivatives,
}

/// Individuals to simulate.
#[derive(Debug, Clone, Copy)]
pub struct Batch<'a> {
    /// Values of the parameters, individual by individual.
    pub values: &'a [f64],
    /// Parameters of one individual.
    pub parameters: usize,
    /// Points of one individual.
    pub points: usize,
    /// What is requested of each.
    pub asked: Asked,
    /// What the solver's tolerance is multiplied with.
    pub tolerance: f64,
}

/// The answer for one individual.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Simulation {
    /// The simulated points; NaN where it failed.
    pub row: Vec<f64>,
    /// Derivatives of the points by the parameters, points × parameters; empty where there are none.
    pub derivatives: Vec<f64>,
    /// Whether the derivatives are exact.
    pub exact: bool,
    /// Why there are none.
    pub refusal: Option<String>,
    /// Why it failed.
    pub failed: Option<Failed>,
}

impl Batch<'_> {
    /// Number of individuals.
    pub fn len(&self) -> usize {
        self.values.len() / self.parameters.max(1)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The values of one individual.
    pub fn row(&self, individual: usize) -> &[f64] {
        &self.values[individual * self.parameters..(individual + 1) * self.parameters]
    }
}

impl Simulation {
    /// The answer for an individual that was cancelled; it is not used.
    pub fn cancelled(batch: &Batch<'_>) -> Simulation {
        let failed = cancelled();
        let row = vec![f64::NAN; batch.points];
        Simulation { row, failed: Some(failed), ..Simulation::default() }
    }
}

/// What is answered where a simulation was cancelled.
pub(super) fn cancelled() -> Failed {
    Failed::new(FailureKind::Budget, "the simulation was cancelled", 0.0)
}

/// Simulates one individual of a batch.
pub fn simulate(simulator: &mut dyn Simulate, batch: &Batch<'_>, individual: usize) -> Simulation {
    let values = batch.row(individual);
    let mut row = vec![f64::NAN; batch.points];
    let mut refusal = None;
    if batch.asked != Asked::Points {
        let mut derivatives = vec![f64::NAN; batch.points * values.len()];
        let found = simulator.sensitivities(values, &mut row, &mut derivatives);
        let is_finite = derivatives.iter().all(|value| value.is_finite());
        if found == Ok(true) && (is_finite || batch.asked == Asked::Derivatives) {
            return Simulation { row, derivatives, exact: true, ..Simulation::default() };
        }
        refusal = simulator.sensitivity_refusal().map(str::to_owned);
        if batch.asked == Asked::Derivatives {
            return Simulation { row, refusal, failed: found.err(), ..Simulation::default() };
        }
    }
    let failed = simulator.simulate(values, &mut row).err();
    if failed.is_some() {
        row.fill(f64::NAN);
    }
    Simulation { row, refusal, failed, ..Simulation::default() }
}
