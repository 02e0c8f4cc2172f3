//! Scheduled execution: a unit of which this program activates the parts, one after the other at the
//! ticks of its clocks (FMI 3.0.2 §5).
//!
//! Periodic clocks tick at their intervals, those that count down when the unit says so, triggered ones at
//! each sample of an input that is true. Of clocks that tick at one time those with the smallest number
//! for their priority come first. Nothing is interrupted.

use super::binary::Component;
use super::calls::CallError;
use super::plan::Samples;
use super::stepped::{Stepped, Stopped};
use crate::Description;
use crate::description::{Causality, ClockInterval, Kind};
use crate::sim::{Settings, SimErrorKind, Trajectory, same_time};

/// More ticks at one time than this have no end.
const MOST_AT_ONCE: u32 = 10_000;

/// A simulation.
pub(super) struct Scheduled<'a> {
    pub run: Stepped<'a>,
    clocks: Vec<Clock>,
}

/// An input clock.
struct Clock {
    reference: u32,
    priority: u32,
    course: Course,
    /// When it ticks next.
    next: Option<f64>,
}

/// When a clock ticks.
enum Course {
    /// From a time after the start on with an interval, which the unit says where it is `None`.
    Periodic { shift: f64, interval: Option<f64>, first: f64, ticks: u64 },
    /// So many seconds after a tick of any clock as the unit says then.
    Countdown,
    /// So many seconds after its own last tick as the unit says then.
    Changing { interval: f64 },
    /// At these times, the next one first.
    Triggered(std::vec::IntoIter<f64>),
}

impl Clock {
    fn of(own: &ClockInterval, reference: u32, samples: Option<&Samples>) -> Clock {
        let resolution = own.resolution.unwrap_or(1) as f64;
        let counted = |counter: Option<u64>| counter.map(|counter| counter as f64 / resolution);
        let interval = own.decimal.or(counted(own.counter));
        let shift = own.shift.or(counted(own.shift_counter)).unwrap_or(0.0);
        let course = match own.variability.as_str() {
            "countdown" => Course::Countdown,
            "changing" => Course::Changing { interval: f64::INFINITY },
            "triggered" => {
                let rows = samples.into_iter().flat_map(|own| own.times.iter().zip(&own.values));
                let ticks = rows.filter(|(_, value)| **value != 0.0).map(|(time, _)| *time);
                Course::Triggered(ticks.collect::<Vec<_>>().into_iter())
            }
            _ => Course::Periodic { shift, interval, first: 0.0, ticks: 0 },
        };
        Clock { reference, priority: own.priority.unwrap_or(u32::MAX), course, next: None }
    }

    /// The first tick of a simulation that begins at a time.
    fn begin(&mut self, component: &Component, start: f64) -> Result<(), CallError> {
        self.next = match &mut self.course {
            Course::Periodic { shift, interval, first, .. } => {
                if interval.is_none() {
                    *interval = component.interval(self.reference)?;
                }
                *first = start + *shift;
                Some(*first)
            }
            Course::Countdown => component.interval(self.reference)?.map(|wait| start + wait),
            Course::Changing { .. } => Some(start),
            Course::Triggered(ticks) => ticks.find(|time| *time >= start),
        };
        Ok(())
    }

    /// The next tick after one at a time.
    fn advance(&mut self, component: &Component, t: f64) -> Result<(), CallError> {
        self.next = match &mut self.course {
            Course::Periodic { interval, first, ticks, .. } => {
                *ticks += 1;
                let interval = interval.filter(|interval| *interval > 0.0);
                interval.map(|interval| *first + *ticks as f64 * interval)
            }
            Course::Countdown => None,
            Course::Changing { interval } => {
                *interval = component.interval(self.reference)?.unwrap_or(*interval);
                Some(t + *interval)
            }
            Course::Triggered(ticks) => ticks.next(),
        };
        Ok(())
    }
}

impl<'a> Scheduled<'a> {
    /// A simulation of an instance that has got its values.
    pub(crate) fn new(
        run: Stepped<'a>,
        description: &Description,
        samples: &[Samples],
    ) -> Scheduled<'a> {
        let variables = description.variables.iter().enumerate();
        let own = variables.filter(|(_, variable)| {
            variable.kind == Kind::Clock && variable.causality == Causality::Input
        });
        let clocks = own.filter_map(|(at, variable)| {
            let samples = samples.iter().find(|own| own.place.variable == at);
            Some(Clock::of(variable.clock.as_ref()?, variable.reference, samples))
        });
        Scheduled { run, clocks: clocks.collect() }
    }

    /// Simulates; there are rows at the output points, and before and after ticks.
    pub(crate) fn simulate(&mut self, out: &mut Trajectory) -> Result<(), Stopped> {
        let Settings { start, stop, .. } = *self.run.settings;
        self.run.begin(self.run.settings.stop, out)?;
        for clock in &mut self.clocks {
            clock.begin(self.run.component, start)?;
        }
        let mut number = 0;
        loop {
            let output = self.run.settings.output.point(start, stop, number);
            let tick = self.clocks.iter().filter_map(|clock| clock.next).reduce(f64::min);
            let tick = tick.filter(|tick| *tick <= stop || same_time(*tick, stop));
            let Some(next) = [output, tick].into_iter().flatten().reduce(f64::min) else {
                return Ok(());
            };
            self.run.time = next;
            self.run.check_budget(self.run.statistics.time_events)?;
            let is_due =
                |time: Option<f64>| time.is_some_and(|time| time <= next || same_time(time, next));
            if is_due(tick) {
                self.run.record(out)?;
                self.activate(next)?;
            }
            number += usize::from(is_due(output));
            self.run.record(out)?;
        }
    }

    /// Activates the parts of all clocks that tick at a time.
    fn activate(&mut self, t: f64) -> Result<(), Stopped> {
        let is_due = |clock: &Clock| clock.next.is_some_and(|next| next <= t || same_time(next, t));
        let component = self.run.component;
        for _ in 0..MOST_AT_ONCE {
            let due = self.clocks.iter_mut().filter(|clock| is_due(clock));
            // The first of several with one priority.
            let Some(clock) = due.min_by_key(|clock| clock.priority) else { return Ok(()) };
            self.run.inputs.seek(t);
            self.run.inputs.set(component, t, true)?;
            component.activate(clock.reference, t)?;
            clock.advance(component, t)?;
            self.run.statistics.time_events += 1;
            for clock in &mut self.clocks {
                if let Course::Countdown = clock.course
                    && let Some(wait) = component.interval(clock.reference)?
                {
                    clock.next = Some(t + wait);
                }
            }
        }
        Err(Stopped::Kind(SimErrorKind::Chattering))
    }
}
