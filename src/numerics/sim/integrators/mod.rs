//! Integrators: methods that advance x and v by one step.

pub(super) mod bdf;
mod dop853;
mod dopri5;
mod euler;
mod exact;
mod explicit;
mod exponential;
mod mass_matrix;
pub(super) mod nonstiff;
mod radau;
mod rodas;
mod rungekutta;
mod step_control;
mod without_unknowns;

use super::sliding::Sliding;
use super::step_budget::StepBudget;
use super::{Residual, Sensitive, Settings, SimErrorKind, Statistics, TimeBudget};
use crate::diag::Fault;
use crate::registry::{self, Entry};
pub(super) use exact::Exact;
use std::sync::atomic::Ordering;
pub(super) use without_unknowns::WithoutUnknowns;

/// The methods a script may ask for.
pub(crate) const INTEGRATORS: &[&Entry<dyn Integrator>] = &[
    &bdf::ENTRY,
    &rodas::ENTRY,
    &radau::ENTRY,
    &dopri5::ENTRY,
    &dop853::ENTRY,
    &euler::ENTRY,
    &rungekutta::ORDER_2,
    &rungekutta::ORDER_3,
    &rungekutta::ENTRY,
];

/// The method where none is asked for.
pub const DEFAULT: &Entry<dyn Integrator> = &bdf::ENTRY;

/// The method of this name or alias.
///
/// # Errors
/// `unknown-choice` with the names there are.
pub fn find_integrator(name: &str) -> Result<&'static Entry<dyn Integrator>, Fault> {
    registry::find("integration method", INTEGRATORS, name)
}

/// A method with its workspace. [`Integrator::restart`] comes first, then any number of steps.
pub trait Integrator: Send {
    /// Whether systems with algebraic unknowns are out of reach.
    fn is_explicit(&self) -> bool;

    /// Forgets the past and starts at (t, y).
    ///
    /// # Errors
    /// What an evaluation at (t, y) reports.
    fn restart(&mut self, problem: &mut Problem, t: f64, y: &[f64]) -> Result<(), SimErrorKind>;

    /// Makes one step, at most to `limit`, which is exactly reached if the step would come near it.
    ///
    /// # Errors
    /// Why no step could be made, however small; then only a restart helps.
    fn step(&mut self, problem: &mut Problem, limit: f64) -> Result<(), SimErrorKind>;

    /// The end of the last step.
    fn time(&self) -> f64;

    /// How long the next step is meant to be, seconds, where the method keeps nothing else.
    fn next_step(&self) -> Option<f64> {
        None
    }

    /// The unknown with the largest part in the error of the last step, where the method knows.
    fn dominant(&self) -> Option<usize> {
        None
    }

    /// Whether it can continue after an event: see [`Integrator::continue_from`].
    fn keeps_past(&self) -> bool {
        false
    }

    /// Continues from (t, y), where t is within the last step or at its end and y is its solution
    /// there, as if the step had ended there, with a next step of at most `longest`. Whether it
    /// does; if not, nothing has changed, and it needs a restart.
    fn continue_from(&mut self, _t: f64, _y: &[f64], _longest: f64) -> bool {
        false
    }

    /// Whether the algebraic unknowns of which it knows a past are determined at (t, y).
    fn determines_unknowns(&mut self, _problem: &mut Problem, _t: f64, _y: &[f64]) -> bool {
        true
    }

    /// Notes that the right-hand side at the end of the last step is another one since, although
    /// there was no event: what is known of it there does not hold any more.
    fn branches_changed(&mut self) {}

    /// y at the end of the last step.
    fn state(&self) -> &[f64];

    /// Writes y at a time within the last step.
    fn interpolate(&self, t: f64, y: &mut [f64]);
}

/// What an integrator works on.
pub struct Problem<'a> {
    /// The system.
    pub(super) system: &'a mut Sliding<'a>,
    /// Typical magnitude of every y, positive and finite.
    pub nominal: &'a [f64],
    /// What is asked for.
    pub settings: &'a Settings,
    /// What it cost so far.
    pub statistics: &'a mut Statistics,
    /// How many steps it may take.
    pub budget: StepBudget,
    /// When the clock of the time budget ends the simulation.
    pub(crate) deadline: Option<f64>,
    /// The sum of the steps since the last restart, s: more exact than the difference of times far from
    /// zero.
    pub elapsed: f64,
}

impl<'a> Problem<'a> {
    /// A simulation at its begin.
    pub(super) fn new(
        system: &'a mut Sliding<'a>,
        nominal: &'a [f64],
        settings: &'a Settings,
        statistics: &'a mut Statistics,
    ) -> Problem<'a> {
        let Settings { start, max_steps, max_total_steps, .. } = *settings;
        Problem {
            system,
            nominal,
            settings,
            statistics,
            budget: StepBudget::new(start, max_steps, max_total_steps),
            deadline: settings.time_budget.map(|budget| (budget.clock)() + budget.seconds),
            elapsed: 0.0,
        }
    }
}

impl Problem<'_> {
    /// Evaluates the right-hand side; an error also if a value is not finite.
    fn rhs(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), SimErrorKind> {
        self.statistics.rhs_evaluations += 1;
        self.system.rhs(t, y, out).map_err(SimErrorKind::Evaluation)?;
        if out.iter().all(|value| value.is_finite()) {
            Ok(())
        } else {
            Err(SimErrorKind::NotFinite)
        }
    }

    /// Evaluates the derivatives of the right-hand side along all directions, y with its own given;
    /// an error also if one is not finite.
    fn sensitivity_rhs(&mut self, t: f64, y: &[f64], out: &mut [f64]) -> Result<(), SimErrorKind> {
        self.statistics.sensitivity_evaluations += 1;
        self.system.sensitivity_rhs(t, y, out).map_err(SimErrorKind::Evaluation)?;
        if out.iter().all(|value| value.is_finite()) {
            Ok(())
        } else {
            Err(SimErrorKind::NotFinite)
        }
    }

    /// Evaluates the nonzeros of the Jacobian; an error also if one is not finite.
    fn jacobian(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), SimErrorKind> {
        self.statistics.jacobian_evaluations += 1;
        self.system.jacobian(t, y, values).map_err(SimErrorKind::Evaluation)?;
        if values.iter().all(|value| value.is_finite()) {
            Ok(())
        } else {
            Err(SimErrorKind::NotFinite)
        }
    }

    /// Asks before every attempt of a step whether to continue.
    pub(super) fn may_continue(&self) -> Result<(), SimErrorKind> {
        if self.statistics.attempts() >= self.budget.allowed {
            return Err(SimErrorKind::StepBudget);
        }
        let late = |(deadline, budget): (f64, TimeBudget)| (budget.clock)() > deadline;
        if self.deadline.zip(self.settings.time_budget).is_some_and(late) {
            return Err(SimErrorKind::TimeBudget);
        }
        let cancelled =
            self.settings.cancel.as_ref().is_some_and(|cancel| cancel.load(Ordering::Relaxed));
        if cancelled { Err(SimErrorKind::Cancelled) } else { Ok(()) }
    }

    /// Number of the unknowns whose errors count: all but the auxiliary ones.
    pub(super) fn n_tested(&self) -> usize {
        let system = &self.system;
        system.n_differential() + system.n_algebraic() - system.n_auxiliary()
    }

    /// The unknowns of algebraic loops.
    fn coupled(&self) -> Vec<usize> {
        (self.system.n_differential()..self.n_tested()).collect()
    }

    /// The smallest step that changes the time since the last restart noticeably, by two or more of its
    /// last binary digits. Steps after it may be shorter than the digits of t itself: what relaxes
    /// with a rate of 1e12/s does so also where the simulation begins at -1e7 s (Brannmark_JBC2010).
    ///
    /// With 16 digits WindPowerPlants GenericPlant_B did not pass a jump without an event two months
    /// after its start, nor TGM_Trina_Analytical_2016 a transient of 1e-6 s five days after it.
    fn smallest_step(&self) -> f64 {
        let span = (self.settings.stop - self.settings.start).abs();
        2.0 * f64::EPSILON * self.elapsed.max(1e-10 * span)
    }

    /// Notes a step that was made, s.
    fn note_step(&mut self, h: f64) {
        self.statistics.steps += 1;
        self.elapsed += h;
    }

    /// A first step over which x changes little, from the relative speed of x at (t, y). It is not
    /// longer than the distance of output points: derivatives that are zero at first predict
    /// nothing, and users who set output points expect changes between them.
    fn first_step(&self, t: f64, y: &[f64], rhs: &[f64]) -> f64 {
        let settings = self.settings;
        let n = self.system.n_differential();
        let speed = |i: usize| rhs[i].abs() / y[i].abs().max(self.nominal[i]);
        let fastest = (0..n).map(speed).fold(0.0, f64::max);
        let remaining = settings.stop - t;
        let by_speed = 0.5 * settings.tolerance.sqrt() / fastest;
        let longest = settings.output.spacing(settings.start, settings.stop).min(1e-2 * remaining);
        let first = settings.initial_step.unwrap_or(by_speed.min(longest));
        first.min(settings.max_step).max(self.smallest_step())
    }
}
