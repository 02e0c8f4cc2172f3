//! The crossover of the paper: adjacent ranks mate and exchange the genes after each crossing
//! point. The points are drawn once a run.
//!
//! Ranks (1, 2), (3, 4), … make two children each. With the points c₁, …, cₖ the genes after c₁ are
//! exchanged, then those after c₂, and so on: with one point c the children are (a₁ … a_c b_c+1 …
//! bₙ) and (b₁ … b_c a_c+1 … aₙ); with two points the genes between them are exchanged. An odd last
//! parent mates with rank 1 and gives the first child of that pair.
//!
//! Reference: [Rubio et al. 2006](gapilib_base::bibliography#rubio-2006), Figure 3.

use super::{Crossover, Parents};
use crate::bail;
use crate::diag::Fault;
use crate::ga::errors::BAD_CROSS_POINT;
use crate::ga::{Genomes, Mrg32k3a};
use crate::registry::Entry;
use std::sync::Arc;

/// The table entry.
pub(crate) const ENTRY: Entry<dyn Crossover> = Entry {
    name: "fixed_points",
    aliases: &["gapilib2006", "points"],
    summary: "n-point crossover at fixed points: genes after each of `points` points are \
              exchanged; points are drawn once per run",
    reference: "rubio-2006",
    make: |options| {
        let count = options.take_whole("points", 0.0..=1e3, 1.0)?;
        Ok(Box::new(FixedPoints { count, points: Vec::new() }))
    },
};

struct FixedPoints {
    count: usize,
    /// Those of the run; none before it begins.
    points: Vec<usize>,
}

impl Crossover for FixedPoints {
    fn cross(&self, parents: Parents, _: &mut Mrg32k3a) -> Result<(), Fault> {
        let Parents { first, second, .. } = parents;
        // After an even number of points the genes are exchanged and back in place.
        for &point in &self.points {
            first[point..].swap_with_slice(&mut second[point..]);
        }
        Ok(())
    }

    fn for_run(&self, n_genes: usize, rng: &mut Mrg32k3a) -> Option<Arc<dyn Crossover>> {
        let room = n_genes.saturating_sub(1) as f64;
        let points = (0..self.count).map(|_| 1 + (room * rng.uniform()) as usize);
        Some(Arc::new(FixedPoints { count: self.count, points: points.collect() }))
    }
}

/// The crossing points as indices.
///
/// # Errors
///
/// `bad-cross-point` when one lies outside 0..=`n_genes`.
pub fn check_points(points: &[i64], n_genes: usize) -> Result<Vec<usize>, Fault> {
    let mut checked = Vec::with_capacity(points.len());
    for &point in points {
        match usize::try_from(point) {
            Ok(index) if index <= n_genes => checked.push(index),
            _ => bail!(
                BAD_CROSS_POINT,
                "the crossing point {point} is outside a genome of {n_genes} genes";
                help: "choose crossing points from 1 to {}", n_genes.saturating_sub(1).max(1)
            ),
        }
    }
    Ok(checked)
}

/// One child for each parent; `points` lie in 0..=n_genes.
pub fn cross_adjacent(parents: &Genomes, points: &[usize]) -> Genomes {
    let n_genes = parents.n_genes();
    let exchanged: Vec<bool> = (0..n_genes)
        .map(|gene| points.iter().filter(|&&point| gene >= point).count() % 2 == 1)
        .collect();
    let mut children = Genomes::with_capacity(n_genes, parents.len());
    let mut child = vec![0.0; n_genes];
    for k in 0..parents.len() {
        let mate = if k % 2 == 1 {
            k - 1
        } else if k + 1 < parents.len() {
            k + 1
        } else {
            0
        };
        for (j, value) in child.iter_mut().enumerate() {
            *value = parents.row(if exchanged[j] { mate } else { k })[j];
        }
        children.push(&child);
    }
    children
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ga::Gene;
    use proptest::prelude::*;

    fn parents() -> Genomes {
        Genomes::new(4, (0..12).map(f64::from).collect()).unwrap()
    }

    #[test]
    fn one_point_exchanges_the_tails() {
        let children = cross_adjacent(&parents(), &[1]);
        assert_eq!(children.row(0), [0.0, 5.0, 6.0, 7.0]);
        assert_eq!(children.row(1), [4.0, 1.0, 2.0, 3.0]);
        assert_eq!(children.row(2), [8.0, 1.0, 2.0, 3.0], "an odd last parent mates with rank 1");
    }

    #[test]
    fn two_points_exchange_what_lies_between() {
        for points in [[1, 3], [3, 1]] {
            assert_eq!(cross_adjacent(&parents(), &points).row(0), [0.0, 5.0, 6.0, 3.0]);
        }
        assert_eq!(cross_adjacent(&parents(), &[2, 2]), parents(), "equal points cancel");
    }

    #[test]
    fn points_at_the_ends_exchange_all_or_nothing() {
        assert_eq!(cross_adjacent(&parents(), &[4]), parents());
        assert_eq!(cross_adjacent(&parents(), &[0]).row(0), parents().row(1));
    }

    #[test]
    fn the_points_of_a_run_exchange_as_the_scripts_do() {
        let mut rng = Mrg32k3a::new(&Mrg32k3a::DEFAULT_SEED).unwrap();
        let operator = FixedPoints { count: 3, points: Vec::new() };
        let genes = vec![Gene::new("a", 0.0, 12.0).unwrap(); 4];
        let mut again = rng.clone();
        let points: Vec<usize> = (0..3).map(|_| 1 + (3.0 * again.uniform()) as usize).collect();
        let run = operator.for_run(4, &mut rng).unwrap();
        let cross = |a: &mut [f64], b: &mut [f64]| {
            run.cross(Parents { first: a, second: b, genes: &genes }, &mut rng)
        };
        let children = super::super::cross_rows(&parents(), cross).unwrap();
        assert_eq!(children, cross_adjacent(&parents(), &points));
        assert_ne!(children, parents());
    }

    #[test]
    fn points_outside_the_genome_are_refused() {
        assert_eq!(check_points(&[5], 4).unwrap_err().code, BAD_CROSS_POINT);
        assert_eq!(check_points(&[-1], 4).unwrap_err().code, BAD_CROSS_POINT);
        assert_eq!(check_points(&[0, 4], 4), Ok(vec![0, 4]));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn a_pair_keeps_its_genes(points in prop::collection::vec(0_usize..=5, 0..4)) {
            let parents = Genomes::new(5, (0..20).map(f64::from).collect()).unwrap();
            let children = cross_adjacent(&parents, &points);
            for pair in [0, 2] {
                for j in 0..5 {
                    let before = (parents.row(pair)[j], parents.row(pair + 1)[j]);
                    let after = (children.row(pair)[j], children.row(pair + 1)[j]);
                    prop_assert!(after == before || after == (before.1, before.0));
                }
            }
        }
    }
}
