//! Roulette wheel, fitness-proportionate selection: the probability of an individual is
//! proportional to how much better it is than the worst of the generation. One turn for each parent,
//! so that numbers of children scatter; `stochastic_universal` has the same mean without that.
//!
//! References: [Holland 1975](gapilib_base::bibliography#holland-1975), windowing:
//! [Goldberg 1989](gapilib_base::bibliography#goldberg-1989).

use super::{Selection, proportionate, spun};
use crate::diag::Fault;
use crate::ga::Mrg32k3a;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Selection> = Entry {
    name: "roulette",
    aliases: &["proportionate", "fitness_proportionate"],
    summary: "fitness-proportional: probability proportional to the distance from the worst \
              fitness; one spin per parent",
    reference: "holland-1975",
    make: |_| Ok(Box::new(Roulette)),
};

struct Roulette;

impl Selection for Roulette {
    fn select(
        &self,
        fitness: &[f64],
        count: usize,
        rng: &mut Mrg32k3a,
    ) -> Result<Vec<usize>, Fault> {
        Ok(spun(&proportionate(fitness), count, rng))
    }

    fn draws_all_at_once(&self) -> bool {
        // Independent, but the wheel is the same for all of a generation.
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parents_are_drawn_in_proportion() {
        let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
        let fitness = [1.0, 4.0, 1e60, 3.0, f64::NAN];
        let chosen = Roulette.select(&fitness, 20_000, &mut rng).unwrap();
        for (k, share) in [0.75, 0.0, 0.0, 0.25, 0.0].into_iter().enumerate() {
            let count = chosen.iter().filter(|own| **own == k).count() as f64;
            assert!((count - 20_000.0 * share).abs() <= 300.0 * share, "{k}: {count}");
        }
    }

    #[test]
    fn equal_and_failed_individuals_are_equally_likely() {
        for fitness in [[2.0; 4], [1e60; 4], [f64::NAN; 4]] {
            assert_eq!(proportionate(&fitness), [1.0; 4]);
        }
        assert_eq!(proportionate(&[2.0, 1e60]), [1.0, 0.0]);
    }
}
