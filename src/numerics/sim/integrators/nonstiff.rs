//! Explicit steps of systems that are not stiff.
//!
//! Where the states are no faster than the steps that are made anyway, an explicit method makes these with
//! a few evaluations and without a Jacobian, and nothing is lost at samples of inputs and at events, which
//! a multistep method has to find its order across. This is for systems without algebraic unknowns
//! and without kinks (as of `abs`, or of relations inside `noEvent`), whose eigenvalues λ are in reach of
//! the method,
//!
//! ```text
//! ρ(J) ≤ min(‖D⁻¹ J D‖₁, ‖D⁻¹ J D‖∞),   D = diag(nominal)          ρ Δ ≤ REACH
//! ```
//!
//! with the mean distance Δ of the samples of inputs, or else a small part of the simulation. With samples
//! the method suits somewhat faster systems, too, ρ Δ ≤ STEPS REACH: some explicit steps from sample to
//! sample cost less than the steps of low order that a multistep method begins with after each. Where the
//! steps nevertheless become shorter, the implicit method takes over for the rest of the simulation. The
//! method is that of Dormand and Prince of order 5; of order 8 where the tolerance is tight and no sample
//! cuts the steps.

use super::explicit::ExplicitRungeKutta;
use super::{Integrator, dop853, dopri5};
use crate::sim::{DaeSystem, Failure, Settings};

/// The interval of stability of the method on the negative real axis is 3.3 long.
const REACH: f64 = 3.0;
/// So many steps from sample to sample are worth it. With a cell of two RC elements and 3,600 held
/// samples, the implicit method makes 10 to 17 steps at a tolerance of 1e-6 where λ Δ is -1 to -10.
const STEPS: f64 = 8.0;
/// Fewer samples than this say nothing of the steps.
const FEWEST: f64 = 50.0;
/// Parts of the simulation that are steps without samples.
const PARTS: f64 = 100.0;
/// So many attempts of steps must lead over some distances: this many of them may be made for each. With
/// half as many, a tank with inflows that jump at each sample and λ Δ = -5 was handed over, at 1e-6, to
/// the implicit method, which took 45 steps for each sample.
const ATTEMPTS: u64 = 100;
const MOST_ATTEMPTS: f64 = 3.0 * STEPS;
/// The same where there are no samples, and the tolerance alone shortens steps.
const MOST_ATTEMPTS_FREE: f64 = 40.0;
/// Tolerances from which on the method of order 8 needs fewer evaluations.
const TIGHT: f64 = 1e-7;

/// The methods of such steps with their workspace.
pub(in crate::sim) struct Nonstiff {
    order_5: ExplicitRungeKutta,
    order_8: ExplicitRungeKutta,
    jacobian: Vec<f64>,
    columns: Vec<f64>,
    rows: Vec<f64>,
}

impl Default for Nonstiff {
    fn default() -> Nonstiff {
        Nonstiff {
            order_5: dopri5::new(),
            order_8: dop853::new(),
            jacobian: Vec::new(),
            columns: Vec::new(),
            rows: Vec::new(),
        }
    }
}

/// How long steps should be.
#[derive(Debug, Clone, Copy)]
pub(in crate::sim) struct Distance {
    /// s
    length: f64,
    /// Whether it is that of samples.
    is_sampled: bool,
}

/// How long explicit steps may continue.
#[derive(Debug, Clone, Copy)]
pub(in crate::sim) struct Patience {
    /// How far the next attempts must lead, s.
    way: f64,
    /// Time and attempts when it was checked last.
    time: f64,
    attempts: u64,
}

impl Patience {
    /// Whether the last attempts, of so many, have not led far enough at this time.
    pub(in crate::sim) fn is_exhausted(&mut self, attempts: u64, time: f64) -> bool {
        if attempts - self.attempts < ATTEMPTS {
            return false;
        }
        let is_short = time - self.time < self.way;
        (self.time, self.attempts) = (time, attempts);
        is_short
    }
}

/// How long the steps of a system should be that the method may suit.
pub(in crate::sim) fn distance(system: &dyn DaeSystem, settings: &Settings) -> Option<Distance> {
    let (start, stop) = (settings.start, settings.stop);
    let suits = settings.takes_exact_steps
        && system.n_differential() > 0
        && system.n_algebraic() == 0
        && !system.remembers()
        // The error of a step over a kink is not seen by comparing two methods of high order.
        && !system.has_kinks();
    let samples = system.sample_distance(start, stop);
    let samples = samples.filter(|distance| stop - start >= FEWEST * distance);
    let length = samples.unwrap_or((stop - start) / PARTS);
    suits.then_some(Distance { length, is_sampled: samples.is_some() })
}

impl Nonstiff {
    /// The method for a tolerance.
    pub(in crate::sim) fn method(
        &mut self,
        tolerance: f64,
        distance: Distance,
    ) -> &mut dyn Integrator {
        match tolerance <= TIGHT && !distance.is_sampled {
            true => &mut self.order_8,
            false => &mut self.order_5,
        }
    }

    /// Whether the eigenvalues at (t, y) are in reach of such steps.
    pub(in crate::sim) fn suits(
        &mut self,
        system: &mut dyn DaeSystem,
        (t, y): (f64, &[f64]),
        nominal: &[f64],
        distance: Distance,
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
        let (steps, most) = match distance.is_sampled {
            true => (STEPS, MOST_ATTEMPTS),
            false => (1.0, MOST_ATTEMPTS_FREE),
        };
        let way = ATTEMPTS as f64 / most * distance.length;
        let patience = Patience { way, time: t, attempts: 0 };
        Ok((is_finite && radius * distance.length <= steps * REACH).then_some(patience))
    }
}
