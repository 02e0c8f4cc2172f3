//! Progress: steps so short that the end is out of reach, because relations without events
//! (`noEvent`) switch again and again.
//!
//! The integrator steps across such relations. Where the fields on both sides point at each other,
//! the steps become about as short as the tolerance times the time in which the solution changes.
//! Where they are so short that the end would need too many steps, the relations are looked at for
//! some steps; if one of them switches in many of these, they get events from there on, and the
//! solution slides.

use super::event::sign;

/// Of these, those in which one relation switches that are chattering. A relay switches in 14 with
/// `rodas4`; an oscillation has ten steps or more between two zeros.
const SWITCHES: u32 = 10;
/// This many of them with a reversal of the difference of its sides are chattering: `radau5` at the
/// tolerance 1e-8 stays on one side of a relay, and reverses in every other step. No oscillation is
/// resolved with three steps between its extrema.
const REVERSALS: u32 = 20;
/// A reversal changes the difference by at least this part of it; rounding changes it by less.
const REVERSAL: f64 = 0.25;

/// What is seen of a relation between steps.
#[derive(Debug, Clone, Copy, Default)]
pub struct Look {
    /// left − right, and by how much it has changed.
    difference: f64,
    change: f64,
    switches: u32,
    reversals: u32,
}

impl Look {
    fn next(&mut self, difference: f64) {
        let change = difference - self.difference;
        let is_large = change.abs() > REVERSAL * difference.abs().max(self.difference.abs());
        self.switches += u32::from(sign(difference) != sign(self.difference));
        self.reversals += u32::from(is_large && change * self.change < 0.0);
        (self.difference, self.change) = (difference, change);
    }
}

/// How the simulation gets on.
#[derive(Debug, Default)]
pub struct Progress {
    /// Time and attempts where the window at hand began.
    pub(super) begin: Option<(f64, u64)>,
    /// How often relations were looked at, and what was seen of each.
    pub(super) looks: u32,
    pub(super) relations: Vec<Look>,
    pub(super) differences: Vec<f64>,
    /// Whether relations have events now, or there are none that could have any.
    pub(super) is_over: bool,
}

impl Progress {
    pub(crate) fn end_of_looking(&mut self) {
        (self.begin, self.looks) = (None, 0);
        self.relations.clear();
    }

    pub fn look(&mut self) {
        if self.looks == 0 {
            let first = |z: &f64| Look { difference: *z, ..Look::default() };
            self.relations.extend(self.differences.iter().map(first));
        }
        let pairs = self.relations.iter_mut().zip(&self.differences);
        pairs.for_each(|(relation, difference)| relation.next(*difference));
        self.looks += 1;
    }

    pub(crate) fn is_chattering(&self) -> bool {
        self.relations.iter().any(|seen| seen.switches >= SWITCHES || seen.reversals >= REVERSALS)
    }
}
