//! Elitism: the best individuals pass on unaltered.
//!
//! In the paper's generation the elites precede the offspring ([`elites_first`]). As a way of
//! survival, the elites of the old generation and the offspring are ordered by their fitness; an
//! elite that a child has met bit by bit counts once. Without limit to the elites (as many as the
//! population, or more) all parents compete with as many offspring.
//!
//! Reference: [Rubio et al. 2006](gapilib_base::bibliography#rubio-2006), §2.

use super::{Brood, Sizes, Survival, Survivor};
use crate::diag::Fault;
use crate::ga::{Genomes, order};
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Survival> = Entry {
    name: "elitism",
    aliases: &["elites"],
    summary: "the best `elites` of the method survive, offspring replace the others",
    reference: "rubio-2006",
    make: |_| Ok(Box::new(Elitism)),
};

struct Elitism;

impl Survival for Elitism {
    fn n_offspring(&self, Sizes { population, elites }: Sizes) -> usize {
        // Where all parents compete with them, there are as many offspring.
        if elites < population { population - elites } else { population }
    }

    fn survivors(&self, brood: &Brood<'_>, sizes: Sizes) -> Result<Vec<Survivor>, Fault> {
        let elites = order(brood.old.fitness).into_iter().take(sizes.elites).map(Survivor::Old);
        Ok(brood.best(elites.chain(brood.offspring()).collect(), sizes.population))
    }

    fn has_elites(&self) -> bool {
        true
    }
}

/// The first `elites` individuals of `ordered`, then all of `offspring`.
pub fn elites_first(ordered: &Genomes, elites: usize, offspring: &Genomes) -> Genomes {
    let mut next = Genomes::with_capacity(ordered.n_genes(), elites + offspring.len());
    ordered.rows().take(elites).for_each(|genome| next.push(genome));
    offspring.rows().for_each(|genome| next.push(genome));
    next
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elites_stand_first_unaltered() {
        let old = Genomes::new(1, vec![1.0, 2.0, 3.0]).unwrap();
        let offspring = Genomes::new(1, vec![8.0, 9.0]).unwrap();
        assert_eq!(elites_first(&old, 1, &offspring).values(), [1.0, 8.0, 9.0]);
        assert_eq!(elites_first(&old, 0, &offspring).values(), [8.0, 9.0]);
    }
}
