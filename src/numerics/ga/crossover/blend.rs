//! Blend crossover, BLX-α: each gene of a child is uniform over the interval of the parents'
//! values, widened at both ends by `alpha` times its width and cut at the range of the gene. With
//! `alpha` = 0.5 the spread of a population stays, on average, as it is.
//!
//! Reference: [Eshelman & Schaffer 1993](gapilib_base::bibliography#eshelman-schaffer-1993).

use super::{Crossover, Parents};
use crate::diag::Fault;
use crate::ga::Mrg32k3a;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Crossover> = Entry {
    name: "blend",
    aliases: &["blx", "blx_alpha"],
    summary: "BLX-alpha: genes uniform between the parents, extended by `alpha` times their \
              distance",
    reference: "eshelman-schaffer-1993",
    make: |options| Ok(Box::new(Blend { alpha: options.take("alpha", 0.0..=10.0, 0.5)? })),
};

struct Blend {
    alpha: f64,
}

impl Crossover for Blend {
    fn cross(&self, parents: Parents, rng: &mut Mrg32k3a) -> Result<(), Fault> {
        let Parents { first, second, genes } = parents;
        for ((a, b), gene) in first.iter_mut().zip(second).zip(genes) {
            let beyond = self.alpha * (*a - *b).abs();
            let low = (a.min(*b) - beyond).max(gene.min);
            let high = (a.max(*b) + beyond).min(gene.max);
            for value in [a, b] {
                *value = (low + (high - low) * rng.uniform()).min(high);
            }
        }
        Ok(())
    }
}
