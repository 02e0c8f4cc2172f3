//! Two-point crossover: the genes between two different points of the ring of genes are exchanged,
//! so that the last gene is a neighbour of the first.
//!
//! Reference: [De Jong 1975](gapilib_base::bibliography#de-jong-1975).

use super::{Crossover, Parents, place};
use crate::diag::Fault;
use crate::ga::Mrg32k3a;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Crossover> = Entry {
    name: "two_point",
    aliases: &["double_point"],
    summary: "two-point crossover: the genes between two random points are exchanged",
    reference: "de-jong-1975",
    make: |_| Ok(Box::new(TwoPoint)),
};

struct TwoPoint;

impl Crossover for TwoPoint {
    fn cross(&self, parents: Parents, rng: &mut Mrg32k3a) -> Result<(), Fault> {
        let Parents { first, second, .. } = parents;
        let n = first.len();
        if n > 1 {
            let one = place(n, rng);
            let other = (one + 1 + place(n - 1, rng)) % n;
            let between = one.min(other)..one.max(other);
            first[between.clone()].swap_with_slice(&mut second[between]);
        }
        Ok(())
    }
}
