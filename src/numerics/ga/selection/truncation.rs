//! The best individuals become parents, in the order of their fitness.
//!
//! Reference: [Rubio et al. 2006](gapilib_base::bibliography#rubio-2006), §3.2.

use super::Selection;
use crate::bail;
use crate::diag::Fault;
use crate::ga::errors::BAD_POPULATION;
use crate::ga::{Mrg32k3a, order};
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Selection> = Entry {
    name: "truncation",
    aliases: &["best"],
    summary: "the best individuals become parents, at most the fraction `share`; adjacent ranks mate",
    reference: "rubio-2006",
    make: |options| Ok(Box::new(Truncation { share: options.take("share", 0.0..=1.0, 0.7)? })),
};

struct Truncation {
    /// The paper's first case has 70 parents of 100 individuals.
    share: f64,
}

impl Selection for Truncation {
    fn select(&self, fitness: &[f64], count: usize, _: &mut Mrg32k3a) -> Result<Vec<usize>, Fault> {
        let best = ((self.share * fitness.len() as f64).ceil() as usize).clamp(1, count.max(1));
        // Where more parents are needed, the best mate again.
        Ok(order(fitness).into_iter().take(best).cycle().take(count).collect())
    }

    fn draws_all_at_once(&self) -> bool {
        true
    }
}

/// Whether `parents` children and `elites` fit into a population of `individuals`.
///
/// # Errors
///
/// `bad-population` when a number is negative, the population is empty, or they do not fit.
pub fn check_sizes(individuals: i64, parents: i64, elites: i64) -> Result<(), Fault> {
    for (name, value, least) in
        [("N_Population", individuals, 1), ("N_Parents", parents, 1), ("N_Elitism", elites, 0)]
    {
        if value < least {
            bail!(
                BAD_POPULATION,
                "{name} is {value}, but it must be at least {least}";
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
        let mut selected = |share: f64, count: usize| {
            Truncation { share }.select(&[3.0, 1.0, 5.0, 2.0, 4.0], count, &mut rng).unwrap()
        };
        assert_eq!(selected(1.0, 3), [1, 3, 0]);
        assert_eq!(selected(0.4, 5), [1, 3, 1, 3, 1]);
        assert_eq!(selected(0.0, 2), [1, 1]);
    }
}
