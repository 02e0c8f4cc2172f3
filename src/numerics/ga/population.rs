//! Populations: genomes row by row.

use super::Individual;
use super::errors::SIZE_MISMATCH;
use crate::bail;
use crate::diag::Fault;

/// The genomes of a population, one row each, in row-major order.
#[derive(Debug, Clone, PartialEq)]
pub struct Genomes {
    n_genes: usize,
    values: Vec<f64>,
}

impl Genomes {
    /// Takes `values` row by row.
    ///
    /// # Errors
    ///
    /// `population-size-mismatch` when the values do not fill rows of `n_genes` (which is at least 1).
    pub fn new(n_genes: usize, values: Vec<f64>) -> Result<Genomes, Fault> {
        if n_genes == 0 || !values.len().is_multiple_of(n_genes) {
            bail!(SIZE_MISMATCH, "{} values do not fill rows of {n_genes} genes", values.len());
        }
        Ok(Genomes { n_genes, values })
    }

    /// No individuals yet, room for `n_individuals`.
    pub fn with_capacity(n_genes: usize, n_individuals: usize) -> Genomes {
        Genomes { n_genes, values: Vec::with_capacity(n_genes * n_individuals) }
    }

    /// Number of genes of each individual.
    pub fn n_genes(&self) -> usize {
        self.n_genes
    }

    /// Number of individuals.
    pub fn len(&self) -> usize {
        self.values.len() / self.n_genes
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The genome of individual `k`, from 0.
    pub fn row(&self, k: usize) -> &[f64] {
        &self.values[k * self.n_genes..(k + 1) * self.n_genes]
    }

    /// The genome of individual `k`, from 0.
    pub fn row_mut(&mut self, k: usize) -> &mut [f64] {
        &mut self.values[k * self.n_genes..(k + 1) * self.n_genes]
    }

    /// All genomes in order.
    pub fn rows(&self) -> std::slice::ChunksExact<'_, f64> {
        self.values.chunks_exact(self.n_genes)
    }

    /// Adds an individual at the end.
    pub fn push(&mut self, genome: &[f64]) {
        debug_assert_eq!(genome.len(), self.n_genes);
        self.values.extend_from_slice(genome);
    }

    /// All values, row by row.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// All values, row by row.
    pub fn into_values(self) -> Vec<f64> {
        self.values
    }
}

/// The order of fitness: indices of the individuals, best (smallest) first. Equal fitness keeps
/// its order; what is not a number comes last.
pub fn order(fitness: &[f64]) -> Vec<usize> {
    let key = |k: usize| if fitness[k].is_nan() { f64::INFINITY } else { fitness[k] + 0.0 };
    let mut indices: Vec<usize> = (0..fitness.len()).collect();
    indices.sort_by(|&a, &b| key(a).total_cmp(&key(b)));
    indices
}

/// The population and its fitness, best first.
///
/// # Errors
///
/// `population-size-mismatch` when there is not one fitness for each individual.
pub fn sort_by_fitness(genomes: &Genomes, fitness: &[f64]) -> Result<(Genomes, Vec<f64>), Fault> {
    if genomes.len() != fitness.len() {
        bail!(
            SIZE_MISMATCH,
            "the population has {} individuals but there are {} fitness values",
            genomes.len(),
            fitness.len();
            help: "pass the fitness of this population, one value per row"
        );
    }
    let mut ordered = Genomes::with_capacity(genomes.n_genes(), genomes.len());
    let indices = order(fitness);
    indices.iter().for_each(|&k| ordered.push(genomes.row(k)));
    Ok((ordered, indices.iter().map(|&k| fitness[k]).collect()))
}

/// The best individual; of several equally good ones the first. `None` if there is none.
pub fn best(genomes: &Genomes, fitness: &[f64]) -> Option<Individual> {
    let k = *order(fitness).first()?;
    Some(Individual { genome: genomes.row(k).to_vec(), fitness: fitness[k] })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn ties_keep_their_order_and_nan_comes_last() {
        assert_eq!(order(&[2.0, f64::NAN, 1.0, 2.0, 1.0, 1e60]), [2, 4, 0, 3, 5, 1]);
        assert_eq!(order(&[0.0, -0.0, 0.0]), [0, 1, 2]);
    }

    #[test]
    fn sizes_must_agree() {
        let genomes = Genomes::new(2, vec![1.0, 2.0, 3.0, 4.0]).unwrap();
        assert_eq!(sort_by_fitness(&genomes, &[1.0]).unwrap_err().code, SIZE_MISMATCH);
        assert!(Genomes::new(3, vec![1.0]).is_err());
        assert!(Genomes::new(0, vec![]).is_err());
        assert_eq!(best(&genomes, &[5.0, 4.0]).unwrap().genome, [3.0, 4.0]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn sorting_keeps_every_individual(fitness in prop::collection::vec(0_u8..5, 1..40)) {
            let fitness: Vec<f64> = fitness.into_iter().map(f64::from).collect();
            let values = (0..fitness.len()).map(|k| k as f64).collect();
            let genomes = Genomes::new(1, values).unwrap();
            let (ordered, sorted) = sort_by_fitness(&genomes, &fitness).unwrap();
            for k in 0..sorted.len() {
                prop_assert_eq!(fitness[ordered.values()[k] as usize], sorted[k]);
            }
            for k in 1..sorted.len() {
                let earlier = ordered.values()[k - 1] < ordered.values()[k];
                prop_assert!(sorted[k - 1] < sorted[k] || (sorted[k - 1] == sorted[k] && earlier));
            }
        }
    }
}
