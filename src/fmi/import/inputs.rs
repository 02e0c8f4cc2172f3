//! Inputs that follow samples. Between two events of model exchange an input has one piece of its course,
//! also beyond the ends of the piece, so that steps see no jump.
//!
//! During a step of co-simulation a continuous input has its mean over the step, which makes an error of
//! second order in its length; or, where the unit takes derivatives of inputs (FMI 2.0), the line with this
//! mean that begins at its value, which is the input itself between two samples.

use super::binary::Component;
use super::calls::CallError;
use super::layout::{Layout, Place, starts};
use super::plan::Samples;
use crate::Description;
use crate::description::{Kind, Variability};
use crate::sim::same_time;
use std::collections::BTreeMap;

/// The inputs of an instance.
pub(super) struct Inputs<'a> {
    followed: Vec<Followed<'a>>,
    variables: Vec<InputVariable>,
    /// Whether the unit is given the derivatives of inputs.
    has_derivatives: bool,
}

/// An input with the piece of its samples that holds now.
struct Followed<'a> {
    samples: &'a Samples,
    /// Whether it keeps the value of a sample until the next: what is not continuous does.
    is_held: bool,
    /// The number of the sample at which the piece begins; `None` before the first one.
    piece: Option<usize>,
    /// Its variable among those of the inputs.
    variable: usize,
}

struct InputVariable {
    kind: Kind,
    reference: u32,
    /// Whether it may change between events.
    is_continuous: bool,
    values: Vec<f64>,
}

impl<'a> Inputs<'a> {
    /// Inputs that follow these samples.
    pub(crate) fn new(
        description: &Description,
        layout: &Layout,
        all: &'a [Samples],
        numbers: &[(Place, f64)],
    ) -> Inputs<'a> {
        let mut known: BTreeMap<usize, usize> = BTreeMap::new();
        let interface = description.co_simulation.as_ref();
        let mut inputs = Inputs {
            followed: Vec::new(),
            variables: Vec::new(),
            has_derivatives: interface.is_some_and(|own| own.can_interpolate_inputs),
        };
        for samples in all {
            let at = samples.place.variable;
            // Clocks tick; they have no values.
            if description.variables[at].kind == Kind::Clock {
                continue;
            }
            let variable = *known.entry(at).or_insert_with(|| {
                let own = &description.variables[at];
                let mut values = starts(own, layout.count(at));
                for (place, value) in numbers.iter().filter(|(place, _)| place.variable == at) {
                    values[place.element] = *value;
                }
                inputs.variables.push(InputVariable {
                    kind: own.kind,
                    reference: own.reference,
                    is_continuous: own.kind.is_float()
                        && own.variability == Variability::Continuous,
                    values,
                });
                inputs.variables.len() - 1
            });
            let is_held = samples.is_held || !inputs.variables[variable].is_continuous;
            inputs.followed.push(Followed { samples, is_held, piece: None, variable });
        }
        inputs
    }

    /// Whether short steps follow the inputs closer than long ones.
    pub(crate) fn are_approximated(&self) -> bool {
        !self.has_derivatives && self.followed.iter().any(|input| !input.is_held)
    }

    /// Chooses the pieces that hold from `t` on.
    pub(crate) fn seek(&mut self, t: f64) {
        for input in &mut self.followed {
            input.piece = input.piece_at(t);
        }
    }

    /// Chooses the pieces that hold until `t`.
    pub(crate) fn approach(&mut self, t: f64) {
        for input in &mut self.followed {
            input.piece = input.piece_before(t);
        }
    }

    /// Whether an input jumps until `t`; a bend is no event.
    pub(crate) fn jump(&self, t: f64) -> bool {
        self.followed.iter().any(|input| input.jumps(t))
    }

    /// When the next piece of an input begins.
    pub(crate) fn next_event(&self, t: f64) -> Option<f64> {
        let next = |input: &Followed<'_>| {
            let at = input.piece.map_or(0, |piece| piece + 1);
            input.samples.times.get(at).copied().filter(|time| *time > t)
        };
        self.followed.iter().filter_map(next).reduce(f64::min)
    }

    /// Gives the instance the values at `t`: of all inputs, or of those that change between events.
    pub(crate) fn set(
        &mut self,
        component: &Component,
        t: f64,
        is_event: bool,
    ) -> Result<(), CallError> {
        for input in &self.followed {
            let variable = &mut self.variables[input.variable];
            variable.values[input.samples.place.element] = input.value(t);
        }
        self.give(component, is_event)
    }

    /// Gives the instance the values during a step of co-simulation: of all inputs, or of those that change
    /// between events.
    pub(crate) fn set_step(
        &mut self,
        component: &Component,
        step: (f64, f64),
        is_event: bool,
    ) -> Result<(), CallError> {
        for input in &self.followed {
            let variable = &mut self.variables[input.variable];
            let is_mean = variable.is_continuous && !self.has_derivatives;
            variable.values[input.samples.place.element] =
                if is_mean { input.mean(step) } else { input.value(step.0) };
        }
        self.give(component, is_event)?;
        for input in self.followed.iter().filter(|_| self.has_derivatives) {
            let InputVariable { reference, is_continuous: true, .. } =
                self.variables[input.variable]
            else {
                continue;
            };
            let derivative = 2.0 * (input.mean(step) - input.value(step.0)) / (step.1 - step.0);
            component.set_input_derivative(reference, derivative)?;
        }
        Ok(())
    }

    fn give(&self, component: &Component, is_event: bool) -> Result<(), CallError> {
        let due = self.variables.iter().filter(|variable| is_event || variable.is_continuous);
        for variable in due {
            component.set(variable.kind, &[variable.reference], &variable.values)?;
        }
        Ok(())
    }
}

impl Followed<'_> {
    /// The number of the sample at which the piece begins that holds from `t` on.
    fn piece_at(&self, t: f64) -> Option<usize> {
        let times = &self.samples.times;
        times.partition_point(|time| *time <= t || same_time(*time, t)).checked_sub(1)
    }

    /// The number of the sample at which the piece begins that holds until `t`.
    fn piece_before(&self, t: f64) -> Option<usize> {
        let times = &self.samples.times;
        times.partition_point(|time| *time < t && !same_time(*time, t)).checked_sub(1)
    }

    /// Whether the piece at `t` begins with another value, or several pieces at once.
    fn jumps(&self, t: f64) -> bool {
        let next = self.piece_at(t);
        let count = |piece: Option<usize>| piece.map_or(0, |piece| piece + 1);
        match self.is_held {
            true => self.value_in(self.piece, t) != self.value_in(next, t),
            false => count(next) > count(self.piece) + 1,
        }
    }

    /// The value at a time, in the piece that holds now.
    fn value(&self, t: f64) -> f64 {
        self.value_in(self.piece, t)
    }

    /// The mean over a step that begins in the piece that holds now.
    fn mean(&self, (from, to): (f64, f64)) -> f64 {
        let times = &self.samples.times;
        let (mut piece, mut t, mut area) = (self.piece, from, 0.0);
        loop {
            let next = piece.map_or(0, |piece| piece + 1);
            let end = times.get(next).copied().filter(|end| *end < to);
            let until = end.unwrap_or(to).max(t);
            area += (until - t) * (self.value_in(piece, t) + self.value_in(piece, until)) / 2.0;
            if end.is_none() {
                return area / (to - from);
            }
            (piece, t) = (Some(next), until);
        }
    }

    fn value_in(&self, piece: Option<usize>, t: f64) -> f64 {
        let Samples { times, values, .. } = self.samples;
        let Some(piece) = piece else { return values.first().copied().unwrap_or(0.0) };
        let begin = values[piece];
        match times.get(piece + 1) {
            Some(end) if !self.is_held && *end > times[piece] => {
                let share = (t - times[piece]) / (end - times[piece]);
                begin + share * (values[piece + 1] - begin)
            }
            _ => begin,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at<'a>(samples: &'a Samples, seek: f64) -> Followed<'a> {
        let is_held = samples.is_held;
        let mut inputs = Inputs {
            followed: vec![Followed { samples, is_held, piece: None, variable: 0 }],
            variables: Vec::new(),
            has_derivatives: false,
        };
        inputs.seek(seek);
        inputs.followed.remove(0)
    }

    fn value(samples: &Samples, seek: f64, t: f64) -> f64 {
        at(samples, seek).value(t)
    }

    #[test]
    fn bends_are_no_jumps() {
        let place = Place { variable: 0, element: 0 };
        let (times, values) = (vec![1.0, 2.0, 3.0, 3.0], vec![10.0, 20.0, 20.0, 0.0]);
        let samples = Samples { place, times, values, is_held: false };
        let jumps = |samples: &Samples, seek: f64, t: f64| at(samples, seek).jumps(t);
        assert!(!jumps(&samples, 0.0, 1.0) && !jumps(&samples, 1.0, 2.0));
        assert!(jumps(&samples, 2.0, 3.0) && !jumps(&samples, 3.0, 4.0));
        let held = Samples { is_held: true, ..samples };
        assert!(!jumps(&held, 0.0, 1.0) && jumps(&held, 1.0, 2.0) && jumps(&held, 2.0, 3.0));
    }

    #[test]
    fn means_are_those_of_the_whole_course() {
        let place = Place { variable: 0, element: 0 };
        let (times, values) = (vec![1.0, 2.0, 2.0, 4.0], vec![10.0, 20.0, 50.0, 70.0]);
        let samples = Samples { place, times, values, is_held: false };
        let mean = |samples: &Samples, from: f64, to: f64| at(samples, from).mean((from, to));
        assert_eq!(mean(&samples, 1.0, 2.0), 15.0);
        assert_eq!(mean(&samples, 1.5, 1.7), 16.0);
        // (10 + 15 + 2·60 + 70) / 5: before the first, two lines with a jump, after the last.
        assert_eq!(mean(&samples, 0.0, 5.0), 43.0);
        assert_eq!(mean(&samples, 2.0, 3.0), 55.0, "after the jump");
        let held = Samples { is_held: true, ..samples };
        assert_eq!(mean(&held, 0.0, 5.0), (10.0 + 10.0 + 2.0 * 50.0 + 70.0) / 5.0);
    }

    #[test]
    fn samples_are_held_or_connected_and_jumps_have_two_sides() {
        let place = Place { variable: 0, element: 0 };
        let (times, values) = (vec![1.0, 2.0, 2.0, 4.0], vec![10.0, 20.0, 50.0, 70.0]);
        let samples = Samples { place, times, values, is_held: false };
        assert_eq!(value(&samples, 0.0, 0.0), 10.0, "before the first");
        assert_eq!(value(&samples, 1.0, 1.5), 15.0);
        assert_eq!(value(&samples, 1.0, 2.0), 20.0, "before the jump");
        assert_eq!(value(&samples, 2.0, 2.0), 50.0, "after the jump");
        assert_eq!(value(&samples, 2.0, 3.0), 60.0);
        assert_eq!(value(&samples, 5.0, 9.0), 70.0, "after the last");
        let held = Samples { is_held: true, ..samples };
        assert_eq!(value(&held, 2.0, 3.0), 50.0);
    }
}
