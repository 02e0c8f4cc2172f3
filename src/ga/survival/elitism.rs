//! The best individuals pass on unaltered and stand before the offspring.
//!
//! Reference: [Rubio et al. 2006](crate::bibliography#rubio-2006), §2.

use super::Survival;
use crate::ga::Genomes;
use crate::registry::Entry;

/// The table entry.
pub(super) const ENTRY: Entry<dyn Survival> = Entry {
    name: "elitism",
    aliases: &["elites"],
    summary: "the best individuals pass on unaltered",
    reference: "rubio-2006",
    make: |_| Ok(Box::new(Elitism)),
};

struct Elitism;

impl Survival for Elitism {
    fn survive(&self, ordered: &Genomes, elites: usize, offspring: &Genomes) -> Genomes {
        elites_first(ordered, elites, offspring)
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
