//! Co-simulation: a unit that integrates itself between communication points (FMI 2.0.5 §4,
//! FMI 3.0.2 §4).
//!
//! Communication points are the output points and the beginnings of the pieces of inputs, and points between
//! them where inputs change. A unit with steps of one length gets those of its experiment. What inputs are
//! during a step, `inputs` says; where values are recorded they are those of this time. Where an input jumps
//! there are two rows, with the limits from the left and from the right, as at events of model exchange.

use super::calls::CallError;
use super::stepped::{Stepped, Stopped};
use crate::Description;
use crate::sim::{OutputGrid, Settings, Trajectory, same_time};

/// Steps in a row that do not advance.
const MOST_WITHOUT_PROGRESS: u32 = 1000;
/// Steps of an experiment that gives no length, and at least where inputs change during steps.
const STEPS: f64 = 500.0;

/// A simulation.
pub(super) struct CoSimulation<'a> {
    pub run: Stepped<'a>,
    points: Points,
    /// Whether events are handled by request (FMI 3.0).
    has_event_mode: bool,
    /// Whether the last step has asked for an event, or inputs have jumped in it.
    needs_event: bool,
}

/// Where steps end.
struct Points {
    /// The length of all steps, where it must be one.
    fixed: Option<f64>,
    /// The longest step.
    longest: f64,
}

impl Points {
    /// The points of a unit.
    fn of(description: &Description, settings: &Settings) -> Points {
        let interface = description.co_simulation.as_ref();
        let is_variable = interface.is_some_and(|own| own.can_handle_variable_steps);
        let Settings { start, stop, output, .. } = settings;
        let step = description.experiment.step.filter(|step| *step > 0.0);
        match output {
            // Output points are what the user or the experiment asks for.
            OutputGrid::Intervals(count) if !is_variable => Points {
                fixed: Some((stop - start) / (*count).max(1) as f64),
                longest: f64::INFINITY,
            },
            OutputGrid::Intervals(_) => Points { fixed: None, longest: f64::INFINITY },
            OutputGrid::At(_) => {
                // Steps are whole numbers of those that the unit makes inside.
                let usual = (stop - start) / STEPS;
                let inside = interface.and_then(|own| own.fixed_internal_step);
                let inside = inside.filter(|inside| *inside > 0.0);
                let inside = inside.map(|inside| inside * (usual / inside).round().max(1.0));
                let step = step.or(inside).unwrap_or(usual);
                Points { fixed: (!is_variable).then_some(step), longest: step }
            }
        }
    }

    /// The end of the last step: steps of one length may lead beyond the stop time.
    fn end(&self, start: f64, stop: f64) -> f64 {
        let Some(length) = self.fixed.filter(|length| *length > 0.0) else { return stop };
        let steps = ((stop - start) / length).floor();
        let [whole, beyond] = [steps, steps + 1.0].map(|steps| start + steps * length);
        if same_time(whole, stop) { whole.max(stop) } else { beyond.max(stop) }
    }
}

impl<'a> CoSimulation<'a> {
    /// A simulation of an instance that has got its values.
    pub(crate) fn new(
        run: Stepped<'a>,
        description: &Description,
        has_event_mode: bool,
    ) -> CoSimulation<'a> {
        let mut points = Points::of(description, run.settings);
        if run.inputs.are_approximated() {
            let Settings { start, stop, .. } = run.settings;
            points.longest = points.longest.min((stop - start) / STEPS);
        }
        CoSimulation { run, points, has_event_mode, needs_event: false }
    }

    fn begin(&mut self, out: &mut Trajectory) -> Result<bool, CallError> {
        let Settings { start, stop, .. } = *self.run.settings;
        self.run.begin(self.points.end(start, stop), out)?;
        // After the initialization a unit with event mode is in it.
        if self.has_event_mode {
            let update = self.run.component.update_discrete_states()?;
            self.run.component.enter_step_mode()?;
            return Ok(update.terminates);
        }
        Ok(false)
    }

    /// Simulates; the rows are those of the output points, or of all communication points where
    /// these are given by the unit.
    pub(crate) fn simulate(&mut self, out: &mut Trajectory) -> Result<(), Stopped> {
        let Settings { start, stop, .. } = *self.run.settings;
        let mut ends = self.begin(out)?;
        let mut number = 0;
        let records_all = self.points.fixed.is_some();
        loop {
            let t = self.run.time;
            let output = self.run.settings.output.point(start, stop, number);
            let is_point = output.is_some_and(|point| point <= t || same_time(point, t));
            let is_end = ends && !out.time().last().is_some_and(|last| same_time(*last, t));
            if is_point || records_all || is_end {
                if !ends {
                    self.run.inputs.set(self.run.component, t, !self.has_event_mode)?;
                }
                self.run.record_as(output.filter(|_| is_point).map_or(t, |at| at.max(t)), out)?;
                number += usize::from(is_point);
                if is_point && !records_all {
                    continue;
                }
            }
            if ends || self.handle_event(out)? || t >= stop || same_time(t, stop) {
                return Ok(());
            }
            let steps = self.run.statistics.steps;
            self.run.check_budget(steps)?;
            ends = self.advance(self.target(t, output, steps), out)?;
        }
    }

    /// The end of the next step.
    fn target(&self, t: f64, output: Option<f64>, steps: u64) -> f64 {
        let Settings { start, stop, .. } = *self.run.settings;
        if let Some(length) = self.points.fixed {
            return start + (steps + 1) as f64 * length;
        }
        let nearest = [output, self.run.inputs.next_event(t)].into_iter().flatten();
        nearest.fold(stop, f64::min).min(t + self.points.longest)
    }

    /// Makes a step, in parts where the unit returns early; whether the simulation ends.
    fn advance(&mut self, target: f64, out: &mut Trajectory) -> Result<bool, Stopped> {
        self.run.statistics.steps += 1;
        let mut without_progress = 0;
        loop {
            let t = self.run.time;
            self.run.inputs.set_step(self.run.component, (t, target), !self.has_event_mode)?;
            let end = self.run.component.step(t, target - t)?;
            let is_over = end.time >= target || same_time(end.time, target);
            let reached = if is_over { target } else { end.time };
            without_progress = if reached > t { 0 } else { without_progress + 1 };
            if without_progress > MOST_WITHOUT_PROGRESS {
                return Err(self.run.component.makes_no_progress().into());
            }
            self.run.time = reached;
            let jumps = self.run.inputs.jump(reached);
            self.run.inputs.approach(reached);
            self.needs_event = self.has_event_mode && (end.needs_event || jumps);
            if end.terminates {
                return Ok(true);
            }
            if is_over {
                return Ok(false);
            }
            if self.handle_event(out)? {
                return Ok(true);
            }
        }
    }

    /// Handles an event where one is needed, and jumps of inputs, with a row before and one after; whether
    /// the simulation ends. From then on inputs follow the pieces that begin here.
    fn handle_event(&mut self, out: &mut Trajectory) -> Result<bool, CallError> {
        let t = self.run.time;
        let component = self.run.component;
        if !self.needs_event && !self.run.inputs.jump(t) {
            self.run.inputs.seek(t);
            return Ok(false);
        }
        self.needs_event = false;
        self.run.statistics.time_events += 1;
        if !out.time().last().is_some_and(|last| same_time(*last, t)) {
            self.run.inputs.set(component, t, !self.has_event_mode)?;
            self.run.record(out)?;
        }
        if self.has_event_mode {
            component.enter_event_mode()?;
        }
        self.run.inputs.seek(t);
        self.run.inputs.set(component, t, true)?;
        let mut ends = false;
        if self.has_event_mode {
            ends = component.update_discrete_states()?.terminates;
            component.enter_step_mode()?;
        }
        self.run.record(out)?;
        Ok(ends)
    }
}
