//! A model ready to be simulated.

use crate::codegen::Program;
use crate::flatten::FlatModel;
use std::sync::Arc;

/// A model ready to be simulated.
#[derive(Debug)]
pub struct Translated {
    /// The class with its modification, as it was asked for.
    pub problem: String,
    /// The flat model.
    pub flat: FlatModel,
    /// The compiled model.
    pub program: Arc<Program>,
}

impl Translated {
    /// The names of the states, in their order.
    pub fn state_names(&self) -> impl Iterator<Item = &Arc<str>> {
        let sorted = self.program.sorted();
        sorted.states.iter().map(|state| &sorted.dae.variable(*state).name)
    }
}
