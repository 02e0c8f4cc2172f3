//! Frames of all calls, for each kind of number.

use crate::arithmetic::{Dual, Number};

/// The stacks of a machine.
#[derive(Debug, Clone, Default)]
pub(super) struct Stacks {
    pub(super) values: Vec<f64>,
    pub(super) first: Vec<Dual<f64>>,
    pub(super) second: Vec<Dual<Dual<f64>>>,
}

/// Numbers that a machine has a stack for.
pub(super) trait Stacked: Number {
    fn stack(stacks: &mut Stacks) -> &mut Vec<Self>;
}

impl Stacked for f64 {
    fn stack(stacks: &mut Stacks) -> &mut Vec<f64> {
        &mut stacks.values
    }
}

impl Stacked for Dual<f64> {
    fn stack(stacks: &mut Stacks) -> &mut Vec<Dual<f64>> {
        &mut stacks.first
    }
}

impl Stacked for Dual<Dual<f64>> {
    fn stack(stacks: &mut Stacks) -> &mut Vec<Dual<Dual<f64>>> {
        &mut stacks.second
    }
}
