//! Relations inside `noEvent` that have events after all, once the integrator cannot continue: the
//! system replaces its program by one in which they are relations as all others.

use super::execution::run;
use super::system::System;
use crate::codegen::memory::Memory;
use crate::codegen::program::{Differences, Program};
use crate::sim::Failure;
use std::sync::Arc;

impl System {
    /// Writes left − right of every relation inside `noEvent`; y is loaded and solved.
    pub(super) fn literal_differences(&mut self, out: &mut Vec<f64>) -> Result<(), Failure> {
        out.clear();
        let program = self.program.clone();
        let Some(Differences { registers, code }) = program.differences() else { return Ok(()) };
        let made = || Box::new(Memory::new(registers));
        let memory = self.literal.memory.get_or_insert_with(made);
        let n = program.sorted.dae.variables.len();
        memory.registers[..n].copy_from_slice(&self.registers[..n]);
        run(&code.tape, memory)?;
        out.extend(code.outputs.iter().map(|at| memory.registers[*at as usize]));
        Ok(())
    }

    /// Continues with a program in which relations inside `noEvent` have events; whether there is
    /// one. y is loaded and solved.
    pub(super) fn replace_program(&mut self, t: f64) -> Result<bool, Failure> {
        // The past of delays and derivatives along directions belong to the program at hand.
        if self.has_directions() || self.program.has_past() {
            return Ok(false);
        }
        let Some(program) = self.program.clone().with_events().cloned() else { return Ok(false) };
        let mut next = self.in_program(program);
        next.start_relations(self.program.switching.relations.len(), t)?;
        let plain = std::mem::replace(self, next);
        self.literal.plain = Some(Box::new(plain));
        Ok(true)
    }
}

impl System {
    /// This system in a program that has more relations, at the same point of the same simulation.
    fn in_program(&mut self, program: Arc<Program>) -> System {
        let mut next = System::new(program);
        if let Some(variables) = &self.outputs.observed_variables {
            next.observe_only(variables);
        }
        let n = self.program.sorted.dae.variables.len();
        next.registers[..n].copy_from_slice(&self.registers[..n]);
        next.registers.calls = self.registers.calls.clone();
        let m = self.program.switching.relations.len();
        next.relations.held[..m].copy_from_slice(&self.relations.held);
        next.relations.tolerated[..m].copy_from_slice(&self.relations.tolerated);
        next.relations.postponed[..m].copy_from_slice(&self.relations.postponed[..m]);
        next.relations.switches[..m].copy_from_slice(&self.relations.switches[..m]);
        next.relations.switches[m..].fill(None);
        next.loops.choices = self.loops.choices.clone();
        next.events.clocks = self.events.clocks.clone();
        next.inputs = self.inputs.clone();
        next.events.before = self.events.before.clone();
        next.events.previous_iterate = self.events.previous_iterate.clone();
        next.events.sampled = self.events.sampled;
        next.loops.solves_loops = self.loops.solves_loops;
        next.set = self.set.clone();
        next.messages.log = self.messages.log.take();
        next.relations.treated = std::mem::take(&mut self.relations.treated);
        next
    }

    /// Everything that follows from parameters, and the relations that have events from now on: all
    /// but the first so many.
    fn start_relations(&mut self, known: usize, t: f64) -> Result<(), Failure> {
        let program = self.program.clone();
        run(&program.registers.hoisted.tape, &mut self.registers)?;
        run(&program.switching.time_rests, &mut self.registers)?;
        self.reschedule();
        for at in known..program.switching.relations.len() {
            let holds = self.relation_value(at, false, t);
            let register = program.switching.relations[at].register as usize;
            self.registers[register] = f64::from(u8::from(holds));
        }
        Ok(())
    }
}
