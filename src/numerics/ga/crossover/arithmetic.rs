//! Whole arithmetical crossover: the children are λ a + (1 − λ) b and λ b + (1 − λ) a, one λ drawn
//! uniform in 0..1 for all genes of a pair. They lie on the line between their parents, so that the
//! population shrinks; mutation has to keep it wide.
//!
//! Reference: [Michalewicz 1996](gapilib_base::bibliography#michalewicz-1996), §5.2.

use super::{Crossover, Parents};
use crate::diag::Fault;
use crate::ga::Mrg32k3a;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Crossover> = Entry {
    name: "arithmetic",
    aliases: &["intermediate"],
    summary: "arithmetic crossover: children at random on the line between their parents",
    reference: "michalewicz-1996",
    make: |_| Ok(Box::new(Arithmetic)),
};

struct Arithmetic;

impl Crossover for Arithmetic {
    fn cross(&self, parents: Parents, rng: &mut Mrg32k3a) -> Result<(), Fault> {
        let Parents { first, second, genes } = parents;
        let share = rng.uniform();
        for ((a, b), gene) in first.iter_mut().zip(second).zip(genes) {
            let moved = share * (*b - *a);
            // Between two values of the range but for rounding.
            *a = (*a + moved).clamp(gene.min, gene.max);
            *b = (*b - moved).clamp(gene.min, gene.max);
        }
        Ok(())
    }
}
