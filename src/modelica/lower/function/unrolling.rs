//! Loops of few short iterations, which become these, one after the other.
//!
//! The loop variable is then a number: elements `P[5 - i]` of constant arrays are numbers, too, those
//! of others are registers, and machine code keeps what one iteration hands to the next.

use crate::syntax::ast::{Expression, ExpressionKind, ForIndex};

/// Most instructions of all iterations, each as long as in the loop. The Bessel functions of IBPSA,
/// polynomials of degree 5 by Horner's scheme, have 110.
const MOST_INSTRUCTIONS: usize = 200;

/// Whether a loop of so many instructions is short, over a range of whole numbers that are known.
pub(super) fn is_short(
    index: &ForIndex,
    instructions: usize,
    known: impl FnMut(&Expression) -> Option<f64>,
) -> bool {
    iterations(index, known).is_some_and(|n| n * instructions as f64 <= MOST_INSTRUCTIONS as f64)
}

/// The number of iterations over a range of whole numbers.
fn iterations(index: &ForIndex, mut known: impl FnMut(&Expression) -> Option<f64>) -> Option<f64> {
    let range = index.range.as_ref()?;
    let ExpressionKind::Range { start, step, stop } = &range.kind else { return None };
    let mut whole = |e: &Expression| known(e).filter(|n| n.fract() == 0.0);
    let step = step.as_ref().map_or(Some(1.0), |step| whole(step)).filter(|step| *step != 0.0)?;
    let (start, stop) = (whole(start)?, whole(stop)?);
    Some((((stop - start) / step).floor() + 1.0).max(0.0))
}
