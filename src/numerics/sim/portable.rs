//! [`Settings`] as data, for other processes.

use super::integrators::find_integrator;
use super::settings::{OutputGrid, Settings, TimeBudget};
use crate::diag::Fault;
use serde::{Deserialize, Serialize};

/// The [`Settings`] of a simulation: the method by its name, the budget of time without its clock.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct PortableSettings {
    start: f64,
    stop: f64,
    output: OutputGrid,
    tolerance: f64,
    method: String,
    takes_exact_steps: bool,
    step: Option<f64>,
    initial_step: Option<f64>,
    max_step: f64,
    treats_chattering: bool,
    stops_at_events: bool,
    max_steps: u64,
    max_total_steps: u64,
    counts_effort: bool,
    time_budget: Option<f64>,
}

impl PortableSettings {
    /// The settings as data.
    pub fn of(settings: &Settings) -> PortableSettings {
        // Named one by one, so that a new setting is not forgotten here.
        let Settings {
            start,
            stop,
            output,
            tolerance,
            method,
            takes_exact_steps,
            step,
            initial_step,
            max_step,
            treats_chattering,
            stops_at_events,
            max_steps,
            max_total_steps,
            counts_effort,
            time_budget,
            cancel: _,
            reached: _,
        } = settings;
        PortableSettings {
            start: *start,
            stop: *stop,
            output: output.clone(),
            tolerance: *tolerance,
            method: method.name.to_owned(),
            takes_exact_steps: *takes_exact_steps,
            step: *step,
            initial_step: *initial_step,
            max_step: *max_step,
            treats_chattering: *treats_chattering,
            stops_at_events: *stops_at_events,
            max_steps: *max_steps,
            max_total_steps: *max_total_steps,
            counts_effort: *counts_effort,
            time_budget: time_budget.as_ref().map(|budget| budget.seconds),
        }
    }

    /// The settings, with a clock for the budget of time.
    ///
    /// # Errors
    /// A method of another version.
    pub fn settings(self, clock: fn() -> f64) -> Result<Settings, Fault> {
        Ok(Settings {
            start: self.start,
            stop: self.stop,
            output: self.output,
            tolerance: self.tolerance,
            method: find_integrator(&self.method)?,
            takes_exact_steps: self.takes_exact_steps,
            step: self.step,
            initial_step: self.initial_step,
            max_step: self.max_step,
            treats_chattering: self.treats_chattering,
            stops_at_events: self.stops_at_events,
            max_steps: self.max_steps,
            max_total_steps: self.max_total_steps,
            counts_effort: self.counts_effort,
            time_budget: self.time_budget.map(|seconds| TimeBudget { seconds, clock }),
            cancel: None,
            reached: None,
        })
    }
}
