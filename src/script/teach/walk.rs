//! Walking through a trace, forward and back.

use super::event::ScriptLine;
use super::generation::Generation;
use super::operation::Operation;
use super::step::{Step, steps};
use super::stop_test::loop_around;
use super::trace::{Script, Trace};

/// A place in a trace: one step of one generation.
#[derive(Debug, Clone)]
pub struct TraceCursor {
    trace: Trace,
    generation: usize,
    steps: Vec<Step>,
    at: usize,
}

impl TraceCursor {
    /// At the first step of a trace.
    pub fn new(trace: Trace) -> TraceCursor {
        let mut walk = TraceCursor { trace, generation: 0, steps: Vec::new(), at: 0 };
        walk.enter(0);
        walk
    }

    /// The trace.
    pub fn trace(&self) -> &Trace {
        &self.trace
    }

    /// Ends the walk.
    pub(crate) fn into_trace(self) -> Trace {
        self.trace
    }

    /// The number of the generation, from 0.
    pub fn number(&self) -> usize {
        self.generation
    }

    /// The generation.
    pub fn generation(&self) -> &Generation {
        &self.trace.generations[self.generation]
    }

    /// The generation after it.
    pub(crate) fn next_generation(&self) -> Option<&Generation> {
        self.trace.generations.get(self.generation + 1)
    }

    /// The step.
    pub fn step(&self) -> Step {
        self.steps[self.at]
    }

    /// The call of an operator by name that the step is about.
    pub fn operation(&self) -> Option<&Operation> {
        match self.step() {
            Step::Operate { call, .. } => {
                self.generation().operations.get(call).map(|called| &called.operation)
            }
            _ => None,
        }
    }

    /// Which of the steps of this generation it is, from 0, and how many there are.
    pub fn progress(&self) -> (usize, usize) {
        (self.at, self.steps.len())
    }

    /// Whether this is the last step of all.
    pub fn is_last(&self) -> bool {
        self.at + 1 == self.steps.len() && self.next_generation().is_none()
    }

    /// The script and the line, from 1, of the step.
    pub fn line(&self) -> Option<(&Script, usize)> {
        let place = self.place()?;
        Some((self.trace.scripts.get(place.script as usize)?, place.line as usize))
    }

    /// The same as a place. The stop test is where the loop of the generations begins.
    pub fn place(&self) -> Option<ScriptLine> {
        let place = self.step().place(self.generation(), self.next_generation())?;
        let script = self.trace.scripts.get(place.script as usize)?;
        let head = match self.step() {
            Step::Renew | Step::Stop => loop_around(&script.lines, place.line as usize),
            _ => None,
        };
        Some(head.map_or(place, |line| ScriptLine { line: line as u32, ..place }))
    }

    /// One step on; whether there was one.
    pub fn forward(&mut self) -> bool {
        if self.at + 1 < self.steps.len() {
            self.at += 1;
            return true;
        }
        self.forward_generation()
    }

    /// One step back; whether there was one.
    pub fn back(&mut self) -> bool {
        if self.at > 0 {
            self.at -= 1;
            return true;
        }
        if self.generation == 0 {
            return false;
        }
        self.enter(self.generation - 1);
        self.at = self.steps.len() - 1;
        true
    }

    /// On to the next part of the generation, such as from crossover to mutation.
    pub(crate) fn forward_phase(&mut self) -> bool {
        let phase = self.step().phase();
        match (self.at..self.steps.len()).find(|&k| self.steps[k].phase() != phase) {
            Some(at) => {
                self.at = at;
                true
            }
            None => self.forward_generation(),
        }
    }

    /// On to the first step of the next generation.
    pub(crate) fn forward_generation(&mut self) -> bool {
        self.go_to(self.generation + 1)
    }

    /// To the first step of a generation; whether there is one of this number.
    pub fn go_to(&mut self, generation: usize) -> bool {
        let exists = generation < self.trace.generations.len();
        if exists {
            self.enter(generation);
        }
        exists
    }

    /// On to the next step where `condition` holds; back where it was if there is none.
    pub fn until(&mut self, condition: impl Fn(&TraceCursor) -> bool) -> bool {
        let (generation, at) = (self.generation, self.at);
        while self.forward() {
            if condition(self) {
                return true;
            }
        }
        self.enter(generation);
        self.at = at;
        false
    }

    fn enter(&mut self, generation: usize) {
        self.generation = generation;
        self.at = 0;
        let next = self.trace.generations.get(generation + 1);
        self.steps = steps(&self.trace.generations[generation], next);
    }
}
