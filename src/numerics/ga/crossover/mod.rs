//! Crossover (recombination): how two parents make two children.

mod arithmetic;
mod blend;
mod fixed_points;
mod one_point;
mod own;
mod sbx;
mod two_point;
mod uniform;

pub use fixed_points::{check_points, cross_adjacent};
pub(crate) use own::SIGNATURE;
pub use own::{Own, cross_by};

use super::{Gene, Genomes, Mrg32k3a};
use crate::diag::Fault;
use crate::registry::Entry;
use std::sync::Arc;

/// Two genomes that are crossed in place.
pub struct Parents<'a> {
    /// One genome.
    pub first: &'a mut [f64],
    /// The other one, of the same length.
    pub second: &'a mut [f64],
    /// The genes with their ranges.
    pub genes: &'a [Gene],
}

/// Makes children from parents.
pub trait Crossover: Send + Sync {
    /// Recombines two parents to two children within the ranges of `genes`.
    ///
    /// # Errors
    ///
    /// A user's function that failed or did not return genes.
    fn cross(&self, parents: Parents, rng: &mut Mrg32k3a) -> Result<(), Fault>;

    /// The crossover of one run, for one that draws something once a run; `None` where each pair
    /// is crossed by itself.
    fn for_run(&self, _n_genes: usize, _rng: &mut Mrg32k3a) -> Option<Arc<dyn Crossover>> {
        None
    }
}

/// All ways of crossover.
pub(crate) const CROSSOVERS: &[&Entry<dyn Crossover>] = &[
    &sbx::ENTRY,
    &blend::ENTRY,
    &arithmetic::ENTRY,
    &uniform::ENTRY,
    &one_point::ENTRY,
    &two_point::ENTRY,
    &fixed_points::ENTRY,
];

/// Crosses adjacent rows: (1, 2), (3, 4), … make two children each; an odd last row mates with row
/// 1 and makes one.
///
/// # Errors
///
/// Those of the crossover.
pub fn cross_rows(
    parents: &Genomes,
    mut cross: impl FnMut(&mut [f64], &mut [f64]) -> Result<(), Fault>,
) -> Result<Genomes, Fault> {
    let count = parents.len();
    let mut children = Genomes::with_capacity(parents.n_genes(), count);
    for k in (0..count).step_by(2) {
        let mate = if k + 1 < count { k + 1 } else { 0 };
        let (mut first, mut second) = (parents.row(k).to_vec(), parents.row(mate).to_vec());
        cross(&mut first, &mut second)?;
        children.push(&first);
        if k + 1 < count {
            children.push(&second);
        }
    }
    Ok(children)
}

/// A place from 0 to `count` − 1, each as likely as the others; `count` is at least 1.
fn place(count: usize, rng: &mut Mrg32k3a) -> usize {
    ((rng.uniform() * count as f64) as usize).min(count - 1)
}
