//! Sines and cosines of the same angle, which machine code computes at once: that takes two thirds of
//! the time.

use super::code::{Code, Functions, Instruction};
use super::constants::written;
use crate::arithmetic::{Operation, Operator, Register};
use rustc_hash::{FxHashMap, FxHashSet};

/// The functions of an angle that are computed together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum OfAngle {
    Sine,
    Cosine,
}

/// Which of them an operation is.
pub(super) fn of_angle(operator: Operator) -> Option<OfAngle> {
    match operator.function()?.name {
        "sin" => Some(OfAngle::Sine),
        "cos" => Some(OfAngle::Cosine),
        _ => None,
    }
}

/// The instructions that compute one of them where the other is computed after it, in any case and
/// before the angle changes.
pub(super) fn shared(functions: &Functions, code: &Code) -> FxHashSet<usize> {
    let mut shared = FxHashSet::default();
    let mut last: FxHashMap<Register, (usize, OfAngle)> = FxHashMap::default();
    for (at, instruction) in code.instructions.iter().enumerate() {
        match *instruction {
            Instruction::Jump { .. } | Instruction::JumpUnless { .. } => last.clear(),
            Instruction::Operation(Operation { operator, a, .. }) => {
                if let Some(of_angle) = of_angle(operator) {
                    let before = last.insert(a, (at, of_angle));
                    shared.extend(before.filter(|(_, own)| *own != of_angle).map(|(at, _)| at));
                }
            }
            _ => {}
        }
        if let Some((first, n)) = written(functions, instruction) {
            last.retain(|angle, _| !(first..first + n).contains(angle));
        }
    }
    shared
}
