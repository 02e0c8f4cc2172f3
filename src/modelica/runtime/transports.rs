//! Variable `delay` and `spatialDistribution` in a running system: when they are recorded and read.

use super::execution::run;
use super::profile::End;
use super::state::DelayState;
use super::transport_record::{ReadPoint, Record};
use crate::codegen::code::Outputs;
use crate::codegen::events::CompiledTransport;
use crate::codegen::memory::Memory;
use crate::codegen::program::Program;
use crate::sim::Failure;

/// Relative difference of values that reading again may make.
const ROUNDING: f64 = 1e-10;
/// How often values are read again that depend on each other.
pub(super) const PASSES: usize = 50;

fn values(code: &Outputs, registers: &mut Memory) -> Result<Vec<f64>, Failure> {
    run(&code.tape, registers)?;
    Ok(code.outputs.iter().map(|register| registers[*register as usize]).collect())
}

fn place(code: &CompiledTransport, registers: &mut Memory, t: f64) -> Result<ReadPoint, Failure> {
    Ok(match values(&code.read, registers)?[..] {
        [position, positive] if positive != 0.0 => {
            ReadPoint { at: position - 1.0, from: End::High, position }
        }
        [position, _] => ReadPoint { at: position, from: End::Low, position },
        [delay] => ReadPoint { at: t - delay, from: End::High, position: t },
        _ => ReadPoint { at: t, from: End::High, position: t },
    })
}

impl DelayState {
    /// Sets the values at `t`, in other pieces than before if `is_restart`; whether one has
    /// changed.
    pub(super) fn load_transported(
        &mut self,
        program: &Program,
        registers: &mut Memory,
        t: f64,
        is_restart: bool,
    ) -> bool {
        if self.transported.is_empty() {
            return false;
        }
        for pass in 0..PASSES {
            let mut changed = false;
            for (code, record) in program.events.transports.iter().zip(&mut self.transported) {
                let Ok(place) = place(code, registers, t) else { continue };
                if is_restart {
                    record.profile.locate(place.at, place.from);
                }
                let read = record.read(code.is_pipe(), place);
                for (register, value) in code.outputs.iter().zip(read) {
                    let slot = &mut registers[*register as usize];
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

    /// Starts the records with the values at `t`, all variables being known; whether one of them
    /// began with other values.
    pub(super) fn start_transported(
        &mut self,
        program: &Program,
        registers: &mut Memory,
        t: f64,
    ) -> Result<bool, Failure> {
        let mut changed = self.transported.len() != program.events.transports.len();
        let mut records = Vec::with_capacity(program.events.transports.len());
        for (at, code) in program.events.transports.iter().enumerate() {
            let start = values(&code.start, registers)?;
            let inputs = values(&code.inputs, registers)?;
            let place = place(code, registers, t)?;
            changed |= self.transported.get(at).is_none_or(|record| record.first != inputs);
            records.push(Record::start(&start, place, &inputs, t));
        }
        self.transported = records;
        Ok(changed)
    }

    /// Records the values at `t`, all registers of states and events being loaded.
    pub(super) fn record_transported(
        &mut self,
        program: &Program,
        registers: &mut Memory,
        t: f64,
    ) -> Result<(), Failure> {
        for (at, code) in program.events.transports.iter().enumerate() {
            let inputs = values(&code.inputs, registers)?;
            let place = place(code, registers, t)?;
            self.transported[at].push(code.is_pipe(), place, &inputs, t);
        }
        Ok(())
    }

    /// Functions that cross zero where the piece that is read ends, two for every record.
    pub(super) fn transported_crossings(
        &self,
        program: &Program,
        registers: &mut Memory,
        t: f64,
        out: &mut [f64],
    ) -> Result<(), Failure> {
        let codes = program.events.transports.iter().zip(&self.transported);
        for ((code, record), out) in codes.zip(out.chunks_exact_mut(2)) {
            let place = place(code, registers, t)?;
            let (below, above) = record.profile.borders();
            out[0] = if above.is_finite() { place.at - above } else { -1.0 };
            out[1] = if below.is_finite() { place.at - below } else { 1.0 };
        }
        Ok(())
    }

    /// Whether the piece that is read has ended at `t`, all registers of states and events being loaded.
    pub(super) fn is_at_border(
        &self,
        program: &Program,
        registers: &mut Memory,
        t: f64,
    ) -> Result<bool, Failure> {
        for (code, record) in program.events.transports.iter().zip(&self.transported) {
            let place = place(code, registers, t)?;
            if record.profile.direction(place.at, place.from).is_ne() {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The longest step for which what is read is recorded before it.
    pub(super) fn longest_step(&self, program: &Program) -> f64 {
        let codes = program.events.transports.iter().zip(&self.transported);
        let longest = codes.map(|(code, record)| record.longest_step(code.is_pipe()));
        let longest = longest.fold(f64::INFINITY, f64::min);
        self.delay_times.iter().copied().fold(longest, f64::min)
    }
}
