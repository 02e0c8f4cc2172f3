//! One-point crossover: the genes after a point are exchanged. A new point is drawn for every pair.
//!
//! Reference: [Holland 1975](gapilib_base::bibliography#holland-1975).

use super::{Crossover, Parents, place};
use crate::diag::Fault;
use crate::ga::Mrg32k3a;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Crossover> = Entry {
    name: "one_point",
    aliases: &["single_point"],
    summary: "one-point crossover: the genes after a random point are exchanged",
    reference: "holland-1975",
    make: |_| Ok(Box::new(OnePoint)),
};

struct OnePoint;

impl Crossover for OnePoint {
    fn cross(&self, parents: Parents, rng: &mut Mrg32k3a) -> Result<(), Fault> {
        let Parents { first, second, .. } = parents;
        // A single gene has no point inside.
        if first.len() > 1 {
            let point = 1 + place(first.len() - 1, rng);
            first[point..].swap_with_slice(&mut second[point..]);
        }
        Ok(())
    }
}
