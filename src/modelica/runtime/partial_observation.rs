//! What is known of observations where some variables have no value.

use crate::codegen::code::Outputs;
use crate::codegen::registers::Registers;
use crate::symbolic::VarId;
use std::sync::Arc;

/// What is observed where some variables have no value.
#[derive(Debug, Clone, Default)]
pub(super) struct OtherVariables {
    /// Variables that have had no value, of which a warning says so.
    pub(super) warned: Vec<VarId>,
    pub(super) known: Vec<Others>,
    /// Whether such values may be missing without a warning, as the caller looks at each value.
    pub(super) may_lack: bool,
}

/// The variables that do not depend on some.
#[derive(Debug, Clone)]
pub(super) struct Others {
    pub(super) without_value: Vec<VarId>,
    pub(super) code: Arc<(Registers, Outputs)>,
    /// Which of the observed they are.
    pub(super) places: Vec<usize>,
}
