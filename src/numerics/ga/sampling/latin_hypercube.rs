//! Latin hypercube: each gene has one value in each of `count` equal slices of its range, in
//! random order.
//!
//! Reference: [McKay et al. 1979](gapilib_base::bibliography#mckay-1979).

use super::{Sampling, scaled};
use crate::diag::Fault;
use crate::ga::{Gene, Genomes, Mrg32k3a};
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Sampling> = Entry {
    name: "latin_hypercube",
    aliases: &["lhs"],
    summary: "Latin hypercube: one value per slice of each range",
    reference: "mckay-1979",
    make: |_| Ok(Box::new(LatinHypercube)),
};

struct LatinHypercube;

impl Sampling for LatinHypercube {
    fn sample(&self, genes: &[Gene], count: usize, rng: &mut Mrg32k3a) -> Result<Genomes, Fault> {
        Ok(scaled(latin_hypercube(genes.len(), count, rng), genes))
    }
}

/// `count` individuals in the unit cube; `n_genes` is at least 1.
pub fn latin_hypercube(n_genes: usize, count: usize, rng: &mut Mrg32k3a) -> Genomes {
    let mut columns: Vec<Vec<f64>> = Vec::with_capacity(n_genes);
    for _ in 0..n_genes {
        let mut column: Vec<f64> =
            (0..count).map(|slice| (slice as f64 + rng.uniform()) / count as f64).collect();
        for last in (1..count).rev() {
            let other = (rng.uniform() * (last + 1) as f64) as usize;
            column.swap(last, other.min(last));
        }
        columns.push(column);
    }
    let mut genomes = Genomes::with_capacity(n_genes, count);
    let mut genome = vec![0.0; n_genes];
    for k in 0..count {
        for (value, column) in genome.iter_mut().zip(&columns) {
            *value = column[k].min(1.0);
        }
        genomes.push(&genome);
    }
    genomes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_slice_holds_one_value() {
        let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
        let genomes = latin_hypercube(3, 20, &mut rng);
        for gene in 0..3 {
            let mut slices: Vec<usize> =
                genomes.rows().map(|genome| (genome[gene] * 20.0) as usize).collect();
            slices.sort_unstable();
            assert_eq!(slices, (0..20).collect::<Vec<_>>());
        }
        assert!(latin_hypercube(2, 0, &mut rng).is_empty());
    }
}
