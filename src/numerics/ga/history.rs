//! The course of a run: one record for each generation.

use super::individual::has_failed;

/// What is remembered of one generation. Mean and worst are taken over the individuals whose
/// simulation succeeded; all three are NaN when none did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Generation {
    /// Smallest fitness.
    pub best: f64,
    /// Mean fitness.
    pub mean: f64,
    /// Largest fitness.
    pub worst: f64,
    /// Number of individuals whose simulation failed.
    pub failures: usize,
}

impl Generation {
    /// Summarises the fitness of all individuals.
    pub fn of(fitness: &[f64]) -> Generation {
        let succeeded = || fitness.iter().copied().filter(|&fitness| !has_failed(fitness));
        let count = succeeded().count();
        Generation {
            best: succeeded().min_by(f64::total_cmp).unwrap_or(f64::NAN),
            mean: if count == 0 { f64::NAN } else { succeeded().sum::<f64>() / count as f64 },
            worst: succeeded().max_by(f64::total_cmp).unwrap_or(f64::NAN),
            failures: fitness.len() - count,
        }
    }
}

/// The generations of a run, in order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct History {
    /// One record for each generation evaluated.
    pub generations: Vec<Generation>,
}

impl History {
    /// Adds the fitness of the next generation.
    pub fn record(&mut self, fitness: &[f64]) {
        self.generations.push(Generation::of(fitness));
    }

    /// Number of failed simulations over all generations.
    pub fn failures(&self) -> usize {
        self.generations.iter().map(|generation| generation.failures).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failures_count_but_do_not_spoil_the_mean() {
        let mut history = History::default();
        history.record(&[3.0, 1e60, 1.0, f64::NAN]);
        let expected = Generation { best: 1.0, mean: 2.0, worst: 3.0, failures: 2 };
        assert_eq!(history.generations, [expected]);
        history.record(&[1e60]);
        assert!(history.generations[1].mean.is_nan());
        assert_eq!(history.failures(), 3);
    }
}
