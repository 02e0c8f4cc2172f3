//! Linear ranking: the probability falls linearly with the rank, from `pressure`/n for the best of
//! n individuals to (2 − `pressure`)/n for the worst; how much better one is does not matter.
//!
//! Reference: [Baker 1985](gapilib_base::bibliography#baker-1985).

use super::{Selection, spun};
use crate::diag::Fault;
use crate::ga::{Mrg32k3a, order};
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Selection> = Entry {
    name: "linear_ranking",
    aliases: &["ranking"],
    summary: "linear ranking: the best is `pressure` times as likely as the average, decreasing \
              linearly with the rank",
    reference: "baker-1985",
    make: |options| {
        Ok(Box::new(LinearRanking { pressure: options.take("pressure", 1.0..=2.0, 1.5)? }))
    },
};

struct LinearRanking {
    pressure: f64,
}

impl Selection for LinearRanking {
    fn select(
        &self,
        fitness: &[f64],
        count: usize,
        rng: &mut Mrg32k3a,
    ) -> Result<Vec<usize>, Fault> {
        let last = fitness.len().saturating_sub(1).max(1) as f64;
        let weight = |rank: usize| self.pressure - 2.0 * (self.pressure - 1.0) * rank as f64 / last;
        let order = order(fitness);
        let weights: Vec<f64> = (0..order.len()).map(|rank| weight(rank).max(0.0)).collect();
        Ok(spun(&weights, count, rng).into_iter().map(|rank| order[rank]).collect())
    }

    fn draws_all_at_once(&self) -> bool {
        // Independent, but the order is the same for all of a generation.
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probabilities_fall_linearly_whatever_the_fitness_is() {
        let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
        let fitness = [1e9, 1.0, 1.1, f64::NAN, 7.0];
        let chosen = LinearRanking { pressure: 1.8 }.select(&fitness, 50_000, &mut rng).unwrap();
        for (rank, k) in [1, 2, 4, 0, 3].into_iter().enumerate() {
            let expected = 10_000.0 * (1.8 - 0.4 * rank as f64);
            let count = chosen.iter().filter(|own| **own == k).count() as f64;
            assert!((count - expected).abs() < 5.0 * expected.sqrt(), "{rank}: {count}");
        }
        assert_eq!(LinearRanking { pressure: 2.0 }.select(&[3.0], 2, &mut rng).unwrap(), [0, 0]);
    }
}
