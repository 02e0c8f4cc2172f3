//! Relations that keep their values between events (MLS §8.5).
//!
//! ```text
//! a > b   changes in a step and       where a - b > 0 begins or ends to hold
//!         at first in an event
//!         changes again in that event where a - b passes -ε while it holds, ε while it does not
//! ```
//!
//! A relation that has so been kept once has these bounds in all later steps, and in a later event if
//! the variables have no values with what its sides say exactly: the flow between two closed ports
//! is zero, and only s > 0 with s = 0 determines the pressure between them.
//!
//! Where no values of the relations agree with what they decide, those whose sides differ by less
//! than errors of y as large as the tolerance are tolerated: ε is as large for them until they
//! change.
//!
//! ε is a little more than what rounding makes of the sides. Without it the value of a relation
//! that decides which equations hold, and that they bring to its very limit (a friction element
//! that just begins to slide), would depend on rounding errors and never come to rest.

use super::execution::{read, run};
use super::instants::{Change, same_time};
use super::system::System;
use crate::sim::Failure;
use crate::symbolic::RelationOperator;

/// ε relative to the larger side.
const RELATIVE: f64 = 1e-12;
/// ε of sides that are zero.
const ABSOLUTE: f64 = 1e-13;

/// How far a relation is from having another value, given the one it has; negative beyond that.
fn distance(operator: RelationOperator, holds: bool, (a, b): (f64, f64), tolerated: f64) -> f64 {
    let margin = (RELATIVE * a.abs().max(b.abs()) + ABSOLUTE).max(tolerated);
    match operator {
        RelationOperator::Greater | RelationOperator::GreaterEqual if holds => a - b + margin,
        RelationOperator::Greater | RelationOperator::GreaterEqual => b - a + margin,
        RelationOperator::Less | RelationOperator::LessEqual if holds => b - a + margin,
        RelationOperator::Less | RelationOperator::LessEqual => a - b + margin,
        RelationOperator::Equal | RelationOperator::NotEqual => {
            let same = if operator.holds(a, b) == holds { 1.0 } else { -1.0 };
            same * (a - b).abs().max(ABSOLUTE)
        }
    }
}

impl System {
    /// Evaluates the relations at the values of the variables; whether one changed.
    pub(super) fn update_relations(&mut self, t: f64, change: Change) -> bool {
        let program = self.program.clone();
        self.reschedule();
        let mut changed = self.update_roundings(t);
        for at in 0..program.switching.relations.len() {
            if changed && change == Change::First {
                break;
            }
            let register = program.switching.relations[at].register;
            let before = self.registers[register as usize] != 0.0;
            if self.relation_value(at, before, t) != before {
                changed = true;
                self.events.unstable = register;
                self.relations.has_changed[at] = true;
                self.relations.inconsistent[at] = true;
                self.relations.tolerated[at] = 0.0;
                self.registers[register as usize] = f64::from(u8::from(!before));
            }
        }
        changed
    }

    /// The times of relations on time whose other terms change at events, with their values at hand.
    pub(super) fn reschedule(&mut self) {
        let program = self.program.clone();
        let Some(rests) = &program.switching.rescheduled_rests else { return };
        let is_known = run(rests, &mut self.registers).is_ok();
        for (at, relation) in program.switching.relations.iter().enumerate() {
            if let (Some((factor, rest)), true) = (relation.time, relation.is_rescheduled) {
                let time = -self.registers[rest as usize] / factor;
                self.set_switch(at, is_known.then_some(time));
            }
        }
    }

    pub(super) fn relation_value(&mut self, at: usize, before: bool, t: f64) -> bool {
        let relation = &self.program.switching.relations[at];
        let operator = relation.operator;
        if let (Some((factor, _)), Some(switch)) = (relation.time, self.relations.switches[at]) {
            // At the instant itself the value is that after it; at the start, which nothing comes
            // before, an event follows for that.
            let difference = match (same_time(t, switch), self.relations.is_at_start) {
                (true, true) => 0.0,
                (true, false) => factor,
                (false, _) => factor * (t - switch),
            };
            return operator.holds(difference, 0.0);
        }
        let sides = &self.program.switching.relation_sides[at];
        if sides.tape.run(&mut self.registers).is_err() {
            return before;
        }
        let [a, b] = [sides.outputs[0], sides.outputs[1]];
        let (a, b) = (self.registers[a as usize], self.registers[b as usize]);
        if a == b && a.is_infinite() {
            // Which of two overflows is larger is not known.
            return before;
        }
        let mut kept = self.relations.kept.iter().filter(|(relation, _)| *relation == at);
        if kept.any(|(_, limit)| (a - b).abs() <= *limit) {
            return before;
        }
        let exact = operator.holds(a, b);
        let may_keep = self.relations.has_changed[at]
            || (self.relations.keeps_held && self.relations.held[at]);
        if exact == before || !may_keep {
            return exact;
        }
        if distance(operator, before, (a, b), 0.0) >= 0.0 {
            self.relations.held[at] = true;
            return before;
        }
        let tolerated = if self.relations.is_lenient {
            self.relations.uncertainty[at]
        } else {
            self.relations.tolerated[at]
        };
        let keeps = tolerated > 0.0 && distance(operator, before, (a, b), tolerated) >= 0.0;
        if keeps {
            (self.relations.held[at], self.relations.tolerated[at]) = (true, tolerated);
            return before;
        }
        exact
    }

    /// Writes the crossing functions of relations and roundings; y is loaded and solved.
    pub(super) fn relation_crossings(&mut self, out: &mut [f64]) -> Result<(), Failure> {
        let program = self.program.clone();
        let mut values = std::mem::take(&mut self.relations.crossing_values);
        values.resize(program.switching.crossings.outputs.len(), 0.0);
        let computed = read(&program.switching.crossings, &mut self.registers, &mut values);
        let n = program.switching.crossing_relations.len();
        let (sides, rest) = values.split_at(2 * n);
        let (first, second) = out.split_at_mut(n);
        let pairs = sides.chunks_exact(2).zip(&program.switching.crossing_relations);
        for (z, (pair, at)) in first.iter_mut().zip(pairs) {
            *z = self.crossing(*at, (pair[0], pair[1]));
        }
        second.copy_from_slice(rest);
        self.relations.crossing_values = values;
        computed
    }

    /// Writes these of the crossing functions of relations, ascending, and perhaps others beside them;
    /// y is loaded and solved. `None` where they have no code of their own.
    pub(super) fn relation_crossings_among(
        &mut self,
        which: &[usize],
        out: &mut [f64],
    ) -> Option<Result<(), Failure>> {
        let program = self.program.clone();
        let parts = &program.switching.crossing_parts;
        let mut left = which.iter().peekable();
        let mut values = std::mem::take(&mut self.relations.crossing_values);
        let mut computed = Ok(());
        while let (Some(at), Ok(())) = (left.peek(), &computed) {
            let part = parts.get(parts.partition_point(|part| part.end() <= **at))?;
            values.resize(part.code.outputs.len(), 0.0);
            computed = read(&part.code, &mut self.registers, &mut values);
            for (number, pair) in (part.first..).zip(values.chunks_exact(2)) {
                let at = program.switching.crossing_relations[number];
                out[number] = self.crossing(at, (pair[0], pair[1]));
            }
            while left.next_if(|at| **at < part.end()).is_some() {}
        }
        self.relations.crossing_values = values;
        Some(computed)
    }

    /// The crossing function of a relation with these sides.
    fn crossing(&self, at: usize, (a, b): (f64, f64)) -> f64 {
        let relation = &self.program.switching.relations[at];
        let tolerated = self.relations.tolerated[at];
        let holds = || self.registers[relation.register as usize] != 0.0;
        match self.relations.held[at] {
            true if holds() => distance(relation.operator, true, (a, b), tolerated),
            true => -distance(relation.operator, false, (a, b), tolerated),
            false => a - b,
        }
    }

    /// Writes for every relation and rounding with crossing functions how far it is from another value:
    /// positive as long as it keeps the one that it has, within ε; y is loaded and solved.
    pub(super) fn distances(&mut self, out: &mut [f64]) -> Result<(), Failure> {
        let program = self.program.clone();
        let mut values = vec![0.0; program.switching.crossings.outputs.len()];
        read(&program.switching.crossings, &mut self.registers, &mut values)?;
        let n = program.switching.crossing_relations.len();
        let (sides, rest) = values.split_at(2 * n);
        let (first, second) = out.split_at_mut(n);
        let pairs = sides.chunks_exact(2).zip(&program.switching.crossing_relations);
        for (z, (pair, at)) in first.iter_mut().zip(pairs) {
            let relation = &program.switching.relations[*at];
            let holds = self.registers[relation.register as usize] != 0.0;
            let tolerated = self.relations.tolerated[*at];
            *z = distance(relation.operator, holds, (pair[0], pair[1]), tolerated);
        }
        // The argument of a rounding less its value, and that less 1.
        for (z, pair) in second.chunks_exact_mut(2).zip(rest.chunks_exact(2)) {
            (z[0], z[1]) = (pair[0] + ABSOLUTE, ABSOLUTE - pair[1]);
        }
        Ok(())
    }
}
