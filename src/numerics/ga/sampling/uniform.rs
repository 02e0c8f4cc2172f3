//! Every gene uniform over its range, independent of the others.
//!
//! Reference: [Rubio et al. 2006](gapilib_base::bibliography#rubio-2006), §3.1.

use super::Sampling;
use crate::diag::Fault;
use crate::ga::{Gene, Genomes, Mrg32k3a};
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Sampling> = Entry {
    name: "uniform",
    aliases: &["random"],
    summary: "each gene uniform over its range",
    reference: "rubio-2006",
    make: |_| Ok(Box::new(Uniform)),
};

struct Uniform;

impl Sampling for Uniform {
    fn sample(&self, genes: &[Gene], count: usize, rng: &mut Mrg32k3a) -> Result<Genomes, Fault> {
        Ok(sample_uniform(genes, count, rng))
    }
}

/// `count` individuals: gene j is minⱼ + (maxⱼ − minⱼ) u, numbers drawn individual by individual.
pub(crate) fn sample_uniform(genes: &[Gene], count: usize, rng: &mut Mrg32k3a) -> Genomes {
    let mut genomes = Genomes::with_capacity(genes.len(), count);
    let mut genome = vec![0.0; genes.len()];
    for _ in 0..count {
        for (value, gene) in genome.iter_mut().zip(genes) {
            *value = gene.at(rng.uniform());
        }
        genomes.push(&genome);
    }
    genomes
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn uses_the_numbers_row_by_row() {
        let genes = [Gene::new("a", 0.0, 1.0).unwrap(), Gene::new("b", 10.0, 20.0).unwrap()];
        let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
        let genomes = sample_uniform(&genes, 2, &mut rng);
        let expected = [0.12701112204657714, 13.185275653967945, 0.3091860155832701];
        for (value, expected) in genomes.values().iter().zip(expected) {
            assert!((value - expected).abs() < 1e-14);
        }
        assert_eq!(genomes.len(), 2);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        #[test]
        fn stays_within_the_ranges(low in -1e6..1e6_f64, width in 0.0..1e6_f64, count in 1..50_usize) {
            let gene = Gene::new("a", low, low + width).unwrap();
            let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
            let genomes = sample_uniform(std::slice::from_ref(&gene), count, &mut rng);
            prop_assert!(genomes.values().iter().all(|v| (gene.min..=gene.max).contains(v)));
        }
    }
}
