//! Inputs that follow samples. Between two events an input has one piece of its course, also beyond
//! the ends of the piece, so that steps see no jump.

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
    /// Which of the readings it is, where these are of its own value.
    reading: Option<usize>,
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
    pub fn new(
        description: &Description,
        layout: &Layout,
        all: &'a [Samples],
        numbers: &[(Place, f64)],
    ) -> Inputs<'a> {
        let mut known: BTreeMap<usize, usize> = BTreeMap::new();
        let mut inputs = Inputs { followed: Vec::new(), variables: Vec::new() };
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
            let (piece, reading) = (None, None);
            inputs.followed.push(Followed { samples, is_held, piece, variable, reading });
        }
        inputs
    }

    /// The same inputs; among readings of these scalars are their own.
    pub fn read_among(mut self, observed: &[Place]) -> Inputs<'a> {
        for input in &mut self.followed {
            input.reading = observed.iter().position(|place| *place == input.samples.place);
        }
        self
    }

    /// Writes the values at `t` to the readings of inputs: within a step of co-simulation the instance
    /// has those of its beginning.
    pub fn read(&self, t: f64, readings: &mut [f64]) {
        for input in &self.followed {
            if let Some(reading) = input.reading {
                readings[reading] = input.value(t);
            }
        }
    }

    /// Chooses the pieces that hold from `t` on.
    pub fn seek(&mut self, t: f64) {
        for input in &mut self.followed {
            let times = &input.samples.times;
            let after = times.partition_point(|time| *time <= t || same_time(*time, t));
            input.piece = after.checked_sub(1);
        }
    }

    /// The same; whether other pieces hold than before.
    pub fn begin_piece(&mut self, t: f64) -> bool {
        let before: Vec<Option<usize>> = self.followed.iter().map(|input| input.piece).collect();
        self.seek(t);
        self.followed.iter().map(|input| input.piece).ne(before)
    }

    /// When the next piece of an input begins.
    pub fn next_event(&self, t: f64) -> Option<f64> {
        let next = |input: &Followed<'_>| {
            let at = input.piece.map_or(0, |piece| piece + 1);
            input.samples.times.get(at).copied().filter(|time| *time > t)
        };
        self.followed.iter().filter_map(next).reduce(f64::min)
    }

    /// Gives the instance the values at `t`: of all inputs, or of those that change between events.
    pub fn set(&mut self, component: &Component, t: f64, is_event: bool) -> Result<(), CallError> {
        for input in &self.followed {
            let variable = &mut self.variables[input.variable];
            variable.values[input.samples.place.element] = input.value(t);
        }
        let due = self.variables.iter().filter(|variable| is_event || variable.is_continuous);
        for variable in due {
            component.set(variable.kind, &[variable.reference], &variable.values)?;
        }
        Ok(())
    }
}

impl Followed<'_> {
    fn value(&self, t: f64) -> f64 {
        let Samples { times, values, .. } = self.samples;
        let Some(piece) = self.piece else { return values.first().copied().unwrap_or(0.0) };
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

    fn value(samples: &Samples, seek: f64, t: f64) -> f64 {
        let mut inputs = Inputs {
            followed: vec![Followed {
                samples,
                is_held: samples.is_held,
                piece: None,
                variable: 0,
                reading: None,
            }],
            variables: Vec::new(),
        };
        inputs.seek(seek);
        inputs.followed[0].value(t)
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
