//! Explicit steps from sample to sample of recorded inputs.
//!
//! Between two samples the solution is smooth, and where the states are slower than the samples a step of
//! the distance of two of them is short: the method of Dormand and Prince makes it with six evaluations
//! and without Jacobian, and nothing is lost at the samples, which a multistep method has to find its
//! order across. This is for systems without algebraic unknowns whose eigenvalues λ are in reach of the
//! method,
//!
//! ```text
//! ρ(J) ≤ min(‖D⁻¹ J D‖₁, ‖D⁻¹ J D‖∞),   D = diag(nominal)          ρ Δ ≤ REACH
//! ```
//!
//! with the mean distance Δ of samples. Where the steps nevertheless become much shorter than Δ, the
//! implicit method takes over for the rest of the simulation.

use super::dopri5;
use super::explicit::ExplicitRungeKutta;
use crate::sim::{DaeSystem, Failure, Settings};

/// The interval of stability of the method on the negative real axis is 3.3 long.
const REACH: f64 = 3.0;
/// Fewer samples than this are worth no other method.
const FEWEST: f64 = 50.0;
/// Attempts of steps for each sample after which the steps are too short, and how many may be more.
const MOST_ATTEMPTS: f64 = 4.0;
const SLACK: f64 = 100.0;

/// The method of such steps with its workspace.
pub(in crate::sim) struct Sampled {
    pub(in crate::sim) method: ExplicitRungeKutta,
    jacobian: Vec<f64>,
    columns: Vec<f64>,
    rows: Vec<f64>,
}

impl Default for Sampled {
    fn default() -> Sampled {
        Sampled {
            method: dopri5::new(),
            jacobian: Vec::new(),
            columns: Vec::new(),
            rows: Vec::new(),
        }
    }
}

/// How long explicit steps may continue.
#[derive(Debug, Clone, Copy)]
pub(in crate::sim) struct Patience {
    /// The mean distance of samples, s.
    distance: f64,
}

impl Patience {
    /// Whether so many attempts of steps were too many for this time.
    pub(in crate::sim) fn is_exhausted(self, attempts: u64, time: f64) -> bool {
        attempts as f64 > MOST_ATTEMPTS * time / self.distance + SLACK
    }
}

/// The distance of samples of a system that has so many that the method may suit.
pub(in crate::sim) fn distance(system: &dyn DaeSystem, settings: &Settings) -> Option<f64> {
    let (start, stop) = (settings.start, settings.stop);
    let suits = settings.takes_exact_steps
        && system.n_differential() > 0
        && system.n_algebraic() == 0
        && !system.remembers();
    let distance = system.sample_distance(start, stop).filter(|_| suits)?;
    (stop - start >= FEWEST * distance).then_some(distance)
}

impl Sampled {
    /// Whether the eigenvalues at (t, y) are in reach of steps as long as the distance of samples.
    pub(in crate::sim) fn suits(
        &mut self,
        system: &mut dyn DaeSystem,
        (t, y): (f64, &[f64]),
        nominal: &[f64],
        distance: f64,
    ) -> Result<Option<Patience>, Failure> {
        let n = nominal.len();
        self.jacobian.resize(system.pattern().rows.len(), 0.0);
        system.jacobian(t, &y[..n], &mut self.jacobian)?;
        for sums in [&mut self.columns, &mut self.rows] {
            sums.clear();
            sums.resize(n, 0.0);
        }
        let pattern = system.pattern();
        for column in 0..n {
            for at in pattern.column(column) {
                let row = pattern.rows[at];
                let entry = (self.jacobian[at] * nominal[column] / nominal[row]).abs();
                self.columns[column] += entry;
                self.rows[row] += entry;
            }
        }
        let largest = |sums: &[f64]| sums.iter().copied().fold(0.0, f64::max);
        let radius = largest(&self.columns).min(largest(&self.rows));
        let is_finite = self.columns.iter().all(|sum| sum.is_finite());
        Ok((is_finite && radius * distance <= REACH).then_some(Patience { distance }))
    }
}
