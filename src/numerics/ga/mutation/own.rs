//! A mutation that the user wrote in Modelica: any function of the genes, their ranges, the rate,
//! how much of the run is over, and random numbers.

use super::{Child, Mutation};
use crate::diag::Fault;
use crate::ga::operators::{Call, NUMBERS, Signature, Size, ranges, within};
use crate::ga::{Gene, Mrg32k3a};
use crate::registry::UserFunction;
use std::sync::Arc;

/// Its inputs and outputs; `progress` is 0 at the beginning of the run and 1 at its end.
pub(crate) const SIGNATURE: Signature = Signature {
    inputs: &[
        ("genes", Size::Genes),
        ("minimum", Size::Genes),
        ("maximum", Size::Genes),
        ("rate", Size::One),
        ("progress", Size::One),
        ("random", Size::Random),
    ],
    outputs: &[("mutated", Size::Genes)],
};

/// A function of the user as mutation.
pub struct Own(pub Arc<dyn UserFunction>);

impl Mutation for Own {
    fn mutate(&self, child: Child, rng: &mut Mrg32k3a) -> Result<(), Fault> {
        let Child { genome, genes, rate, course } = child;
        mutate_by(&mut |inputs| self.0.call(inputs), genome, genes, [rate, course.fraction()], rng)
    }
}

/// Mutates by a function; genes outside their ranges are set to the ends.
///
/// # Errors
///
/// Those of the function, and genes that are not numbers.
pub fn mutate_by(
    call: Call<'_>,
    genome: &mut [f64],
    genes: &[Gene],
    rate_and_progress: [f64; 2],
    rng: &mut Mrg32k3a,
) -> Result<(), Fault> {
    let mut inputs = genome.to_vec();
    inputs.extend(ranges(genes));
    inputs.extend(rate_and_progress);
    inputs.extend((0..NUMBERS * genes.len()).map(|_| rng.uniform()));
    let mutated = call(&inputs)?;
    genome.copy_from_slice(&within("mutation", &mutated, genes)?);
    Ok(())
}
