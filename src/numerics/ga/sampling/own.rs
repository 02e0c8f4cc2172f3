//! A sampling that the user wrote in Modelica: the genes of an individual from one uniform number
//! for each of them.

use super::Sampling;
use crate::diag::Fault;
use crate::ga::operators::{Call, Signature, Size, ranges, within};
use crate::ga::{Gene, Genomes, Mrg32k3a};
use crate::registry::UserFunction;
use std::sync::Arc;

/// Its inputs and outputs.
pub(crate) const SIGNATURE: Signature = Signature {
    inputs: &[("random", Size::Genes), ("minimum", Size::Genes), ("maximum", Size::Genes)],
    outputs: &[("genes", Size::Genes)],
};

/// A function of the user as sampling.
pub struct Own(pub Arc<dyn UserFunction>);

impl Sampling for Own {
    fn sample(&self, genes: &[Gene], count: usize, rng: &mut Mrg32k3a) -> Result<Genomes, Fault> {
        sample_by(&mut |inputs| self.0.call(inputs), genes, count, rng)
    }
}

/// Samples by a function; genes outside their ranges are set to the ends.
///
/// # Errors
///
/// Those of the function, and genes that are not numbers.
pub fn sample_by(
    call: Call<'_>,
    genes: &[Gene],
    count: usize,
    rng: &mut Mrg32k3a,
) -> Result<Genomes, Fault> {
    let mut genomes = Genomes::with_capacity(genes.len(), count);
    for _ in 0..count {
        let mut inputs: Vec<f64> = genes.iter().map(|_| rng.uniform()).collect();
        inputs.extend(ranges(genes));
        genomes.push(&within("sampling", &call(&inputs)?, genes)?);
    }
    Ok(genomes)
}
