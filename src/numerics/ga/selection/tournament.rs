//! Tournament: of `size` individuals drawn at random, with replacement, the best becomes a parent.
//!
//! The k-th best of n wins with the probability ((n − k + 1)ˢ − (n − k)ˢ)/nˢ, k from 1.
//!
//! Reference: [Goldberg & Deb 1991](gapilib_base::bibliography#goldberg-deb-1991).

use super::Selection;
use crate::diag::Fault;
use crate::ga::Mrg32k3a;
use crate::registry::Entry;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Selection> = Entry {
    name: "tournament",
    aliases: &["binary_tournament"],
    summary: "the best of `size` random individuals becomes a parent",
    reference: "goldberg-deb-1991",
    make: |options| {
        Ok(Box::new(Tournament { size: options.take_whole("size", 1.0..=1000.0, 2.0)? }))
    },
};

struct Tournament {
    size: usize,
}

impl Selection for Tournament {
    fn select(
        &self,
        fitness: &[f64],
        count: usize,
        rng: &mut Mrg32k3a,
    ) -> Result<Vec<usize>, Fault> {
        let key = |k: usize| if fitness[k].is_nan() { f64::INFINITY } else { fitness[k] };
        let parent = |_| tournament(fitness.len(), self.size, rng, |a, b| key(a) <= key(b));
        Ok((0..count).map(parent).collect())
    }
}

/// The winner among `size` of `count` individuals (both at least 1); `better(a, b)` says whether a
/// wins over b, which was drawn later.
pub fn tournament(
    count: usize,
    size: usize,
    rng: &mut Mrg32k3a,
    better: impl Fn(usize, usize) -> bool,
) -> usize {
    let mut draw = || ((rng.uniform() * count as f64) as usize).min(count - 1);
    let first = draw();
    (1..size).fold(first, |winner, _| {
        let other = draw();
        if better(winner, other) { winner } else { other }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_win_as_often_as_they_should() {
        let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
        for size in [1, 2, 3, 7] {
            let fitness = [3.0, 1.0, f64::NAN, 2.0];
            let chosen = Tournament { size }.select(&fitness, 16_000, &mut rng).unwrap();
            for (rank, k) in [1, 3, 0, 2].into_iter().enumerate() {
                let wins = chosen.iter().filter(|own| **own == k).count() as f64;
                let share = |not_better: usize| (not_better as f64 / 4.0).powi(size as i32);
                let expected = 16_000.0 * (share(4 - rank) - share(3 - rank));
                assert!(
                    (wins - expected).abs() < 5.0 * expected.sqrt() + 1.0,
                    "{size} {rank}: {wins}"
                );
            }
        }
    }
}
