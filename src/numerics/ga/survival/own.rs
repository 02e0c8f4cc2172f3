//! A survival that the user wrote in Modelica: a number for each of the old generation and of the
//! offspring. Those with the smallest numbers survive.

use super::{Brood, Sizes, Survival, Survivor};
use crate::bail;
use crate::diag::Fault;
use crate::ga::errors::BAD_OPERATOR;
use crate::ga::operators::{Call, Signature, Size};
use crate::ga::order;
use crate::registry::UserFunction;
use std::sync::Arc;

/// Its inputs and outputs; rank 1 is the best of all `individuals`, the old and the offspring;
/// `age` counts the generations that one has survived, 0 for offspring.
pub(crate) const SIGNATURE: Signature = Signature {
    inputs: &[
        ("fitness", Size::One),
        ("rank", Size::One),
        ("individuals", Size::One),
        ("age", Size::One),
    ],
    outputs: &[("key", Size::One)],
};

/// A function of the user as survival.
pub struct Own(pub Arc<dyn UserFunction>);

impl Survival for Own {
    fn survivors(&self, brood: &Brood<'_>, sizes: Sizes) -> Result<Vec<Survivor>, Fault> {
        survivors_by(&mut |inputs| self.0.call(inputs), brood, sizes)
    }
}

/// Chooses survivors by a function.
///
/// # Errors
///
/// Those of the function, and keys that are not numbers.
pub fn survivors_by(
    call: Call<'_>,
    brood: &Brood<'_>,
    sizes: Sizes,
) -> Result<Vec<Survivor>, Fault> {
    let n_old = brood.old.fitness.len();
    // The generation is individual by individual: old first, then offspring.
    let one = |k: usize| match k.checked_sub(n_old) {
        None => Survivor::Old(k),
        Some(k) => Survivor::Offspring(k),
    };
    // An offspring is 0 generations old, an old one at least 1.
    let age = |k: usize| brood.ages.get(k).map_or(0, |age| age + 1);
    let fitness = [brood.old.fitness, brood.offspring.fitness].concat();
    let mut keys = vec![0.0; fitness.len()];
    for (rank, k) in order(&fitness).into_iter().enumerate() {
        let inputs = [fitness[k], (rank + 1) as f64, fitness.len() as f64, age(k) as f64];
        match call(&inputs)?.first() {
            Some(&key) if !key.is_nan() => keys[k] = key,
            _ => bail!(
                BAD_OPERATOR,
                "the survival does not return a number for rank {}", rank + 1;
                help: "return a number; individuals with the smallest numbers survive"
            ),
        }
    }
    Ok(order(&keys).into_iter().take(sizes.population).map(one).collect())
}
