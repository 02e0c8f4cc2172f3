//! Recorded inputs at run time: a cursor into the knots of each recording. It moves at events alone,
//! so that the segment that ends at a knot continues until the event there has been handled.

use super::instants::same_time;
use crate::codegen::memory::Memory;
use crate::codegen::program::Program;
use crate::lower::Recording;

/// Where the recorded inputs are.
#[derive(Debug, Clone)]
pub(super) struct RecordedInputs {
    /// How many knots of each recording have been passed.
    pub(super) knots_passed: Vec<usize>,
    /// Values that are set from outside, by their registers.
    pub(super) given: Vec<(u32, f64)>,
}

impl RecordedInputs {
    pub(super) fn new(program: &Program) -> RecordedInputs {
        let knots_passed = vec![0; program.sorted.dae.events.recordings.len()];
        RecordedInputs { knots_passed, given: Vec::new() }
    }

    /// Places all recordings at `t`: a knot there has been passed.
    pub(super) fn start(&mut self, program: &Program, registers: &mut Memory, t: f64) {
        let recordings = &program.sorted.dae.events.recordings;
        self.knots_passed.clear();
        for recording in recordings {
            let passed = recording.passed(0, t);
            self.knots_passed.push(passed);
            recording.load(registers, passed);
        }
        for (register, value) in &self.given {
            registers[*register as usize] = *value;
        }
    }

    /// Gives an input a value that holds until another one is given.
    pub(super) fn give(&mut self, registers: &mut Memory, input: u32, value: f64) {
        registers[input as usize] = value;
        match self.given.iter_mut().find(|(known, _)| *known == input) {
            Some((_, known)) => *known = value,
            None => self.given.push((input, value)),
        }
    }

    /// Advances to the segments that begin at `t`; whether an input jumps there, or its derivative
    /// where equations contain it.
    pub(super) fn advance(&mut self, program: &Program, registers: &mut Memory, t: f64) -> bool {
        let mut jumps = false;
        for (at, recording) in program.sorted.dae.events.recordings.iter().enumerate() {
            let before = self.knots_passed[at];
            let passed = recording.passed(before, t);
            if passed > before {
                self.knots_passed[at] = passed;
                recording.load(registers, passed);
                jumps |= program.reads_rates || recording.jumps((before, passed));
            }
        }
        jumps
    }

    /// The next knot of each recording.
    pub(super) fn next_knots(&self, program: &Program) -> impl Iterator<Item = f64> {
        let recordings = program.sorted.dae.events.recordings.iter();
        let pairs = recordings.zip(&self.knots_passed);
        pairs.filter_map(|(recording, passed)| recording.knots.get(*passed).copied())
    }
}

/// The mean distance of all knots between two times.
pub(super) fn distance_of_knots(program: &Program, start: f64, stop: f64) -> Option<f64> {
    let recordings = program.sorted.dae.events.recordings.iter();
    let within = |recording: &Recording| {
        let up_to = |time: f64| recording.knots.partition_point(|knot| *knot < time);
        up_to(stop) - up_to(start)
    };
    let knots: usize = recordings.map(within).sum();
    (knots > 0).then(|| (stop - start) / knots as f64)
}

impl Recording {
    /// How many knots lie up to `t`, at least so many.
    fn passed(&self, known: usize, t: f64) -> usize {
        let is_passed = |knot: &f64| *knot <= t || same_time(*knot, t);
        // In a simulation mostly the next one, or it and the one after a jump.
        if self.knots.get(known + 2).is_none_or(|knot| !is_passed(knot)) {
            return known + self.knots[known..].iter().take_while(|knot| is_passed(knot)).count();
        }
        known + self.knots[known..].partition_point(is_passed)
    }

    /// Whether an input has another value after these knots than before them.
    fn jumps(&self, (before, passed): (usize, usize)) -> bool {
        let is_held = |rate: Option<_>| rate.is_none();
        let first = before.saturating_sub(1);
        self.tracks.iter().any(|track| match is_held(track.rate) {
            true => track.samples[first] != track.samples[passed - 1],
            false => track.samples[before..passed].windows(2).any(|pair| pair[0] != pair[1]),
        })
    }

    /// Values, rates and the time they count from, where so many knots have been passed.
    fn load(&self, registers: &mut Memory, passed: usize) {
        let (first, knots) = (passed.saturating_sub(1), &self.knots);
        if let Some(since) = self.since {
            registers[since.0 as usize] = knots[first];
        }
        for track in &self.tracks {
            registers[track.value.0 as usize] = track.samples[first];
            if let Some(rate) = track.rate {
                let next = (passed > 0 && passed < knots.len()).then_some(passed);
                let rise = |next: usize| {
                    let length = knots[next] - knots[first];
                    let rise = track.samples[next] - track.samples[first];
                    if length > 0.0 { rise / length } else { 0.0 }
                };
                registers[rate.0 as usize] = next.map_or(0.0, rise);
            }
        }
    }
}
