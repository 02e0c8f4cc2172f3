//! Combinations of relations: where they do not come to rest by themselves.
//!
//! Each relation taken for itself may contradict the values that solving with it gives, although
//! together with another one it holds: a limiter with positive feedback jumps from its upper to its
//! lower limit and has no solution between them. What keeps changing is tried in all combinations,
//! then together with other relations that would change, and with those of the same blocks; of
//! combinations that hold, that with the fewest changes is taken.

use super::instants::Stage;
use super::system::System;

/// The most relations that are tried in all combinations.
const MOST_RELATIONS: usize = 10;
/// The most combinations that are tried where the branches at hand cannot be solved.
const MOST_BRANCHES: usize = 64;
/// Rounding errors of what is compared, beside the largest of it: IMC_InverterDrive, where they are
/// 1.1e-13 A of the currents of open diodes, ends without this at 0.66 s.
const ROUNDING: f64 = 1e-14;
/// Passes in which variables of discrete loops must come to rest.
const PASSES: usize = 10;

impl System {
    /// Looks for values of the relations that keep changing, and of those that go with them, with
    /// which all hold; whether there are any. Without, all is as before.
    pub(super) fn find_combination(&mut self, t: f64, stage: Stage) -> bool {
        let before = self.registers.clone();
        let mut group: Vec<usize> = Vec::new();
        let inconsistent = |group: &[usize], system: &System| {
            let all = system.relations.inconsistent.iter().enumerate();
            all.filter(|(at, inconsistent)| **inconsistent && !group.contains(at))
                .map(|(at, _)| at)
                .collect()
        };
        let mut added: Vec<usize> = inconsistent(&group, self);
        while !added.is_empty() && group.len() + added.len() <= MOST_RELATIONS {
            group.append(&mut added);
            if self.try_combinations(0, &group, &before, t, stage) {
                return true;
            }
            added = inconsistent(&group, self);
            if added.is_empty() {
                added = self.companions(&group);
            }
        }
        self.registers.copy_from_slice(&before);
        false
    }

    /// As [`find_combination`](System::find_combination), where relations are tolerated that hold
    /// but for what the tolerance, or rounding, makes of their sides: of two diodes without a
    /// current, rounding errors decide which one conducts, and may contradict each of them.
    pub(super) fn find_lenient_combination(&mut self, t: f64, stage: Stage) -> bool {
        let rounding = ROUNDING * self.largest_side();
        self.relations.uncertainty.iter_mut().for_each(|error| *error = error.max(rounding));
        self.relations.is_lenient = true;
        let found = self.find_combination(t, stage);
        self.relations.is_lenient = false;
        found
    }

    /// The largest number that relations compare.
    fn largest_side(&self) -> f64 {
        let sides =
            self.program.switching.relation_sides.iter().flat_map(|sides| sides.outputs.iter());
        let values = sides.map(|register| self.registers[*register as usize].abs());
        values.filter(|value| value.is_finite()).fold(0.0, f64::max)
    }

    /// Looks for values of the relations of one block with which all can be solved and hold, where the
    /// branches at hand cannot be solved: a limiter that begins at its limit does not let through
    /// what determines its input. Without, all is as before.
    pub(super) fn find_other_branch(&mut self, t: f64, stage: Stage) -> bool {
        let before = self.registers.clone();
        let program = self.program.clone();
        let mut tried = 0;
        let groups = program.switching.relations_of_blocks.iter();
        let found = groups.filter(|group| group.len() <= MOST_RELATIONS).any(|group| {
            tried += 1 << group.len();
            // As they are they cannot be solved.
            tried <= MOST_BRANCHES && self.try_combinations(1, group, &before, t, stage)
        });
        if !found {
            self.registers.copy_from_slice(&before);
        }
        found
    }

    /// The relations that are in a block with one of a group.
    fn companions(&self, group: &[usize]) -> Vec<usize> {
        let blocks = self.program.switching.relations_of_blocks.iter();
        let touched = blocks.filter(|block| block.iter().any(|at| group.contains(at)));
        let mut others: Vec<usize> =
            touched.flatten().copied().filter(|at| !group.contains(at)).collect();
        others.sort_unstable();
        others.dedup();
        others
    }

    /// Tries the combinations of a group with at least so many changes.
    fn try_combinations(
        &mut self,
        least: u32,
        group: &[usize],
        before: &[f64],
        t: f64,
        stage: Stage,
    ) -> bool {
        let mut combinations: Vec<u32> = (least..1 << group.len()).collect();
        combinations.sort_by_key(|combination| combination.count_ones());
        combinations.into_iter().any(|combination| {
            self.registers.copy_from_slice(before);
            for (bit, at) in group.iter().enumerate() {
                self.relations.has_changed[*at] = true;
                if combination >> bit & 1 == 1 {
                    let register = self.program.switching.relations[*at].register as usize;
                    self.registers[register] = 1.0 - self.registers[register];
                }
            }
            self.holds(t, stage)
        })
    }

    /// Solves with the relations as they are; whether they then hold. Those that do not are
    /// inconsistent.
    fn holds(&mut self, t: f64, stage: Stage) -> bool {
        for _ in 0..PASSES {
            self.events.note_iterate(&self.program, &self.registers);
            if self.solve(stage).is_err() {
                return false;
            }
            if self.events.changed_iterate(&self.program, &self.registers).is_none() {
                return !self.note_inconsistent(t) && !self.update_roundings(t);
            }
        }
        false
    }

    /// Marks the relations that do not hold; whether there are any.
    fn note_inconsistent(&mut self, t: f64) -> bool {
        let mut any = false;
        self.reschedule();
        for at in 0..self.program.switching.relations.len() {
            let value =
                self.registers[self.program.switching.relations[at].register as usize] != 0.0;
            if self.relation_value(at, value, t) != value {
                self.relations.inconsistent[at] = true;
                any = true;
            }
        }
        any
    }
}
