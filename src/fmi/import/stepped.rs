//! What simulations have in common that this program advances from point to point: their beginning, the rows
//! that they record, and when they may not go on.

use super::binary::Component;
use super::calls::CallError;
use super::inputs::Inputs;
use super::values::Readings;
use crate::sim::{Settings, SimErrorKind, Statistics, Trajectory};
use std::sync::atomic::Ordering;

/// A simulation of an instance.
pub(super) struct Stepped<'a> {
    pub component: &'a Component,
    pub inputs: Inputs<'a>,
    readings: Readings,
    pub settings: &'a Settings,
    /// The time reached.
    pub time: f64,
    pub statistics: Statistics,
    deadline: Option<f64>,
    row: Vec<f64>,
}

/// Why a simulation ended early.
pub(super) enum Stopped {
    Call(CallError),
    Kind(SimErrorKind),
}

impl From<CallError> for Stopped {
    fn from(error: CallError) -> Stopped {
        Stopped::Call(error)
    }
}

impl<'a> Stepped<'a> {
    /// A simulation of an instance that has got its values.
    pub(crate) fn new(
        component: &'a Component,
        (inputs, readings): (Inputs<'a>, Readings),
        settings: &'a Settings,
    ) -> Stepped<'a> {
        Stepped {
            component,
            inputs,
            row: vec![0.0; readings.count()],
            readings,
            settings,
            time: settings.start,
            statistics: Statistics::default(),
            deadline: settings.time_budget.map(|budget| (budget.clock)() + budget.seconds),
        }
    }

    /// Initializes the instance, which is not advanced beyond `stop`.
    pub(crate) fn begin(&mut self, stop: f64, out: &mut Trajectory) -> Result<(), CallError> {
        let Settings { start, tolerance, .. } = *self.settings;
        out.reset(self.readings.count());
        self.component.enter_initialization(Some(tolerance), (start, stop))?;
        self.inputs.seek(start);
        self.inputs.set(self.component, start, true)?;
        self.component.exit_initialization()
    }

    /// Adds a row with the values at the time reached.
    pub(crate) fn record(&mut self, out: &mut Trajectory) -> Result<(), CallError> {
        self.record_as(self.time, out)
    }

    /// Adds a row with the values now, at a time that differs from the one reached by rounding.
    pub(crate) fn record_as(&mut self, time: f64, out: &mut Trajectory) -> Result<(), CallError> {
        self.readings.read(self.component, &mut self.row)?;
        let last = out.time().last().copied();
        out.push(last.map_or(time, |last| time.max(last)), &self.row);
        if let Some(reached) = &self.settings.reached {
            reached.store(self.time.to_bits(), Ordering::Relaxed);
        }
        Ok(())
    }

    /// Whether the simulation may go on after so many steps.
    pub(crate) fn check_budget(&self, steps: u64) -> Result<(), Stopped> {
        let settings = self.settings;
        let is_late =
            settings.time_budget.zip(self.deadline).is_some_and(|(b, end)| (b.clock)() > end);
        let kind = if settings.cancel.as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed)) {
            SimErrorKind::Cancelled
        } else if is_late {
            SimErrorKind::TimeBudget
        } else if steps >= settings.max_total_steps {
            SimErrorKind::StepBudget
        } else {
            return Ok(());
        };
        Err(Stopped::Kind(kind))
    }
}
