//! Non-uniform mutation: a gene moves towards one end of its range, drawn at random, by the part
//! 1 − r^((1 − t/T)ᵇ) of the way, r uniform in 0..1. At the start (t = 0) the whole range is within
//! reach, at the end (t = T) nothing moves any more; the larger the exponent b, the sooner.
//!
//! T is `generations`, or with 0 what the run is planned to have: the evaluations of its stop
//! condition over the population, else 100.
//!
//! Reference: [Michalewicz 1996](gapilib_base::bibliography#michalewicz-1996), §6.2.

use super::{Child, Mutation};
use crate::diag::Fault;
use crate::elementary;
use crate::ga::Mrg32k3a;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Mutation> = Entry {
    name: "non_uniform",
    aliases: &["michalewicz", "nonuniform"],
    summary: "non-uniform mutation: a step towards an end of the range that decreases over \
              `generations`",
    reference: "michalewicz-1996",
    make: |options| {
        Ok(Box::new(NonUniform {
            exponent: options.take("exponent", 0.0..=100.0, 5.0)?,
            generations: options.take_whole("generations", 0.0..=1e9, 0.0)?,
        }))
    },
};

struct NonUniform {
    exponent: f64,
    generations: usize,
}

impl Mutation for NonUniform {
    fn mutate(&self, child: Child, rng: &mut Mrg32k3a) -> Result<(), Fault> {
        let over = match self.generations {
            0 => child.course.fraction(),
            generations => child.course.of(generations as f64),
        };
        let power = elementary::powf(1.0 - over, self.exponent);
        child.change(rng, |value, gene, rng| {
            let (upwards, r) = (rng.uniform() < 0.5, rng.uniform());
            let part = 1.0 - elementary::powf(r, power);
            let u = gene.fraction(value);
            match upwards {
                // A part of 0 leaves the gene as it is, bit for bit.
                _ if part == 0.0 => value,
                true => gene.at((u + part * (1.0 - u)).min(1.0)),
                false => gene.at((u - part * u).max(0.0)),
            }
        });
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ga::Gene;
    use crate::ga::mutation::Course;

    fn mutated(operator: &NonUniform, generation: u64, planned: Option<f64>) -> Vec<f64> {
        let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
        let genes = vec![Gene::new("g", -1.0, 3.0).unwrap(); 4000];
        let mut genome = vec![1.0; 4000];
        let course = Course { generation, planned };
        operator
            .mutate(Child { genome: &mut genome, genes: &genes, rate: 1.0, course }, &mut rng)
            .unwrap();
        genome
    }

    fn mean_change(genome: &[f64]) -> f64 {
        genome.iter().map(|value| (value - 1.0).abs()).sum::<f64>() / genome.len() as f64
    }

    /// With the power p = (1 − t/T)ᵇ the mean of 1 − rᵖ is p/(1 + p), of a way that is 2 long here.
    #[test]
    fn changes_shrink_as_published_and_end() {
        let operator = NonUniform { exponent: 2.0, generations: 0 };
        for over in [0.0_f64, 0.3, 0.8] {
            let power = (1.0 - over).powi(2);
            let found = mean_change(&mutated(&operator, (over * 1000.0) as u64, Some(1000.0)));
            let expected = 2.0 * power / (1.0 + power);
            assert!((found - expected).abs() < 0.05 * expected, "{over}: {found} for {expected}");
        }
        assert_eq!(mutated(&operator, 1000, Some(1000.0)), vec![1.0; 4000]);
        assert_eq!(mutated(&operator, 100, None), vec![1.0; 4000], "100 unless something is known");
        let planned = NonUniform { exponent: 2.0, generations: 40 };
        assert_eq!(mutated(&planned, 41, Some(1000.0)), vec![1.0; 4000]);
    }
}
