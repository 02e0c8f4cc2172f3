//! What is asked of a simulation.

use super::integrators::{self, Integrator};
use crate::registry::Entry;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// What is asked of a simulation.
#[derive(Clone)]
pub struct Settings {
    /// First time, seconds.
    pub start: f64,
    /// Last time, seconds; not before `start`.
    pub stop: f64,
    /// When to record; events are recorded besides.
    pub output: OutputGrid,
    /// Relative tolerance of the local error, between 1e-14 and 1; the absolute one of a variable
    /// is the tolerance times its nominal value.
    pub tolerance: f64,
    /// The integration method, from [`find_integrator`](super::find_integrator).
    pub method: &'static Entry<dyn Integrator>,
    /// Whether another method may take its place where it suits: exact steps of a system that is linear
    /// between events, explicit ones of one that is not stiff.
    pub takes_exact_steps: bool,
    /// Step of the methods with fixed step, seconds; `None` for the distance of the output points.
    pub step: Option<f64>,
    /// First step of the methods with variable step, seconds; `None` lets the method choose.
    pub initial_step: Option<f64>,
    /// Largest step, seconds.
    pub max_step: f64,
    /// Whether the simulation continues where events are chattering: relations
    /// are evaluated between steps, the solution slides or rests. If not, it fails there.
    pub treats_chattering: bool,
    /// Whether it ends before the first event, which is handled elsewhere.
    pub stops_at_events: bool,
    /// Steps, rejected ones included, after which the simulation is given up unless it gets on.
    pub max_steps: u64,
    /// Steps after which it is given up in any case: it gets on where it would end within these at
    /// its pace.
    pub max_total_steps: u64,
    /// Whether the [`Effort`](super::Effort) is counted.
    pub counts_effort: bool,
    /// The time on the clock that the simulation may take.
    pub time_budget: Option<TimeBudget>,
    /// Checked before every step: true ends the simulation.
    pub cancel: Option<Arc<AtomicBool>>,
    /// The time recorded last, seconds, as the bits of an `f64`: for displays of progress.
    pub reached: Option<Arc<AtomicU64>>,
}

/// How long a simulation may take. What is given up depends on the machine.
#[derive(Debug, Clone, Copy)]
pub struct TimeBudget {
    /// Seconds from its beginning.
    pub seconds: f64,
    /// Seconds since an arbitrary moment.
    pub clock: fn() -> f64,
}

/// When to record.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub enum OutputGrid {
    /// The interval is divided into so many parts (at least one).
    Intervals(usize),
    /// At these times, ascending; those outside the simulated interval are left out. The first and
    /// the last time are recorded only if listed.
    At(Vec<f64>),
}

impl Default for Settings {
    /// 0 to 1 s, 500 intervals, tolerance 1e-4, variable-order BDF, a million steps.
    fn default() -> Settings {
        Settings {
            start: 0.0,
            stop: 1.0,
            output: OutputGrid::Intervals(500),
            tolerance: 1e-4,
            method: integrators::DEFAULT,
            takes_exact_steps: false,
            step: None,
            initial_step: None,
            max_step: f64::INFINITY,
            treats_chattering: true,
            stops_at_events: false,
            max_steps: 1_000_000,
            max_total_steps: 1_000_000,
            counts_effort: false,
            time_budget: None,
            cancel: None,
            reached: None,
        }
    }
}

impl Settings {
    /// The step of methods with fixed step.
    pub(super) fn fixed_step(&self) -> f64 {
        let intervals = match self.output {
            OutputGrid::Intervals(intervals) => intervals.max(1),
            OutputGrid::At(_) => 500,
        };
        let step = self.step.unwrap_or((self.stop - self.start) / intervals as f64);
        step.min(self.max_step)
    }
}

impl OutputGrid {
    /// The mean distance of the output points.
    pub(super) fn spacing(&self, start: f64, stop: f64) -> f64 {
        let intervals = match self {
            OutputGrid::Intervals(intervals) => *intervals,
            OutputGrid::At(times) => times.len(),
        };
        (stop - start) / intervals.max(1) as f64
    }

    /// The output point of this number, if there is one within the simulated interval.
    pub fn point(&self, start: f64, stop: f64, number: usize) -> Option<f64> {
        match self {
            OutputGrid::Intervals(intervals) => {
                let intervals = (*intervals).max(1);
                let fraction = number as f64 / intervals as f64;
                match number.cmp(&intervals) {
                    std::cmp::Ordering::Less => Some(start + (stop - start) * fraction),
                    std::cmp::Ordering::Equal => Some(stop),
                    std::cmp::Ordering::Greater => None,
                }
            }
            OutputGrid::At(times) => {
                let first = times.partition_point(|t| *t < start);
                times.get(first + number).copied().filter(|t| *t <= stop)
            }
        }
    }
}

impl std::fmt::Debug for Settings {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Settings")
            .field("start", &self.start)
            .field("stop", &self.stop)
            .field("output", &self.output)
            .field("tolerance", &self.tolerance)
            .field("method", &self.method.name)
            .finish_non_exhaustive()
    }
}
