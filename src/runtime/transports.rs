//! Variable `delay` and `spatialDistribution` in a running system (MLS §3.7.4.1, §3.7.4.2).
//!
//! A delay is recorded over time t and read at t - T. The content of a pipe is recorded over the
//! coordinate s = x - y of the fluid, x being how far it has moved and y the place in the pipe: what
//! enters at y = 0 is recorded at s = x, what enters at y = 1 at s = x - 1, and the other end is
//! read. Where the fluid enters, the specification gives back the value of the last accepted step,
//! to avoid an algebraic loop; here the straight line through the last ones leads on from it.

use super::execution::run;
use super::profile::{End, Profile};
use super::system::System;
use super::transport_record::Record;
use crate::codegen::code::Outputs;
use crate::codegen::events::CompiledTransport;
use crate::codegen::memory::Memory;
use crate::sim::Failure;

/// The part of the longest delay that steps may be long, however short the delay is: so far the last
/// values are extrapolated.
const SHORTEST_DELAY: f64 = 1e-3;
/// The part of a pipe that the content moves about at most in one step: with a half, the cubics of
/// `a_profile_is_transported_at_constant_velocity` are off by 4e-5.
const LONGEST_MOVE: f64 = 0.1;
/// Relative difference of values that reading again may make.
const ROUNDING: f64 = 1e-10;
/// How often values are read again that depend on each other.
const PASSES: usize = 50;

/// Where a profile is read.
#[derive(Debug, Clone, Copy)]
struct Place {
    at: f64,
    /// The end from which the values come.
    from: End,
    /// How far the content of a pipe has moved.
    position: f64,
}

fn values(code: &Outputs, registers: &mut Memory) -> Result<Vec<f64>, Failure> {
    run(&code.tape, registers)?;
    Ok(code.outputs.iter().map(|register| registers[*register as usize]).collect())
}

fn place(code: &CompiledTransport, registers: &mut Memory, t: f64) -> Result<Place, Failure> {
    Ok(match values(&code.read, registers)?[..] {
        [position, positive] if positive != 0.0 => {
            Place { at: position - 1.0, from: End::High, position }
        }
        [position, _] => Place { at: position, from: End::Low, position },
        [delay] => Place { at: t - delay, from: End::High, position: t },
        _ => Place { at: t, from: End::High, position: t },
    })
}

impl Record {
    /// Before anything has gone in but `inputs`.
    fn start(start: &[f64], place: Place, inputs: &[f64], t: f64) -> Record {
        let positive = place.from == End::High;
        let mut record = Record { positive, last: (t, place.position), ..Record::default() };
        record.first = inputs.to_vec();
        record.delay = t - place.at;
        match *start {
            [longest] => {
                record.longest = longest;
                record.profile = Profile::constant_before(t, inputs[0], longest);
            }
            _ => {
                let (points, values) = start.split_at(start.len() / 2);
                let points: Vec<f64> = points.iter().rev().map(|y| place.position - y).collect();
                let values: Vec<f64> = values.iter().rev().copied().collect();
                record.longest = 1.0;
                record.profile = Profile::of_points(&points, &values, 1.0);
                record.enter(place, inputs);
            }
        }
        record.profile.locate(place.at, place.from);
        record
    }

    /// What goes into a pipe.
    fn enter(&mut self, place: Place, inputs: &[f64]) {
        match place.from {
            End::High => self.profile.push(End::High, place.position, inputs[0]),
            End::Low => self.profile.push(End::Low, place.position - 1.0, inputs[1]),
        }
    }

    fn push(&mut self, is_pipe: bool, place: Place, inputs: &[f64], t: f64) {
        if !is_pipe {
            self.delay = t - place.at;
            self.profile.push(End::High, t, inputs[0]);
            self.profile.forget_below(t - 2.0 * self.longest);
            return;
        }
        // What is forgotten is not even needed at the begin of the step at hand.
        let positive = place.from == End::High;
        if positive != self.positive {
            match place.from {
                End::High => self.profile.cut(End::High, place.position),
                End::Low => self.profile.cut(End::Low, place.position - 1.0),
            }
            self.positive = positive;
            self.profile.locate(place.at, place.from);
        }
        self.enter(place, inputs);
        match place.from {
            End::High => self.profile.forget_below(place.at - 1.0),
            End::Low => self.profile.forget_above(place.at + 1.0),
        }
        if t > self.last.0 {
            self.velocity = (place.position - self.last.1) / (t - self.last.0);
            self.last = (t, place.position);
        }
    }

    /// The values at a place; not a number where the step is too long for what is recorded.
    fn read(&self, is_pipe: bool, place: Place) -> [f64; 2] {
        let end = self.profile.end(place.from);
        let margin = if is_pipe { 0.0 } else { SHORTEST_DELAY * self.longest * 1.01 };
        let unknown = match place.from {
            End::High => place.at > end + margin,
            End::Low => place.at < end,
        };
        let out = if unknown { f64::NAN } else { self.profile.value(place.at) };
        match place.from {
            End::High if is_pipe => [self.profile.near_end(End::High, place.position), out],
            End::Low => [out, self.profile.near_end(End::Low, place.position - 1.0)],
            End::High => [out, out],
        }
    }

    fn longest_step(&self, is_pipe: bool) -> f64 {
        match is_pipe {
            true => LONGEST_MOVE / self.velocity.abs(),
            false => self.delay.max(SHORTEST_DELAY * self.longest),
        }
    }
}

impl System {
    /// Sets the values at `t`, in other pieces than before if `anew`; whether one has changed.
    pub(super) fn load_transported(&mut self, t: f64, anew: bool) -> bool {
        if self.transported.is_empty() {
            return false;
        }
        let program = self.program.clone();
        for pass in 0..PASSES {
            let mut changed = false;
            for (code, record) in program.events.transports.iter().zip(&mut self.transported) {
                let Ok(place) = place(code, &mut self.registers, t) else { continue };
                if anew {
                    record.profile.locate(place.at, place.from);
                }
                let read = record.read(code.is_pipe(), place);
                for (register, value) in code.outputs.iter().zip(read) {
                    let slot = &mut self.registers[*register as usize];
                    changed |= (*slot - value).abs() > ROUNDING * slot.abs().max(value.abs());
                    *slot = value;
                }
            }
            if !changed {
                return pass > 0;
            }
        }
        true
    }

    /// Solves for iteration variables until they agree with the values that depend on them.
    pub(super) fn agree_with_transported(&mut self, t: f64) -> Result<(), Failure> {
        for _ in 0..PASSES {
            if !self.load_transported(t, false) {
                return Ok(());
            }
            self.solve(super::instants::Stage::Continuous)?;
        }
        Ok(())
    }

    /// Starts the records with the values at `t`, all variables being known; whether one of them
    /// began with other values.
    pub(super) fn start_transported(&mut self, t: f64) -> Result<bool, Failure> {
        let program = self.program.clone();
        let mut changed = self.transported.len() != program.events.transports.len();
        let mut records = Vec::with_capacity(program.events.transports.len());
        for (at, code) in program.events.transports.iter().enumerate() {
            let start = values(&code.start, &mut self.registers)?;
            let inputs = values(&code.inputs, &mut self.registers)?;
            let place = place(code, &mut self.registers, t)?;
            changed |= self.transported.get(at).is_none_or(|record| record.first != inputs);
            records.push(Record::start(&start, place, &inputs, t));
        }
        self.transported = records;
        Ok(changed)
    }

    /// Records the values at `t`, all registers of states and events being loaded.
    pub(super) fn record_transported(&mut self, t: f64) -> Result<(), Failure> {
        let program = self.program.clone();
        for (at, code) in program.events.transports.iter().enumerate() {
            let inputs = values(&code.inputs, &mut self.registers)?;
            let place = place(code, &mut self.registers, t)?;
            self.transported[at].push(code.is_pipe(), place, &inputs, t);
        }
        Ok(())
    }

    /// Functions that cross zero where the piece that is read ends, two for every record.
    pub(super) fn transported_crossings(&mut self, t: f64, out: &mut [f64]) -> Result<(), Failure> {
        let program = self.program.clone();
        let codes = program.events.transports.iter().zip(&self.transported);
        for ((code, record), out) in codes.zip(out.chunks_exact_mut(2)) {
            let place = place(code, &mut self.registers, t)?;
            let (below, above) = record.profile.borders();
            out[0] = if above.is_finite() { place.at - above } else { -1.0 };
            out[1] = if below.is_finite() { place.at - below } else { 1.0 };
        }
        Ok(())
    }

    /// The longest step for which what is read is recorded before it.
    pub(super) fn longest_transport(&self) -> f64 {
        let codes = self.program.events.transports.iter().zip(&self.transported);
        codes
            .map(|(code, record)| record.longest_step(code.is_pipe()))
            .fold(f64::INFINITY, f64::min)
    }
}
