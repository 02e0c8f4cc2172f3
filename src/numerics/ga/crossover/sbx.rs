//! Simulated binary crossover: children lie about their parents as the children of bit strings
//! would; a large `eta` keeps them close. The spread is limited so that children stay in the range.
//! Each gene is crossed with the probability 1/2.
//!
//! Reference: [Deb & Agrawal 1995](gapilib_base::bibliography#deb-agrawal-1995), §3.

use super::{Crossover, Parents};
use crate::diag::Fault;
use crate::elementary;
use crate::ga::Mrg32k3a;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Crossover> = Entry {
    name: "sbx",
    aliases: &["simulated_binary"],
    summary: "simulated binary crossover: genes near those of the parents, closer for larger `eta`",
    reference: "deb-agrawal-1995",
    make: |options| Ok(Box::new(Sbx { eta: options.take("eta", 0.0..=1000.0, 15.0)? })),
};

/// Parents closer than this fraction of the range have children like themselves: their distance
/// divides.
const SAME: f64 = 1e-14;

struct Sbx {
    eta: f64,
}

impl Crossover for Sbx {
    fn cross(&self, parents: Parents, rng: &mut Mrg32k3a) -> Result<(), Fault> {
        let Parents { first, second, genes } = parents;
        for ((a, b), gene) in first.iter_mut().zip(second).zip(genes) {
            let fractions = [gene.fraction(*a), gene.fraction(*b)];
            if rng.uniform() > 0.5 || (fractions[0] - fractions[1]).abs() < SAME {
                continue;
            }
            let [lower, upper] = children(fractions, self.eta, rng).map(|u| gene.at(u));
            (*a, *b) = if rng.uniform() < 0.5 { (lower, upper) } else { (upper, lower) };
        }
        Ok(())
    }
}

/// Two children of a gene in 0..1, the smaller first.
fn children([a, b]: [f64; 2], eta: f64, rng: &mut Mrg32k3a) -> [f64; 2] {
    let (low, high) = (a.min(b), a.max(b));
    let (u, distance) = (rng.uniform(), high - low);
    let spread = |room: f64| {
        let alpha = 2.0 - elementary::powf(1.0 + 2.0 * room / distance, -(eta + 1.0));
        let base = if u <= 1.0 / alpha { u * alpha } else { 1.0 / (2.0 - u * alpha) };
        elementary::powf(base, 1.0 / (eta + 1.0))
    };
    let lower = 0.5 * (low + high - spread(low) * distance);
    let upper = 0.5 * (low + high + spread(1.0 - high) * distance);
    [lower.clamp(0.0, 1.0), upper.clamp(0.0, 1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ga::Gene;
    use proptest::prelude::*;

    fn genes(n: usize, min: f64, max: f64) -> Vec<Gene> {
        vec![Gene::new("g", min, max).unwrap(); n]
    }

    fn rng() -> Mrg32k3a {
        Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn equal_parents_have_children_like_themselves(
            a in prop::collection::vec(-3.0..=7.0_f64, 1..8),
            eta in 0.0..50.0_f64,
        ) {
            let (mut first, mut second) = (a.clone(), a.clone());
            let genes = genes(a.len(), -3.0, 7.0);
            Sbx { eta }.cross(Parents { first: &mut first, second: &mut second, genes: &genes }, &mut rng()).unwrap();
            prop_assert_eq!(&first, &second);
            prop_assert_eq!(&first, &a);
        }
    }

    /// In the middle of the range, where the limits do not matter, the mean of the children is the
    /// mean of the parents.
    #[test]
    fn children_keep_the_mean_of_their_parents() {
        let (mut first, mut second) = (vec![4.9; 100], vec![5.1; 100]);
        Sbx { eta: 15.0 }
            .cross(
                Parents { first: &mut first, second: &mut second, genes: &genes(100, 0.0, 10.0) },
                &mut rng(),
            )
            .unwrap();
        for (a, b) in first.iter().zip(&second) {
            assert!((a + b - 10.0).abs() < 1e-9, "{a} {b}");
        }
        assert!(first.iter().any(|v| *v != 4.9));
    }

    /// The spread β = |c₂ − c₁|/|p₂ − p₁| has the distribution function β^(η + 1)/2 below 1 and
    /// 1 − β^−(η + 1)/2 above (Kolmogorov-Smirnov at 0.1 %).
    #[test]
    fn the_spread_has_the_distribution_of_the_paper() {
        for eta in [2.0, 15.0] {
            let (n, mut rng, mut spreads) = (4000, rng(), Vec::new());
            while spreads.len() < n {
                let (mut a, mut b) = ([0.4995], [0.5005]);
                Sbx { eta }
                    .cross(
                        Parents { first: &mut a, second: &mut b, genes: &genes(1, 0.0, 1.0) },
                        &mut rng,
                    )
                    .unwrap();
                if (a[0], b[0]) != (0.4995, 0.5005) {
                    spreads.push((a[0] - b[0]).abs() / 0.001);
                }
            }
            spreads.sort_by(f64::total_cmp);
            let distribution = |beta: f64| match beta {
                beta if beta <= 1.0 => 0.5 * beta.powf(eta + 1.0),
                beta => 1.0 - 0.5 * beta.powf(-(eta + 1.0)),
            };
            let gap = |(k, beta): (usize, &f64)| {
                ((k as f64 + 0.5) / n as f64 - distribution(*beta)).abs()
            };
            let largest = spreads.iter().enumerate().map(gap).fold(0.0, f64::max);
            assert!(largest < 1.95 / (n as f64).sqrt(), "eta {eta}: {largest}");
        }
    }
}
