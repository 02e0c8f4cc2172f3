//! The best individuals become parents, in the order of their fitness.
//!
//! Reference: [Rubio et al. 2006](crate::bibliography#rubio-2006), §3.2.

use super::Selection;
use crate::bail;
use crate::diag::Fault;
use crate::ga::Mrg32k3a;
use crate::ga::errors::BAD_POPULATION;
use crate::registry::Entry;

/// The table entry.
pub(super) const ENTRY: Entry<dyn Selection> = Entry {
    name: "truncation",
    aliases: &["best"],
    summary: "the best individuals become parents, adjacent ranks mate",
    reference: "rubio-2006",
    make: |_| Ok(Box::new(Truncation)),
};

struct Truncation;

impl Selection for Truncation {
    fn select(&self, n_individuals: usize, n_parents: usize, _: &mut Mrg32k3a) -> Vec<usize> {
        (0..n_parents.min(n_individuals)).collect()
    }
}

/// Whether `parents` children and `elites` fit into a population of `individuals`.
///
/// # Errors
///
/// `bad-population` when a number is negative, nobody is there, or they do not fit.
pub fn check_sizes(individuals: i64, parents: i64, elites: i64) -> Result<(), Fault> {
    for (name, value, least) in
        [("N_Population", individuals, 1), ("N_Parents", parents, 1), ("N_Elitism", elites, 0)]
    {
        if value < least {
            bail!(
                BAD_POPULATION,
                "{name} is {value}, it must be at least {least}";
                help: "the paper uses 100 individuals, 70 parents and 1 elite"
            );
        }
    }
    if parents.saturating_add(elites) > individuals {
        bail!(
            BAD_POPULATION,
            "N_Parents + N_Elitism = {parents} + {elites} is more than N_Population = {individuals}";
            help: "lower N_Parents to {} or raise N_Population", (individuals - elites).max(1)
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_of_the_three_case_studies_fit() {
        for (individuals, parents, elites) in [(100, 70, 1), (150, 100, 1), (70, 50, 1), (5, 4, 1)]
        {
            assert_eq!(check_sizes(individuals, parents, elites), Ok(()));
        }
    }

    #[test]
    fn sizes_that_do_not_fit_are_refused() {
        for (individuals, parents, elites) in
            [(100, 100, 1), (0, 1, 0), (10, 0, 1), (10, 5, -1), (10, i64::MAX, 1)]
        {
            assert_eq!(check_sizes(individuals, parents, elites).unwrap_err().code, BAD_POPULATION);
        }
    }

    #[test]
    fn the_best_are_selected() {
        let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
        assert_eq!(Truncation.select(5, 3, &mut rng), [0, 1, 2]);
    }
}
