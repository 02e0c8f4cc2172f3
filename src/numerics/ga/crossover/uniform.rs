//! Uniform crossover: each gene changes places with the probability `swap`.
//!
//! Reference: [Syswerda 1989](gapilib_base::bibliography#syswerda-1989).

use super::{Crossover, Parents};
use crate::diag::Fault;
use crate::ga::Mrg32k3a;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Crossover> = Entry {
    name: "uniform",
    aliases: &["discrete"],
    summary: "uniform crossover: each gene is exchanged with the probability `swap`",
    reference: "syswerda-1989",
    make: |options| Ok(Box::new(Uniform { swap: options.take("swap", 0.0..=1.0, 0.5)? })),
};

struct Uniform {
    swap: f64,
}

impl Crossover for Uniform {
    fn cross(&self, parents: Parents, rng: &mut Mrg32k3a) -> Result<(), Fault> {
        let Parents { first, second, .. } = parents;
        for (a, b) in first.iter_mut().zip(second) {
            if rng.uniform() < self.swap {
                std::mem::swap(a, b);
            }
        }
        Ok(())
    }
}
