//! Deterministic crowding: of two parents and their two children, each child competes with the
//! parent that it is more like, and takes its place if it is better. Everyone is a parent once a
//! generation (selection `shuffle`), and competes with similar individuals only, so that several
//! minima stay occupied.
//!
//! Distances are Euclidean in the fractions of the ranges.
//!
//! Reference: [Mahfoud 1995](gapilib_base::bibliography#mahfoud-1995), §5.2.

use super::{Brood, Sizes, Survival, Survivor};
use crate::diag::Fault;
use crate::ga::Gene;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Survival> = Entry {
    name: "crowding",
    aliases: &["deterministic_crowding"],
    summary: "deterministic crowding: a child replaces the more similar parent if it is better",
    reference: "mahfoud-1995",
    make: |_| Ok(Box::new(Crowding)),
};

struct Crowding;

impl Survival for Crowding {
    fn survivors(&self, brood: &Brood<'_>, _: Sizes) -> Result<Vec<Survivor>, Fault> {
        let mut places: Vec<Survivor> = (0..brood.old.fitness.len()).map(Survivor::Old).collect();
        for first in (0..brood.parents.len()).step_by(2) {
            let [a, b] = brood.parents[first];
            let distance = |parent: usize, child: usize| {
                distance(brood, Survivor::Old(parent), Survivor::Offspring(child))
            };
            if first + 1 < brood.parents.len() {
                let straight = distance(a, first) + distance(b, first + 1);
                let crosswise = distance(a, first + 1) + distance(b, first);
                let (one, other) = if straight <= crosswise { (a, b) } else { (b, a) };
                compete(brood, &mut places[one], first);
                compete(brood, &mut places[other], first + 1);
            } else {
                // The second child of the last pair was not requested.
                let like = if distance(a, first) <= distance(b, first) { a } else { b };
                compete(brood, &mut places[like], first);
            }
        }
        Ok(places)
    }

    fn can_resize(&self) -> bool {
        false
    }

    fn needs_parents(&self) -> bool {
        true
    }

    fn usual_selection(&self) -> &'static str {
        "shuffle"
    }
}

/// A child takes the place if it is better than who is there.
fn compete(brood: &Brood<'_>, place: &mut Survivor, child: usize) {
    let child = Survivor::Offspring(child);
    let (own, there) = (brood.fitness(child), brood.fitness(*place));
    if own < there || there.is_nan() && !own.is_nan() {
        *place = child;
    }
}

fn distance(brood: &Brood<'_>, one: Survivor, other: Survivor) -> f64 {
    let pairs = brood.genome(one).iter().zip(brood.genome(other)).zip(brood.genes);
    let square = |((a, b), gene): ((&f64, &f64), &Gene)| {
        let difference = gene.fraction(*a) - gene.fraction(*b);
        difference * difference
    };
    pairs.map(square).sum::<f64>().sqrt()
}
