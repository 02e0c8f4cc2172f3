//! Recorded inputs at run time: a cursor into the knots of each recording. It moves at events alone,
//! so that the segment that ends at a knot continues until the event there has been handled.

use super::instants::same_time;
use super::system::System;
use crate::lower::Recording;

impl System {
    /// Places all recordings at `t`: a knot there has been passed.
    pub(super) fn start_recordings(&mut self, t: f64) {
        let program = self.program.clone();
        let recordings = &program.sorted.dae.events.recordings;
        self.events.knots_passed.clear();
        for recording in recordings {
            let passed = recording.passed(0, t);
            self.events.knots_passed.push(passed);
            self.set_segment(recording, passed);
        }
        for (register, value) in &self.events.given {
            self.registers.registers[*register as usize] = *value;
        }
    }

    /// Gives a recorded input, by its number from [`Program::recorded_input`](crate::codegen::Program::recorded_input),
    /// a value that holds from the next event, or the start, until another one is given. It has one
    /// sample.
    pub fn set_recorded(&mut self, input: u32, value: f64) {
        self.loops.is_solved = false;
        self.registers.registers[input as usize] = value;
        match self.events.given.iter_mut().find(|(known, _)| *known == input) {
            Some((_, known)) => *known = value,
            None => self.events.given.push((input, value)),
        }
    }

    /// Advances to the segments that begin at `t`; whether an input jumps there, or its derivative
    /// where equations contain it.
    pub(super) fn advance_recordings(&mut self, t: f64) -> bool {
        let program = self.program.clone();
        let mut jumps = false;
        for (at, recording) in program.sorted.dae.events.recordings.iter().enumerate() {
            let before = self.events.knots_passed[at];
            let passed = recording.passed(before, t);
            if passed > before {
                self.events.knots_passed[at] = passed;
                self.set_segment(recording, passed);
                jumps |= program.reads_rates || recording.jumps((before, passed));
            }
        }
        jumps
    }

    /// The next knot of each recording.
    pub(super) fn next_knots(&self) -> impl Iterator<Item = f64> {
        let recordings = self.program.sorted.dae.events.recordings.iter();
        let pairs = recordings.zip(&self.events.knots_passed);
        pairs.filter_map(|(recording, passed)| recording.knots.get(*passed).copied())
    }

    /// The mean distance of all knots between two times.
    pub(super) fn distance_of_knots(&self, start: f64, stop: f64) -> Option<f64> {
        let recordings = self.program.sorted.dae.events.recordings.iter();
        let within = |recording: &Recording| {
            let up_to = |time: f64| recording.knots.partition_point(|knot| *knot < time);
            up_to(stop) - up_to(start)
        };
        let knots: usize = recordings.map(within).sum();
        (knots > 0).then(|| (stop - start) / knots as f64)
    }

    /// Values, rates and the time they count from, where so many knots have been passed.
    fn set_segment(&mut self, recording: &Recording, passed: usize) {
        let (first, knots) = (passed.saturating_sub(1), &recording.knots);
        if let Some(since) = recording.since {
            self.registers[since.0 as usize] = knots[first];
        }
        for track in &recording.tracks {
            self.registers[track.value.0 as usize] = track.samples[first];
            if let Some(rate) = track.rate {
                let next = (passed > 0 && passed < knots.len()).then_some(passed);
                let rise = |next: usize| {
                    let length = knots[next] - knots[first];
                    let rise = track.samples[next] - track.samples[first];
                    if length > 0.0 { rise / length } else { 0.0 }
                };
                self.registers[rate.0 as usize] = next.map_or(0.0, rise);
            }
        }
    }
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
}
