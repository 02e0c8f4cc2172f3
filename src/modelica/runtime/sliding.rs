//! A compiled model on both sides of relations: what chattering and sliding need.
//!
//! A mode is a combination of values of relations with the values of events that follow from them.
//! It is a function of the combination alone where no value of events remembers another one: no
//! `pre`, no when-clause and no `reinit` depends on the relations.
//!
//! A relation of which another one does may be followed while its events change nothing, as that of
//! `q = r or pre(q)` while `q` holds.

use super::execution::run;
use super::instants::Stage;
use super::modes::Treated;
use super::system::System;
use crate::sim::{Failure, Side, Treatment};
use crate::symbolic::RelationOperator;

/// Passes in which the values of events of a mode must come to rest.
const PASSES: usize = 10;

impl System {
    /// The relation of a crossing function.
    fn relation_of(&self, crossing: usize) -> Option<usize> {
        self.program.switching.crossing_relations.get(crossing).copied()
    }

    pub(super) fn is_memoryless(&self, crossing: usize) -> bool {
        let relation = self.relation_of(crossing);
        relation.is_some_and(|at| self.program.switching.memoryless[at]) && !self.program.has_past()
    }

    /// Whether the relation of a crossing function chooses equations of a torn loop.
    pub(super) fn is_in_loop(&self, crossing: usize) -> bool {
        let loops = &self.program.switching.relations_of_loops;
        self.relation_of(crossing).is_none_or(|at| loops.binary_search(&at).is_ok())
    }

    /// Sets the relation of a crossing function to its value on one side.
    fn set_side(&mut self, crossing: usize, is_positive: bool) {
        let Some(at) = self.relation_of(crossing) else { return };
        let relation = &self.program.switching.relations[at];
        let side = if is_positive { 1.0 } else { -1.0 };
        let holds = relation.operator.holds(side, 0.0);
        let register = relation.register as usize;
        self.registers[register] = f64::from(u8::from(holds));
    }

    /// Solves for the values of events that follow from the relations at hand.
    fn solve_for_values_of_events(&mut self) -> Result<bool, Failure> {
        if self.program.events.steps.is_empty() {
            return Ok(true);
        }
        for _ in 0..PASSES {
            self.events.note_iterate(&self.program, &self.registers);
            self.solve(Stage::Event)?;
            if self.events.changed_iterate(&self.program, &self.registers).is_none() {
                return Ok(true);
            }
        }
        Ok(false)
    }

    pub(super) fn compute_modes(&mut self, sides: &[Side]) -> Result<bool, Failure> {
        if !sides.iter().all(|side| self.is_memoryless(side.crossing)) {
            return Ok(false);
        }
        let program = self.program.clone();
        self.relations.modes.registers.clear();
        self.relations.modes.values.clear();
        let relations =
            sides.iter().map(|side| program.switching.crossing_relations[side.crossing]);
        self.relations
            .modes
            .registers
            .extend(relations.map(|at| program.switching.relations[at].register));
        self.relations.modes.registers.extend(program.events.discrete.iter().map(|v| v.0));
        let before = self.registers.to_vec();
        let mut found = Ok(true);
        let surfaces = sides.iter().map(|side| side.surface + 1).max().unwrap_or(0);
        for mode in 0..1usize << surfaces {
            for side in sides {
                let is_above = mode >> side.surface & 1 == 1;
                self.set_side(side.crossing, is_above != side.is_reversed);
            }
            found = self.solve_for_values_of_events();
            if found != Ok(true) {
                break;
            }
            let values =
                self.relations.modes.registers.iter().map(|at| self.registers[*at as usize]);
            self.relations.modes.values.extend(values);
            self.registers.copy_from_slice(&before);
        }
        self.registers.copy_from_slice(&before);
        // In a mode that has no values there is no field either.
        Ok(found.unwrap_or(false))
    }

    pub(super) fn load_mode(&mut self, mode: usize) {
        self.loops.is_solved = false;
        let n = self.relations.modes.registers.len();
        let values = self.relations.modes.values.iter().skip(mode * n);
        for (register, value) in self.relations.modes.registers.iter().zip(values) {
            self.registers[*register as usize] = *value;
        }
    }

    /// Sets relations without an event; whether no value that remembers them has changed. If one
    /// has, all is as before.
    pub(super) fn change_sides(&mut self, sides: &[(usize, bool)]) -> Result<bool, Failure> {
        let has_memory = !sides.iter().all(|(crossing, _)| self.is_memoryless(*crossing));
        let before = if has_memory { self.registers.to_vec() } else { Vec::new() };
        sides.iter().for_each(|(crossing, is_positive)| self.set_side(*crossing, *is_positive));
        self.solve_for_values_of_events()?;
        if !has_memory {
            return Ok(true);
        }
        let discrete = self.program.events.discrete.iter().map(|v| v.0 as usize);
        let is_idle = discrete.into_iter().all(|at| self.registers[at] == before[at]);
        if is_idle && !self.reinit_is_due()? {
            return Ok(true);
        }
        self.registers.copy_from_slice(&before);
        for (crossing, _) in sides {
            if let Some(at) = self.relation_of(*crossing) {
                self.relations.is_idle[at] = false;
            }
        }
        Ok(false)
    }

    /// Notes of the relations that have changed in the event at hand whether anything followed.
    pub(super) fn note_idle_relations(&mut self) {
        let changed = self
            .relations
            .has_changed
            .iter()
            .zip(&mut self.relations.is_idle)
            .filter(|(changed, _)| **changed);
        changed.for_each(|(_, is_idle)| *is_idle = !self.relations.has_effect);
    }

    /// Whether the last event of a relation has changed nothing.
    pub(super) fn is_idle_now(&self, crossing: usize) -> bool {
        let Some(at) = self.relation_of(crossing) else { return false };
        let operator = self.program.switching.relations[at].operator;
        let has_sides = !matches!(operator, RelationOperator::Equal | RelationOperator::NotEqual);
        has_sides && self.relations.is_idle[at] && self.delays.histories.is_empty()
    }

    /// Whether the condition of a `reinit` holds.
    fn reinit_is_due(&mut self) -> Result<bool, Failure> {
        let program = self.program.clone();
        let reinits = &program.events.reinits;
        run(&reinits.tape, &mut self.registers)?;
        let mut conditions = reinits.outputs.chunks_exact(2).map(|pair| pair[0] as usize);
        Ok(conditions.any(|condition| self.registers[condition] != 0.0))
    }

    pub(super) fn keep_uncertainty(&mut self, crossings: &[f64]) {
        for (at, value) in self.program.switching.crossing_relations.iter().zip(crossings) {
            self.relations.uncertainty[*at] = *value;
        }
    }

    pub(super) fn keep_relations_of(&mut self, crossings: &[(usize, f64)]) {
        self.relations.kept.clear();
        for (crossing, limit) in crossings {
            self.relations.kept.extend(self.relation_of(*crossing).map(|at| (at, *limit)));
        }
    }

    pub(super) fn note_treated(&mut self, time: f64, crossing: usize, treatment: Treatment) {
        let Some(relation) = self.relation_of(crossing) else { return };
        let span = self.program.sorted().dae.relations[relation].span;
        if !self
            .relations
            .treated
            .iter()
            .any(|known| known.span == span && known.treatment == treatment)
        {
            self.relations.treated.push(Treated { time, treatment, span });
        }
    }

    /// What was done about relations that chattered in the last simulation, once for each place.
    pub fn treated(&self) -> &[Treated] {
        &self.relations.treated
    }
}
