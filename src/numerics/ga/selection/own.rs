//! A selection that the user wrote in Modelica: how likely an individual becomes a parent, by its
//! fitness and rank. Parents are drawn with these probabilities.

use super::{Selection, spun};
use crate::bail;
use crate::diag::Fault;
use crate::ga::errors::BAD_OPERATOR;
use crate::ga::operators::{Call, Signature, Size};
use crate::ga::{Mrg32k3a, order};
use crate::registry::UserFunction;
use std::sync::Arc;

/// Its inputs and outputs; rank 1 is the best.
pub(crate) const SIGNATURE: Signature = Signature {
    inputs: &[("fitness", Size::One), ("rank", Size::One), ("individuals", Size::One)],
    outputs: &[("weight", Size::One)],
};

/// A function of the user as selection.
pub struct Own(pub Arc<dyn UserFunction>);

impl Selection for Own {
    fn select(
        &self,
        fitness: &[f64],
        count: usize,
        rng: &mut Mrg32k3a,
    ) -> Result<Vec<usize>, Fault> {
        select_by(&mut |inputs| self.0.call(inputs), fitness, count, rng)
    }

    fn draws_all_at_once(&self) -> bool {
        // One by one, but the weights are the same for all of a generation.
        true
    }
}

/// Draws parents with the weights of a function.
///
/// # Errors
///
/// Those of the function, and weights that are negative, not finite, or all zero.
pub fn select_by(
    call: Call<'_>,
    fitness: &[f64],
    count: usize,
    rng: &mut Mrg32k3a,
) -> Result<Vec<usize>, Fault> {
    let order = order(fitness);
    let mut weights = Vec::with_capacity(fitness.len());
    for (rank, &k) in order.iter().enumerate() {
        let found = call(&[fitness[k], (rank + 1) as f64, fitness.len() as f64])?;
        match found.first() {
            Some(&weight) if weight >= 0.0 && weight.is_finite() => weights.push(weight),
            found => bail!(
                BAD_OPERATOR,
                "the selection returns the weight {1} for rank \
                 {0}", rank + 1, found.unwrap_or(&f64::NAN);
                help: "return a nonnegative number"
            ),
        }
    }
    let sum: f64 = weights.iter().sum();
    if !(sum > 0.0 && sum.is_finite()) {
        bail!(BAD_OPERATOR, "the weights of the selection add up to \
                             {sum}"; help: "return a positive number for at least one rank");
    }
    Ok(spun(&weights, count, rng).into_iter().map(|rank| order[rank]).collect())
}
