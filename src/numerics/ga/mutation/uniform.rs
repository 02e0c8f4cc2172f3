//! Each gene is replaced, with the probability F_Mut, by a value uniform over its range; one
//! number u decides both: the gene mutates when u < F_Mut, and u / F_Mut, again uniform in
//! 0..1, gives its value min + (max − min) u / F_Mut (never above max by rounding).
//!
//! Reference: [Rubio et al. 2006](gapilib_base::bibliography#rubio-2006), Table 2.

use super::{Child, Mutation};
use crate::bail;
use crate::diag::Fault;
use crate::ga::errors::BAD_MUTATION_FACTOR;
use crate::ga::{Gene, Genomes, Mrg32k3a};
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Mutation> = Entry {
    name: "uniform",
    aliases: &["random"],
    summary: "uniform mutation: a gene is replaced by a uniform random value of its range",
    reference: "rubio-2006",
    make: |_| Ok(Box::new(Uniform)),
};

struct Uniform;

impl Mutation for Uniform {
    fn mutate(&self, child: Child, rng: &mut Mrg32k3a) -> Result<(), Fault> {
        for (value, gene) in child.genome.iter_mut().zip(child.genes) {
            replace(value, gene, child.rate, rng.uniform());
        }
        Ok(())
    }
}

/// A value uniform over the range in place of this one, where u < `factor`.
fn replace(value: &mut f64, gene: &Gene, factor: f64, u: f64) {
    if u < factor {
        *value = (gene.min + (gene.max - gene.min) * u / factor).min(gene.max);
    }
}

/// The mutation factor, checked.
///
/// # Errors
///
/// `bad-mutation-factor` outside 0..1.
pub fn check_factor(factor: f64) -> Result<(), Fault> {
    if (0.0..=1.0).contains(&factor) {
        return Ok(());
    }
    bail!(
        BAD_MUTATION_FACTOR,
        "F_Mut is {factor}, but a probability must be between 0 and 1";
        help: "use a number from 0 to 1; the paper uses 0.25 and 0.15"
    )
}

/// Mutates the individuals after the first `elites`; `numbers` has one number for each gene of
/// each individual, elites included (theirs are not used).
pub fn mutate_uniform(
    genomes: &mut Genomes,
    elites: usize,
    genes: &[Gene],
    factor: f64,
    numbers: &[f64],
) {
    let n_genes = genomes.n_genes();
    for k in elites..genomes.len() {
        let drawn = &numbers[k * n_genes..(k + 1) * n_genes];
        for ((value, gene), &u) in genomes.row_mut(k).iter_mut().zip(genes).zip(drawn) {
            replace(value, gene, factor, u);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn genes() -> Vec<Gene> {
        vec![Gene::new("a", 0.0, 1.0).unwrap(), Gene::new("b", 10.0, 20.0).unwrap()]
    }

    #[test]
    fn one_number_decides_whether_and_what() {
        let mut genomes = Genomes::new(2, vec![7.0; 4]).unwrap();
        mutate_uniform(&mut genomes, 0, &genes(), 0.5, &[0.25, 0.25, 0.5, 0.75]);
        assert_eq!(genomes.values(), [0.5, 15.0, 7.0, 7.0]);
    }

    #[test]
    fn factor_zero_changes_nothing_and_factor_one_changes_all() {
        let mut genomes = Genomes::new(2, vec![7.0; 2]).unwrap();
        mutate_uniform(&mut genomes, 0, &genes(), 0.0, &[1e-9, 0.5]);
        assert_eq!(genomes.values(), [7.0, 7.0]);
        mutate_uniform(&mut genomes, 0, &genes(), 1.0, &[0.5, 0.9]);
        assert_eq!(genomes.values(), [0.5, 19.0]);
    }

    #[test]
    fn factors_that_are_no_probability_are_refused() {
        for factor in [-0.1, 1.1, f64::NAN] {
            assert_eq!(check_factor(factor).unwrap_err().code, BAD_MUTATION_FACTOR);
        }
        assert!(check_factor(0.0).is_ok() && check_factor(1.0).is_ok());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn elites_stay_and_bounds_hold(
            factor in 0.0..=1.0_f64,
            numbers in prop::collection::vec(1e-10..1.0_f64, 12),
            elites in 0_usize..=6,
        ) {
            let before = Genomes::new(2, [0.5, 15.0].repeat(6)).unwrap();
            let mut after = before.clone();
            mutate_uniform(&mut after, elites, &genes(), factor, &numbers);
            for k in 0..elites {
                prop_assert_eq!(after.row(k), before.row(k));
            }
            for row in after.rows() {
                prop_assert!((0.0..=1.0).contains(&row[0]) && (10.0..=20.0).contains(&row[1]));
            }
        }
    }
}
