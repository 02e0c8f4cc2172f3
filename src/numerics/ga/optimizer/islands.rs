//! The island model of genetic algorithms: several populations evolve apart, and from time to time the
//! best individual of each moves to the next one in a ring.
//!
//! All islands ask at once, so that a question is as large as all of them together: that gives many
//! processors work where one population is too small for them. Each island has random numbers of its
//! own, and migration is at fixed generations, so that the result depends on the number of islands, not
//! on what evaluates them.
//!
//! Reference: [Tanese 1989](gapilib_base::bibliography#tanese-1989).

use super::{Answers, Optimizer};
use crate::diag::Fault;
use crate::ga::Genomes;

/// A population that takes immigrants.
pub(super) trait Island: Optimizer {
    /// Its best individual that has been evaluated.
    fn best(&self) -> Option<Vec<f64>>;
    /// Takes an individual into the next generation, in place of the one that was bred last.
    fn immigrate(&mut self, genome: &[f64]);
}

/// Several islands as one search.
pub(super) struct Islands {
    islands: Vec<Box<dyn Island>>,
    /// Individuals that each has asked.
    sizes: Vec<usize>,
    /// Generations between two migrations.
    interval: u64,
    generation: u64,
}

impl Islands {
    pub(crate) fn new(islands: Vec<Box<dyn Island>>, interval: u64) -> Islands {
        Islands { islands, sizes: Vec::new(), interval, generation: 0 }
    }

    /// The best of each island moves to the next one; the first follows the last.
    fn migrate(&mut self) {
        let emigrants: Vec<Option<Vec<f64>>> =
            self.islands.iter().map(|island| island.best()).collect();
        let count = self.islands.len();
        for (place, emigrant) in emigrants.into_iter().enumerate() {
            if let Some(genome) = emigrant {
                self.islands[(place + 1) % count].immigrate(&genome);
            }
        }
    }
}

impl Optimizer for Islands {
    fn ask(&mut self, batch: &mut Genomes) {
        self.sizes.clear();
        for island in &mut self.islands {
            let mut own = Genomes::with_capacity(batch.n_genes(), 0);
            island.ask(&mut own);
            own.rows().for_each(|genome| batch.push(genome));
            self.sizes.push(own.len());
        }
    }

    fn tell(&mut self, batch: &Genomes, answers: &Answers<'_>) {
        let mut first = 0;
        for (island, size) in self.islands.iter_mut().zip(&self.sizes) {
            let end = first + size;
            let mut own = Genomes::with_capacity(batch.n_genes(), *size);
            (first..end).for_each(|k| own.push(batch.row(k)));
            if !own.is_empty() {
                island.tell(&own, &answers.part(first, end, batch.len()));
            }
            first = end;
        }
        self.generation += 1;
        if self.generation.is_multiple_of(self.interval) {
            self.migrate();
        }
    }

    fn phase(&self) -> &'static str {
        "search"
    }

    fn fault(&self) -> Option<&Fault> {
        self.islands.iter().find_map(|island| island.fault())
    }

    fn change(&mut self, setting: &str, value: f64) -> Result<(), Fault> {
        self.islands.iter_mut().try_for_each(|island| island.change(setting, value))
    }

    fn rescale(&mut self, gene: usize, offset: f64, scale: f64) {
        self.islands.iter_mut().for_each(|island| island.rescale(gene, offset, scale));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Asks its own number, and remembers who came.
    struct Lone {
        number: f64,
        came: Vec<f64>,
    }

    impl Optimizer for Lone {
        fn ask(&mut self, batch: &mut Genomes) {
            // The islands are of different sizes.
            (0..=self.number as usize).for_each(|_| batch.push(&[self.number]));
        }
        fn tell(&mut self, batch: &Genomes, answers: &Answers<'_>) {
            assert!(batch.rows().all(|genome| genome == [self.number]));
            assert!((0..batch.len()).all(|k| answers.fitness(k) == 10.0 * self.number));
        }
        fn phase(&self) -> &'static str {
            "search"
        }
        /// Compares the number of those that came.
        fn change(&mut self, _setting: &str, value: f64) -> Result<(), Fault> {
            assert_eq!(self.came.len() as f64, value);
            Ok(())
        }
    }

    impl Island for Lone {
        fn best(&self) -> Option<Vec<f64>> {
            Some(vec![self.number])
        }
        fn immigrate(&mut self, genome: &[f64]) {
            // From the one before in the ring of three.
            assert_eq!(genome, [(self.number + 2.0) % 3.0]);
            self.came.push(genome[0]);
        }
    }

    #[test]
    fn islands_get_their_own_answers_and_exchange_the_best_in_a_ring() {
        let island = |k: u8| Box::new(Lone { number: f64::from(k), came: Vec::new() }) as Box<_>;
        let mut all = Islands::new((0..3).map(island).collect(), 4);
        for generation in 1..=9 {
            let mut batch = Genomes::with_capacity(1, 0);
            all.ask(&mut batch);
            assert_eq!(batch.values(), [0.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
            let objectives: Vec<f64> = batch.values().iter().map(|number| 10.0 * number).collect();
            let answers = Answers {
                objectives: &objectives,
                n_objectives: 1,
                residuals: &[],
                jacobians: &[],
            };
            all.tell(&batch, &answers);
            all.change("count", f64::from(generation / 4)).unwrap();
        }
    }
}
