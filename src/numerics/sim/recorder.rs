//! Rows of results, and the output points at which they are due.

use super::integrators::Problem;
use super::{Failure, Residual, Settings, Trajectory};
use std::sync::atomic::Ordering;

/// Where the rows of a run go.
pub(crate) struct Recorder<'a> {
    /// What is observed.
    pub(super) observed: &'a mut [f64],
    pub(super) rows: &'a mut Trajectory,
    pub(super) points: OutputPoints,
}

impl Recorder<'_> {
    /// Observes the system at (t, y), which becomes a row.
    pub(super) fn record(
        &mut self,
        problem: &mut Problem,
        t: f64,
        y: &[f64],
    ) -> Result<(), Failure> {
        problem.system.observe(t, y, self.observed)?;
        self.rows.push(t, self.observed);
        if let Some(reached) = &problem.settings.reached {
            reached.store(t.to_bits(), Ordering::Relaxed);
        }
        Ok(())
    }
}

/// The output points of a run.
pub(crate) struct OutputPoints {
    /// The next output point and its number.
    next_output: Option<f64>,
    output_number: usize,
    /// Whether a step ends at every output point: nothing is interpolated.
    pub(super) ends_at_points: bool,
}

impl OutputPoints {
    pub(super) fn new(settings: &Settings, ends_at_points: bool) -> OutputPoints {
        let next_output = settings.output.point(settings.start, settings.stop, 0);
        OutputPoints { next_output, output_number: 0, ends_at_points }
    }

    /// The next one.
    pub(super) fn next(&self) -> Option<f64> {
        self.next_output
    }

    /// Those after the last one that was recorded.
    pub(super) fn following(&self, settings: &Settings) -> impl Iterator<Item = f64> {
        let (start, stop) = (settings.start, settings.stop);
        (self.output_number..).map_while(move |n| settings.output.point(start, stop, n))
    }

    pub(super) fn advance(&mut self, settings: &Settings) {
        self.output_number += 1;
        self.next_output = settings.output.point(settings.start, settings.stop, self.output_number);
    }
}
