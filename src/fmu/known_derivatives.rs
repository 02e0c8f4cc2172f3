//! What an instance keeps of its derivatives.

use crate::codegen::SensitivityCode;
use nalgebra::DMatrix;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What is known of derivatives at the values at hand: importers ask for a direction at a time.
#[derive(Default)]
pub(crate) struct Derivatives {
    /// By all states, with the variables of the further rows.
    pub(crate) by_states: Option<(Vec<usize>, DMatrix<f64>)>,
    /// The code of derivatives by a parameter, with the variables of the further rows: it does not
    /// depend on the values.
    pub(crate) by_parameters: BTreeMap<(usize, Vec<usize>), Arc<SensitivityCode>>,
}

impl Derivatives {
    /// The values at hand are others.
    pub(crate) fn forget(&mut self) {
        self.by_states = None;
    }
}
