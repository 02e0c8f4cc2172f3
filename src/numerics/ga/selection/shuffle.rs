//! No selection: everyone becomes a parent as often as the others, in random order. For ways of
//! survival that select by themselves, as crowding does.
//!
//! Reference: [Mahfoud 1995](gapilib_base::bibliography#mahfoud-1995).

use super::{Selection, shuffled};
use crate::diag::Fault;
use crate::ga::Mrg32k3a;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Selection> = Entry {
    name: "shuffle",
    aliases: &["random"],
    summary: "every individual becomes a parent, in random order",
    reference: "mahfoud-1995",
    make: |_| Ok(Box::new(Shuffle)),
};

struct Shuffle;

impl Selection for Shuffle {
    fn select(
        &self,
        fitness: &[f64],
        count: usize,
        rng: &mut Mrg32k3a,
    ) -> Result<Vec<usize>, Fault> {
        let mut chosen = Vec::with_capacity(count);
        while chosen.len() < count {
            chosen.extend(shuffled((0..fitness.len()).collect(), rng));
        }
        chosen.truncate(count);
        Ok(chosen)
    }

    fn draws_all_at_once(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everyone_becomes_a_parent_once() {
        let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
        let mut chosen = Shuffle.select(&[1.0; 20], 20, &mut rng).unwrap();
        assert_ne!(chosen, (0..20).collect::<Vec<_>>());
        chosen.sort_unstable();
        assert_eq!(chosen, (0..20).collect::<Vec<_>>());
        assert_eq!(Shuffle.select(&[1.0; 3], 7, &mut rng).unwrap().len(), 7);
    }
}
