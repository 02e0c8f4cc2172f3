//! A crossover that the user wrote in Modelica: any function of two parents, the ranges of the
//! genes and random numbers.

use super::{Crossover, Parents};
use crate::diag::Fault;
use crate::ga::operators::{Call, NUMBERS, Signature, Size, ranges, within};
use crate::ga::{Gene, Mrg32k3a};
use crate::registry::UserFunction;
use std::sync::Arc;

/// Its inputs and outputs.
pub(crate) const SIGNATURE: Signature = Signature {
    inputs: &[
        ("first", Size::Genes),
        ("second", Size::Genes),
        ("minimum", Size::Genes),
        ("maximum", Size::Genes),
        ("random", Size::Random),
    ],
    outputs: &[("child1", Size::Genes), ("child2", Size::Genes)],
};

/// A function of the user as crossover.
pub struct Own(pub Arc<dyn UserFunction>);

impl Crossover for Own {
    fn cross(&self, parents: Parents, rng: &mut Mrg32k3a) -> Result<(), Fault> {
        let Parents { first, second, genes } = parents;
        cross_by(&mut |inputs| self.0.call(inputs), first, second, genes, rng)
    }
}

/// Crosses by a function; children outside the ranges are set to their ends.
///
/// # Errors
///
/// Those of the function, and children that are not numbers.
pub fn cross_by(
    call: Call<'_>,
    first: &mut [f64],
    second: &mut [f64],
    genes: &[Gene],
    rng: &mut Mrg32k3a,
) -> Result<(), Fault> {
    let mut inputs = [&*first, &*second].concat();
    inputs.extend(ranges(genes));
    inputs.extend((0..NUMBERS * genes.len()).map(|_| rng.uniform()));
    let children = call(&inputs)?;
    let (one, two) = children.split_at(genes.len().min(children.len()));
    first.copy_from_slice(&within("crossover", one, genes)?);
    second.copy_from_slice(&within("crossover", two, genes)?);
    Ok(())
}
