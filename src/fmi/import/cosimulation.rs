//! Co-simulation: a unit that integrates itself between communication points (FMI 2.0.5 §4,
//! FMI 3.0.2 §4).
//!
//! Communication points are the output points and the beginnings of the pieces of inputs. A unit with
//! steps of one length gets those of its experiment. Inputs have one value during a step.

use super::binary::Component;
use super::calls::CallError;
use super::inputs::Inputs;
use super::values::Readings;
use crate::Description;
use crate::sim::{OutputGrid, Settings, SimErrorKind, Statistics, Trajectory, same_time};
use std::sync::atomic::Ordering;

/// Steps in a row that do not advance.
const MOST_WITHOUT_PROGRESS: u32 = 1000;
/// Steps of an experiment that gives no length.
const STEPS: f64 = 500.0;

/// A simulation.
pub(super) struct CoSimulation<'a> {
    component: &'a Component<'a>,
    inputs: Inputs<'a>,
    readings: Readings,
    settings: &'a Settings,
    points: Points,
    /// Whether events are handled by request (FMI 3.0).
    has_event_mode: bool,
    /// Whether the last step has asked for an event.
    needs_event: bool,
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

/// Why a simulation may not go on after so many steps.
pub(super) fn check_budget(
    settings: &Settings,
    deadline: Option<f64>,
    steps: u64,
) -> Result<(), Stopped> {
    let is_late = settings.time_budget.zip(deadline).is_some_and(|(b, end)| (b.clock)() > end);
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
                let step = step.unwrap_or((stop - start) / STEPS);
                Points { fixed: (!is_variable).then_some(step), longest: step }
            }
        }
    }
}

impl<'a> CoSimulation<'a> {
    /// A simulation of an instance that has got its values.
    pub fn new(
        component: &'a Component<'a>,
        description: &Description,
        (inputs, readings): (Inputs<'a>, Readings),
        (settings, has_event_mode): (&'a Settings, bool),
    ) -> CoSimulation<'a> {
        CoSimulation {
            component,
            inputs,
            readings,
            settings,
            points: Points::of(description, settings),
            has_event_mode,
            needs_event: false,
            row: Vec::new(),
        }
    }

    /// Simulates; the rows are those of the output points, or of all communication points where
    /// these are given by the unit.
    pub fn run(&mut self, out: &mut Trajectory) -> Result<Statistics, (f64, Stopped)> {
        let mut statistics = Statistics::default();
        let mut t = self.settings.start;
        let ended = self.steps(&mut t, &mut statistics, out);
        ended.map_err(|stopped| (t, stopped))?;
        Ok(statistics)
    }

    fn begin(&mut self) -> Result<bool, CallError> {
        let Settings { start, stop, tolerance, .. } = *self.settings;
        self.component.enter_initialization(Some(tolerance), (start, stop))?;
        self.inputs.seek(start);
        self.inputs.set(self.component, start, true)?;
        self.component.exit_initialization()?;
        // After the initialization a unit with event mode is in it.
        if self.has_event_mode {
            let update = self.component.update_discrete_states()?;
            self.component.enter_step_mode()?;
            return Ok(update.terminates);
        }
        Ok(false)
    }

    fn steps(
        &mut self,
        t: &mut f64,
        statistics: &mut Statistics,
        out: &mut Trajectory,
    ) -> Result<(), Stopped> {
        let Settings { start, stop, .. } = *self.settings;
        out.reset(self.readings.count());
        self.row.resize(self.readings.count(), 0.0);
        let mut ends = self.begin()?;
        let mut number = 0;
        let records_all = self.points.fixed.is_some();
        let deadline = self.settings.time_budget.map(|budget| (budget.clock)() + budget.seconds);
        loop {
            let output = self.settings.output.point(start, stop, number);
            let is_point = output.is_some_and(|point| point <= *t || same_time(point, *t));
            if is_point || records_all {
                self.record(*t, out)?;
                number += usize::from(is_point);
                if is_point && !records_all {
                    continue;
                }
            }
            if ends || *t >= stop || same_time(*t, stop) {
                return Ok(());
            }
            check_budget(self.settings, deadline, statistics.steps)?;
            let target = self.target(*t, output, statistics.steps);
            ends = self.advance(t, target, (statistics, out))?;
        }
    }

    /// The end of the next step.
    fn target(&self, t: f64, output: Option<f64>, steps: u64) -> f64 {
        let Settings { start, stop, .. } = *self.settings;
        if let Some(length) = self.points.fixed {
            return start + (steps + 1) as f64 * length;
        }
        let nearest = [output, self.inputs.next_event(t)].into_iter().flatten();
        nearest.fold(stop, f64::min).min(t + self.points.longest)
    }

    /// Makes a step, in parts where the unit returns early; whether the simulation ends.
    fn advance(
        &mut self,
        t: &mut f64,
        target: f64,
        (statistics, out): (&mut Statistics, &mut Trajectory),
    ) -> Result<bool, Stopped> {
        statistics.steps += 1;
        let mut without_progress = 0;
        while *t < target {
            if self.prepare(*t, (statistics, out))? {
                return Ok(true);
            }
            let end = self.component.step(*t, target - *t)?;
            let is_over = end.time >= target || same_time(end.time, target);
            let reached = if is_over { target } else { end.time };
            without_progress = if reached > *t { 0 } else { without_progress + 1 };
            if without_progress > MOST_WITHOUT_PROGRESS {
                return Err(Stopped::Kind(SimErrorKind::StepSize));
            }
            *t = reached;
            self.needs_event = end.needs_event;
            if end.terminates {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Sets the inputs of the next step, and handles an event where one is needed, with a row before
    /// and one after it; whether the simulation ends.
    fn prepare(
        &mut self,
        t: f64,
        (statistics, out): (&mut Statistics, &mut Trajectory),
    ) -> Result<bool, CallError> {
        let changes = self.inputs.begin_piece(t);
        let is_event = self.has_event_mode && (self.needs_event || changes);
        if !is_event {
            self.inputs.set(self.component, t, !self.has_event_mode)?;
            return Ok(false);
        }
        self.needs_event = false;
        statistics.time_events += 1;
        if out.time().last() != Some(&t) {
            self.record(t, out)?;
        }
        self.component.enter_event_mode()?;
        self.inputs.set(self.component, t, true)?;
        let update = self.component.update_discrete_states()?;
        self.component.enter_step_mode()?;
        self.record(t, out)?;
        Ok(update.terminates)
    }

    fn record(&mut self, t: f64, out: &mut Trajectory) -> Result<(), CallError> {
        self.readings.read(self.component, &mut self.row)?;
        self.inputs.read(t, &mut self.row);
        out.push(t, &self.row);
        if let Some(reached) = &self.settings.reached {
            reached.store(t.to_bits(), Ordering::Relaxed);
        }
        Ok(())
    }
}
