//! Which generations of a long run a page steps through: a page with all of them would be one that no
//! browser opens and no mail takes.

use super::generation::Generation;
use super::operation::{Action, Operation};
use super::step::steps;
use std::collections::BTreeSet;

/// Of the bytes of a page, at most this part is for the improvements, in tenths; the rest is for the
/// first generations.
const IMPROVEMENTS: usize = 9;
/// Bytes of one gene: before and after crossover and mutation, and its random number.
const PER_GENE: usize = 36;
/// No table of a page has more rows than this.
pub(crate) const MOST_ROWS: usize = 100;
/// Bytes of one row of the table of an operator's call, and of one number of it.
const PER_ROW: usize = 60;
const PER_NUMBER: usize = 16;
/// Bytes of one step: its sentence.
const PER_STEP: usize = 260;

/// The generations that a page has.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Kept {
    /// Their numbers, from 0, in order.
    pub numbers: Vec<usize>,
    /// How many of the first ones are there without a gap.
    pub first: usize,
    /// How many of those are there in which the best has improved.
    pub improvements: usize,
    /// How many there are in the run.
    pub(crate) all_improvements: usize,
}

/// The generations to keep within about `most` bytes: the first and the last, those in which the best
/// improves, the largest gain first, together with the ones that brought them about, and as many of
/// the first ones as fit; all of them where they fit.
pub(crate) fn kept(generations: &[Generation], most: usize) -> Kept {
    let costs: Vec<usize> = (0..generations.len()).map(|at| cost(generations, at)).collect();
    let improvements = improvements(generations);
    let last = generations.len().saturating_sub(1);
    let mut chosen: BTreeSet<usize> = generations.iter().enumerate().map(|(at, _)| at).collect();
    if costs.iter().sum::<usize>() > most {
        chosen = BTreeSet::from([0, last]);
        let mut spent = costs[0] + costs[last];
        let mut keep = |numbers: &[usize], most: usize| {
            let new = numbers.iter().filter(|at| !chosen.contains(at));
            let more: usize = new.map(|at| costs[*at]).sum();
            let fits = spent + more <= most;
            if fits {
                spent += more;
                chosen.extend(numbers);
            }
            fits
        };
        let mut pairs = improvements.iter().map(|at| [at - 1, *at]);
        // While there is room: what is kept is the largest gains without a gap.
        let _ = pairs.all(|pair| keep(&pair, most / 10 * IMPROVEMENTS));
        let _ = (1..last).all(|at| keep(&[at], most));
    }
    Kept {
        first: (0..=last).take_while(|at| chosen.contains(at)).count(),
        improvements: improvements.iter().filter(|at| chosen.contains(at)).count(),
        all_improvements: improvements.len(),
        numbers: chosen.into_iter().collect(),
    }
}

fn cost(generations: &[Generation], at: usize) -> usize {
    let steps = steps(&generations[at], generations.get(at + 1)).len();
    let operation: usize =
        generations[at].operations.iter().map(|called| rows(&called.operation)).sum();
    PER_GENE * generations[at].genes.len() + PER_STEP * steps + operation
}

/// Bytes of the rows of an operator's call: their names and notes, and the numbers.
fn rows(operation: &Operation) -> usize {
    let count = match &operation.action {
        Action::Sampling { sampled, .. } => operation.count(sampled).min(MOST_ROWS),
        Action::Selection { fitness, .. } => fitness.len().min(MOST_ROWS),
        Action::Crossover { parents, .. } => 2 * operation.count(parents),
        Action::Mutation { before, .. } => 2 * operation.count(before),
        Action::Survival { fitness, fitness_offspring, .. } => {
            (fitness.len() + fitness_offspring.len()).min(MOST_ROWS)
        }
    };
    count * (PER_ROW + PER_NUMBER * (1 + operation.n_genes as usize))
}

/// The generations after the first whose best is better than all before, the largest gain first.
fn improvements(generations: &[Generation]) -> Vec<usize> {
    let mut best = f64::INFINITY;
    let mut found = Vec::new();
    for (at, generation) in generations.iter().enumerate() {
        let Some((_, fitness)) = generation.best().filter(|(_, fitness)| *fitness < best) else {
            continue;
        };
        if at > 0 {
            found.push((fitness / best, at));
        }
        best = fitness;
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    found.into_iter().map(|(_, at)| at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::teach::Origin;

    /// So many generations of 100 individuals; the best improves at each multiple of 300.
    fn long(count: usize) -> Vec<Generation> {
        let fitness = |at: usize| 1e3 / (1 + at / 300) as f64;
        let generation = |at| Generation {
            n_genes: 6,
            genes: vec![0.5; 600],
            fitness: vec![fitness(at); 100],
            origins: vec![Origin::Script; 100],
            ..Generation::default()
        };
        (0..count).map(generation).collect()
    }

    #[test]
    fn a_short_run_is_kept_whole() {
        let whole = kept(&long(20), 2_300_000);
        assert_eq!((whole.numbers, whole.first), ((0..20).collect(), 20));
        assert!(kept(&[], 2_300_000).numbers.is_empty());
    }

    #[test]
    fn improvements_and_the_end_of_a_long_run_are_kept() {
        let kept = kept(&long(1000), 2_300_000);
        for at in [0, 1, 299, 300, 599, 600, 899, 900, 999] {
            assert!(kept.numbers.contains(&at), "{at} is missing in {kept:?}");
        }
        assert!(!kept.numbers.contains(&450) && kept.numbers.len() < 200, "{kept:?}");
        assert!(kept.numbers.is_sorted());
        assert_eq!((kept.improvements, kept.all_improvements), (3, 3));
        assert!(kept.numbers[..kept.first].iter().copied().eq(0..kept.first));
        assert!(!kept.numbers.contains(&kept.first));
    }

    /// Where there is no room for all improvements, the count says so.
    #[test]
    fn improvements_that_do_not_fit_are_counted() {
        let kept = kept(&long(1000), 120_000);
        assert!(kept.improvements < 3 && kept.all_improvements == 3, "{kept:?}");
        assert!(kept.numbers.contains(&300), "the largest gain is there: {kept:?}");
    }
}
