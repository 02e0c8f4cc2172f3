//! Stochastic universal sampling: probabilities as those of the roulette wheel, but one turn of a
//! wheel with equally spaced pointers. An individual that is due e parents becomes ⌊e⌋ or ⌈e⌉ of
//! them: the smallest spread that there can be. The parents mate in random order.
//!
//! Reference: [Baker 1987](gapilib_base::bibliography#baker-1987).

use super::{Selection, pointed, proportionate, shuffled, sums};
use crate::diag::Fault;
use crate::ga::Mrg32k3a;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Selection> = Entry {
    name: "stochastic_universal",
    aliases: &["sus"],
    summary: "as roulette, with one spin of a wheel with one pointer per parent",
    reference: "baker-1987",
    make: |_| Ok(Box::new(StochasticUniversal)),
};

struct StochasticUniversal;

impl Selection for StochasticUniversal {
    fn select(
        &self,
        fitness: &[f64],
        count: usize,
        rng: &mut Mrg32k3a,
    ) -> Result<Vec<usize>, Fault> {
        let (sums, first) = (sums(&proportionate(fitness)), rng.uniform());
        let pointer = |k: usize| pointed(&sums, (k as f64 + first) / count as f64);
        Ok(shuffled((0..count).map(pointer).collect(), rng))
    }

    fn draws_all_at_once(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        /// The minimal spread of Baker's paper.
        #[test]
        fn everyone_gets_the_floor_or_the_ceiling_of_what_is_due(
            fitness in prop::collection::vec(0.0..10.0_f64, 2..30),
            count in 1..60_usize,
        ) {
            let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
            let chosen = StochasticUniversal.select(&fitness, count, &mut rng).unwrap();
            prop_assert_eq!(chosen.len(), count);
            let weights = proportionate(&fitness);
            let sum: f64 = weights.iter().sum();
            for (k, weight) in weights.iter().enumerate() {
                let due = count as f64 * weight / sum;
                let found = chosen.iter().filter(|own| **own == k).count() as f64;
                let within = found >= (due - 1e-9).floor() && found <= (due + 1e-9).ceil();
                prop_assert!(within, "{found} for {due}");
            }
        }
    }
}
