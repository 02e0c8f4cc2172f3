//! What a system that carries forward sensitivities needs besides its registers.

use crate::codegen::sensitivity::{RightSidesSpace, SensitivityCode};
use std::sync::Arc;

/// What a system that carries sensitivities needs besides its registers.
#[derive(Debug, Clone)]
pub(super) struct Sensitivity {
    pub(super) code: Arc<SensitivityCode>,
    /// What led to the event at hand: a crossing function, or its time. `None` where the event was
    /// entered before.
    pub(super) cause: Option<Option<usize>>,
    /// The length of the simulation.
    pub(super) span: f64,
    /// Whether the time of the event has derivatives.
    pub(super) is_smooth: bool,
    /// Derivatives of the states by time before the event, and after it.
    pub(super) before: Vec<f64>,
    pub(super) after: Vec<f64>,
    pub(super) space: RightSidesSpace,
    pub(super) refusal: Option<&'static str>,
}
