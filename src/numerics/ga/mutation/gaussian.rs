//! Gaussian mutation: a gene moves by a normal number with the standard deviation `sigma` times
//! the width of its range. What would leave the range is reflected at its ends, so that the ends
//! are no more likely than what lies beside them.
//!
//! Reference: [Bäck & Schwefel 1993](gapilib_base::bibliography#back-schwefel-1993).

use super::{Child, Mutation};
use crate::diag::Fault;
use crate::ga::Mrg32k3a;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Mutation> = Entry {
    name: "gaussian",
    aliases: &["normal"],
    summary: "Gaussian mutation: adds a normal random number of `sigma` times the width of the \
              range",
    reference: "back-schwefel-1993",
    make: |options| Ok(Box::new(Gaussian { sigma: options.take("sigma", 1e-6..=1.0, 0.1)? })),
};

struct Gaussian {
    sigma: f64,
}

impl Mutation for Gaussian {
    fn mutate(&self, child: Child, rng: &mut Mrg32k3a) -> Result<(), Fault> {
        child.change(rng, |value, gene, rng| {
            gene.at(reflected(gene.fraction(value) + self.sigma * rng.normal()))
        });
        Ok(())
    }
}

/// A number reflected at 0 and at 1 until it lies between them.
fn reflected(u: f64) -> f64 {
    let folded = u.rem_euclid(2.0);
    if folded > 1.0 { 2.0 - folded } else { folded }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ga::Gene;
    use crate::ga::mutation::Course;

    const START: Course = Course { generation: 0, planned: None };

    #[test]
    fn what_leaves_the_range_is_reflected() {
        for (u, expected) in [(0.3, 0.3), (-0.25, 0.25), (1.25, 0.75), (2.5, 0.5), (-1.5, 0.5)] {
            assert_eq!(reflected(u), expected);
        }
    }

    #[test]
    fn changes_have_the_standard_deviation_that_was_asked_for() {
        let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
        let (n, genes) = (20_000, vec![Gene::new("g", -50.0, 50.0).unwrap(); 20_000]);
        let mut genome = vec![0.0; n];
        Gaussian { sigma: 0.05 }
            .mutate(
                Child { genome: &mut genome, genes: &genes, rate: 0.5, course: START },
                &mut rng,
            )
            .unwrap();
        let changed: Vec<f64> = genome.into_iter().filter(|value| *value != 0.0).collect();
        assert!((changed.len() as f64 - 10_000.0).abs() < 350.0, "{}", changed.len());
        let count = changed.len() as f64;
        let mean = changed.iter().sum::<f64>() / count;
        let variance = changed.iter().map(|value| value * value).sum::<f64>() / count;
        assert!(mean.abs() < 0.2 && (variance.sqrt() - 5.0).abs() < 0.15, "{mean} {variance}");
        let within = changed.iter().filter(|value| value.abs() < 5.0).count() as f64 / count;
        assert!((within - 0.6827).abs() < 0.02, "one standard deviation: {within}");
    }
}
